"""Folders of labelled recordings: scores as defined elsewhere, and the table of the command."""

from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from kineme.errors import KinemeWarning, ParameterError, ReadError
from kineme.evaluation.comparison import Comparison, compare, map_clusters
from kineme.evaluation.folder import evaluate_folder, find_recordings
from kineme.evaluation.measures import compute_edit_distance
from kineme.evaluation.score import (
    SCORES,
    Ratio,
    Score,
    compute_results,
    get_value,
    pool_scores,
    register,
    scores,
)
from kineme.labels.collections import find_labels
from kineme.segments.segmentation import Segmentation
from segmentations import from_rows

per_frame = st.lists(st.integers(0, 3), min_size=1, max_size=40)


def both(draw) -> Comparison:
    """Draw labels of the same number of frames."""
    truth = draw(per_frame)
    found = draw(st.lists(st.integers(0, 5), min_size=len(truth), max_size=len(truth)))
    return Comparison(truth, found, fps=4)


comparisons = st.composite(both)()


def runs_of(labels) -> list[list[int]]:
    runs: list[list[int]] = []
    for frame, label in enumerate(labels.tolist()):
        if runs and runs[-1][0] == label:
            runs[-1][2] = frame + 1
        else:
            runs.append([label, frame, frame + 1])
    return runs


def iou(a: list[int], b: list[int]) -> float:
    frames_a, frames_b = set(range(a[1], a[2])), set(range(b[1], b[2]))
    return len(frames_a & frames_b) / len(frames_a | frames_b)


@given(a=per_frame, b=per_frame)
def test_edit_distance_is_levenshteins(a: list[int], b: list[int]) -> None:
    table = {(i, 0): i for i in range(len(a) + 1)} | {(0, j): j for j in range(len(b) + 1)}
    for i in range(1, len(a) + 1):
        for j in range(1, len(b) + 1):
            exchange = table[i - 1, j - 1] + (a[i - 1] != b[j - 1])
            table[i, j] = min(table[i - 1, j] + 1, table[i, j - 1] + 1, exchange)
    assert compute_edit_distance(a, b) == table[len(a), len(b)]


@given(compared=comparisons, percent=st.sampled_from([10, 25, 50]))
def test_f1_counts_segments_that_overlap_one_of_their_class(compared, percent) -> None:
    true, found = runs_of(compared.truth), runs_of(compared.mapped)
    taken: list[int] = []
    for run in found:
        overlaps = [iou(run, other) if other[0] == run[0] else 0 for other in true]
        best = overlaps.index(max(overlaps))
        if overlaps[best] >= percent / 100 and best not in taken:
            taken.append(best)
    expected = 2 * len(taken) / (len(true) + len(found))
    assert get_value(scores()[f"f1@{percent}"].function(compared)) == pytest.approx(expected)


@given(compared=comparisons)
def test_covering_is_the_best_overlap_weighted_by_length(compared) -> None:
    found = runs_of(compared.found)
    covered = sum((t[2] - t[1]) * max(iou(t, f) for f in found) for t in runs_of(compared.truth))
    expected = covered / compared.truth.size
    assert scores()["covering"].function(compared) == pytest.approx(expected)


@given(compared=comparisons)
def test_a_mapping_is_one_to_one_and_no_single_exchange_betters_it(compared) -> None:
    mapping = map_clusters([compared])
    assert len(set(mapping.values())) == len(mapping)
    right = int((compared.mapped == compared.truth).sum())
    for one in mapping:
        for other in mapping:
            swapped = {**mapping, one: mapping[other], other: mapping[one]}
            again = Comparison(compared.truth, compared.found, compared.fps, swapped)
            assert int((again.mapped == again.truth).sum()) <= right


def test_each_score_of_a_small_example_by_hand() -> None:
    compared = Comparison([0, 0, 0, 0, 1, 1, 1, 1, 2, 2], [7, 7, 7, 7, 7, 3, 3, 3, 3, 3], fps=1)
    values = {name: get_value(score.function(compared)) for name, score in scores().items()}
    assert values["mof"] == values["one_to_one"] == pytest.approx(0.7)
    assert values["edit"] == pytest.approx(2 / 3)
    assert values["f1@50"] == pytest.approx(2 * 2 / 5)
    assert values["border_f1"] == 0.0
    assert values["covering"] == pytest.approx((4 * 4 / 5 + 4 * 3 / 6 + 2 * 2 / 5) / 10)
    assert values["cut_ratio"] == 0.5
    assert values["cluster_ratio"] == pytest.approx(2 / 3)


def test_over_a_folder_ratios_add_up_and_numbers_are_averaged() -> None:
    assert pool_scores([Ratio(9, 10), Ratio(0, 90)]) == pytest.approx(0.09)
    assert pool_scores([0.2, math.nan, 0.4]) == pytest.approx(0.3)
    assert math.isnan(pool_scores([]))


