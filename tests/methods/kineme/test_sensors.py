"""Sensors and series: posture and energy, the tree of segments, and the pace of a series."""

from __future__ import annotations

from itertools import islice, pairwise
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from sklearn.metrics import normalized_mutual_info_score

import kineme
import naive
from kineme.errors import ParameterError
from kineme.evaluation import Comparison, covering
from kineme.features.channels import compute_channel_statistics
from kineme.methods.kineme import _tree_kernels as kernels
from kineme.methods.kineme import tree
from kineme.methods.kineme.preset import SENSORS, estimate_period
from kineme.methods.kineme.tree import MAX_SHIFT, choose_part_ends
from kineme.methods.kineme.views import compute_views, measure_mutual_information, reduce_shared
from kineme.recordings import Signals
from series import read_series

FPS = 50.0
seconds = settings(max_examples=60)


def worn(seed: int = 0) -> tuple[np.ndarray, list[int]]:
    """Make standing, walking, standing, running, lying, walking: six channels, and all ends."""
    rng = np.random.default_rng(seed)
    parts = []
    for posture, pace, strength in (
        (0, 0, 0),
        (0, 1.8, 1),
        (0, 0, 0),
        (0, 2.8, 3),
        (2, 0, 0),
        (0, 1.8, 1),
    ):
        t = np.arange(int(12 * FPS)) / FPS
        phases = rng.uniform(0, 6, 6)
        waves = strength * np.sin(2 * np.pi * pace * t[:, None] + phases)
        parts.append(posture * np.array([1, -1, 0, 0, 0, 0]) + waves)
    borders = np.cumsum([len(part) for part in parts])[:-1]
    rows = np.concatenate(parts)
    return rows + 0.1 * rng.standard_normal(rows.shape), borders.tolist()


def samples() -> st.SearchStrategy[np.ndarray]:
    def made(shape: tuple[int, int, int]) -> np.ndarray:
        return np.random.default_rng(shape[2]).normal(size=shape[:2]).astype(np.float32)

    return st.tuples(st.integers(2, 12), st.integers(1, 3), st.integers(0, 99)).map(made)


@given(samples(), st.integers(1, 14), st.floats(0.1, 5))
@seconds
def test_the_band_is_that_of_the_naive_version(features, width, unit) -> None:
    width = min(width, len(features))
    found = np.empty((len(features), width), np.float32)
    kernels.compute_similarity_band(features, unit, 0, len(features), found)
    np.testing.assert_allclose(
        found, naive.compute_similarity_band(features, unit, width), atol=1e-5
    )


@given(samples(), st.data())
@seconds
def test_distances_of_segments_are_those_of_the_naive_version(features, data) -> None:
    cuts = data.draw(st.sets(st.integers(1, len(features) - 1)))
    borders = np.array([0, *sorted(cuts), len(features)])
    sums = tree.sum_between_segments(features, borders, 2.0)
    segments = [range(a, b) for a, b in pairwise(borders.tolist())]
    expected = np.array(naive.compute_mean_distances(features, segments, 2.0))
    lengths = np.diff(borders)
    np.testing.assert_allclose(sums, expected * np.outer(lengths, lengths), atol=1e-4)


@given(samples(), st.integers(1, 8), st.floats(0, 2), st.floats(0, 2))
@seconds
def test_the_cheapest_grouping_is_that_of_the_naive_version(features, most, run, cluster) -> None:
    n = len(features)
    lengths = 1.0 + np.arange(n) % 3
    means = np.linalg.norm(features[:, None] - features, axis=2) + 0.1
    sums = np.ascontiguousarray(means * np.outer(lengths, lengths))
    cost, groups = naive.find_cheapest_grouping(sums, lengths, most, run, cluster)
    labels = np.empty(n, np.int64)
    assert kernels.find_cheapest_grouping(
        sums.copy(), lengths.copy(), most, run, cluster, labels
    ) == pytest.approx(cost)
    assert sorted(np.flatnonzero(labels == g).tolist() for g in np.unique(labels)) == groups


