"""Repetitions: kernels against naive versions, loops of known number, exercises."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import naive
from gestures import stack_features
from kineme.methods.kineme import _repetition_kernels as kernels
from kineme.methods.kineme.pipeline import KinemeFound
from kineme.methods.kineme.preset import KINEME, SENSORS
from kineme.methods.kineme.repetitions import find_repetitions, measure_channel_energies
from loops import make_nods, make_swings

seconds = settings(max_examples=60)


@st.composite
def points(draw: st.DrawFn) -> np.ndarray:
    """Draw points on a small grid, so that many points and distances are equal."""
    frames, dims = draw(st.integers(1, 30)), draw(st.integers(1, 3))
    rng = np.random.default_rng(draw(st.integers(0, 2**32 - 1)))
    return rng.integers(0, draw(st.integers(1, 6)), (frames, dims)).astype(np.float32)


@given(points(), st.data())
@seconds
def test_distances_are_those_of_the_naive_version(features, data) -> None:
    frames = st.integers(0, len(features) - 1)
    references = np.array(data.draw(st.lists(frames, max_size=4)), np.int64)
    found = kernels.measure_distances(features, references)
    assert found.shape == (len(references), len(features))
    for row, reference in zip(found, references, strict=True):
        expected = np.linalg.norm(features[reference] - features, axis=1)
        np.testing.assert_allclose(row, expected, rtol=1e-6)


@given(st.integers(1, 25).flatmap(lambda n: st.permutations(range(n))), st.integers(1, 9))
@seconds
def test_dips_are_those_of_the_naive_version(row, least) -> None:
    rows = np.array([row, row[::-1]], np.float32)
    depths, columns = kernels.find_dips(rows, np.array([least, 0.5], np.float32))
    for found, where, values, limit in zip(depths, columns, rows, (least, 0.5), strict=True):
        pairs = [(d, c) for d, c in zip(found.tolist(), where.tolist(), strict=True) if d > 0]
        expected = naive.find_dips(values.tolist(), limit)
        assert [d for d, _ in pairs] == [d for d, _ in expected]
        assert sorted(pairs) == sorted(expected)


@given(
    st.lists(st.integers(0, 40), unique=True).map(sorted),
    st.sampled_from([1.2, 1.35, 1.6]),
    st.sampled_from([0.15, 0.35, 1.0]),
)
@seconds
def test_extra_visits_are_those_of_the_naive_version(visits, longest, most) -> None:
    kept = kernels.drop_extra_visits(np.array(visits, np.int64), longest, most)
    assert kept.tolist() == naive.drop_extra_visits(visits, longest, most)


def count(rows: np.ndarray) -> np.ndarray:
    frames = len(rows)
    return find_repetitions(rows.astype(np.float32), 0, frames, KINEME)


movements = pytest.mark.parametrize("movement", [make_swings, make_nods])


@movements
@pytest.mark.parametrize("period", [0.5, 0.8, 1.2, 2.0, 3.0])
@pytest.mark.parametrize("rest", [0, 0.3, 1.0, 2.0])
def test_every_repetition_is_counted_also_if_there_are_rests(movement, period, rest) -> None:
    for times in range(2, 13):
        assert len(count(movement(times, period=period, rest=rest))) + 1 == times


@movements
@pytest.mark.parametrize("place", [0.42, 0.5, 0.63])
@pytest.mark.parametrize("size", [1, 2, 4])
def test_a_shock_is_no_repetition(movement, place: float, size: int) -> None:
    rows = movement(8, period=4.0)
    shock = size * rows.std(axis=0).max() * np.sin(np.linspace(0, 2 * np.pi, 18))
    rows[int(place * len(rows)) :][:18] += shock[:, None]
    assert len(count(rows)) + 1 == 8


@movements
@pytest.mark.parametrize("rest", [0.5, 1.0, 2.0])
def test_repetitions_begin_where_somebody_rests_between_them(movement, rest: float) -> None:
    found = count(movement(6, period=1.2, rest=rest))
    phases = found % (36 + round(30 * rest))
    assert ((phases >= 33) | (phases <= 3)).all()


@given(st.integers(2, 9), st.integers(0, 2**32 - 1))
@seconds
def test_people_are_not_clocks(times: int, seed: int) -> None:
    """Make repetitions whose pace and size differ by up to a sixth, with noise."""
    rng = np.random.default_rng(seed)
    rows = np.concatenate(
        [
            make_swings(
                1, period=1.2 * rng.uniform(0.92, 1.08), height=0.3 * rng.uniform(0.92, 1.08)
            )
            for _ in range(times)
        ]
    )
    rows += rng.normal(0, 0.003, rows.shape)
    assert len(count(rows)) + 1 == times


def test_what_does_not_move_has_one_repetition() -> None:
    for frames in (1, 2, 3, 100):
        assert len(count(np.zeros((frames, 4)))) == 0
        assert len(count(np.linspace(0, 1, frames)[:, None])) == 0


@movements
@pytest.mark.parametrize("rest", [0.5, 1.5])
def test_a_single_repetition_between_rests_is_one(movement, rest: float) -> None:
    still = np.zeros((round(30 * rest), 6))
    once = movement(1, period=1.5)
    for rows in (np.concatenate([once, still]), np.concatenate([still, once, still])):
        assert len(count(rows)) == 0


@movements
@pytest.mark.parametrize("missing", [0.1, 0.2, 0.4])
def test_a_repetition_cut_short_at_an_end_still_counts(movement, missing: float) -> None:
    for times in range(3, 9):
        rows = movement(times, period=1.5)
        lost = round(missing * 45)
        for part in (rows[lost:], rows[:-lost]):
            assert len(count(part)) + 1 == times


def test_what_comes_before_the_repetitions_joins_the_first() -> None:
    rows = np.concatenate([make_swings(1, period=2, axis=2), make_swings(6, period=1)])
    found = count(rows)
    assert len(found) == 5
    assert found[0] > 60


@pytest.mark.parametrize("heights", [(0.3, 0.15, 0.3, 0.15), (0.15, 0.15, 0.3, 0.15, 0.3, 0.3)])
def test_deep_and_shallow_ones_are_as_many(heights: tuple[float, ...]) -> None:
    rows = np.concatenate([make_nods(1, period=1.5, rest=0.3, height=height) for height in heights])
    assert len(count(rows)) + 1 == len(heights)


def test_left_and_right_are_halves_of_one_repetition() -> None:
    both = np.concatenate([make_nods(1, period=0.8, axis=axis) for axis in (0, 2)])
    for times in range(2, 7):
        assert len(count(np.tile(both, (times, 1)))) + 1 == times


@given(st.integers(20, 300), st.integers(0, 2**32 - 1))
@settings(max_examples=40)
def test_what_merely_shakes_is_not_repeated(frames: int, seed: int) -> None:
    rows = np.random.default_rng(seed).normal(0, 0.01, (frames, 15))
    assert len(count(rows)) == 0


@pytest.mark.parametrize("fps", [8.0, 10.0, 12.5])
def test_noise_of_one_channel_is_no_repetition_but_a_slow_movement_with_noise_is(fps) -> None:
    preset, times = SENSORS.at_most(fps), np.arange(0, 20, 1 / fps)
    for seed in range(20):
        noise = np.random.default_rng(seed).normal(0, 0.01, (len(times), 1)).astype(np.float32)
        assert len(find_repetitions(noise, 0, len(times), preset)) == 0
        slow = noise + np.float32(0.03 * np.cos(np.pi * times))[:, None]
        assert len(find_repetitions(slow, 0, len(times), preset)) == pytest.approx(9, abs=1)


@given(st.integers(0, 2**32 - 1), st.integers(2, 5), st.integers(1, 3))
@seconds
def test_divisions_are_those_of_the_naive_version(seed: int, count: int, smooth: int) -> None:
    rng = np.random.default_rng(seed)
    rows = np.sin(np.arange(40)[:, None] / (2, 3, 5)) + rng.normal(0, 0.3, (40, 3))
    poses, speeds = kernels.smooth_rows(rows.astype(np.float32), smooth)
    for found, expected in zip((poses, speeds), naive.smooth_rows(rows.astype(np.float32), smooth)):
        np.testing.assert_allclose(found, expected, atol=1e-5)
    path = np.append(0, np.cumsum(speeds))
    visits = np.sort(rng.choice(np.arange(2, 39, 6), count, replace=False))
    options = 6, 1.0, 1.5, 0.4, 0.2
    found = kernels.measure_division(poses, path, visits, *options)
    np.testing.assert_allclose(
        found, naive.measure_division(poses, path, visits, *options), atol=1e-9
    )


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
