"""One result against its truth: what label files say, and how the two meet."""

from __future__ import annotations

import pytest

from kineme.errors import ReadError
from kineme.evaluation import TRANSITION
from kineme.evaluation.inputs import agreement, differences, read_result, read_truth
from kineme.segments.segmentation import Segmentation


def result(n_frames: int = 60, fps: float = 10.0) -> Segmentation:
    columns = {"level": ["activity"], "kind": ["activity"], "start_frame": [0],
               "stop_frame": [n_frames], "cluster": [0]}  # fmt: skip
    return Segmentation.from_columns(columns, n_frames=n_frames, fps=fps)


@pytest.mark.parametrize("separator", [",", "\t"])
def test_gaps_and_transitions_of_a_truth_are_uncertain_borders(tmp_path, separator) -> None:
    rows = ["start_s,stop_s,label,count", "0,2,walk,4", "2.5,4,jump,", "4,4.4,transition,",
            "4.4,6,walk,3"]  # fmt: skip
    path = tmp_path / "truth.csv"
    path.write_text("\n".join(rows).replace(",", separator))
    truth = read_truth(path, result())
    assert truth.labels == ("walk", "jump", "walk")
    assert truth.earliest.tolist() == [20, 40]
    assert truth.mean.tolist() == [23, 42]
    assert truth.latest.tolist() == [25, 44]
    assert truth.counts == (4, None, 3)
    assert truth.labelling().labels == ("walk", TRANSITION, "jump", TRANSITION, "walk")


def test_the_activities_of_a_segment_table_are_a_truth(tmp_path) -> None:
    path = tmp_path / "truth.csv"
    path.write_text(
        "level,kind,start_s,stop_s,label\nactivity,activity,0,2,walk\n"
        "activity,transition,2,3,\nactivity,activity,3,6,run\nprimitive,activity,0,1,x\n"
    )
    truth = read_truth(path, result())
    assert (truth.labels, truth.latest.tolist()) == (("walk", "run"), [30])


def test_one_label_per_frame_of_another_rate(tmp_path) -> None:
    path = tmp_path / "truth.txt"
    path.write_text("walk\n" * 30 + "transition\n" * 10 + "run\n" * 20)
    truth = read_truth(path, result())
    assert (truth.labels, truth.mean.tolist()) == (("walk", "run"), [35])
    half = read_truth(path, result(30, 5.0), fps=10)
    assert (half.earliest.tolist(), half.latest.tolist()) == ([15], [20])
    with pytest.raises(ReadError, match=r"cover 6.000 s .* the recording lasts 9.000 s"):
        read_truth(path, result(90))


@pytest.mark.parametrize(
    ("rows", "words"),
    [
        ("0,3,a\n2,6,b", "'b' starts at frame 20, before the label ahead of it stops"),
        ("3,1,a", "'a' stops at 1.0, before 3.0"),
        ("0,9,a", r"cover 9.000 s .* the recording lasts 6.000 s"),
        ("0,3,a", r"cover 3.000 s .* the recording lasts 6.000 s"),
        ("0,x,a", "line 2: stop_s must be a number, not 'x'"),
        ("0,nan,a", "not 'nan'"),
        ("0", "not ''"),
        ("", "has no labels"),
    ],
)
def test_broken_tables_are_one_clear_error(tmp_path, rows, words) -> None:
    path = tmp_path / "truth.csv"
    path.write_text(f"start_s,stop_s,label\n{rows}\n")
    with pytest.raises(ReadError, match=words):
        read_truth(path, result())


def test_labels_without_a_rate_need_one_only_where_they_count_frames(tmp_path) -> None:
    (tmp_path / "found.csv").write_text("start_s,stop_s,label\n0,5,a\n5,10,b\n")
    assert read_result(tmp_path / "found.csv").n_frames == 300
    (tmp_path / "found.txt").write_text("a\nb\n")
    with pytest.raises(ReadError, match=r"give fps \(--fps\)"):
        read_result(tmp_path / "found.txt")


def test_labelled_intervals_are_clusters_by_their_names(tmp_path) -> None:
    path = tmp_path / "found.csv"
    path.write_text("start_s,stop_s,label\n0,2,a\n2,4,b\n4,6,a\n")
    found = read_result(path, fps=10)
    assert agreement(found, found)["one_to_one"] == 1.0
    assert agreement(found, found)["cluster_ratio"] == 1.0
    assert agreement(found, result(60))["cluster_ratio"] == 0.5
    assert not agreement(Segmentation.from_columns(
        {"level": ["activity"], "kind": ["transition"], "start_frame": [0], "stop_frame": [60]},
        n_frames=60, fps=10.0), found)  # fmt: skip


def test_where_two_people_differ_is_told_but_not_what_borders_leave_open(tmp_path) -> None:
    first, second = tmp_path / "ann.csv", tmp_path / "bob.csv"
    first.write_text("start_s,stop_s,label\n0,2,a\n2,4,b\n4,6,a\n")
    second.write_text("start_s,stop_s,label\n0,2.2,a\n2.2,4,b\n4,5,a\n5,6,b\n")
    ann, bob = (read_result(path, fps=10) for path in (first, second))
    assert differences(ann, bob) == [(5.0, 6.0)]
    assert differences(ann, ann) == []