def test_activities_of_sensors_are_found_and_known_again() -> None:
    for seed in range(5):
        rows, borders = worn(seed)
        found = kineme.segment(kineme.Signals(rows, FPS))
        assert found.provenance["preset"] == "sensors"
        cuts = found.cuts()
        assert len(cuts) <= len(borders) + 1
        assert all(np.abs(cuts - border).min() <= FPS for border in borders)
        middles = np.array([0, *borders]) + int(6 * FPS)
        standing, walking, again, running, lying, last = found.per_frame("cluster")[middles]
        assert standing == again
        assert walking == last
        assert len({standing, walking, running, lying}) == 4


def test_a_slow_recording_has_no_energies_above_its_rate() -> None:
    fast = compute_channel_statistics(worn()[0], FPS, rate=5, window=1, bands=SENSORS.bands)
    slow = compute_channel_statistics(
        worn()[0][::10], FPS / 10, rate=5, window=1, bands=SENSORS.bands
    )
    assert (fast.shape[1], slow.shape[1]) == (30, 18)
    found = kineme.segment(kineme.Signals(worn()[0][::10], FPS / 10))
    assert found.provenance["parameters"]["working_fps"] == FPS / 10


@pytest.mark.parametrize("frames", [1, 2, 3, 10, 60])
def test_short_and_still_recordings_are_one_activity(frames: int) -> None:
    rows = np.ones((frames, 2))
    found = kineme.segment(kineme.Signals(rows, FPS))
    assert found.activities.stop_frame.tolist() == [frames]


def test_dearer_segments_are_fewer_and_cheaper_ones_more() -> None:
    rows, _ = worn()
    counts = [
        len(kineme.segment(kineme.Signals(rows, FPS), segment_cost=cost).activities)
        for cost in (0.02, 0.15, 2.0, 40.0)
    ]
    assert counts == sorted(counts, reverse=True)
    assert counts[-1] == 1


def test_steps_are_counted() -> None:
    t = np.arange(int(20 * FPS)) / FPS
    swing = np.column_stack([np.sin(2 * np.pi * t), np.sin(4 * np.pi * t + 1)])
    rows = swing + 0.02 * np.random.default_rng(0).standard_normal(swing.shape)
    found = kineme.segment(kineme.Signals(rows, FPS))
    assert abs(sum(found.repetitions().values()) - 20) <= 1


def test_up_and_down_are_one_repetition_though_the_sensor_shakes_alike() -> None:
    """The sensor has another orientation on the way up than on the way down."""
    for times in range(4, 9):
        phase = 2 * np.pi * np.arange(int(times * 3 * FPS)) / (3 * FPS)
        shaken = np.column_stack([np.sin(2 * phase), np.cos(2 * phase), np.sin(4 * phase + 1)])
        held = 0.8 * np.tanh(3 * np.sin(phase))
        found = kineme.segment(kineme.Signals(np.column_stack([shaken, held]), FPS))
        assert np.count_nonzero(found.primitives.kind == "primitive") == times


def test_long_recordings_are_cut_as_finely_as_their_parts_and_known_again() -> None:
    rows, borders = worn()
    one, ends = len(rows), [*borders, len(rows)]
    found = kineme.segment(kineme.Signals(np.tile(rows, (4, 1)), FPS), part=one / FPS)
    cuts = found.cuts()
    expected = [turn * one + end for turn in range(4) for end in ends][:-1]
    assert all(np.abs(cuts - border).min() <= FPS for border in expected)
    assert len(cuts) <= len(expected) + 4
    middles = np.array([0, *borders]) + int(6 * FPS)
    turns = [found.per_frame("cluster")[turn * one + middles].tolist() for turn in range(4)]
    assert turns[1:] == turns[:1] * 3


