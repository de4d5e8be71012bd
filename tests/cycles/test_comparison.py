"""Left beside right, in the same repetitions."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from matplotlib.figure import Figure
from scipy.stats import ttest_ind

import kineme
from kineme.cycles import Cycles, channels_of, compare_curves, compare_sessions, compare_sides
from kineme.cycles.channels import make_contact_channels
from kineme.cycles.comparison import pair_sides
from kineme.datasets.synthetic import SyntheticRecording
from kineme.errors import ParameterError
from kineme.plot import plot_sides
from kineme.recordings import Motion, Signals
from kineme.segments.segmentation import Segmentation
from rows import pick_row


@pytest.fixture(scope="module")
def cycles(walks: SyntheticRecording) -> Cycles:
    return kineme.cycles(walks.motion, walks.truth, channels=["knee_*", "trunk_lean"])


def test_channels_of_two_sides_are_told_by_their_names() -> None:
    names = ("knee_l", "knee_r", "LeftFoot.speed", "RightFoot.speed", "left_gyr", "trunk_lean",
             "total", "totar", "hip_r")  # fmt: skip
    assert pair_sides(names) == [("knee_l", "knee_r"), ("LeftFoot.speed", "RightFoot.speed")]


def test_what_differs_by_a_tenth_has_that_index(cycles: Cycles) -> None:
    left = cycles.columns["knee_l.range"]
    sides = compare_sides(replace(cycles, columns={**cycles.columns, "knee_r.range": 0.9 * left}))
    of_range = sides["measure"] == "range"
    assert sides["symmetry_index"][of_range] == pytest.approx(100 * 0.1 / 0.95)
    assert np.isnan(sides["symmetry_index"][~of_range]).all()
    assert (sides["low"][of_range] > 0).all()


def test_sensors_at_feet_tell_the_share_of_stance() -> None:
    rates = np.zeros((500, 3))
    rates[:, 1] = np.tile(np.r_[np.zeros(40), -6 * np.hanning(12), 5 * np.hanning(36),
                                -5 * np.hanning(12)], 5)  # fmt: skip
    signals = Signals(rates, 100.0, ["lf_gyr_x", "lf_gyr_y", "lf_gyr_z"])
    assert [channel.name for channel in make_contact_channels(signals)] == ["stance_l"]
    assert 45 < channels_of(signals, ["stance_l"])[0].values()[150:350].mean() < 65
    assert [channel.name for channel in channels_of(signals)] == list(signals.names)


def test_left_is_drawn_over_right(cycles: Cycles) -> None:
    axes = plot_sides(cycles, "knee_l", "knee_r", "walk", ax=Figure().add_subplot())
    assert [line.get_label()[:6] for line in axes.lines] == ["knee_l", "knee_r"]
    assert axes.get_title(loc="left") == "walk"
    with pytest.raises(ParameterError, match="no channel 'knee'"):
        plot_sides(cycles, "knee", "knee_r", "walk")


def test_one_cycle_has_no_bounds_and_none_no_means(cycles: Cycles) -> None:
    first = np.flatnonzero(cycles.used())[0]
    alone = compare_sides(cycles.select(np.arange(len(cycles)) == first))
    assert (alone["n"] == 1).all()
    assert np.isnan(alone["low"]).all()
    none = compare_sides(cycles.exclude(range(len(cycles))))
    assert (none["n"] == 0).all()
    assert np.isnan(none["left"]).all()


def compare_peaks(cycles: Cycles, left: float, right: list[float]) -> dict[str, float]:
    """Compare the sides of walks in which the knees have their maxima at these times."""
    n = len(cycles)
    times = {"knee_l.max_at": np.full(n, left), "knee_r.max_at": np.resize(right, n)}
    sides = compare_sides(replace(cycles, columns=cycles.columns | times), ends=True)
    return pick_row(sides, group="walk", measure="max_at")


def test_times_on_both_sides_of_the_end_are_near(cycles: Cycles) -> None:
    walk = compare_peaks(cycles, 99.0, [2.0])
    assert (walk["difference"], walk["left"], walk["right"]) == pytest.approx((-3, 99, 2))


def test_sides_in_antiphase_differ_by_half_a_cycle(cycles: Cycles) -> None:
    walk = compare_peaks(cycles, 72.0, [23.0, 21.0, 22.0, 20.5])
    assert abs(walk["difference"]) == pytest.approx(50, abs=1)
    assert walk["high"] - walk["low"] < 3


def test_differences_and_bounds_are_those_of_welch(cycles) -> None:
    duration = cycles.columns["duration_s"]
    slow = duration * np.where(np.arange(len(cycles)) % 2, 1.2, 1.3)
    later = replace(cycles, columns={**cycles.columns, "duration_s": slow})
    row = pick_row(compare_sessions(cycles, later), group="squat", measure="duration_s")
    used = cycles.used() & (cycles.columns["group"] == "squat")
    test = ttest_ind(slow[used], duration[used], equal_var=False)
    bounds = test.confidence_interval()
    assert row["difference"] == pytest.approx(slow[used].mean() - duration[used].mean())
    assert (row["low"], row["high"]) == pytest.approx((bounds.low, bounds.high))


def test_curves_are_compared_group_by_group_whatever_their_order(cycles) -> None:
    later = replace(cycles, curves=cycles.curves + 5)
    turned = later.select(np.ones(len(later), bool))
    order = np.argsort(turned.columns["group"], kind="stable")  # squats first
    columns = {name: column[order] for name, column in turned.columns.items()}
    turned = replace(turned, columns=columns, curves=turned.curves[order])
    assert turned.groups != cycles.groups
    np.testing.assert_allclose(compare_curves(cycles, turned)["difference"], 5)
    table = compare_sessions(cycles, turned)
    assert np.nan_to_num(table["difference"]).tolist() == [0] * len(table["difference"])


@pytest.mark.parametrize("compare", [compare_sessions, compare_curves])
def test_numbers_of_clusters_are_those_of_one_recording(walks, compare) -> None:
    columns = {**walks.truth.table.columns(), "label": [""] * len(walks.truth)}
    bare = Segmentation.from_columns(columns, n_frames=walks.truth.n_frames, fps=60.0)
    other = replace(walks.motion, positions=1.1 * walks.motion.positions)

    def measure(motion: Motion, **options: bool) -> Cycles:
        return kineme.cycles(motion, bare, channels=["knee_l"], **options)

    first, second = measure(walks.motion), measure(other)
    with pytest.raises(ParameterError, match="no group in common: cluster 0, cluster 1 and clust"):
        compare(first, second)
    alone = [each.select(each.columns["group"] == "cluster 1") for each in (first, second)]
    same = (first, first), alone, [measure(each, common=True) for each in (walks.motion, other)]
    assert [len({*compare(*each)["group"].tolist()}) for each in same] == [2, 1, 2]


def test_what_cannot_be_compared_is_refused(walks, cycles) -> None:
    other = kineme.cycles(walks.motion, walks.truth, channels=["hip_l"])
    with pytest.raises(ParameterError, match="the same channels"):
        compare_sessions(cycles, other)
    alone = [cycles.select(cycles.columns["group"] == group) for group in ("walk", "squat")]
    with pytest.raises(ParameterError, match="no group in common: walk and squat"):
        compare_sessions(*alone)
    short = kineme.cycles(walks.motion, walks.truth, channels=cycles.channels, points=51)
    with pytest.raises(ParameterError, match="curves of 101 and of 51 points"):
        compare_curves(cycles, short)
    with pytest.raises(ParameterError, match="a boolean array of length 16"):
        cycles.select(np.array([1]))
