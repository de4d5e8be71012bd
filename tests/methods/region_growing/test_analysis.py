"""Test the whole chain from features to clusters: invariances, any constants, and mirrored cuts."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.stats import ortho_group

import naive
from graphs import features
from kineme.datasets import Action, random_recording, synthesize
from kineme.errors import ParameterError
from kineme.features import mirror
from kineme.methods.prepare import compute_motion_features
from kineme.methods.presets import PUBLISHED, resolve_preset
from kineme.methods.region_growing import BASIC_STEPS
from kineme.methods.region_growing.activities import merge_cuts
from kineme.methods.region_growing.analysis import RegionsFound, analyze_regions
from kineme.methods.region_growing.preset import (
    KRUEGER2017,
    VOEGELE2014,
    RegionGrowingPreset,
)
from kineme.methods.segmenter import segment_and_found

presets = pytest.mark.parametrize("preset", PUBLISHED.values(), ids=PUBLISHED.keys())
few = settings(max_examples=5)


@cache
def recorded(seed: int, preset: RegionGrowingPreset) -> np.ndarray:
    return compute_motion_features(random_recording(seed).motion, preset)


@cache
def found_in(seed: int, preset: RegionGrowingPreset) -> RegionsFound:
    return analyze_regions(recorded(seed, preset), preset)


def assert_same(found: RegionsFound, expected: RegionsFound) -> None:
    for name in ("borders", "repeats", "repetition", "primitives"):
        np.testing.assert_array_equal(getattr(found, name), getattr(expected, name), name)
    np.testing.assert_array_equal(found.clustering.labels, expected.clustering.labels)
    np.testing.assert_array_equal(found.clustering.scores, expected.clustering.scores)


def assert_tiles(found: RegionsFound, n: int) -> None:
    for borders in (found.borders, found.primitives):
        assert borders[0] == 0
        assert borders[-1] == n
        assert (np.diff(borders) > 0).all()
    assert set(found.borders.tolist()) <= set(found.primitives.tolist())
    assert len(found.repeats) == len(found.repetition) == len(found.borders) - 1
    assert len(found.clustering.labels) == len(found.primitives) - 1
    assert ((found.repetition >= 0) & (found.repetition <= 1)).all()
    assert ((found.clustering.scores >= 0) & (found.clustering.scores <= 1)).all()


@presets
@given(st.integers(0, 3), st.integers(0, 2**32 - 1), st.floats(-1e4, 1e4))
@few
def test_moving_and_turning_the_features_changes_nothing(preset, seed, turn, shift) -> None:
    rows = recorded(seed, preset)
    turned = rows @ ortho_group.rvs(rows.shape[1], random_state=turn) + shift
    assert_same(analyze_regions(turned, preset), found_in(seed, preset))


@presets
@given(st.integers(0, 3), st.floats(1e-3, 1e3))
@few
def test_scaling_the_features_with_all_lengths_changes_nothing(preset, seed, factor) -> None:
    factor = 2.0 ** round(np.log2(factor))  # distances are then scaled exactly
    growth = preset.growth_radius
    scaled = replace(
        preset,
        radius=factor * preset.radius,
        growth_radius=None if growth is None else factor * growth,
        zero_cost=factor * preset.zero_cost,
    )
    found = analyze_regions(factor * recorded(seed, preset), scaled)
    assert_same(found, found_in(seed, preset))


@presets
def test_threads_and_repetition_change_nothing(preset, set_threads) -> None:
    set_threads(1)
    alone = analyze_regions(recorded(2, preset), preset)
    set_threads(5)
    for _ in range(2):
        found = analyze_regions(recorded(2, preset), preset)
        assert_same(found, alone)
        np.testing.assert_array_equal(found.graph.indices, alone.graph.indices)
        np.testing.assert_array_equal(found.graph.distances, alone.graph.distances)


@st.composite
def constants(draw: st.DrawFn) -> RegionGrowingPreset:
    """Draw a preset with changed constants."""
    seconds = st.sampled_from([0.0, 0.01, 1 / 30, 0.2, 1.0, 50.0])
    some = st.sampled_from([0.01, 1 / 30, 0.2, 50.0])
    few_frames = st.integers(1, 20)
    steps = st.lists(st.tuples(st.integers(0, 5), st.integers(0, 5)).filter(any), min_size=1)
    choices = {
        "radius": st.sampled_from([1e-9, 0.5, 1.0, 3.0, 1e4]),
        "max_neighbors": few_frames,
        "max_lag": st.none() | some,
        "bundling": st.none() | few_frames,
        "mirror": st.booleans(),
        "steps": st.just(BASIC_STEPS) | steps.map(tuple),
        "skip_penalty": st.sampled_from([0.0, 1.0]),
        "growth": st.sampled_from(["squares", "scan_lines"]),
        "growth_radius": st.none() | st.sampled_from([0.5, 10.0]),
        "growth_neighbors": st.none() | few_frames,
        "diagonal": st.sampled_from(["band", "component"]),
        "diagonal_width": seconds,
        "growth_gap": some,
        "growth_count": st.integers(0, 200),
        "growth_distance": seconds,
        "min_path": seconds,
        "path_separation": st.none() | some,
        "max_slope": st.sampled_from([1.0, 2.0, 9.0]),
        "symmetry": st.sampled_from([0.01, 0.5, 1.0]),
        "min_primitive": seconds,
        "cluster_neighbors": st.none() | few_frames,
        "cluster_min_path": seconds,
        "coverage": st.sampled_from([0.01, 0.5, 1.0]),
        "interpolate": st.booleans(),
        "connection": st.sampled_from(["weak", "strong"]),
    }
    changed = draw(st.sets(st.sampled_from(sorted(choices))))
    overrides = {name: draw(choices[name]) for name in sorted(changed)}
    return resolve_preset(draw(st.sampled_from(sorted(PUBLISHED))), **overrides)


@given(features(max_frames=60), constants())
@settings(max_examples=60)
def test_segments_tile_whatever_the_constants(points, preset) -> None:
    assert_tiles(analyze_regions(points, preset, mirror=np.negative), len(points))


MIRRORING = {
    "voegele2014": VOEGELE2014.replace(mirror=True),
    "krueger2017": KRUEGER2017.replace(mirror=True),
}
mirroring = pytest.mark.parametrize("preset", MIRRORING.values(), ids=MIRRORING.keys())
frames = st.lists(st.integers(0, 200), unique=True).map(sorted)


@cache
def find_mirrored(preset: RegionGrowingPreset, *actions: str, side: str = "right") -> RegionsFound:
    made = synthesize([Action(name, 6, side=side) for name in actions], fps=30, seed=5)
    return segment_and_found(made.motion, preset=preset)[1]


def longest(found: RegionsFound) -> str:
    return str(found.symmetry[np.argmax(np.diff(found.borders) * found.repeats)])


@given(frames, frames, st.sampled_from([0.5, 7.5, 30.0]))
def test_merging_equals_the_naive_version(main, mirrored, gap) -> None:
    found = merge_cuts(np.array(main, np.int64), np.array(mirrored, np.int64), gap)
    assert found.tolist() == naive.merge_cuts(main, mirrored, gap)


@mirroring
def test_steps_are_told_apart_in_walking(preset: RegionGrowingPreset) -> None:
    plain = find_mirrored(preset.replace(mirror=False), "walk")
    found = find_mirrored(preset, "walk")
    assert plain.symmetry is None
    assert longest(found) == "alternating"
    assert len(found.primitives) >= 1.6 * len(plain.primitives)
    assert set(plain.primitives.tolist()) <= set(found.primitives.tolist())
    np.testing.assert_array_equal(found.borders, plain.borders)


@mirroring
@pytest.mark.parametrize(
    ("action", "expected"),
    [("squat", "symmetric"), ("arm circles", "symmetric"), ("run", "alternating"),
     ("punch", "one-sided"), ("wave", "one-sided")],
)  # fmt: skip
def test_the_symmetry_of_an_activity_is_told(preset, action: str, expected: str) -> None:
    found = find_mirrored(preset, action)
    assert longest(found) == expected
    assert ((found.symmetry == "") == ~found.repeats).all()


@mirroring
def test_a_kick_with_the_other_leg_has_the_same_cuts(preset: RegionGrowingPreset) -> None:
    motion = synthesize([Action("kick", 5), Action("walk", 4)], fps=30, seed=3).motion
    found, other = (segment_and_found(m, preset=preset)[1] for m in (motion, mirror(motion)))
    np.testing.assert_array_equal(found.primitives, other.primitives)
    np.testing.assert_array_equal(found.symmetry, other.symmetry)


def test_features_without_sides_are_refused() -> None:
    with pytest.raises(ParameterError, match="mirror=False"):
        analyze_regions(np.zeros((30, 2)), MIRRORING["krueger2017"])
