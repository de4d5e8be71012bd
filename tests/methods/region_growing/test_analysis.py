"""Invariances of the whole chain from features to clusters."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.stats import ortho_group

from graphs import features
from kineme.datasets import random_recording
from kineme.errors import ParameterError
from kineme.methods.prepare import compute_motion_features
from kineme.methods.presets import PUBLISHED, resolve_preset
from kineme.methods.region_growing.analysis import RegionsFound, analyze_regions
from kineme.methods.region_growing.preset import RegionGrowingPreset
from kineme.methods.region_growing.warping import BASIC_STEPS

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


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("radius", 0),
        ("radius", float("nan")),
        ("path_separation", 0),
        ("path_separation", -1.0),
        ("path_separation", float("nan")),
        ("growth_gap", -1),
        ("coverage", 1.5),
        ("symmetry", 0),
        ("bundling", 0),
        ("max_slope", 0.5),
        ("connection", "loose"),
        ("raduis", 1.0),
        ("name", "mine"),
    ],
)
def test_a_constant_out_of_range_is_named(name: str, value: object) -> None:
    with pytest.raises(ParameterError, match=name):
        resolve_preset("krueger2017", **{name: value})
