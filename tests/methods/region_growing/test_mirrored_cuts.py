"""Mirrored cuts: left and right steps become separate primitives."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import naive
from kineme.datasets import Action, synthesize
from kineme.errors import ParameterError
from kineme.features import mirror
from kineme.methods.region_growing.activities import merge_cuts
from kineme.methods.region_growing.analysis import RegionsFound, analyze_regions
from kineme.methods.region_growing.preset import KRUEGER2017, VOEGELE2014, RegionGrowingPreset
from kineme.methods.segmenter import segment_and_found

MIRRORING = {
    "voegele2014": VOEGELE2014.replace(mirror=True),
    "krueger2017": KRUEGER2017.replace(mirror=True),
}
presets = pytest.mark.parametrize("preset", MIRRORING.values(), ids=MIRRORING.keys())
frames = st.lists(st.integers(0, 200), unique=True).map(sorted)


@cache
def found_in(preset: RegionGrowingPreset, *actions: str, side: str = "right") -> RegionsFound:
    made = synthesize([Action(name, 6, side=side) for name in actions], fps=30, seed=5)
    return segment_and_found(made.motion, preset=preset)[1]


def longest(found: RegionsFound) -> str:
    return str(found.symmetry[np.argmax(np.diff(found.borders) * found.repeats)])


@given(frames, frames, st.sampled_from([0.5, 7.5, 30.0]))
def test_merging_equals_the_naive_version(main, mirrored, gap) -> None:
    found = merge_cuts(np.array(main, np.int64), np.array(mirrored, np.int64), gap)
    assert found.tolist() == naive.merge_cuts(main, mirrored, gap)


@presets
def test_steps_are_told_apart_in_walking(preset: RegionGrowingPreset) -> None:
    plain = found_in(preset.replace(mirror=False), "walk")
    found = found_in(preset, "walk")
    assert plain.symmetry is None
    assert longest(found) == "alternating"
    assert len(found.primitives) >= 1.6 * len(plain.primitives)
    assert set(plain.primitives.tolist()) <= set(found.primitives.tolist())
    np.testing.assert_array_equal(found.borders, plain.borders)


@presets
@pytest.mark.parametrize(
    ("action", "expected"),
    [("squat", "symmetric"), ("arm circles", "symmetric"), ("run", "alternating"),
     ("punch", "one-sided"), ("wave", "one-sided")],
)  # fmt: skip
def test_the_symmetry_of_an_activity_is_told(preset, action: str, expected: str) -> None:
    found = found_in(preset, action)
    assert longest(found) == expected
    assert ((found.symmetry == "") == ~found.repeats).all()


@presets
def test_a_kick_with_the_other_leg_has_the_same_cuts(preset: RegionGrowingPreset) -> None:
    motion = synthesize([Action("kick", 5), Action("walk", 4)], fps=30, seed=3).motion
    found, other = (segment_and_found(m, preset=preset)[1] for m in (motion, mirror(motion)))
    np.testing.assert_array_equal(found.primitives, other.primitives)
    np.testing.assert_array_equal(found.symmetry, other.symmetry)


def test_features_without_sides_are_refused() -> None:
    with pytest.raises(ParameterError, match="mirror=False"):
        analyze_regions(np.zeros((30, 2)), MIRRORING["krueger2017"])
