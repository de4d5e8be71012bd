"""A stream tells the same events however rows come, and never takes back what is final."""

from __future__ import annotations

import numpy as np
import pandas as pd
import pytest

import kineme
from kineme.errors import ParameterError, ReadError
from kineme.live import ActivityEnded, ActivityStarted, Gap, Repetition, Stream
from streams import FPS, make_stream, push_pieces, two_exercises


@pytest.fixture(scope="module")
def rows():
    return two_exercises()


@pytest.fixture(scope="module")
def told(rows):
    """A stream that has ended, and its events."""
    stream = make_stream()
    return stream, list(push_pieces(stream, rows, [10]))


def test_activities_are_found_counted_and_recognised(told):
    stream, events = told
    ended = [e for e in events if isinstance(e, ActivityEnded) and e.is_final]
    assert [e.cluster for e in ended] == [0, 1, 0]
    assert np.abs(np.diff([e.stop_s for e in ended]) - 12).max() < 1
    # slow ones of 2 s, fast ones of 1.26 s
    assert np.abs(np.array([e.repetitions for e in ended]) - [6, 9.5, 6]).max() <= 1
    assert stream.segmentation.n_frames == len(two_exercises())


def test_an_exercise_is_recognised_after_fourteen_others():
    angle = np.linspace(0, 20 * np.pi, int(12 * FPS))
    exercise = np.column_stack([np.sin(angle), np.cos(angle)])
    stream = make_stream()
    stream.push(np.concatenate([exercise + 4 * (number % 15) for number in range(16)]))
    stream.finish()
    clusters = [row.cluster for row in stream.segmentation.activities if row.kind == "activity"]
    assert clusters == [*range(15), 0]


def test_events_do_not_depend_on_the_pieces(rows, told):
    assert list(push_pieces(make_stream(), rows, [1, 250, 3])) == told[1]


def spans(table):
    return [(row.start_frame, row.stop_frame, row.cluster) for row in table]


def test_what_is_final_never_changes(rows, told):
    stream, known = make_stream(), []
    for start in range(0, len(rows), 25):
        stream.push(rows[start : start + 25])
        if start > 10 * FPS:
            table = stream.segmentation
            # the last rows of both levels go on
            known.append([spans(table.activities)[:-1], spans(table.primitives)[:-1]])
    stream.finish()
    table = stream.segmentation
    last = spans(table.activities), spans(table.primitives)
    for levels in known:
        for level, final in zip(levels, last, strict=True):
            assert final[: len(level)] == level


def test_final_events_are_the_table(told):
    stream, events = told
    table = stream.segmentation
    final = [e for e in events if e.is_final]
    starts = [(e.start_s, e.cluster) for e in final if isinstance(e, ActivityStarted)]
    assert starts == [(r.start_s, r.cluster) for r in table.activities if r.kind == "activity"]
    units = [(e.start_s, e.stop_s, e.cluster) for e in final if isinstance(e, Repetition)]
    assert units == [(r.start_s, r.stop_s, r.cluster) for r in table.primitives if r.cluster >= 0]


def test_provisional_events_come_first_and_final_ones_after_the_delay(told):
    stream, events = told
    second = [e for e in events if isinstance(e, ActivityStarted) and e.cluster == 1]
    assert [e.state for e in second] == ["provisional", "final"]
    assert second[0].at_s - 12 < 4
    assert stream.delay <= second[1].at_s - second[1].start_s <= 2 * stream.delay + stream.interval


def test_a_stream_goes_on_after_it_was_saved(rows, told, tmp_path):
    stream = make_stream()
    events = stream.push(rows[:407])
    stream.save(tmp_path / "stream.npz")
    again = Stream.load(tmp_path / "stream.npz")
    assert events + list(push_pieces(again, rows[407:], [10])) == told[1]
    assert again.segmentation == told[0].segmentation


def test_files_of_nothing_and_of_other_versions_are_refused(tmp_path, monkeypatch):
    (tmp_path / "other.npz").write_bytes(b"nothing")
    with pytest.raises(ReadError, match="not a stream"):
        Stream.load(tmp_path / "other.npz")
    with monkeypatch.context() as context:
        context.setattr("kineme.live.storage.SCHEMA", "kineme.stream/1")
        make_stream().save(tmp_path / "older.npz")
    with pytest.raises(ReadError, match="another version: 'kineme.stream/1'"):
        Stream.load(tmp_path / "older.npz")


def test_memory_is_bounded(rows):
    stream = make_stream(interval=10.0, delay=5.0, memory=30.0)
    sizes = []
    for _ in range(3):
        stream.push(rows)
        past = stream._state.past
        sizes.append(len(past.values) + sum(len(block) for block, _ in past._blocks))
    assert max(sizes) <= (30 + 10) * FPS
    assert sum(map(len, stream._state.past.examples.values())) <= 40 * 8 * FPS


def test_a_body_is_segmented_by_its_joints():
    motion = kineme.read(kineme.bundled_recording())[:900]
    stream = Stream(fps=motion.fps, skeleton=motion.skeleton)
    events = list(push_pieces(stream, motion.positions, [60]))
    starts = [e.start_s for e in events if isinstance(e, ActivityStarted) and e.is_final]
    expected = [r.start_s for r in kineme.segment(motion).activities if r.kind == "activity"]
    assert len(starts) == len(expected)
    np.testing.assert_allclose(starts, expected, atol=1.0)


