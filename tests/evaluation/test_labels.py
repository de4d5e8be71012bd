"""Labellings, truths, and invariances of scores."""

from __future__ import annotations

import mir_eval
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.sparse import csr_array
from scipy.sparse.csgraph import maximum_bipartite_matching

import naive
from kineme.errors import ParameterError
from kineme.evaluation import (
    TRANSITION,
    Comparison,
    Labelling,
    Truth,
    border_ratio,
    border_score,
    compare,
    covering,
    cut_ratio,
    evaluate,
    one_to_one_accuracy,
    scores,
)
from kineme.evaluation.measures import find_border_frames
from kineme.evaluation.score import get_value
from kineme.recordings import Signals
from segmentations import from_rows

SHARES = [
    "one_to_one",
    "one_to_one_agreed",
    "mutual_information",
    "border_precision",
    "border_recall",
    "border_f1",
    "covering",
]


@st.composite
def truths(draw: st.DrawFn) -> Truth:
    """Draw actions of at least 2 s at 10 fps, with borders uncertain by up to 1 s."""
    lengths = draw(st.lists(st.integers(20, 60), min_size=1, max_size=6))
    labels = draw(st.lists(st.sampled_from("abc"), min_size=len(lengths), max_size=len(lengths)))
    ends = np.cumsum(lengths)
    before, after = (
        np.array([draw(st.integers(0, 5)) for _ in lengths[1:]], dtype=np.int64) for _ in "ab"
    )
    mean = ends[:-1]
    return Truth(tuple(labels), mean - before, mean, mean + after, int(ends[-1]), 10.0)


@st.composite
def results(draw: st.DrawFn, frames: int) -> Labelling:
    cuts = draw(st.sets(st.integers(1, frames - 1), max_size=12))
    labels = [draw(st.sampled_from(["1", "2", "3", TRANSITION])) for _ in range(len(cuts) + 1)]
    return Labelling.from_cuts(sorted(cuts), labels, frames=frames, fps=10.0)


@st.composite
def pairs(draw: st.DrawFn) -> tuple[Truth, Labelling]:
    truth = draw(truths())
    return truth, draw(results(truth.frames))


of = Comparison.of


def right(truth: Truth, found: Labelling) -> tuple[float, float]:
    """Compare all frames, and those on which people agree."""
    compared = of(truth, found)
    return one_to_one_accuracy(compared), one_to_one_accuracy(compared.agreed)


@given(pairs())
def test_shares_lie_between_0_and_1(pair):
    scores = evaluate(*pair)
    assert all(-1e-12 <= scores[name] <= 1 + 1e-12 for name in SHARES)
    assert -1 <= scores["rand_index"] <= 1


@given(truths())
def test_the_truth_itself_scores_1(truth):
    found = truth.labelling()
    assert right(truth, found) == (1, 1)
    scores = evaluate(truth, found)
    assert scores["rand_index"] == pytest.approx(1)
    assert scores["mutual_information"] == pytest.approx(1)
    assert scores["cohen_kappa"] == pytest.approx(1)
    assert scores["cluster_ratio"] == 1


@given(truths())
def test_cutting_at_the_mean_marks_meets_every_border(truth):
    found = Labelling.from_cuts(truth.mean, frames=truth.frames, fps=10.0)
    assert border_score(of(truth, found)) == (1, 1, 1)
    assert covering(of(truth, found)) == 1
    if truth.mean.size:
        assert border_ratio(of(truth, found)).value == cut_ratio(of(truth, found)).value == 1


@given(pairs(), st.permutations(["1", "2", "3"]))
def test_names_of_clusters_do_not_matter(pair, names):
    truth, found = pair
    new = dict(zip(["1", "2", "3", TRANSITION], [*names, TRANSITION], strict=True))
    renamed = Labelling(found.borders, tuple(new[label] for label in found.labels), found.fps)
    ours, theirs = evaluate(truth, found), evaluate(truth, renamed)
    # Of mappings with as many frames right any is taken, which these tell apart.
    for name in ("cohen_kappa", "edit", "f1@10", "f1@25", "f1@50"):
        del ours[name], theirs[name]
    assert theirs == pytest.approx(ours, nan_ok=True)


@given(pairs(), st.integers(2, 4))
def test_a_result_at_a_multiple_of_the_rate_scores_the_same(pair, factor):
    truth, found = pair
    faster = Labelling(found.borders * factor, found.labels, found.fps * factor)
    assert evaluate(truth, faster) == pytest.approx(evaluate(truth, found), nan_ok=True)


@given(pairs())
def test_one_to_one_is_the_best_of_all_assignments(pair):
    truth, found = pair
    wanted, given_ = truth.labelling().per_frame(), found.per_frame()
    agreed = wanted != TRANSITION
    assert right(truth, found) == pytest.approx(
        (
            naive.one_to_one_accuracy(wanted, given_),
            naive.one_to_one_accuracy(wanted[agreed], given_[agreed]),
        )
    )


@given(pairs())
def test_exact_borders_are_matched_as_mir_eval_does(pair):
    truth, found = pair
    labels = [str(i) for i in range(len(found.labels))]
    found = Labelling(found.borders, tuple(labels), found.fps)
    exact = Truth(truth.labels, truth.mean, truth.mean, truth.mean, truth.frames, 10.0)
    if len(exact.labels) == 1 or len(labels) == 1:
        return  # mir_eval warns where it has nothing to compare
    spans = [
        np.stack([b[:-1], b[1:]], axis=1) / 10 for b in (exact.at_means().borders, found.borders)
    ]
    theirs = mir_eval.segment.detection(*spans, window=0.25 + 1e-9, trim=True)
    assert border_score(of(exact, found)) == pytest.approx(theirs)


