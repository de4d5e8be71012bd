"""transfer_labels(): right labels across bodies, rates and phases, and none without a match."""

from __future__ import annotations

from collections import Counter
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest

import kineme
from kineme.datasets import Action, synthesize
from kineme.errors import ParameterError
from kineme.segments.segmentation import Segmentation
from kineme.transfer import KnowledgeBase, name_primitives, transfer_features, transfer_labels
from segmentations import from_rows, make_activities

TAUGHT = synthesize(
    [Action("walk", 3), Action("kick", 3), Action("walk", 2), Action("jump", 3)], fps=60, seed=1
)
KNOWLEDGE = KnowledgeBase.from_recording(TAUGHT.motion, TAUGHT.truth)
ASKED = synthesize(
    [Action("jump", 4), Action("walk", 4), Action("squat", 3), Action("kick", 3)],
    fps=48,
    size=1.2,
    seed=5,
)
FEATURES = transfer_features(ASKED.motion)


def drop_labels(segments: Segmentation) -> Segmentation:
    blank = np.full(len(segments.table), "")
    return replace(segments, table=replace(segments.table, label=blank), hierarchy=None)


BLANK = drop_labels(ASKED.truth)


def pair_labels(segments: Segmentation) -> list[tuple[str, str]]:
    rows = zip(ASKED.truth.primitives, segments.primitives, strict=True)
    return [(truth.label, row.label) for truth, row in rows if truth.kind == "primitive"]


def test_another_body_at_another_rate_gets_the_right_names() -> None:
    result = transfer_labels(BLANK, FEATURES, KNOWLEDGE)
    pairs = pair_labels(result)
    assert {got for truth, got in pairs if truth == "squat"} == {""}  # nobody taught it
    known = [(truth, got) for truth, got in pairs if truth != "squat"]
    assert known
    assert all(truth == got for truth, got in known)
    activities = [row.label for row in result.activities if row.kind == "activity"]
    assert activities == ["jump", "walk", "", "kick"]


def test_scores_are_margins_and_costs_stay_within_the_threshold() -> None:
    result = transfer_labels(BLANK, FEATURES, KNOWLEDGE)
    rows = result.primitives
    named = rows.label != ""
    assert (rows.confidence[named] > 0).all()
    assert (rows.confidence[named] <= 1).all()
    costs = result.provenance["transfer"]["costs"]
    assert [cost is not None for cost in costs] == named.tolist()
    assert max(cost for cost in costs if cost is not None) <= 0.85
    assert f"{named.sum()} of " in result.provenance["notes"][-1]


def test_a_lower_threshold_only_takes_labels_away() -> None:
    before = None
    for threshold in (1.1, 0.85, 0.6, 0.3, 0.001):
        named = transfer_labels(BLANK, FEATURES, KNOWLEDGE, threshold=threshold).primitives
        if before is not None:
            assert not ((named.label != "") & (before == "")).any()
        before = named.label
    assert not (before != "").any()


def test_a_persons_labels_stay() -> None:
    first = int(np.flatnonzero(ASKED.truth.primitives.kind == "primitive")[0])
    row = int(np.flatnonzero(BLANK.table.level == "primitive")[first])
    labels = BLANK.table.label.astype("U9")
    labels[row] = "my word"
    own = replace(BLANK, table=replace(BLANK.table, label=labels))
    result = transfer_labels(own, FEATURES, KNOWLEDGE, spread=True)
    assert result.primitives.label[first] == "my word"


def test_spreading_names_the_rest_of_a_cluster() -> None:
    knowledge = KNOWLEDGE.select(KNOWLEDGE.labels != "kick")
    walk = ASKED.truth.primitives
    one = np.where(walk.label == "walk", 7, 8)
    table = BLANK.table
    cluster = table.cluster.copy()
    cluster[table.level == "primitive"] = one
    clustered = replace(BLANK, table=replace(table, cluster=cluster))
    strict = transfer_labels(clustered, FEATURES, knowledge, threshold=0.5)
    spread = transfer_labels(clustered, FEATURES, knowledge, threshold=0.5, spread=True)
    activity = walk.kind == "primitive"
    for number in (7, 8):
        members = activity & (one == number)
        votes = Counter(label for label in strict.primitives.label[members].tolist() if label)
        winner = votes.most_common(1)[0][0] if votes else ""
        assert set(spread.primitives.label[members].tolist()) == {winner}


def test_activities_are_labelled_where_there_are_no_primitives() -> None:
    table = BLANK.table.select(BLANK.table.level == "activity")
    result = transfer_labels(replace(BLANK, table=table), FEATURES, KNOWLEDGE)
    activities = [row.label for row in result.activities if row.kind == "activity"]
    assert activities == ["jump", "walk", "", "kick"]


def make_transition(motion: kineme.Motion) -> Segmentation:
    """Make the segmentation of a recording without activities."""
    return make_activities(motion.n_frames, fps=motion.fps, kind=["transition"])


def test_a_recording_too_short_for_activities_is_searched() -> None:
    kick = next(row for row in ASKED.truth.primitives if row.label == "kick")
    short = ASKED.motion[max(0, kick.start_frame - 12) : kick.stop_frame + 12]
    nothing = make_transition(short)
    result = transfer_labels(nothing, transfer_features(short), KNOWLEDGE)
    (found,) = [row for row in result.primitives if row.kind == "primitive"]
    assert found.label == "kick"
    assert abs(found.start_frame - 12) < 12
    assert [row.label for row in result.activities if row.kind == "activity"] == ["kick"]
    assert "1 of 1" in result.provenance["notes"][-1]
    other = KNOWLEDGE.select(KNOWLEDGE.labels == "walk")
    same = transfer_labels(nothing, transfer_features(short), other)
    assert same.table == nothing.table


def test_touching_matches_are_primitives_of_one_activity() -> None:
    walk = synthesize([Action("walk", 3)], fps=60, seed=9)
    nothing = make_transition(walk.motion)
    result = transfer_labels(nothing, transfer_features(walk.motion), KNOWLEDGE)
    assert [row.label for row in result.activities if row.kind == "activity"] == ["walk"]
    assert sum(row.label == "walk" for row in result.primitives) >= 2


def test_an_empty_knowledge_base_names_nothing() -> None:
    empty = KNOWLEDGE.select(np.zeros(len(KNOWLEDGE), bool))
    assert not transfer_labels(BLANK, FEATURES, empty).table.label.any()


def test_features_of_another_recording_are_refused() -> None:
    with pytest.raises(ParameterError, match="make them with transfer_features"):
        transfer_labels(BLANK, FEATURES[:10], KNOWLEDGE)


def test_primitives_are_called_as_most_of_their_frames() -> None:
    kinds = ["activity", "transition", "activity"]
    person = make_activities(50, 60, 100, fps=50, kind=kinds, label=["a", "", "b"])
    spans = [
        ("activity", 0, 100),
        *[("primitive", *span) for span in pairwise([0, 30, 51, 59, 100])],
    ]
    found = from_rows([(level, "activity", *span, -1, "") for level, *span in spans], fps=50)
    named = name_primitives(found, person)
    assert named.primitives.label.tolist() == ["a", "a", "", "b"]
    assert named.activities.label.tolist() == ["a"]
