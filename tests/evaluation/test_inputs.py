"""Compare a result with its truth, from label files."""

from __future__ import annotations

import pytest

from kineme.errors import ReadError
from kineme.evaluation import TRANSITION, annotator_agreement, evaluate
from kineme.evaluation.comparison import compare
from kineme.evaluation.inputs import (
    find_differences,
    read_result,
    read_truth,
)
from kineme.evaluation.score import compute_results, get_value
from kineme.evaluation.truth import make_truth
from kineme.labels.collections import LabelSource
from kineme.segments.segmentation import Segmentation
from segmentations import from_rows, one_activity


def result(n_frames: int = 60, fps: float = 10.0) -> Segmentation:
    return one_activity(n_frames, fps, cluster=0)


def test_gaps_and_transitions_of_a_truth_are_uncertain_borders(tmp_path) -> None:
    rows = ["start_s,stop_s,label,count", "0,2,walk,4", "2.5,4,jump,", "4,4.4,transition,",
            "4.4,6,walk,3"]  # fmt: skip
    path = tmp_path / "truth.csv"
    path.write_text("\n".join(rows))
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
        ("0,3,a\n2,6,b", "'b' starts at frame 20, before the previous label stops"),
        ("3,1,a", "'a' stops at 1.0, before 3.0"),
        ("0,9,a", r"cover 9.000 s \(90 frames at 10 fps\), but the recording lasts 6.000 s \(60"),
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


def test_silence_at_the_ends_counts_in_nothing(tmp_path) -> None:
    path = tmp_path / "truth.csv"
    path.write_text("start_s,stop_s,label\n1,2,walk\n2,3,run\n")
    truth = read_truth(path, result())
    assert truth.labels == (TRANSITION, "walk", "run", TRANSITION)
    found = labels_as(tmp_path / "found.csv", ["0,2,a", "2,4,b", "4,6,c"])
    scores = evaluate(truth, found)
    assert scores["mof"] == scores["border_f1"] == scores["covering"] == 1.0
    assert scores["cluster_ratio"] == scores["cut_ratio"] == 1.0


def labels_as(path, rows: list[str], header: str = "start_s,stop_s,label") -> Segmentation:
    path.write_text("\n".join([header, *rows]) + "\n")
    return read_result(path, fps=10)


CUT = ["0,2,squat", "2,4,squat", "4,6,squat", "6,9,walk"]
"""Three repetitions, and an activity of unknown count."""
BOTH = ["0,6,squat,activity,", "6,9,walk,activity,", "0,2,squat,primitive,",
        "2,4,squat,primitive,", "4,6,squat,primitive,"]  # fmt: skip
COUNTED = ["0,6,squat,activity,3", "6,9,walk,activity,"]
LEVELS = "start_s,stop_s,label,level,count"


@pytest.fixture
def counted_wrong(tmp_path) -> Segmentation:
    """Make four squats where the truth has three."""
    rows = ["0,6,0,activity,", "6,9,1,activity,", "0,2,0,primitive,", "2,3,0,primitive,",
            "3,4,0,primitive,", "4,6,0,primitive,", "6,9,1,primitive,"]  # fmt: skip
    return labels_as(tmp_path / "found.csv", rows, LEVELS)


@pytest.mark.parametrize(
    ("header", "rows"), [("start_s,stop_s,label", CUT), (LEVELS, BOTH), (LEVELS, COUNTED)]
)
def test_repetitions_are_counted_however_labels_tell_them(
    tmp_path, counted_wrong, header, rows
) -> None:
    labels_as(tmp_path / "truth.csv", rows, header)
    truth = read_truth(tmp_path / "truth.csv", counted_wrong)
    assert (truth.labels, truth.counts) == (("squat", "walk"), (3, None))
    one = evaluate(truth, counted_wrong)
    folder = folder_scores(tmp_path / "truth.csv", counted_wrong)
    for scores in (one, folder):
        assert (scores["count_error"], scores["count_exact"]) == (1.0, 0.0)
        assert scores["border_f1"] == scores["covering"] == scores["mof"] == 1.0
    for scores in (one, folder) if rows is not COUNTED else ():
        assert scores["repetition_f1"] == pytest.approx(4 / 5)
    assert ("repetition_f1" in one) == ("repetition_f1" in folder) == (rows is not COUNTED)


def folder_scores(path, found: Segmentation) -> dict[str, float]:
    truth = LabelSource(path).of(n_frames=found.n_frames, fps=found.fps)
    return {name: get_value(one) for name, one in compute_results(compare(truth, found)).items()}


@pytest.mark.parametrize("rests", [(), ("0,2,rest,activity,", "8,12,rest,activity,",
                                        "16,18,rest,activity,")])  # fmt: skip