@given(pairs())
def test_as_many_borders_are_matched_as_can_be(pair):
    truth, found = pair
    borders = find_border_frames(found)
    first, last = truth.earliest[:, None] - 2.5, truth.latest[:, None] + 2.5
    near = csr_array((first <= borders) & (borders <= last))
    most = (maximum_bipartite_matching(near) >= 0).sum() if all(near.shape) else 0
    score = border_score(of(truth, found))
    assert score.precision * borders.size == pytest.approx(most if truth.mean.size else 0)
    assert score.recall * truth.mean.size == pytest.approx(most if borders.size else 0)


@given(st.lists(st.integers(0, 2), min_size=1, max_size=60), st.data())
def test_labels_without_gaps_score_as_a_truth_of_exact_borders(labels, data):
    clusters = data.draw(
        st.lists(st.integers(0, 4), min_size=len(labels), max_size=len(labels)), "clusters"
    )
    plain = Comparison(labels, clusters, fps=10.0)
    truth = Truth.from_labelling(Labelling.from_frames(labels, fps=10.0), tolerance_s=0.5)
    exact = of(truth, Labelling.from_frames(clusters, fps=10.0))
    for name, score in scores().items():
        # Of mappings with as many frames right any is taken, which these tell apart.
        if name not in ("cohen_kappa", "edit", "f1@10", "f1@25", "f1@50"):
            ours, theirs = (get_value(score.function(one)) for one in (plain, exact))
            assert ours == pytest.approx(theirs, nan_ok=True), name


def test_a_short_transition_is_one_border_and_a_long_one_two():
    truth = Truth(("a", "b"), [18], [20], [22], 60, 10.0)
    short = Labelling([0, 17, 25, 60], ("1", TRANSITION, "2"), 10.0)
    long = Labelling([0, 17, 28, 60], ("1", TRANSITION, "2"), 10.0)
    assert border_score(of(truth, short)) == (1, 1, 1)
    assert border_score(of(truth, long)).precision == 1 / 2
    assert (
        border_ratio(of(truth, short)).value,
        cut_ratio(of(truth, short)).value,
    ) == (1, 2)


def test_a_found_transition_is_no_cluster():
    truth = Truth(("a", "b"), [20], [25], [30], 60, 10.0)
    lazy = Labelling([0, 60], (TRANSITION,), 10.0)
    assert right(truth, lazy) == (10 / 60, 0)


def test_repetitions_are_counted_within_each_action():
    truth = Truth(("a", "b"), [20], [20], [20], 60, 10.0, counts=(2, None))
    exact = Labelling([0, 9, 19, 25, 60], ("1", "1", TRANSITION, "2"), 10.0)
    scores = evaluate(truth, exact)
    assert (scores["count_error"], scores["count_exact"]) == (0, 1)
    assert evaluate(truth, Labelling([0, 60], ("1",), 10.0))["count_error"] == 2
    assert "count_error" not in evaluate(Truth(("a",), [], [], [], 60, 10.0), exact)


def test_a_segmentation_is_scored_at_its_own_levels():
    truth = Truth(("walk", "jump"), [28], [30], [32], 60, 30.0)
    spans = [(0, 112, "activity"), (112, 128, "transition"), (128, 240, "activity")]
    rows = [("activity", kind, start, stop, -1, "") for start, stop, kind in spans]
    rows += [("primitive", "primitive", 0, 60, 0, ""), ("primitive", "primitive", 60, 112, 0, "")]
    rows += [("primitive", kind, start, stop, -1, "") for start, stop, kind in spans[1:]]
    found = from_rows(rows, fps=120.0)
    scores = evaluate(truth, found)
    assert scores["one_to_one"] == scores["border_f1"] == 1
    assert scores["cluster_ratio"] == scores["border_ratio"] == 1


@pytest.mark.parametrize(
    ("marks", "words"),
    [
        (([20], [18], [25]), "after action 1 \\(a\\) is not in order"),
        (([70], [70], [70]), "at frame 70 is not before the end of the recording, frame 60"),
        (([0], [0], [0]), "borders overlap"),
        (([20, 30], [20, 30], [20, 30]), "earliest has 2 borders, but 2 actions have 1 between"),
    ],
)
def test_impossible_marks_are_one_clear_error(marks, words):
    with pytest.raises(ParameterError, match=words):
        Truth(("a", "b"), *marks, 60, 10.0)


def test_labels_of_another_length_than_the_recording_are_one_clear_error():
    truth = Truth(("a",), [], [], [], 60, 10.0)
    with pytest.raises(ParameterError, match="cover 5.000 s .*lasts 6.000 s"):
        evaluate(truth, Labelling([0, 50], ("1",), 10.0))


@pytest.mark.parametrize("measure", [evaluate, compare])
def test_what_is_no_segmentation_is_one_clear_error(measure):
    table = from_rows([("activity", "activity", 0, 60, 0, "a")], fps=10.0)
    assert measure(table, table)
    for sides in ((Signals(np.zeros((60, 1)), 10.0), table), (table, "table.csv")):
        with pytest.raises(ParameterError, match="takes a Segmentation.* not .*: kineme.read_segm"):
            measure(*sides)


@pytest.mark.parametrize("labels", [(), (TRANSITION,)])
def test_a_truth_without_actions_is_one_clear_error(labels):
    with pytest.raises(ParameterError, match="at least one action"):
        Truth(labels, [], [], [], 60, 10.0)


@pytest.mark.parametrize(
    "borders", [[0, 5, 5, 9], [1, 9], [0], [0, 9, 5], [[0, 5], [5, 9]], [0, float("nan"), 9], 5]
)
def test_intervals_must_tile_from_0(borders):
    with pytest.raises(ParameterError):
        Labelling(borders, tuple("abc")[: np.size(borders) - 1], 10.0)