def test_frames_without_a_label_count_in_nothing() -> None:
    truth = segments([("activity", 0, 4, "walk", -1), ("transition", 4, 8, "", -1),
                      ("activity", 8, 10, "run", -1)])  # fmt: skip
    found = segments([("activity", 0, 5, "", 2), ("transition", 5, 6, "", -1),
                      ("activity", 6, 10, "", 0)])  # fmt: skip
    compared = compare(truth, found)
    assert compared.truth.tolist() == [0, 0, 0, 0, 1, 1]
    assert compared.found.tolist() == [2, 2, 2, 2, 0, 0]
    nothing = segments([("transition", 0, 10, "", -1)])
    with pytest.raises(ParameterError, match="every frame is unlabelled"):
        compare(nothing, found)


def test_repetitions_are_those_within_labelled_frames() -> None:
    found = from_rows(
        [("activity", "activity", 0, 10, 0, ""), ("primitive", "primitive", 0, 6, 0, ""),
         ("primitive", "primitive", 6, 10, 0, "")], fps=10
    )  # fmt: skip
    truth = segments([("activity", 0, 4, "walk", -1), ("transition", 4, 7, "", -1),
                      ("activity", 7, 10, "run", -1)])  # fmt: skip
    compared = compare(truth, found)
    assert compared.spans.primitives.borders.tolist() == [0, 4, 7]
    assert scores()["count_error"].function(compared) is None


def test_one_mapping_for_the_folder_asks_for_clusters_that_mean_the_same() -> None:
    first = Comparison([0, 0, 1], [5, 5, 6], fps=1)
    second = Comparison([0, 1, 1, 1], [6, 5, 5, 5], fps=1)
    mapping = map_clusters([first, second])
    assert mapping == {5: 1, 6: 0}
    assert Comparison(first.truth, first.found, 1, mapping).mapped.tolist() == [1, 1, 0]


def segments(rows: list[tuple]) -> Segmentation:
    return from_rows([("activity", *row[:3], row[4], row[3]) for row in rows], fps=10)


def test_a_label_file_for_each_recording_serves_as_well(corpus, tmp_path) -> None:
    labels = tmp_path / "labels"
    labels.mkdir()
    (labels / "a.txt").write_text("0\t20\tslow\n20\t40\tfast\n")
    (labels / "b.labels.csv").write_text("start_s,stop_s,label\n0,20,slow\n20,40,fast\n")
    sources = find_labels(find_recordings(corpus), labels)
    assert [path.name for path in sources] == ["a.csv", "b.csv"]
    result = evaluate_folder(sources, ["uniform"], processes=1)
    assert [one.error for one in result.methods["uniform"]] == ["", ""]
    assert result.pool_scores("uniform")["cut_ratio"] == 79.0


def test_clusters_are_joined_for_one_mapping(corpus) -> None:
    sources = find_labels(find_recordings(corpus), corpus / "labels.csv")
    given = {"mapping": "folder", "without": ("emg*",), "processes": 1}
    result = evaluate_folder(sources, ["uniform"], n_clusters=2, **given)  # clusters of no meaning
    assert result.pool_scores("uniform")["mof"] > 0.95
    assert [bool(one.error) for one in result.methods["uniform"]] == [False, False, True]


def test_labels_that_belong_to_nothing_here_are_refused(corpus, tmp_path) -> None:
    (tmp_path / "labels.csv").write_text("recording,start_s,stop_s,label\nwalk,0,1,step\n")
    with pytest.raises(ReadError, match="no labels of any of the 4 recordings, such as 'a'"):
        find_labels(find_recordings(corpus), tmp_path / "labels.csv")
    (tmp_path / "one.csv").write_text("start_s,stop_s,label\n0,1,step\n")
    with pytest.raises(ReadError, match="a label without a recording: .* column 'recording'"):
        find_labels(find_recordings(corpus), tmp_path / "one.csv")
    (tmp_path / "boris.csv").write_text("Time,Behavior,Behavior type\n0,step,START\n1,step,STOP\n")
    with pytest.raises(ReadError, match="without a recording: .* column 'Observation id'"):
        find_labels(find_recordings(corpus), tmp_path / "boris.csv")


def test_a_score_that_fails_costs_itself_only() -> None:
    register(Score("broken", "broken", "divides by nothing", "frames", lambda _: 1 / 0))
    try:
        with pytest.warns(
            KinemeWarning, match="the score 'broken' was left out, since it failed: ZeroDiv"
        ):
            found = compute_results(Comparison([0, 0, 1], [4, 4, 4], fps=1))
    finally:
        SCORES.remove("broken")
    assert found["mof"] == Ratio(2, 3)
    assert "broken" not in found


def test_the_figures_of_a_set_with_human_labels_come_out(data_dir) -> None:
    home = data_dir / "sets" / "ipolgait"
    if not home.is_dir():
        pytest.skip(f"no {home}")
    sources = find_labels(find_recordings(home), home / "labels.csv")
    some = dict([*sources.items()][::5])
    result = evaluate_folder(some, ["kineme"], without=("emg*",), processes=1)
    found = result.pool_scores("kineme")
    known = {"mof": 0.918, "edit": 0.887, "f1@10": 0.923, "f1@25": 0.923, "f1@50": 0.872}
    assert {name: found[name] for name in known} == pytest.approx(known, abs=0.002)