def test_rests_between_sets_need_no_labels(tmp_path, rests: tuple[str, ...]) -> None:
    sets = ["2,8,squat,activity,4", "12,16,curl,activity,3"]
    found = [(0, 2.2), (2.2, 3.6), (3.6, 5), (5, 6.4), (6.4, 7.8), (7.8, 12.2), (12.2, 13.4),
             (13.4, 14.6), (14.6, 15.8), (15.8, 18)]  # fmt: skip
    clusters = [2, *[0] * 4, 2, *[1] * 3, 2]
    rows = [f"{a},{b},,primitive,,{c}" for (a, b), c in zip(found, clusters, strict=True)]
    rows += ["0,2.2,,activity,,2", "2.2,7.8,,activity,,0", "7.8,12.2,,activity,,2",
             "12.2,15.8,,activity,,1", "15.8,18,,activity,,2"]  # fmt: skip
    result = labels_as(tmp_path / "found.csv", rows, f"{LEVELS},cluster")
    path = tmp_path / "truth.csv"
    labels_as(path, sorted([*sets, *rests], key=lambda row: float(row.split(",")[0])), LEVELS)
    for scores in (
        evaluate(read_truth(path, result), result),
        folder_scores(path, result),
        evaluate(LabelSource(path).of(n_frames=180, fps=10), result),
    ):
        for name in ("count_exact", "border_f1", "edit", "f1@50", "border_ratio"):
            assert scores[name] == 1.0, name
    labels = {"Anna": LabelSource(path).of(n_frames=180, fps=10)}
    agreement = annotator_agreement({"take": labels | {"Ben": labels["Anna"]}})
    assert agreement.pairs[0].border_f1 == 1.0


def test_primitives_alone_are_repetitions_with_pauses_between_them(tmp_path, counted_wrong) -> None:
    rows = ["0,1.6,squat,primitive,", "2,4,squat,primitive,", "4,6,squat,primitive,",
            "6.8,9,jump,primitive,"]  # fmt: skip
    labels_as(tmp_path / "truth.csv", rows, LEVELS)
    truth = read_truth(tmp_path / "truth.csv", counted_wrong)
    assert (truth.labels, truth.counts) == (("squat", "jump"), (3, 1))
    assert truth.earliest.tolist() == [60]
    one, folder = (
        evaluate(truth, counted_wrong),
        folder_scores(tmp_path / "truth.csv", counted_wrong),
    )
    for scores in (one, folder):
        assert (scores["count_error"], scores["count_exact"]) == (0.5, 0.5)
        assert scores["repetition_f1"] == pytest.approx(4 / 5)


def test_an_activity_may_be_called_transition_in_a_segment_table() -> None:
    table = from_rows(
        [("activity", "activity", 0, 20, -1, "transition"),
         ("activity", "transition", 20, 25, -1, ""), ("activity", "activity", 25, 60, -1, "walk")],
        fps=10,
    )  # fmt: skip
    assert make_truth(table, n_frames=60, fps=10).labels == ("transition (activity)", "walk")
    found = evaluate(table, table)
    assert found["cluster_ratio"] == found["border_f1"] == found["mof"] == 1.0
    assert get_value(compute_results(compare(table, table))["mof"]) == 1.0


def test_counts_of_neighbours_of_one_name_add_up(tmp_path) -> None:
    rows = ["0,2,walk,activity,4", "2,4,walk,activity,3", "4,5,run,activity,2",
            "5,6,run,activity,"]  # fmt: skip
    labels_as(tmp_path / "truth.csv", rows, LEVELS)
    truth = read_truth(tmp_path / "truth.csv", result())
    assert (truth.labels, truth.counts) == (("walk", "run"), (7, None))


def test_a_border_found_near_the_end_of_an_action_is_no_wrong_repetition(tmp_path) -> None:
    labels_as(tmp_path / "truth.csv", ["0,2,a", "2,4,a", "4,6,b", "6,8,b"])
    found = labels_as(tmp_path / "found.csv", ["0,2,a", "2,4.3,a", "4.3,6,b", "6,8,b"])
    assert evaluate(read_truth(tmp_path / "truth.csv", found), found)["repetition_f1"] == 1.0
    labels_as(tmp_path / "truth.csv", ["0,0.6,a", "0.6,1.2,a"])  # within a quarter: 0.15 s
    found = labels_as(tmp_path / "found.csv", ["0,0.8,a", "0.8,1.2,a"])
    assert evaluate(read_truth(tmp_path / "truth.csv", found), found)["repetition_f1"] == 0.0


def test_labels_without_a_rate_need_one_only_where_they_count_frames(tmp_path) -> None:
    (tmp_path / "found.csv").write_text("start_s,stop_s,label\n0,5,a\n5,10,b\n")
    assert read_result(tmp_path / "found.csv").n_frames == 300
    (tmp_path / "found.txt").write_text("a\nb\n")
    with pytest.raises(ReadError, match=r"give fps \(--fps\)"):
        read_result(tmp_path / "found.txt")


def test_where_two_people_differ_is_told_but_not_what_borders_leave_open(tmp_path) -> None:
    first, second = tmp_path / "ann.csv", tmp_path / "bob.csv"
    first.write_text("start_s,stop_s,label\n0,2,a\n2,4,b\n4,6,a\n")
    second.write_text("start_s,stop_s,label\n0,2.2,a\n2.2,4,b\n4,5,a\n5,6,b\n")
    ann, bob = (read_result(path, fps=10) for path in (first, second))
    assert find_differences(ann, bob) == [(5.0, 6.0)]
    assert find_differences(ann, ann) == []
