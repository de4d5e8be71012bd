"""What is measured of each repetition, and which of them count."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pandas as pd
import pytest

import kineme
from kineme.cycles import Cycles, compare_sides, foot_events
from kineme.datasets.synthetic import SyntheticRecording
from kineme.errors import ParameterError
from kineme.recordings import Motion, Signals
from kineme.recordings.operations import cut
from kineme.segments.editing import exclude
from kineme.segments.segmentation import Segmentation
from rows import pick_row
from segmentations import from_rows, one_activity


@pytest.fixture(scope="module")
def cycles(walks: SyntheticRecording) -> Cycles:
    return kineme.cycles(walks.motion, walks.truth)


def make_repetitions(starts: list[float], end: float, fps: float, n_frames: int) -> Segmentation:
    """One activity with these repetitions, in a recording that goes on."""
    frames = [round(at * fps) for at in [*starts, end]]
    rows = [("activity", "activity", frames[0], frames[-1], 0, "")]
    rows += [("primitive", "primitive", a, b, 0, "") for a, b in pairwise(frames)]
    for level in ("activity", "primitive"):
        rows += [(level, "transition", 0, frames[0], -1, "")] if frames[0] else []
        if frames[-1] < n_frames:
            rows.append((level, "transition", frames[-1], n_frames, -1, ""))
    return from_rows(rows, fps=fps)


def find_rows(cycles: Cycles, group: str) -> np.ndarray:
    return np.flatnonzero(cycles.columns["group"] == group)


def test_there_are_as_many_as_the_segments_say(walks, cycles) -> None:
    assert len(cycles) == (walks.truth.primitives.kind == "primitive").sum()
    assert cycles.groups == ["walk", "squat"]
    assert cycles.columns["number"][find_rows(cycles, "squat")].tolist() == [0, 1, 2, 3, 4]
    places = cycles.columns["place"][find_rows(cycles, "squat")].tolist()
    assert places == ["first", *["inner"] * 3, "last"]


def test_durations_are_those_of_the_maker(walks, cycles) -> None:
    true = walks.truth.primitives
    true = true.select(true.kind == "primitive")
    inner = cycles.columns["place"] == "inner"
    wrong = cycles.columns["duration_s"] / true.duration_s - 1
    assert np.abs(wrong[inner]).max() < 0.05
    assert abs(wrong[inner].mean()) < 0.01


def test_walks_that_begin_with_another_foot_are_measured_from_the_same(walks) -> None:
    """Cut by half a stride later, the second walk is turned to the phase of the first."""
    truth = walks.truth
    second = truth.activities[truth.activities.label == "walk"][1]
    columns = {name: np.array(column) for name, column in truth.table.columns().items()}
    moved = (columns["activity"] == second.activity) & (columns["level"] == "primitive")
    rows = np.flatnonzero(moved & (columns["kind"] == "primitive"))
    half = 33
    columns["start_frame"][rows[1:]] += half
    columns["stop_frame"][rows[:-1]] += half
    other = Segmentation.from_columns(columns, n_frames=truth.n_frames, fps=truth.fps)
    found = kineme.cycles(walks.motion, other, channels=["knee_l", "knee_r"])
    curves = found.curves[find_rows(found, "walk")][1:-1, 0]
    assert np.corrcoef(curves[1], curves[-2])[0, 1] > 0.95
    assert "begins" in " ".join(found.provenance["notes"])
    assert {each["group"] for each in found.provenance["turned"]} == {"walk"}
    assert len(found.provenance["turned"]) == len(found.provenance["notes"])
    assert len(found) == (truth.primitives.kind == "primitive").sum()


def test_statistics_are_those_of_the_curve(cycles) -> None:
    columns, knee = cycles.columns, cycles.channels.index("knee_l")
    for row in find_rows(cycles, "squat"):
        curve = cycles.curves[row, knee]
        assert columns["knee_l.max"][row] == pytest.approx(curve.max(), abs=0.5)
        assert columns["knee_l.max_at"][row] == pytest.approx(curve.argmax(), abs=3)
        assert columns["knee_l.start"][row] == pytest.approx(curve[0])
        assert columns["knee_l.mean"][row] == pytest.approx(curve.mean(), abs=1)
        width = columns["knee_l.max"][row] - columns["knee_l.min"][row]
        assert columns["knee_l.range"][row] == pytest.approx(width)


def test_the_summary_is_over_inner_cycles(cycles) -> None:
    inner = cycles.columns["duration_s"][find_rows(cycles, "squat")][1:-1]
    duration = pick_row(cycles.summary(), group="squat", measure="duration_s")
    assert duration["n"] == 3
    assert duration["mean"] == pytest.approx(inner.mean())
    assert duration["cv"] == pytest.approx(inner.std(ddof=1) / inner.mean())
    assert pick_row(cycles.summary(ends=True), group="squat", measure="duration_s")["n"] == 5
    cadence = pick_row(cycles.summary(), group="squat", measure="cadence_per_min")
    assert cadence["mean"] == pytest.approx((60 / inner).mean())


def test_mean_curves_have_a_band(cycles) -> None:
    table = cycles.mean_curves()
    rows = (table["group"] == "squat") & (table["channel"] == "knee_l")
    curves = cycles.layout("knee_l", "squat")
    np.testing.assert_allclose(table["mean"][rows], curves.mean(axis=0))
    assert (table["low"][rows] <= table["mean"][rows]).all()
    assert table["percent"][rows].tolist() == [*range(101)]


def test_what_people_left_out_in_the_table_is_left_out(walks, cycles) -> None:
    row = find_rows(cycles, "walk")[2]
    frame = [each.start_frame for each in walks.truth.primitives if each.kind == "primitive"][row]
    table = exclude(walks.truth, [frame], excluded=True)
    found = kineme.cycles(walks.motion, table)
    assert np.flatnonzero(found.columns["excluded"] == "by hand").tolist() == [row]
    expected = cycles.exclude([row]).summary()
    for name, column in found.summary().items():
        np.testing.assert_array_equal(column, expected[name])


def test_an_excluded_cycle_stays_with_its_reason(cycles) -> None:
    row = int(find_rows(cycles, "squat")[1])
    less = cycles.exclude([row])
    assert len(less) == len(cycles)
    assert less.columns["excluded"][row] == "by hand"
    assert less.layout("knee_l", "squat").shape[0] == cycles.layout("knee_l", "squat").shape[0] - 1
    assert cycles.columns["excluded"][row] == ""
    with pytest.raises(ParameterError, match="there is no cycle 99"):
        cycles.exclude([99])


def test_what_is_far_from_the_mean_is_left_out_by_rule(cycles) -> None:
    curves = np.array(cycles.curves)
    row = int(find_rows(cycles, "walk")[2])
    curves[row] += 80
    less = replace(cycles, curves=curves).exclude_far()
    assert less.columns["excluded"][row] == "far from the mean"
    assert (cycles.exclude_far().columns["excluded"] != "").sum() <= 1


def test_borders_that_are_not_sure_are_left_out_by_rule(cycles) -> None:
    confidence = np.where(np.arange(len(cycles)) == 3, 0.2, np.nan)
    unsure = replace(cycles, columns={**cycles.columns, "border_confidence": confidence})
    assert np.flatnonzero(unsure.exclude_unsure().columns["excluded"] != "").tolist() == [3]
    unknown = replace(cycles, columns={**cycles.columns, "border_confidence": confidence * np.nan})
    with pytest.raises(ParameterError, match="the starts of these cycles have no confidence"):
        unknown.exclude_unsure()


def test_a_pause_is_part_of_no_repetition() -> None:
    fps, swing, rest = 50.0, 2.0, 1.5
    t = np.arange(0, swing, 1 / fps)
    once = np.concatenate([1 - np.cos(2 * np.pi * t / swing), np.zeros(round(rest * fps))])
    values = np.tile(once, 6)
    signals = Signals(np.stack([values, values**2], axis=1), fps, ["a", "b"])
    starts = [3.5 * i for i in range(6)]
    cycles = kineme.cycles(signals, make_repetitions(starts, 21.0, fps, len(values)))
    inner = cycles.columns["place"] == "inner"
    assert len(cycles) == 6
    np.testing.assert_allclose(cycles.columns["duration_s"][inner], swing, atol=0.35)
    np.testing.assert_allclose(cycles.columns["pause_s"][1:], rest, atol=0.35)


def test_a_gap_in_a_cycle_makes_its_values_missing(walks) -> None:
    truth = walks.truth
    squat = truth.activities[truth.activities.label == "squat"][0]
    start = squat.start_frame + 60
    motion = replace(walks.motion, gaps=((start, start + 10),))
    cycles = kineme.cycles(motion, truth, channels=["knee_l"])
    missing = np.isnan(cycles.columns["knee_l.range"])
    assert missing.sum() == 1
    assert np.isnan(cycles.curves[missing]).any()
    assert cycles.layout("knee_l", "squat").shape[0] in (2, 3)
    summary = cycles.summary(ends=True)
    assert pick_row(summary, group="squat", measure="knee_l.range")["n"] == 4


def test_one_repetition_has_no_deviation_and_none_is_no_error(walks) -> None:
    motion = cut(walks.motion, 0, 200)
    one = kineme.cycles(motion, make_repetitions([0.5], 2.0, 60.0, 200), channels=["knee_l"])
    assert one.columns["place"].tolist() == ["only"]
    assert np.isnan(one.summary(ends=True)["sd"]).all()
    assert one.summary()["n"].tolist() == [0] * 10
    nothing = kineme.cycles(motion, replace(one_activity(200, 60.0), provenance={"preset": "x"}))
    assert len(nothing) == 0
    assert nothing.groups == []
    assert len(nothing.summary()["n"]) == 0
    assert nothing.mean_curves() == {}


def test_recordings_are_measured_together_by_labels(walks) -> None:
    both = kineme.cycles([walks.motion] * 2, [walks.truth] * 2, channels=["knee_l"])
    assert both.groups == ["walk", "squat"]
    assert len({*both.columns["recording"].tolist()}) == 2
    bare = Segmentation.from_columns(
        {**walks.truth.table.columns(), "label": [""] * len(walks.truth)},
        n_frames=walks.truth.n_frames,
        fps=60.0,
    )
    apart = kineme.cycles([walks.motion] * 2, [bare] * 2, channels=["knee_l"])
    assert len(apart.groups) == 4
    common = kineme.cycles([walks.motion] * 2, [bare] * 2, channels=["knee_l"], common=True)
    assert common.groups == ["cluster 0", "cluster 1"]


def test_channels_beside_are_measured_at_their_own_rate(walks) -> None:
    fast = Signals(np.arange(walks.motion.n_frames * 10) / 600, 600.0, ["clock"])
    cycles = kineme.cycles(walks.motion, walks.truth, channels=["clock"], beside=[fast])
    np.testing.assert_allclose(cycles.columns["clock.start"], cycles.columns["start_s"], atol=1e-9)
    np.testing.assert_allclose(
        cycles.columns["clock.range"], cycles.columns["duration_s"], atol=2e-3
    )


def test_what_was_not_recorded_beside_is_missing(walks) -> None:
    squats = walks.truth.primitives[walks.truth.primitives.label == "squat"]
    seconds = np.arange(walks.motion.n_frames * 10) / 600
    # The signals end in the middle of the third squat.
    end = (squats.start_s[2] + squats.stop_s[2]) / 2
    full, part, exact = (
        kineme.cycles(
            walks.motion, walks.truth, beside=[Signals(each, 600.0, ["clock"])], channels=["clock"]
        )
        # The last ends with the last frame of the motion.
        for each in (seconds, seconds[seconds < end], seconds[:-9])
    )
    assert np.isfinite(exact.columns["clock.range"]).all()
    recorded = full.columns["stop_s"] <= end
    assert np.isnan(part.columns["clock.range"]).tolist() == (~recorded).tolist()
    np.testing.assert_array_equal(part.curves[recorded], full.curves[recorded])
    cut = part.curves[np.flatnonzero(~recorded)[0], 0]
    known = np.isfinite(cut)
    assert 20 < known.sum() < 80
    np.testing.assert_allclose(cut[known], full.curves[np.flatnonzero(~recorded)[0], 0][known])


def test_rows_of_labels_are_measured_one_by_one(walks) -> None:
    spans, n_frames = [(6, 72), (72, 138), (144, 216), (216, 282)], walks.motion.n_frames
    rows = [("activity", "activity", *span, -1, "stride") for span in spans]
    gaps = [(0, 6), (138, 144), (282, n_frames)]
    rows += [("activity", "transition", *span, -1, "") for span in gaps]
    labels = from_rows(sorted(rows, key=lambda row: row[2]), fps=60.0)
    measured = kineme.cycles(walks.motion, labels, channels=["knee_l"]).columns
    assert [*zip(measured["start_frame"], measured["stop_frame"], strict=True)] == spans
    assert {*measured["place"]} == {"inner"}
    moved = kineme.cycles(walks.motion, labels, channels=["knee_l"], refine=True).columns
    assert moved["start_frame"].tolist() != measured["start_frame"].tolist()


def test_a_data_frame_is_measured_like_signals(walks) -> None:
    frame = pd.DataFrame(walks.motion.positions[:, 5], columns=["x", "y", "z"])
    signals = Signals(frame.to_numpy(), 60.0, list(frame))
    wanted = kineme.cycles(signals, walks.truth)
    for data, table in ((frame, walks.truth), ([frame], [walks.truth])):
        np.testing.assert_array_equal(kineme.cycles(data, table).curves, wanted.curves)
    for number in (5, np.float64(5)):
        name = type(number).__name__
        with pytest.raises(ParameterError, match=f"cycles takes Motion or Signals, not {name}"):
            kineme.cycles(number, walks.truth)
    with pytest.raises(ParameterError, match="cycles takes a Segmentation, not NoneType"):
        kineme.cycles(frame, None)


@pytest.mark.parametrize("anchor", ["knee_r max", "knee_r > 40"])
def test_cycles_begin_at_their_anchor(walks, anchor: str) -> None:
    cycles = kineme.cycles(walks.motion, walks.truth, channels=["knee_r"], anchor=anchor)
    walk = find_rows(cycles, "walk")
    assert len(cycles) == 16
    measured = walk[cycles.columns["excluded"][walk] == ""]
    assert len(measured) >= 8
    start = cycles.columns["knee_r.start"][measured]
    if anchor == "knee_r max":
        assert (start > 0.9 * cycles.columns["knee_r.max"][measured]).all()
    else:
        np.testing.assert_allclose(start, 40, atol=1e-6)
    last = cycles.columns["place"] == "last"
    assert {*cycles.columns["excluded"][last].tolist()} <= {"no event follows it", "no event"}
    assert np.isnan(cycles.columns["duration_s"][last]).all()


def test_cycles_run_from_each_event_to_the_next_one(walks) -> None:
    """Whatever the segments are, no stride is lost; the one with the squats in it counts not."""
    strikes = foot_events(walks.motion).at("left foot strike")
    segments = make_repetitions([1.0, 2.0], 3.0, 60, walks.motion.n_frames)
    unlabelled, labelled = (
        kineme.cycles(walks.motion, table, channels=["knee_l"], anchor="left_foot_strike").columns
        for table in (segments, walks.truth)
    )
    assert {*unlabelled["group"]} == {"left foot strike"}
    np.testing.assert_allclose(unlabelled["start_s"], strikes[:-1])
    np.testing.assert_allclose(unlabelled["stop_s"], strikes[1:])
    long = unlabelled["excluded"] == "much longer than the others"
    assert unlabelled["duration_s"][long] > 5
    assert (labelled["group"] == "walk").sum() == 9


def test_each_side_begins_at_its_own_foot(walks) -> None:
    channels = ["knee_l", "knee_r"]
    left, right, both = (
        kineme.cycles(walks.motion, walks.truth, channels=channels, anchor=f"{side}foot strike")
        for side in ("left ", "right ", "")
    )
    own = {name: both.columns[f"{name}.max_at"][both.used()] for name in channels}
    assert np.isin(own["knee_l"], left.columns["knee_l.max_at"]).all()
    # One left cycle has no right one beside it.
    in_right = np.isin(own["knee_r"], right.columns["knee_r.max_at"])
    assert (in_right | np.isnan(own["knee_r"])).all()
    assert in_right.sum() >= 8
    assert "begin at the contacts of the right foot" in both.provenance["notes"][-1]
    latest = pick_row(compare_sides(both), group="walk", measure="max_at")
    assert latest["difference"] == pytest.approx(0, abs=5)


def test_seconds_and_events_of_the_file_are_anchors(walks) -> None:
    truth = walks.truth.primitives
    squats = truth.select((truth.label == "squat") & (truth.kind == "primitive"))
    middles = (squats.start_s + squats.stop_s) / 2
    by_time = kineme.cycles(walks.motion, walks.truth, channels=["knee_r"], anchor=middles)
    rows = find_rows(by_time, "squat")
    np.testing.assert_allclose(by_time.columns["start_s"][rows], middles[:-1])
    provenance = walks.motion.provenance.marked([(at, "Deepest") for at in middles.tolist()])
    marked = replace(walks.motion, provenance=provenance)
    by_name = kineme.cycles(marked, walks.truth, channels=["knee_r"], anchor="deepest")
    np.testing.assert_allclose(by_name.columns["start_s"][rows], middles[:-1])
    for anchor in ("deepst", "knee_r > 1.2.3"):
        with pytest.raises(ParameterError, match=f"no event '{anchor}'; there are Deepest, left"):
            kineme.cycles(marked, walks.truth, anchor=anchor)


def test_an_event_of_the_file_corrects_the_contact_near_it_and_the_others_stay(walks) -> None:
    found = foot_events(walks.motion).at("left foot strike")
    marked_at = float(found[2]) + 0.05
    provenance = walks.motion.provenance.marked([(marked_at, "Left Foot Strike")])
    marked = replace(walks.motion, provenance=provenance)
    before, after = (
        kineme.cycles(motion, walks.truth, channels=["knee_r"], anchor="left foot strike")
        for motion in (walks.motion, marked)
    )
    starts = [each.columns["start_s"][find_rows(each, "walk")] for each in (before, after)]
    moved = np.isclose(starts[0], found[2])
    assert moved.sum() == 1
    np.testing.assert_allclose(starts[1], np.where(moved, marked_at, starts[0]))


def test_what_does_not_belong_together_is_refused(walks) -> None:
    with pytest.raises(ParameterError, match="the segments have"):
        kineme.cycles(cut(walks.motion, 0, 100), walks.truth)
    with pytest.raises(ParameterError, match="one segmentation per recording"):
        kineme.cycles([walks.motion], [walks.truth] * 2)
    with pytest.raises(ParameterError, match="several groups: choose one of walk, squat"):
        kineme.cycles(walks.motion, walks.truth).layout("knee_l")
    signals = Signals(np.ones((walks.motion.n_frames, 1)), 60.0, ["knee_l"])
    with pytest.raises(ParameterError, match="do not have the same channels"):
        kineme.cycles([walks.motion, signals], [walks.truth] * 2)


def test_the_room_can_be_called_whatever_was_imported_first() -> None:
    import importlib

    room = importlib.import_module("kineme.cycles")
    assert callable(room)
    assert isinstance(kineme.Cycles, type)
    with pytest.raises(ParameterError):
        room(Motion, None)


@pytest.mark.parametrize("shift", [0.0, 30.0])
def test_places_in_a_cycle_are_averaged_round_its_end(cycles, shift: float) -> None:
    """Least at the start in some and at the end in others is least there, not in the middle."""
    places = (np.resize([98.0, 2.0, 99.0, 1.0], len(cycles)) + shift) % 100
    moved = replace(cycles, columns={**cycles.columns, "knee_l.min_at": places})
    least = pick_row(moved.summary(ends=True), group="walk", measure="knee_l.min_at")
    assert least["n"] == len(find_rows(cycles, "walk"))
    for name in ("mean", "median", "q25", "q75"):
        assert abs((least[name] - shift + 50) % 100 - 50) <= 2
    assert least["sd"] < 2.5