@given(st.integers(1, 10_000), st.integers(1, 500), st.integers(1, 40), st.integers(0, 9))
def test_parts_are_whole_and_none_is_too_long(n: int, longest: int, side: int, seed: int) -> None:
    rows = np.random.default_rng(seed).normal(size=(n, 2))
    lengths = np.diff(choose_part_ends(rows, longest, side))
    assert lengths.sum() == n
    assert 1 <= lengths.min() <= lengths.max() <= max(2, longest * (1 + 2 * MAX_SHIFT))


@pytest.mark.parametrize("shape", [(400, 12), (12, 400)])
@pytest.mark.parametrize("most", [0.3, 1.0, 5.0])
def test_reducing_shared_variance_equals_the_whole_matrix(shape, most) -> None:
    rng = np.random.default_rng(1)
    channels = rng.standard_normal(shape) + rng.standard_normal((shape[0], 1))
    channels = (channels - channels.mean(axis=0)) / channels.std(axis=0)
    covariance = channels.T @ channels / len(channels)
    variances, directions = np.linalg.eigh(covariance)
    mixing = (directions * np.sqrt(most / np.maximum(variances, most))) @ directions.T
    mixed = channels @ mixing
    expected = mixed / mixed.std(axis=0)
    np.testing.assert_allclose(reduce_shared(channels, most).apply(channels), expected, atol=1e-9)


@given(st.lists(st.tuples(st.integers(0, 3), st.integers(0, 3)), min_size=2, max_size=40))
def test_agreement_is_the_mutual_information(pairs) -> None:
    first, second = np.array(pairs, np.int64).T
    expected = normalized_mutual_info_score(first, second)
    assert measure_mutual_information(first, second) == pytest.approx(expected, abs=1e-9)


def test_views_need_a_number_of_each_kind() -> None:
    with pytest.raises(ParameterError, match="a number for each view, not 2, 5 and 5"):
        SENSORS.replace(shared=(1.0, 0.3))
    alone = SENSORS.replace(shared=(0.3,), weights=(1.0,), restless_over=(1.0,))
    found = kineme.segment(kineme.Signals(worn()[0], FPS), preset=alone)
    assert len(found.activities) >= 6


def test_what_samples_differ_by_does_not_hang_on_what_else_a_file_has() -> None:
    rng = np.random.default_rng(0)
    minute = np.repeat(rng.normal(size=(6, 4)), 50, axis=0) + rng.normal(0, 0.1, (300, 4))
    others = [k + minute for k in range(20)]
    alone, joined = (
        tree.compute_median_distance(np.float32(features), SENSORS.comparison_width)
        for features in (minute, np.concatenate(others))
    )
    assert joined < 1.5 * alone
    assert tree.compute_median_distance(np.float32(np.concatenate(others)), 10**6) > 4 * alone


def test_who_goes_up_is_not_who_goes_down_if_channels_are_joints() -> None:
    t = np.arange(int(60 * FPS)) / FPS
    height = np.abs((t / 6) % 2 - 1)
    channels = np.column_stack([height, 2 * height**2])
    down, up, again = np.round(np.array([15, 21, 27]) * SENSORS.rate).astype(int)  # halfway each
    joints, sensors = (
        compute_views(channels, SENSORS, joints=each).views for each in (True, False)
    )
    for told, plain in zip(joints, sensors, strict=True):
        unit = tree.compute_median_distance(plain, SENSORS.comparison_width)
        assert np.linalg.norm(plain[down] - plain[up]) < 0.05 * unit
        assert np.linalg.norm(told[down] - told[up]) > 0.3 * unit
        assert np.linalg.norm(told[down] - told[again]) < 0.05 * unit


def one_sided(matrix: np.ndarray, width: int) -> np.ndarray:
    """Return ``band[i, j - i]`` for j from i on; zero beyond the end."""
    band = np.zeros((len(matrix), width + 1), np.float32)
    for i, j in np.ndindex(matrix.shape):
        if 0 <= j - i <= width:
            band[i, j - i] = matrix[i, j]
    return band


