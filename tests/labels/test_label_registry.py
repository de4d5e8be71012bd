"""One registry and one reader: content tells formats apart, other packages add their own."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from kineme.errors import ParameterError, ReadError
from kineme.labels import (
    LabelFormat,
    Labels,
    Span,
    holds_labels,
    label_formats,
    read_segments,
    register,
    registry,
    write_segments,
)
from kineme.labels.collections import find_labels_and_unmatched, read_labels
from segmentations import make_activities

SEGMENTS = make_activities(40, 60, fps=10, label=["walk", "jump"])
WRITERS = [name for name, known in label_formats().items() if known.write]


@pytest.mark.parametrize("name", WRITERS)
def test_what_a_file_holds_tells_its_format_where_several_share_the_suffix(
    tmp_path: Path, name: str
) -> None:
    known = label_formats()[name]
    path = tmp_path / known.folder / f"take{known.written_suffix}"
    write_segments(SEGMENTS, path, format=name)
    back = read_segments(path, fps=10, n_frames=60)
    assert back.activities.label.tolist() == ["walk", "jump"]
    assert back.cuts().tolist() == [40]
    assert holds_labels(path)


@pytest.mark.parametrize("separator", [",", "\t"])
@pytest.mark.parametrize("suffix", [".csv", ".tsv"])
def test_a_table_of_intervals_with_gap_transition_and_counts(
    tmp_path: Path, separator: str, suffix: str
) -> None:
    rows = ["start_s,stop_s,label,count", "0,2,walk,4", "2.5,4,jump,", "4,4.4,transition,",
            "4.4,6,walk,3"]  # fmt: skip
    path = tmp_path / f"truth{suffix}"
    path.write_text("\n".join(rows).replace(",", separator))
    found = read_segments(path, fps=10)
    assert found.activities.label.tolist() == ["walk", "", "jump", "", "walk"]
    assert found.activities.start_frame.tolist() == [0, 20, 25, 40, 44]
    assert found.provenance["labels"]["counts"] == [4, None, None, None, 3]
    path.write_text("start_s,stop_s,label,count\n0,6,a,many\n")
    with pytest.raises(ReadError, match="line 2: count must be a whole number, not 'many'"):
        read_segments(path, fps=10)


@pytest.mark.parametrize(
    "text",
    [
        "Start Time,End Time,Activity\n0,2,walk\n2.5,4,jump\n",
        "onset;duration;label\n0;2,0;walk\n2,5;1,5;jump\n",
        "name\tbegin (ms)\tend (ms)\nwalk\t0\t2000\njump\t2500\t4000\n",
        "Name,Start,End,Label\nAnn,0,2,walk\nAnn,2.5,4,jump\n",
        "from,to,trial_type\n0,2,walk\n2.5,4,jump\n",
        "start,duration,to,label\n0,2,1,walk\n2.5,1.5,2,jump\n",
        "onset,duration,from,to,label\n0,2,1,2,walk\n2.5,1.5,2,1,jump\n",
        "time_s,event,start_s,stop_s,label\n0,hit,0,2,walk\n3,hit,2.5,4,jump\n",
        "t_start,t_end,label\n0,2,walk\n2.5,4,jump\n",
        "start_time,end_time,trial_type\n0,2,walk\n2.5,4,jump\n",
        "start,end,label\n00:00.000,0:02,walk\n0:00:02.5,00:04,jump\n",
        "label,start,end,start_frame,stop_frame\njump,,,25,40\nwalk,,,0,20\n",
    ],
)
def test_columns_of_intervals_have_usual_names(tmp_path: Path, text: str) -> None:
    path = tmp_path / "labels.csv"
    path.write_text(text)
    assert holds_labels(path)
    found = read_segments(path, fps=10)
    assert found.activities.label.tolist() == ["walk", "", "jump"]
    assert found.activities.stop_frame.tolist() == [20, 25, 40]
    path.write_text("first,last,label\n0,40,walk\n")
    with pytest.raises(ReadError, match="no header line with the columns 'start_s', 'stop_s'"):
        read_segments(path, fps=10)
    path.write_text("time_s,frame,event\n0.5,5,left foot strike\n")
    with pytest.raises(ReadError, match="table of events, .*: kineme events --labels FILE writes"):
        read_segments(path, fps=10)


@pytest.mark.parametrize(
    ("name", "text"),
    [
        ("bids.tsv", "# by Ann, 2026\nonset\tduration\ttrial_type\n0\t1.5\twalk\n"),
        ("boris.csv", "Observation id\tx\n\nTime,Behavior,Status\n0,walk,START\n1.5,walk,STOP\n"),
        ("intervals.csv", "by Ann, 2026\nstart_s;stop_s;label\n0;1,5;walk\n"),
        ("commas.csv", "start_s;stop_s;label;good, bad\n0;1,5;walk;good\n"),
    ],
)
def test_lines_above_the_header_may_have_another_separator(
    tmp_path: Path, name: str, text: str
) -> None:
    (tmp_path / name).write_text(text)
    found = read_segments(tmp_path / name, fps=10)
    assert (found.activities.label.tolist(), found.n_frames) == (["walk"], 15)


@pytest.mark.parametrize("column", ["recording", "File"])
def test_recordings_in_a_table_are_matched_without_case_unless_ambiguous(
    tmp_path: Path, column: str
) -> None:
    path = tmp_path / "labels.csv"
    rows = "TAKE,0,2,walk\nRun.bvh,0,2,a\nrun,0,2,b\nD:\\data\\Jump.bvh,0,2,c\nSESSION,0,2,d\n"
    path.write_text(f"{column},start_s,stop_s,label\n{rows}")
    recordings = [Path("take.bvh"), Path("RUN.bvh"), Path("jump.bvh"), Path("session")]
    found, unmatched = find_labels_and_unmatched(recordings, path)
    assert (list(found), unmatched) == ([*recordings[:1], *recordings[2:]], ["Run.bvh", "run"])
    assert read_labels(recordings[0], path, n_frames=20, fps=10).activities.label[0] == "walk"


def test_a_column_with_the_video_of_a_recording_is_ignored(tmp_path: Path) -> None:
    path = tmp_path / "labels.csv"
    path.write_text("start_s,stop_s,label,file\n0,1.1,stride,cam1.mp4\n")
    found = read_labels(Path("walk.bvh"), path, n_frames=20, fps=10)
    assert found.activities.label[0] == "stride"
    path.write_text("start_s,stop_s,label,recording\n0,1.1,stride,run\n")
    with pytest.raises(ReadError, match="no labels of 'walk', but of 'run'"):
        read_labels(Path("walk.bvh"), path, n_frames=20, fps=10)


def test_levels_kinds_and_clusters_of_a_table_of_seconds_are_kept(tmp_path: Path) -> None:
    path = tmp_path / "seconds.csv"
    path.write_text(
        "recording,level,kind,start_s,stop_s,label,cluster\n"
        "a.bvh,activity,activity,0,2,,7\na.bvh,activity,transition,2,3,,-1\n"
        "a.bvh,activity,activity,3,6,run,mine\na.bvh,primitive,activity,0,1,x,3\n"
    )
    found = read_segments(path, fps=10)
    assert found.activities.kind.tolist() == ["activity", "transition", "activity"]
    assert found.activities.cluster.tolist() == [7, -1, -1]
    assert found.activities.label.tolist() == ["", "", "run"]
    assert found.primitives.label.tolist() == ["x", "", "", ""]
    assert found.primitives.cluster.tolist()[0] == 3


def test_a_table_of_many_recordings_is_no_table_of_one(tmp_path: Path) -> None:
    path = tmp_path / "labels.csv"
    path.write_text("recording,start_s,stop_s,label\na,0,2,walk\nb,0,2,run\n")
    with pytest.raises(ReadError, match=r"labels of 2 recordings \(a, b\): keep one"):
        read_segments(path, fps=10)


def test_observations_of_boris_are_recordings(tmp_path: Path) -> None:
    path = tmp_path / "events.csv"
    rows = "a,10,walk,START,0\na,10,walk,STOP,2\nb,20,run,START,1\nb,20,run,STOP,1.5\n"
    path.write_text(f"Observation id,FPS,Behavior,Behavior type,Time\n{rows}")
    with pytest.raises(ReadError, match=r"labels of 2 recordings \(a, b\): keep one"):
        read_segments(path)
    found = read_labels("takes/b.bvh", path, n_frames=40, fps=20)
    assert found.activities.label.tolist() == ["", "run", ""]
    assert (found.activities.start_frame[1], found.provenance["labels"]["format"]) == (20, "boris")


def test_one_label_per_frame_needs_no_name_of_the_format(tmp_path: Path) -> None:
    path = tmp_path / "frames.txt"
    path.write_text("stand up\n" * 30 + "transition\n" * 10 + "run\n" * 20)
    found = read_segments(path, fps=10)
    assert found.activities.label.tolist() == ["stand up", "", "run"]
    for text in ("walk", "1\n1\n1", "1\n" * 5000):  # the last line may have no end
        path.write_text(text)
        assert holds_labels(path)
    path.write_text("a\n\nb\n")
    with pytest.raises(ReadError, match="line 2: has an empty line: every frame needs a label"):
        read_segments(path, fps=10)


@pytest.mark.parametrize("form", ["%d", "%.18e", "%.1f"])
def test_states_that_numpy_saved_are_labels(tmp_path: Path, form: str) -> None:
    states = np.repeat([-1, 0, 1, -1], [20, 30, 40, 10])
    np.savetxt(tmp_path / "states.txt", states, form)
    found = read_segments(tmp_path / "states.txt", fps=10, n_frames=100)
    assert found.activities.label.tolist() == ["", "0", "1", ""]
    assert found.activities.stop_frame.tolist() == [20, 50, 90, 100]
    with pytest.raises(ReadError, match="has labels of 100 frames, but the recording has 120"):
        read_segments(tmp_path / "states.txt", fps=10, n_frames=120)


@pytest.mark.parametrize(
    ("name", "text"),
    [
        ("changes.txt", "120\n340\n600\n"),
        ("edges.csv", "from,to,label\nknee,hip,thigh\n"),
        ("recording.csv", "time,x,y\n0,1,2\n"),
        ("signals.txt", "0.1 0.2\n0.3 0.4\n"),
        ("signals.tsv", "time\tx\n0\t1\n"),
        ("keypoints.json", '{"people": []}'),
        ("take.provenance.json", '{"schema": "kineme.segments/2"}'),
        ("walk.bvh", "HIERARCHY\n"),
    ],
)
def test_recordings_are_not_taken_for_labels(tmp_path: Path, name: str, text: str) -> None:
    (tmp_path / name).write_text(text)
    assert not holds_labels(tmp_path / name)


def test_a_format_of_ones_own_is_read_and_written_by_its_suffix(tmp_path: Path) -> None:
    def write(rows, segmentation, path) -> None:
        path.write_text("".join(f"{r.start_frame} {r.stop_frame} {r.label}\n" for r in rows))

    def read(path) -> Labels:
        lines = [line.split() for line in path.read_text().splitlines()]
        return Labels([Span(int(a), int(b), text) for a, b, text in lines], "frames")

    toy = LabelFormat("toy", "Three words a line", (".toy",), "level", read, write)
    register(toy)
    try:
        write_segments(SEGMENTS, tmp_path / "take.toy")
        back = read_segments(tmp_path / "take.toy", fps=10)
        assert back.activities.label.tolist() == ["walk", "jump"]
        with pytest.raises(
            ParameterError, match="holds of 'toy' must be one of all, levels, level"
        ):
            replace(toy, holds="rows")
        with pytest.raises(ParameterError, match="suffixes of 'toy' must be a tuple"):
            replace(toy, suffixes=("toy",))
    finally:
        registry.FORMATS.remove("toy")