@pytest.mark.parametrize("fps", [FPS, 10.0, 60.0])
def test_clusters_of_an_earlier_result_keep_their_numbers_and_labels(rows, fps):
    earlier = kineme.resample(kineme.Signals(rows, FPS, ["x", "y"]), fps)
    n = earlier.n_frames
    a, b = round(12 * fps), round(24 * fps)
    spans = {"start_frame": [0, a, b], "stop_frame": [a, b, n], "cluster": [7, 3, 7]}
    kinds = {
        "level": ["activity"] * 3,
        "kind": ["activity"] * 3,
        "label": ["a", "b", "a"],
    }
    table = kineme.Segmentation.from_columns({**spans, **kinds}, n_frames=n, fps=fps)
    stream = make_stream(known=(earlier, table))
    events = list(push_pieces(stream, two_exercises(seed=1)[250:], [50]))
    labels = [e.label for e in events if isinstance(e, ActivityEnded) and e.is_final]
    assert labels[-2:] == ["b", "a"]


def test_what_a_stream_cannot_know_is_refused(rows):
    earlier = kineme.Signals(rows, FPS, ["x", "y"])
    table = kineme.segment(earlier)
    for known, reason in (
        (table, "must be"),
        ((rows, table), "not ndarray: kineme.as_signals"),
        ((earlier[:300], table), "900 frames, but the recording has 300"),
        ((earlier.select(["x"]), table), "no channel 'y'"),
    ):
        with pytest.raises(ParameterError, match=reason):
            make_stream(known=known)


def test_columns_are_taken_by_their_names(rows, told):
    frame = pd.DataFrame({"y": rows[:, 1], "note": "", "x": rows[:, 0]})
    stream = make_stream()
    with pytest.raises(ParameterError, match="no x, but y, note, z"):
        stream.push(frame.rename(columns={"x": "z"}))
    events = stream.push(frame.iloc[0])
    assert events + stream.push(frame[1:]) + stream.finish() == told[1]


def test_segments_have_the_dates_of_their_rows(rows, tmp_path):
    stream = make_stream()
    dates = np.datetime64("2026-11-28T09:30") + 40 * np.arange(len(rows)).astype("m8[ms]")
    stream.push(rows[:500], dates[:500])
    stream.save(tmp_path / "stream.npz")
    stream = Stream.load(tmp_path / "stream.npz")
    stream.push(rows[500:], dates[500:])
    assert stream.segmentation.start_times()[0] == "2026-11-28T09:30:00.000+00:00"


def test_no_activity_ends_before_it_begins():
    angle = np.arange(0, 30, 1 / FPS) * 2 * np.pi / 5  # parts of slow repetitions look different
    rows = np.column_stack([np.cos(angle) ** 5, np.sin(angle) ** 3])
    rows += np.random.default_rng(0).normal(0, 0.05, rows.shape)
    ended = [e for e in push_pieces(make_stream(), rows, [50]) if isinstance(e, ActivityEnded)]
    assert all(e.start_s <= e.stop_s for e in ended)


def test_a_long_hole_is_a_gap_and_does_not_fill_the_memory(rows):
    stream = make_stream()
    times = np.concatenate([np.arange(400), 86400 * FPS + np.arange(400)]) / FPS
    events = list(push_pieces(stream, np.concatenate([rows[:400], rows[:400]]), [50], times))
    gaps = [e for e in events if isinstance(e, Gap) and e.is_final]
    assert len(gaps) == 1
    assert gaps[0].stop_s - gaps[0].start_s == pytest.approx(86400 - 16, abs=0.1)
    ended = [e.cluster for e in events if isinstance(e, ActivityEnded) and e.is_final]
    assert ended == [0, 1, 0, 1]
    assert stream.segmentation.n_frames == pytest.approx(86400 * FPS + 400, abs=1)


@pytest.mark.parametrize("bad", [np.full((300, 2), np.nan), np.zeros((300, 2)), np.ones((1, 2))])
def test_rows_that_tell_nothing_are_borne(bad):
    stream = make_stream()
    list(push_pieces(stream, bad, [100]))
    assert stream.segmentation.n_frames == len(bad)


def test_rows_that_do_not_fit_are_refused_and_the_stream_goes_on():
    stream = make_stream()
    stream.push([[1.0, 2.0]])
    for rows, times in (
        ([[1.0]], None),
        (np.ones((2, 3)), None),
        ([["a", "b"]], None),
        ([[1.0, 2.0]], [0.0]),
    ):
        with pytest.raises(ParameterError):
            stream.push(rows, times)
    stream.push([1.0, 2.0])
    stream.finish()
    assert stream.segmentation.n_frames == 2


@pytest.mark.parametrize(
    "options",
    [
        {"fps": 0},
        {"channels": None},
        {"channels": []},
        {"delay": 0},
        {"memory": 5.0},
        {"preset": "nothing"},
        {"nothing": 1},
    ],
)
def test_options_that_make_no_sense_are_refused(options):
    with pytest.raises(ParameterError):
        make_stream(**options)
