"""Segments that repeat: kernels against naive versions, and exercises that are counted."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import naive
from gestures import stack_features
from kineme.methods.kineme import _repetition_kernels as kernels
from kineme.methods.kineme.pipeline import KinemeFound
from kineme.methods.kineme.preset import KINEME
from kineme.methods.kineme.repetitions import measure_channel_energies

seconds = settings(max_examples=60)
FPS = round(KINEME.working_fps)


def similar(seed: int, count: int, noise: float) -> np.ndarray:
    """Draw repetitions of one movement with different sizes, (count, places, dims)."""
    rng = np.random.default_rng(seed)
    shape = rng.normal(size=(6, 3)).cumsum(axis=0)
    sizes = rng.uniform(0.6, 1.4, (count, 1, 1))
    return sizes * shape + noise * rng.normal(size=(count, 6, 3)) + rng.normal(size=(count, 1, 3))


def centered(repetitions: np.ndarray) -> np.ndarray:
    found = repetitions.copy()
    kernels.center_repetitions(found)
    return found


shapes = st.integers(0, 2**32 - 1), st.integers(2, 9), st.sampled_from([0.1, 0.5, 2.0])


@given(*shapes)
@seconds
def test_repetitions_are_centered_each_on_its_own_mean(seed, count, noise) -> None:
    repetitions = similar(seed, count, noise)
    means = repetitions.mean(axis=1, keepdims=True)
    np.testing.assert_allclose(centered(repetitions), repetitions - means, atol=1e-12)


@given(*shapes)
@seconds
def test_what_is_explained_is_that_of_the_naive_version(seed, count, noise) -> None:
    rng = np.random.default_rng(seed)
    repetitions = similar(seed, count, noise)
    visits = np.append(0, np.cumsum(rng.integers(4, 12, count)))
    poses = rng.normal(size=(visits[-1] + 3, 3)).cumsum(axis=0)
    path = np.append(0, np.cumsum(rng.uniform(0.1, 2, len(poses))))
    found = kernels.explain_variance(poses, path, visits, centered(repetitions))
    expected = naive.explain_variance(poses, path, visits.tolist(), list(repetitions))
    assert found == pytest.approx(expected, abs=1e-9)
    assert -1e-12 <= found <= 1


@given(*shapes)
@seconds
def test_the_best_parting_is_that_of_the_naive_version(seed, count, noise) -> None:
    repetitions = centered(similar(seed, count, noise))
    found = kernels.find_best_parting(repetitions)
    assert found == pytest.approx(naive.find_best_parting(list(repetitions)), abs=1e-9)
    assert 0 <= found <= 1
    if count < 4:  # two of each are the fewest
        assert found == 1


@given(st.integers(0, 99), st.integers(1, 5))
@seconds
def test_similarities_are_those_of_the_naive_version(seed: int, count: int) -> None:
    movements = np.random.default_rng(seed).normal(size=(count, 6, 3)).cumsum(axis=1)
    found = kernels.measure_similarities(movements)
    np.testing.assert_allclose(found, naive.measure_similarities(list(movements)), atol=1e-9)
    shifted = np.stack([movements[0], np.roll(movements[0], 2, axis=0)])
    np.testing.assert_allclose(kernels.measure_similarities(shifted), 1, atol=1e-9)  # at any phase


@given(st.integers(0, 99), st.integers(1, 30), st.integers(0, 29), st.integers(1, 30))
@seconds
def test_the_spread_is_that_of_the_naive_version(seed, n, start, length) -> None:
    view = np.random.default_rng(seed).normal(size=(n, 3)).astype(np.float32)
    start = min(start, n - 1)
    found = kernels.measure_spread(view, start, start + length, 32)
    assert found == pytest.approx(
        naive.measure_spread(view, start, start + length), rel=1e-5, abs=1e-6
    )


def squats(count: int, *, seed: int = 0, first: int = 0, period: float = 4.0) -> np.ndarray:
    """Make slow squats that become slower and less deep, with noise."""
    rng = np.random.default_rng(seed)
    drift = np.linspace(0, 1, count)
    parts = []
    for share in drift:
        frames = round(FPS * period * (1 + 0.25 * share) * rng.uniform(0.95, 1.05))
        depth = (1 - 0.25 * share) * rng.uniform(0.95, 1.05)
        angle = np.arange(frames) / frames * 2 * np.pi
        poses = np.zeros((frames, 6))
        poses[:, first] = 0.4 * depth * (1 - np.cos(angle))
        poses[:, (first + 1) % 6] = 0.2 * depth * np.sin(angle)
        parts.append(poses)
    rows = np.concatenate(parts)
    return rows + rng.normal(0, 0.005, rows.shape)


@given(
    st.lists(st.integers(1, 300), min_size=1, max_size=12).map(np.cumsum),
    st.sampled_from([(8.0, 1.7, 4.0, 14.0), (30.0, 0.5, 2.0, 1e9)]),
)
def test_what_times_allow_is_that_of_the_naive_version(visits, limits) -> None:
    found = kernels.score_durations(visits, 30.0, *limits)
    assert found == pytest.approx(naive.score_durations(visits, 30.0, *limits), abs=1e-12)


def parting_of_channels(*sizes: np.ndarray) -> float:
    """Score repetitions of one shape with these sizes (repetitions, channels)."""
    angle = np.linspace(0, 2 * np.pi, 16, endpoint=False)
    repetitions = np.array([np.outer(np.sin(angle), size) for size in sizes])
    return float(kernels.find_best_parting(measure_channel_energies(repetitions)))


def test_other_channels_are_another_movement_and_another_size_is_not() -> None:
    arms, legs = np.array([1.0, 0.8, 0.1, 0.0]), np.array([0.1, 0.0, 1.0, 0.6])
    assert parting_of_channels(arms, arms, arms, legs, legs, legs) < KINEME.same_channels - 0.1
    shrinking = [size * arms for size in np.linspace(1, 0.1, 6)]
    assert parting_of_channels(*shrinking) > KINEME.same_channels + 0.1


def found_in(*parts: np.ndarray) -> KinemeFound:
    return KINEME.analyze(stack_features(np.concatenate(parts)))


@pytest.mark.parametrize("seed", range(4))
def test_ten_slow_repetitions_are_one_activity_counted_ten(seed: int) -> None:
    found = found_in(squats(10, seed=seed))
    assert found.segments.labels.tolist() == [0]
    assert found.segments.counts.tolist() == [10]


@pytest.mark.parametrize("counts", [(8, 9), (4, 6)])
@pytest.mark.parametrize("seed", range(4))
def test_two_exercises_one_after_the_other_are_two_activities(seed: int, counts) -> None:
    one = squats(counts[0], seed=seed, period=4.5)
    found = found_in(one, squats(counts[1], seed=seed + 10, first=3))
    assert found.segments.labels.tolist() == [0, 1]
    assert abs(found.borders[1] - len(one)) <= FPS
    assert tuple(found.segments.counts.tolist()) == counts
