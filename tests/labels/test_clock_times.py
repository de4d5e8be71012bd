"""Labels by the clock of a recording that pauses or begins at some time of the day."""

from __future__ import annotations

from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import kineme
from growth import LINEAR, times_longer
from kineme._util.checks import format_count
from kineme.errors import KinemeWarning, ParameterError, ReadError
from kineme.labels.collections import LabelSource, convert_to_frames, find_labels
from kineme.labels.spans import Labels, Span, convert_clock_times
from kineme.recordings.times import Clock
from segmentations import make_activities

FPS = 30.0
PAUSE_S, BEGUN = 20_000.0, 1_769_851_800.25  # 2026-01-31T09:30:00.25Z
AFTER = 40 + PAUSE_S
pytestmark = pytest.mark.filterwarnings("ignore:.*the recording is split there")


def make_times_with_a_pause() -> np.ndarray:
    """40 s, hours of nothing, more than there is room for, and 40 s more."""
    seconds = np.arange(2400) / FPS
    return seconds + PAUSE_S * (seconds >= 40)


def write_recording(path: Path, times, head: str = "time_s") -> Path:
    seconds = np.arange(len(times)) / FPS
    rows = zip(times, np.sin(5 * seconds), np.cos(3 * seconds), strict=True)
    lines = [f"{time},{x:.5f},{y:.5f}" for time, x, y in rows]
    path.write_text("\n".join([f"{head},gyro_x,gyro_y", *lines]))
    return path


def read_labels(home: Path, rows: str, path: Path):
    (home / "labels.csv").write_text(f"recording,start_s,stop_s,label\n{rows}")
    read = kineme.read(path)
    source = find_labels([path], home / "labels.csv")[path]
    return source.of(n_frames=read.n_frames, fps=read.fps, clock=read.provenance.clock)


def list_labels(found) -> list[tuple[str, int, int]]:
    return [(row.label, row.start_frame, row.stop_frame) for row in found.activities if row.label]


@pytest.mark.parametrize(
    ("row", "begin", "expected", "unit"),
    [
        ("09:45,10:15", 34200, ("walk", 900, 2700), "hours"),  # of the clock, from 09:30:00
        ("09:30,10:15", 34225, ("walk", 0, 2675), "hours"),
        ("00:45,01:15", 10, ("walk", 35, 65), "minutes"),
        ("08:45,09:15", 34200, ("walk", 525, 555), "minutes"),  # from the first frame
    ],
)
def test_hours_and_minutes_are_those_of_the_clock(
    tmp_path: Path, row: str, begin: int, expected, unit: str
) -> None:
    (tmp_path / "labels.csv").write_text(f"start,stop,label\n{row},walk\n")
    found = LabelSource(tmp_path / "labels.csv").of(
        n_frames=7200, fps=1.0, clock=Clock([0], [begin])
    )
    assert list_labels(found) == [expected]
    assert any(f"are read as {unit} and " in note for note in found.provenance["notes"])


EVERYTHING = [("a", 0, 600), ("b", 600, 1200), ("c", 1201, 1501), ("d", 1501, 2401)]
"""One frame of the pause is left, which is a gap."""


@pytest.mark.parametrize(
    ("head", "start", "told"),
    [
        ("time_s", 0.0, str),
        ("time_s", 12.5, str),
        ("timestamp", BEGUN, str),
        ("timestamp", BEGUN, lambda t: str(np.datetime64(round(t * 1000), "ms"))),
        ("time", 9.5 * 3600, lambda t: str(np.datetime64(round(t * 1000), "ms"))[11:]),
    ],
)
def test_labels_behind_a_pause_are_where_the_clock_says(tmp_path, head, start, told) -> None:
    times = make_times_with_a_pause() + start
    path = write_recording(tmp_path / "walk.csv", [*map(told, times.tolist())], head)
    rows = [("a", 0, 20), ("b", 20, 40), ("c", AFTER, AFTER + 10), ("d", AFTER + 10, AFTER + 40)]
    lines = [f"walk,{told(a + start)},{told(b + start)},{name}" for name, a, b in rows]
    assert list_labels(read_labels(tmp_path, "\n".join(lines), path)) == EVERYTHING


