"""Feature bundling: the authors' values, the naive version, and invariances."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.stats import ortho_group

import kineme
import naive
from graphs import features
from kineme.datasets import Action, synthesize
from kineme.errors import ParameterError
from kineme.features import pose_features, stack
from kineme.features.bundling import bundle

SQUATS = stack(pose_features(synthesize([Action("squat", 6)], fps=30, seed=2).motion), (-5, 0, 5))
few = settings(max_examples=20)


@pytest.mark.parametrize("trial", ["86_01", "86_09", "86_10", "86_11", "86_14"])
def test_near_the_authors_program(data_dir: Path, trial: str) -> None:
    """Which minimises the same function iteratively, to its own precision."""
    motion = kineme.resample(kineme.read(data_dir / "cmu86" / f"{trial}.amc"), 30)
    plain_cm = 100 * stack(pose_features(motion), (-10, -5, 0, 5, 10))
    with np.load(data_dir / "cmu86" / "reference" / f"2017_bundled_{trial}.npz") as stored:
        expected_cm = stored["features"].T
    apart = np.linalg.norm(bundle(plain_cm) - expected_cm, axis=1)
    assert np.linalg.norm(expected_cm - plain_cm, axis=1).mean() > 15
    assert np.median(apart) < 0.2
    assert apart.max() < 5


@pytest.mark.parametrize(("neighbors", "variance"), [(32, 0.98), (5, 0.8)])
def test_equal_to_the_naive_version(neighbors: int, variance: float) -> None:
    rows = SQUATS[:90] + np.random.default_rng(0).normal(0, 0.01, SQUATS[:90].shape)
    expected = naive.bundle(rows, neighbors=neighbors, variance=variance)
    found = bundle(rows, neighbors=neighbors, variance=variance)
    np.testing.assert_allclose(found, expected, atol=1e-5)
    assert np.abs(found - rows).max() > 0.01


@given(st.integers(0, 2**32 - 1), st.floats(-1e3, 1e3), st.floats(1e-2, 1e2))
@few
def test_turning_moving_and_scaling_do_the_same_to_the_result(seed, shift, factor) -> None:
    turn = ortho_group.rvs(SQUATS.shape[1], random_state=seed)
    changed = bundle(factor * SQUATS @ turn + shift)
    np.testing.assert_allclose(changed, factor * bundle(SQUATS) @ turn + shift, atol=1e-6 * factor)


@given(features(max_frames=60))
@settings(max_examples=60)
def test_any_features_stay_among_their_neighbours(points: np.ndarray) -> None:
    bundled = bundle(points)
    assert bundled.shape == points.shape
    assert np.isfinite(bundled).all()
    reach = np.linalg.norm(points - points.mean(axis=0), axis=1).max()
    assert (np.linalg.norm(bundled - points.mean(axis=0), axis=1) <= 3 * reach + 1e-9).all()


@pytest.mark.parametrize("n", [1, 2, 3, 40, 3000])
def test_what_stands_still_stays(n: int) -> None:
    np.testing.assert_allclose(bundle(np.full((n, 15), 0.3)), 0.3)


@pytest.mark.parametrize(
    ("rows", "options"),
    [
        (np.zeros(5), {}),
        (np.zeros((0, 3)), {}),
        (np.full((5, 3), np.nan), {}),
        (np.zeros((5, 3)), {"neighbors": 0}),
        (np.zeros((5, 3)), {"variance": 0.0}),
        (np.zeros((5, 3)), {"variance": 1.5}),
    ],
)
def test_bad_arguments_are_named(rows: np.ndarray, options: dict[str, float]) -> None:
    with pytest.raises(
        ParameterError, match="neighbors" if options else "frames x dims|not finite"
    ):
        bundle(rows, **options)