@st.composite
def similarities(draw: st.DrawFn, *, max_bins: int = 9) -> np.ndarray:
    """Draw a symmetric similarity matrix from 0 to 1 with ones on the diagonal."""
    n = draw(st.integers(1, max_bins))
    rng = np.random.default_rng(draw(st.integers(0, 2**32 - 1)))
    similarity = rng.random((n, n)) ** draw(st.sampled_from([0.1, 1, 10]))
    similarity = np.round(np.minimum(similarity, similarity.T), 2)
    np.fill_diagonal(similarity, 1)
    return similarity


@given(similarities(), st.integers(0, 9), st.sampled_from([0.0, 0.3, 1.0, 5.0]))
@seconds
def test_no_division_is_cheaper(similarity, width, penalty) -> None:
    width = min(width, len(similarity) - 1)
    divisions = naive.list_divisions(len(similarity), width + 1)
    found = kernels.find_change_points(one_sided(similarity, width), penalty).tolist()
    assert found in divisions
    costs = [naive.compute_division_cost(similarity, borders, penalty) for borders in divisions]
    assert naive.compute_division_cost(similarity, found, penalty) == pytest.approx(
        min(costs), abs=1e-4
    )


PERIOD, HALF = 40, 2000


def two_states(period: float, half: int) -> np.ndarray:
    """Make a sine, then one with a second harmonic, with some noise."""
    phase = np.arange(half) * 2 * np.pi / period
    both = np.concatenate([np.sin(phase), np.sin(phase) + np.sin(2 * phase)])
    return both + 0.05 * np.random.default_rng(0).standard_normal(2 * half)


@pytest.mark.parametrize("pace", [1, 5])
def test_a_change_is_found_at_any_pace(pace: int) -> None:
    found = kineme.segment(two_states(pace * PERIOD, pace * HALF), fps=1, preset="series")
    starts = found.activities.start_frame
    assert len(starts) == 2
    assert abs(starts[1] - pace * HALF) <= 2 * pace * PERIOD


@pytest.mark.filterwarnings("ignore::kineme.errors.KinemeWarning")  # some stay constant
def test_states_of_real_series_are_found(data_dir: Path) -> None:
    scores = []
    for values, ends, states in islice(read_series(data_dir / "timeseries" / "tssb"), 0, None, 3):
        found = kineme.segment(values, fps=1.0, preset="series").per_frame(level="activity")
        truth = np.repeat(np.unique(states, return_inverse=True)[1], np.diff(ends))
        scores.append(covering(Comparison(truth, found, 1.0)))
    assert np.mean(scores) > 0.62


def test_the_rate_that_is_given_changes_seconds_only() -> None:
    slow, fast = (kineme.segment(two_states(PERIOD, HALF), fps=f, preset="series") for f in (1, 50))
    assert slow.table.start_frame.tolist() == fast.table.start_frame.tolist()
    assert slow.activities.stop_s[-1] == 2 * HALF
    assert fast.activities.stop_s[-1] == 2 * HALF / 50
    assert any("count as a second" in note for note in slow.provenance["notes"])


def test_gaps_and_rows_to_look_at_stay_where_they_are() -> None:
    rows = two_states(PERIOD, HALF)[:, None]
    recording = Signals(rows, 10.0, gaps=[(1000, 1100)])
    gapped = kineme.segment(recording, preset="series").table
    assert {1000, 1100} <= {*gapped.start_frame.tolist()}
    looked = kineme.segment(Signals(rows, 10.0), features=rows[::2], feature_fps=5, preset="series")
    assert looked.table.stop_frame.max() == 2 * HALF
    assert len(looked.activities) == 2


@pytest.mark.parametrize("n", [1, 2, 9, 50])
@pytest.mark.parametrize("make", [np.ones, np.arange], ids=["constant", "rising"])
def test_what_has_no_period_is_segmented_by_its_length(make, n: int) -> None:
    rows = np.asarray(make(n), float)
    assert estimate_period(rows[:, None]) is None
    assert kineme.segment(rows, fps=1, preset="series").table.stop_frame[-1] == n