ROWS = f"walk,0,20,a\nwalk,20,40,b\nwalk,{AFTER},{AFTER + 10},c\nwalk,{AFTER + 10},{AFTER + 40},d"


def test_labels_counted_from_the_first_frame_are_known_by_what_they_meet(tmp_path) -> None:
    path = write_recording(tmp_path / "walk.csv", make_times_with_a_pause() + BEGUN, "timestamp")
    found = read_labels(tmp_path, ROWS, path)
    assert list_labels(found) == EVERYTHING
    assert any("relative to the first frame" in note for note in found.provenance["notes"])


def test_what_the_package_wrote_itself_counts_frames_and_is_found_again(tmp_path) -> None:
    path = write_recording(tmp_path / "walk.csv", make_times_with_a_pause())
    rows = f"walk,0,20,a\nwalk,20,40,b\nwalk,{1201 / FPS},{1501 / FPS},c\n"
    assert list_labels(read_labels(tmp_path, f"{rows}walk,{1501 / FPS},81,d", path)) == EVERYTHING


def test_labels_that_meet_nothing_are_named(tmp_path) -> None:
    path = write_recording(tmp_path / "walk.csv", make_times_with_a_pause())
    rows = f"walk,0,20,a\nwalk,100,130,rest\nwalk,{AFTER},{AFTER + 40},c\n"
    rows += f"walk,{AFTER + 60},{AFTER + 70},after"
    found = read_labels(tmp_path, rows, path)
    assert list_labels(found) == [("a", 0, 600), ("c", 1201, 2401)]
    (note,) = found.provenance["notes"]
    assert (
        note
        == "left out, since they contain no frame: 'rest' 100 to 130 s, 'after' 20100 to 20110 s"
    )
    with pytest.raises(ReadError, match="has no labels of this recording .*'b' 900000 to 900001 s"):
        read_labels(tmp_path, "walk,900000,900001,b", path)


def test_one_result_and_its_table_have_the_clock(tmp_path) -> None:
    from kineme.evaluation.inputs import read_truth

    path = write_recording(tmp_path / "walk.csv", make_times_with_a_pause() + BEGUN, "timestamp")
    kineme.write_segments(kineme.segment(kineme.read(path)), tmp_path / "found.csv")
    found = kineme.read_segments(tmp_path / "found.csv")
    lines = (tmp_path / "found.csv").read_text().splitlines()
    assert lines[0].endswith("start_time,start_row,stop_row")
    assert ",2026-01-31T09:30:00.250+00:00,0," in lines[1]
    (tmp_path / "labels.csv").write_text(
        f"start_s,stop_s,label\n{BEGUN},{BEGUN + 40},a\n{BEGUN + 100},{BEGUN + 101},rest\n"
        f"{BEGUN + AFTER},{BEGUN + AFTER + 40},b\n"
    )
    with pytest.warns(KinemeWarning, match="left out, since they contain no frame: 'rest'"):
        annotation = read_truth(tmp_path / "labels.csv", found)
    assert (annotation.labels, annotation.mean.tolist()) == (("a", "b"), [1201])


def test_a_slice_keeps_the_time_of_its_frames(tmp_path) -> None:
    read = kineme.read(write_recording(tmp_path / "walk.csv", make_times_with_a_pause()))
    clock = read[1500:].provenance.clock
    assert clock.time([0.0, 1.0]).tolist() == pytest.approx(
        [AFTER + 10 - 1 / FPS, AFTER + 11 - 1 / FPS]
    )
    across = read[900:].provenance.clock
    assert across.time([0.0, 11.0]).tolist() == pytest.approx([30.0, AFTER + 1], abs=0.05)


def test_where_the_clock_is_set_back_the_first_of_two_is_meant() -> None:
    clock = Clock([0.0, 100.0], [0.0, 50.0])
    assert clock.second([40.0, 70.0, 120.0]).tolist() == [40.0, 70.0, 170.0]
    labels = Labels([Span(60, 90, "walk"), Span(110, 120, "run")])
    assert [span[:2] for span in convert_clock_times(labels, clock, length_s=200).spans] == [
        (60, 90), (160, 170),
    ]  # fmt: skip


