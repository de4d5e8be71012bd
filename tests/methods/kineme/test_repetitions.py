"""Repetition counts: loops of known number, and kernels against naive versions."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import naive
from kineme.methods.kineme import _repetition_kernels as kernels
from kineme.methods.kineme.preset import KINEME
from kineme.methods.kineme.repetitions import Candidate, find_repetitions, shift_to_rest
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
def test_every_repetition_is_counted(movement, period: float) -> None:
    for times in range(2, 13):
        found = count(movement(times, period=period))
        assert len(found) + 1 == times


@movements
@pytest.mark.parametrize("place", [0.42, 0.5, 0.63])
@pytest.mark.parametrize("size", [1, 2, 4])
def test_a_shock_is_no_repetition(movement, place: float, size: int) -> None:
    rows = movement(8, period=4.0)
    shock = size * rows.std(axis=0).max() * np.sin(np.linspace(0, 2 * np.pi, 18))
    rows[int(place * len(rows)) :][:18] += shock[:, None]
    assert len(count(rows)) + 1 == 8


@movements
@pytest.mark.parametrize("rest", [0.3, 1.0, 2.0])
def test_a_rest_between_repetitions_changes_no_count(movement, rest: float) -> None:
    for period in (0.5, 1.2, 3.0):
        for times in range(2, 13):
            assert len(count(movement(times, period=period, rest=rest))) + 1 == times


@movements
def test_repetitions_begin_at_equal_phase(movement) -> None:
    found = count(movement(8, period=1.2))
    lengths = [b - a for a, b in pairwise([0, *found.tolist(), 8 * 36])]
    assert max(abs(length - 36) for length in lengths[1:-1]) <= 1
    assert max(lengths) - min(lengths) <= 18


@movements
@pytest.mark.parametrize("rest", [0.5, 1.0, 2.0])
def test_repetitions_begin_where_somebody_rests_between_them(movement, rest: float) -> None:
    found = count(movement(6, period=1.2, rest=rest))
    phases = found % (36 + round(30 * rest))
    assert ((phases >= 33) | (phases <= 3)).all()


speeds = st.lists(st.sampled_from([0.0, 0.01, 0.5, 1.0, 3.0]), min_size=2, max_size=60)


@given(speeds, st.data(), st.integers(0, 4))
@seconds
def test_as_many_repetitions_follow_each_other_at_rest(moved, data, averaged: int) -> None:
    at = st.sets(st.integers(1, len(moved) - 1), max_size=6)
    cuts = np.array(sorted(data.draw(at)), np.int64)
    found = shift_to_rest(cuts, np.append(0, np.cumsum(moved)), averaged)
    assert len(found) == len(cuts)
    assert (np.diff(found, prepend=0, append=len(moved)) > 0).all()


def test_where_nobody_rests_repetitions_begin_where_their_poses_tell() -> None:
    cuts = np.array([30, 60, 90])
    assert shift_to_rest(cuts, np.arange(121.0), 3).tolist() == cuts.tolist()


@given(st.integers(2, 9), st.integers(0, 2**32 - 1))
@settings(max_examples=60)
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


@pytest.mark.parametrize("times", [2, 3, 5, 10, 40])
def test_chance_is_told_from_any_number_of_repetitions(times: int) -> None:
    """Repetitions of a movement correlate by 0.5, random ones by 0.3."""
    rng = np.random.default_rng(times)
    for common, is_chance in ((0.5, False), (0.3, True)):
        shared = np.sqrt(common) * rng.normal(0, 1, (1000, 15))
        parts = shared + np.sqrt(1 - common) * rng.normal(0, 1, (times, 1000, 15))
        left = float(kernels.measure_unexplained(parts, 1.0).mean())
        assert Candidate(np.arange(times + 1), 0, 0, 0, left).is_chance(0.6) == is_chance


@st.composite
def gains(draw: st.DrawFn) -> np.ndarray:
    shape = draw(st.integers(1, 9)), draw(st.integers(1, 9))
    values = st.integers(-5, 4)
    return np.array([[draw(values) for _ in range(shape[1])] for _ in range(shape[0])], np.float64)


@given(gains())
@seconds
def test_matched_lengths_are_those_of_the_naive_version(gained) -> None:
    best, ends = naive.match_columns(gained.tolist(), 4.0)
    found = kernels.match_columns(gained, 4.0)
    assert found in ends if best > 0 else found == (0, 0)


@given(st.integers(0, 2**32 - 1))
@settings(max_examples=60)
def test_parts_of_a_division_are_those_of_the_naive_versions(seed: int) -> None:
    rng = np.random.default_rng(seed)
    poses = rng.normal(0, 1, (12, 3))
    path = np.append(0, np.cumsum(rng.integers(0, 3, 12))).astype(float)
    lengths = rng.uniform(0, path[-1] + 0.1, 5)
    expected = naive.look_up_poses(poses, path, lengths)
    np.testing.assert_array_equal(kernels.look_up_poses(poses, path, lengths), expected)
    parts = rng.normal(0, 1, (int(rng.integers(2, 5)), 6, 3)) + rng.normal(0, 1, (6, 3))
    for centering in (0.0, 0.4, 1.0):
        found = kernels.measure_unexplained(parts, centering)
        np.testing.assert_allclose(found, naive.measure_unexplained(parts, centering), atol=1e-12)
    best, ends = naive.follow_end(poses, path, lengths, parts[0], 4.0, 2.0)
    length, counted = kernels.follow_end(poses, path, lengths, parts[0], 4.0, 2.0)
    known = min(ends, key=lambda end: abs(end[0] - length) + abs(end[1] - counted))
    np.testing.assert_allclose((length, counted), known if best > 0 else (0, 0), atol=1e-9)
    visits = np.array([1, 5, 9])
    for part, (a, b) in zip(
        kernels.sample_repetitions(poses, path, visits, 4),
        pairwise(path[visits]),
        strict=True,
    ):
        places = a + (b - a) * (np.arange(4) + 0.5) / 4
        np.testing.assert_array_equal(part, naive.look_up_poses(poses, path, places))


@given(st.integers(0, 2**32 - 1), st.integers(2, 5), st.integers(1, 3))
@settings(max_examples=60)
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
