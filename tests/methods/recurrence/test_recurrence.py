"""Recurrence against its naive twins, pair by pair, and what it means."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import naive
from bands import one_sided, points, to_matrix, two_sided
from kineme.methods.recurrence import _distance_kernels as distant
from kineme.methods.recurrence import _recurrence_kernels as kernels
from kineme.methods.recurrence.preset import KINEME
from kineme.methods.recurrence.recurrence import narrower, phase_windows, recurrence
from loops import swing

seconds = settings(max_examples=60)
STEPS = st.integers(1, 7)
WIDTHS = st.integers(0, 12)
BLURS = GAPS = st.integers(0, 15)


@given(points(), STEPS, WIDTHS)
@seconds
def test_nearest_frames_is_that_of_the_naive_version(features, step, width) -> None:
    expected = naive.nearest_frames(features, step, width)
    near = np.full((len(expected), 2 * width + 1), np.nan, np.float32)
    kernels.nearest_frames(features, step, width, 0, len(near), near)
    np.testing.assert_allclose(near, two_sided(expected, width), rtol=1e-6)


@given(points(), WIDTHS, BLURS)
@seconds
def test_blurred_rows_are_those_of_the_naive_version(features, width, blur) -> None:
    near = naive.nearest_frames(features, 1, width)
    found = np.full((len(near), 2 * width + 1), np.nan, np.float32)
    kernels.blur_rows(two_sided(near, width), blur, 0, len(near), found)
    # Beyond the ends a window may still reach back into the recording; nobody asks there.
    inside = np.isfinite(two_sided(np.zeros_like(near), width))
    expected = two_sided(naive.blurred(near, width, blur), width)
    np.testing.assert_array_equal(found[inside], expected[inside])


@given(
    points(), WIDTHS, GAPS, st.integers(0, 9), st.sampled_from([0.1, 1.0]),
    st.sampled_from([1.0, 2.5, 1e9]),
)  # fmt: skip
@seconds
def test_local_scales_are_those_of_the_naive_version(features, width, gap, rank, low, high) -> None:
    near = naive.nearest_frames(features, 1, width)
    found = np.full(len(near), np.nan, np.float32)
    kernels.local_scales(two_sided(near, width), gap, rank, 0, len(near), low, high, found)
    expected = naive.local_scales(near, width, gap, rank, low, high)
    np.testing.assert_allclose(found, expected, rtol=1e-6)


@given(points(), WIDTHS, st.sampled_from([0.5, 1.0, 3.0]))
@seconds
def test_similarities_are_those_of_the_naive_version(features, width, softness) -> None:
    near = naive.nearest_frames(features, 1, width)
    scales = np.linspace(0.5, 2, len(near)).astype(np.float32)
    found = np.zeros((len(near), width + 1), np.float32)
    for weight in (0.25, 0.75):
        kernels.add_similarities(
            two_sided(near, width), scales, softness, weight, 0, len(near), found
        )
    expected = naive.similarities(near, scales, width, softness)
    np.testing.assert_allclose(found, one_sided(expected, width), rtol=1e-4, atol=1e-6)


@given(points(), WIDTHS, GAPS, st.data())
@seconds
def test_coverage_is_that_of_the_naive_version(features, width, gap, data) -> None:
    n = len(features)
    near = naive.nearest_frames(features, 1, width)
    scales = np.linspace(0.5, 2, n).astype(np.float32)
    g, h = (part(data, n) for _ in range(2))
    ends = (g.start, g.stop, h.start, h.stop)
    covered = kernels.coverage(two_sided(near, width), scales, *ends, gap, 1.5)
    assert covered == pytest.approx(naive.coverage(near, width, scales, g, h, gap, 1.5), abs=1e-6)


@given(points(), WIDTHS, GAPS, st.data())
@seconds
def test_distances_to_classes_are_those_of_the_naive_version(features, width, gap, data) -> None:
    near = naive.nearest_frames(features, 1, width)
    labels, wanted = (
        np.array(data.draw(st.lists(st.integers(-1, 2), min_size=len(near), max_size=len(near))))
        for _ in range(2)
    )
    found = np.full(len(near), np.nan, np.float32)
    kernels.class_distances(two_sided(near, width), labels, wanted, gap, 0, len(near), found)
    expected = naive.class_distances(near, width, labels, wanted, gap)
    np.testing.assert_allclose(found, expected, rtol=1e-6)


@given(points(), st.lists(st.integers(0, 20), min_size=1, max_size=3), GAPS, st.data())
@seconds
def test_stretches_are_as_alike_as_in_the_naive_version(poses, reaches, gap, data) -> None:
    reaches = sorted(reaches, reverse=True)
    some = st.lists(st.integers(0, len(poses) - 1), min_size=1, max_size=6, unique=True)
    frames, others = (np.array(sorted(data.draw(some))) for _ in range(2))
    columns = np.ascontiguousarray(poses.T)
    nearest = distant.nearest_around(columns, frames, others, np.array(reaches))
    for reach, found in zip(reaches, nearest):
        expected = naive.nearest_around(poses, frames, others, reach)
        np.testing.assert_allclose(found, expected, rtol=1e-6)
    scales = np.linspace(0.5, 2, len(poses)).astype(np.float32)
    given_to_both = reaches, scales[frames], scales[others], 1.5, gap
    found = distant.mean_similarity(columns, frames, others, np.array(reaches), *given_to_both[1:])
    assert found == pytest.approx(
        naive.mean_similarity(poses, frames, others, *given_to_both), abs=1e-5
    )
    span = part(data, len(poses))
    among = frames, scales[frames], span.start, span.stop, 1.5
    assert distant.mean_recurrence(columns, *among) == pytest.approx(
        naive.mean_recurrence(poses, *among), abs=1e-5
    )


@given(points(), WIDTHS, GAPS, st.data())
@seconds
def test_means_within_a_band_are_those_of_the_naive_version(features, width, gap, data) -> None:
    similarity = np.exp(-naive.nearest_frames(features, 1, len(features)))
    rows, columns = (np.array(part(data, len(features))) for _ in range(2))
    found = kernels.mean_in_band(one_sided(similarity, width), rows, columns, gap)
    assert found == pytest.approx(naive.mean_in_band(similarity, rows, columns, gap, width + 1))


def part(data: st.DataObject, samples: int) -> range:
    start = data.draw(st.integers(0, samples - 1))
    return range(start, data.draw(st.integers(start + 1, samples)))


OPTIONS = {
    "step": 3, "width": 600, "rank": 30, "low": 0.08, "high": 0.16, "softness": 1.6,
    "phases": phase_windows(12, KINEME.phase_shares),
}  # fmt: skip


def test_samples_of_one_movement_are_similar_whatever_their_phase() -> None:
    rows = np.concatenate([swing(8, period=1.2), swing(8, period=1.2, axis=2)])
    similarity = to_matrix(recurrence(rows, **OPTIONS).similarity)
    assert similarity[:84, :84].min() > 0.5
    assert similarity[108:, 108:].min() > 0.5
    assert np.median(similarity[:84, 108:]) < 0.1


def test_a_band_is_no_wider_than_the_recording() -> None:
    for frames in (1, 2, 3, 4, 50):
        found = recurrence(swing(2, period=1)[:frames], **OPTIONS)
        samples = -(-frames // 3)
        assert len(found) == samples
        assert found.near.shape == (samples, 2 * samples - 1)
        assert found.similarity.shape == (samples, samples)


def test_a_narrow_band_is_the_middle_of_a_wide_one() -> None:
    rows = swing(15, period=1.3)
    wide = recurrence(rows, **OPTIONS)
    narrow = recurrence(rows, **{**OPTIONS, "width": 40})
    np.testing.assert_array_equal(narrow.near, wide.near[:, 194 - 40 : 194 + 41])


def test_other_windows_need_no_new_distances() -> None:
    rows = swing(15, period=1.3)
    other = {"phases": (7,), "rank": 16, "low": 0.05, "high": 0.2}
    again, anew = (
        narrower(recurrence(rows, **OPTIONS), **other),
        recurrence(rows, **OPTIONS | other),
    )
    for name in ("near", "similarity", "scales"):
        np.testing.assert_array_equal(getattr(again, name), getattr(anew, name))
    assert again.phases == (7,)


def test_small_movements_count_as_large_ones_do() -> None:
    rows = np.random.default_rng(0).normal(size=(300, 3)).cumsum(axis=0)
    unlimited = {**OPTIONS, "low": 1e-9, "high": 1e9}
    large, small = recurrence(rows, **unlimited), recurrence(rows / 8, **unlimited)
    np.testing.assert_array_equal(small.similarity, large.similarity)
    np.testing.assert_array_equal(8 * small.scales, large.scales)
    limited = recurrence(rows, **{**OPTIONS, "low": 1.0, "high": 2.0})
    np.testing.assert_array_equal(limited.scales, np.clip(large.scales, 1, 2))


@given(st.lists(st.floats(-9, 9, width=32), min_size=1, max_size=40), st.data())
def test_the_value_of_a_rank(values, data) -> None:
    rank = data.draw(st.integers(0, len(values) - 1))
    found = kernels.smallest(np.array(values, np.float32), len(values), rank)
    assert found == sorted(values)[rank]


@pytest.mark.parametrize(("width", "phases"), [(20, (12, 9, 7)), (5, (12, 7)), (150, (7,))])
def test_rows_compared_at_a_time_change_nothing(monkeypatch, width, phases) -> None:
    features = np.random.default_rng(0).normal(0, 0.1, (1200, 4)).cumsum(axis=0)
    options = {**OPTIONS, "width": width, "phases": phases, "high": 1e9}
    at_once = recurrence(features, **options)
    for rows in (1, 3):
        monkeypatch.setattr("kineme.methods.recurrence.recurrence.BLOCK", rows)
        in_blocks = recurrence(features, **options)
        np.testing.assert_array_equal(in_blocks.scales, at_once.scales)
        np.testing.assert_array_equal(in_blocks.similarity, at_once.similarity)
    monkeypatch.setattr("kineme.methods.recurrence.recurrence.BLOCK", 10**6)
    np.testing.assert_array_equal(recurrence(features, **options).similarity, at_once.similarity)