@pytest.mark.parametrize("said", [{}, {"seconds": [0], "times": []}, {"seconds": [1], "times": [1]},
                                  {"seconds": ["a"], "times": ["b"]}, [1], 3])  # fmt: skip
def test_a_clock_that_is_none_is_refused(said) -> None:
    with pytest.raises(ParameterError, match="clock"):
        Clock.from_json(said)


def test_a_table_at_another_rate_is_refused(tmp_path: Path) -> None:
    table = make_activities(90, fps=50)
    kineme.write_segments(table, tmp_path / "walk.json")
    (source,) = find_labels([Path("walk.bvh")], tmp_path).values()
    assert source.of(n_frames=90, fps=50.001) == table
    with pytest.raises(ReadError, match="has 50 frames per second, but the recording has 25"):
        source.of(n_frames=90, fps=25)


def test_seconds_fit_any_rate_and_frames_only_their_own(tmp_path: Path) -> None:
    # People label a video of 25 frames per second; the recording has 60.
    table = make_activities(25, 55, fps=25, label=["walk", "jump"])
    for name in ("boris.csv", "elan.eaf"):
        kineme.write_segments(table, tmp_path / name, format=name.partition(".")[0])
        found = kineme.read_segments(tmp_path / name, fps=60, n_frames=132)
        assert found == LabelSource(tmp_path / name).of(n_frames=132, fps=60)
        assert found.activities.stop_frame.tolist() == [60, 132]
    kineme.write_segments(table, tmp_path / "clips.csv", format="clips")
    refused = pytest.raises(ReadError, match="has 25 frames per second, but the recording has 60")
    with refused:
        kineme.read_segments(tmp_path / "clips.csv", format="clips", fps=60)
    with refused:
        LabelSource(tmp_path, Labels([Span(0, 9, "a")], "frames", 25)).of(n_frames=132, fps=60)


@st.composite
def labels(draw: st.DrawFn) -> Labels:
    spans = st.builds(
        lambda start, length, text, level: Span(start, start + length, text, level),
        *(st.integers(0, 20), st.integers(0, 9), st.sampled_from("abc")),
        st.sampled_from(["activity", "primitive"]),
    )
    return Labels(draw(st.lists(spans, max_size=12)), "frames")


@given(labels())
def test_a_frame_has_the_last_of_the_labels_that_cover_it(given_labels: Labels) -> None:
    found = convert_to_frames(given_labels, 10, n_frames=25)
    for level in ("activity", "primitive"):
        mine, theirs = (
            [
                next((s.text for s in spans if s.level == level and s.start <= i < s.stop), "")
                for i in range(25)
            ]
            for spans in (found.spans, list(reversed(given_labels.spans)))
        )
        assert mine == theirs
        rows = sorted(span[:2] for span in found.spans if span.level == level)
        assert all(a[1] <= b[0] for a, b in pairwise(rows))
    overlapping = sum(
        any(old.level == new.level and old.start < new.stop and new.start < old.stop
            for old in given_labels.spans[:i] if old.start < min(old.stop, 25))
        for i, new in enumerate(given_labels.spans) if new.start < min(new.stop, 25)
    )  # fmt: skip
    assert [note for note in found.notes if note.startswith("overlapping")] == (
        [f"overlapping others: {format_count(overlapping, 'label')}"] if overlapping else []
    )


def test_labels_by_the_ten_thousands_are_laid_out_in_no_time() -> None:
    def laid_out(n: int) -> None:
        many = Labels([Span(i / 2, i / 2 + 3, "a") for i in range(n)], "frames")
        assert len(convert_to_frames(many, 10, n_frames=n).spans) == n // 2 + 1

    assert times_longer(laid_out, 40_000) < LINEAR


def test_a_count_is_of_a_label_that_is_in_one_part() -> None:
    spans = [
        Span(0, 9, "walk", repetitions=8),
        Span(4, 6, "wave", repetitions=2),
        Span(8, 12, "run"),
    ]
    found = convert_to_frames(Labels(spans, "frames"), 10, n_frames=12).spans
    assert [(s.text, s.start, s.stop, s.repetitions) for s in found] == [
        *(("walk", 0, 4, None), ("walk", 6, 8, None), ("wave", 4, 6, 2), ("run", 8, 12, None))
    ]
