"""Corrections by hand: results of edits, and invariants."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from typing import Any, get_args

import hypothesis.strategies as st
import numpy as np
import pytest
from hypothesis import given

import kineme
from kineme.errors import ParameterError
from kineme.segments import editing
from kineme.segments.segmentation import Segmentation
from kineme.segments.table import Kind
from segmentations import LABELS, from_rows, one_activity, segmentations

LEVELS = st.sampled_from(["activity", "primitive"])
FRAMES = st.integers(-1, 61)
EDITS = st.one_of(
    st.tuples(st.just(editing.move_border), LEVELS, FRAMES, FRAMES),
    st.tuples(st.just(editing.split), LEVELS, FRAMES),
    st.tuples(st.just(editing.merge), LEVELS, FRAMES, FRAMES),
    st.tuples(st.just(editing.delete_border), LEVELS, FRAMES),
    st.tuples(st.just(editing.name_segment), LEVELS, FRAMES, LABELS),
    st.tuples(st.just(editing.name_cluster), st.integers(-2, 6), LABELS),
    st.tuples(st.just(editing.set_cluster), LEVELS, FRAMES, st.integers(-2, 8)),
    st.tuples(st.just(editing.merge_clusters), st.integers(-1, 6), st.integers(-1, 6)),
    st.tuples(st.just(editing.set_kind), LEVELS, FRAMES, st.sampled_from(get_args(Kind))),
)


def walk_pause_jump() -> Segmentation:
    """Make three steps, a pause and two jumps: frames 0-30, 30-40, 40-60."""
    rows = [
        ("activity", "activity", 0, 30, 0, "walk"),
        ("activity", "transition", 30, 40, -1, ""),
        ("activity", "activity", 40, 60, 1, ""),
        ("primitive", "primitive", 0, 10, 0, "walk"),
        ("primitive", "primitive", 10, 20, 0, "limp"),
        ("primitive", "primitive", 20, 30, 0, "walk"),
        ("primitive", "transition", 30, 40, -1, ""),
        ("primitive", "primitive", 40, 50, 1, ""),
        ("primitive", "primitive", 50, 60, 1, ""),
    ]
    made = from_rows(rows, provenance={"notes": ["a"]})
    return replace(made, table=made.table.with_columns(confidence=np.full(len(rows), 0.5)))


def spans(segmentation: Segmentation, level: str) -> str:
    """Describe rows as ``0-30 c0 walk | 30-40 t | …``."""
    return " | ".join(
        " ".join(
            filter(
                None,
                [
                    f"{row.start_frame}-{row.stop_frame}",
                    "t" if row.kind == "transition" else "",
                    f"c{row.cluster}" if row.cluster >= 0 else "",
                    row.label,
                ],
            )
        )
        for row in segmentation.level(level)
    )


@given(segmentations(), st.lists(EDITS, min_size=1, max_size=6))
def test_whatever_is_edited_levels_tile_and_nothing_else_changes(
    before: Segmentation, edits: list[tuple[Callable[..., Segmentation], Any]]
) -> None:
    now = before
    for edit, *arguments in edits:
        try:
            now = edit(now, *arguments)  # a Segmentation checks tiles and parents itself
        except ParameterError as error:
            assert str(error)
    assert (now.n_frames, now.fps) == (before.n_frames, before.fps)
    assert now.provenance == before.provenance
    assert bool(len(now.primitives)) == bool(len(before.primitives))
    if len(now.primitives):
        assert set(now.cuts("activity").tolist()) <= set(now.cuts("primitive").tolist())


@given(segmentations(), LEVELS, st.data())
def test_a_border_moved_there_and_back_stands_where_it_stood(before, level, data) -> None:
    cuts = before.cuts(level).tolist()
    if not cuts:
        return
    frame = data.draw(st.sampled_from(cuts))
    edges = [0, *before.cuts("primitive").tolist(), *before.cuts("activity").tolist()]
    low = max(edge for edge in edges if edge < frame)
    high = min(edge for edge in [*edges, before.n_frames] if edge > frame)
    if high - low <= 2:
        return
    to = data.draw(st.integers(low + 1, high - 1))
    there = editing.move_border(before, level, frame, to)
    back = editing.move_border(there, level, to, frame)
    for name, column in before.table.columns().items():
        if name not in ("confidence", "border_confidence"):
            assert (getattr(back.table, name) == column).all(), name


@given(segmentations(), LEVELS, st.integers(1, 59))
def test_splitting_then_merging_gives_the_same_spans(before, level, frame) -> None:
    try:
        halves = editing.split(before, level, frame)
    except ParameterError:
        return
    row = next(r for r in before.level(level) if r.start_frame < frame < r.stop_frame)
    whole = editing.merge(halves, level, row.start_frame, row.stop_frame)
    columns = ("start_frame", "stop_frame", "kind", "cluster", "label")
    assert all(
        (getattr(whole.level(level), name) == getattr(before.level(level), name)).all()
        for name in columns
    )


@pytest.mark.parametrize(
    ("level", "frame", "to", "activities", "primitives"),
    [
        # A nudge takes the repetition's border along.
        ("activity", 30, 33, "0-33 c0 walk | 33-40 t | 40-60 c1",
         "0-10 c0 walk | 10-20 c0 limp | 20-33 c0 walk | 33-40 t | 40-50 c1 | 50-60 c1"),
        ("primitive", 30, 28, "0-28 c0 walk | 28-40 t | 40-60 c1",
         "0-10 c0 walk | 10-20 c0 limp | 20-28 c0 walk | 28-40 t | 40-50 c1 | 50-60 c1"),
        # A transition swallows what its border passes, and stays one primitive.
        ("activity", 30, 20, "0-20 c0 walk | 20-40 t | 40-60 c1",
         "0-10 c0 walk | 10-20 c0 limp | 20-40 t | 40-50 c1 | 50-60 c1"),
        ("activity", 30, 14, "0-14 c0 walk | 14-40 t | 40-60 c1",
         "0-10 c0 walk | 10-14 c0 limp | 14-40 t | 40-50 c1 | 50-60 c1"),
        # Inside an activity only the primitives move.
        ("primitive", 20, 15, "0-30 c0 walk | 30-40 t | 40-60 c1",
         "0-10 c0 walk | 10-15 c0 limp | 15-30 c0 walk | 30-40 t | 40-50 c1 | 50-60 c1"),
    ],
)  # fmt: skip
def test_moved_borders(level, frame, to, activities, primitives) -> None:
    moved = editing.move_border(walk_pause_jump(), level, frame, to)
    assert spans(moved, "activity") == activities
    assert spans(moved, "primitive") == primitives


def test_repetitions_go_to_the_activity_that_grows_over_them() -> None:
    touching = editing.delete_border(walk_pause_jump(), "activity", 40)  # 30-60 is the jump's
    assert spans(touching, "activity") == "0-30 c0 walk | 30-60 c1"
    assert spans(touching, "primitive").endswith("| 30-40 | 40-50 c1 | 50-60 c1")
    moved = editing.move_border(touching, "activity", 30, 8)
    assert spans(moved, "activity") == "0-8 c0 walk | 8-60 c1"
    assert spans(moved, "primitive") == (
        "0-8 c0 walk | 8-20 c1 limp | 20-30 c1 | 30-40 | 40-50 c1 | 50-60 c1"
    )
    assert moved.primitives.activity.tolist() == [0, 1, 1, 1, 1, 1]


def test_only_what_changed_loses_its_confidence() -> None:
    moved = editing.move_border(walk_pause_jump(), "primitive", 20, 15)
    assert np.flatnonzero(np.isnan(moved.primitives.confidence)).tolist() == [1, 2]
    assert not np.isnan(moved.activities.confidence).any()
    named = editing.name_segment(moved, "activity", 0, "go")
    assert not np.isnan(named.activities.confidence).any()


def test_merged_activities_are_what_the_first_is_and_keep_their_repetitions() -> None:
    merged = editing.merge(walk_pause_jump(), "activity", 0, 60)
    assert spans(merged, "activity") == "0-60 c0 walk"
    assert spans(merged, "primitive") == (
        "0-10 c0 walk | 10-20 c0 limp | 20-30 c0 walk | 30-40 | 40-50 c0 | 50-60 c0"
    )


def test_a_transition_that_grows_is_one_primitive() -> None:
    merged = editing.merge(walk_pause_jump(), "activity", 30, 60)
    assert spans(merged, "primitive").endswith("20-30 c0 walk | 30-60 t")
    made = editing.set_kind(walk_pause_jump(), "activity", 0, "transition")
    assert spans(made, "activity").startswith("0-30 t walk | ")
    assert spans(made, "primitive").startswith("0-30 t walk | 30-40 t | ")
    back = editing.set_kind(made, "activity", 0, "primitive")  # means the kind of its level
    assert spans(back, "activity").startswith("0-30 walk | 30-40 t | ")


def test_clusters_take_their_primitives_with_them() -> None:
    changed = editing.set_cluster(walk_pause_jump(), "activity", 30, 1)
    assert spans(changed, "activity") == "0-30 c0 walk | 30-40 c1 | 40-60 c1"
    assert spans(changed, "primitive").endswith("| 30-40 c1 | 40-50 c1 | 50-60 c1")
    assert changed.repetitions() == {0: 3, 1: 3}
    alone = editing.set_cluster(walk_pause_jump(), "primitive", 10, -1)
    assert spans(alone, "primitive").startswith("0-10 c0 walk | 10-20 limp | 20-30 c0 walk")
    new = editing.set_cluster(walk_pause_jump(), "activity", 40, 2)
    assert new.repetitions() == {0: 3, 2: 2}


def test_names() -> None:
    named = editing.name_cluster(walk_pause_jump(), 1, "<b>jump</b>")
    assert spans(named, "activity").endswith("40-60 c1 <b>jump</b>")
    assert spans(named, "primitive").endswith("40-50 c1 <b>jump</b> | 50-60 c1 <b>jump</b>")
    own = editing.name_segment(named, "primitive", 50, "hop")
    assert spans(own, "primitive").endswith("40-50 c1 <b>jump</b> | 50-60 c1 hop")
    assert editing.cluster_names(own) == {0: "walk", 1: "<b>jump</b>"}
    again = editing.name_cluster(own, 1, "leap")
    assert spans(again, "primitive").endswith("40-50 c1 leap | 50-60 c1 hop")
    called_by_its_cluster = editing.name_segment(again, "primitive", 50, "")
    assert spans(called_by_its_cluster, "primitive").endswith("50-60 c1 leap")
    nameless = editing.name_cluster(called_by_its_cluster, 1, "")
    assert spans(nameless, "primitive").endswith("40-50 c1 | 50-60 c1")


def test_naming_one_segment_names_no_cluster() -> None:
    one = editing.name_segment(walk_pause_jump(), "activity", 40, "hop")
    two = editing.name_segment(one, "primitive", 40, "hop")  # most of the cluster, singly
    assert editing.cluster_names(two) == {0: "walk"}
    named = editing.name_cluster(two, 1, "jump")
    assert spans(named, "activity").endswith("40-60 c1 hop")
    assert spans(named, "primitive").endswith("40-50 c1 hop | 50-60 c1 jump")


def test_clusters_are_merged_and_names_of_their_own_stay() -> None:
    merged = editing.merge_clusters(walk_pause_jump(), 0, 1)
    assert spans(merged, "activity") == "0-30 c1 walk | 30-40 t | 40-60 c1 walk"
    assert spans(merged, "primitive").startswith("0-10 c1 walk | 10-20 c1 limp | 20-30 c1 walk |")
    into_named = editing.merge_clusters(walk_pause_jump(), 1, 0)
    assert spans(into_named, "primitive").endswith("40-50 c0 walk | 50-60 c0 walk")
    assert editing.cluster_names(into_named) == {0: "walk"}


@pytest.mark.parametrize(
    ("edit", "arguments", "reason"),
    [
        (editing.move_border, ("activity", 31, 35), "no border .* the nearest is at 30"),
        (editing.move_border, ("activity", 30, 40), "can move to 1 to 39, not 40"),
        (editing.move_border, ("primitive", 20, 30), "can move to 11 to 29"),
        (editing.move_border, ("second", 20, 30), "level must be"),
        (editing.split, ("activity", 30), "choose a frame between two borders"),
        (editing.split, ("primitive", 60), "choose a frame between two borders"),
        (editing.merge, ("primitive", 0, 10), "two or more whole segments"),
        (editing.merge, ("primitive", 0, 15), "two or more whole segments"),
        (editing.merge, ("primitive", 20, 40), "one of activities"),
        (editing.delete_border, ("primitive", 30), "one of activities"),
        (editing.delete_border, ("activity", 0), "no border"),
        (editing.name_segment, ("activity", 5, "a"), "starts at frame 5"),
        (editing.name_segment, ("activity", 0, "a\nb"), "one line"),
        (editing.name_cluster, (7, "a"), "no segment is in cluster 7"),
        (editing.name_cluster, (-1, "a"), "no segment is in cluster -1"),
        (editing.name_cluster, (0, 5), "name of a cluster must be a text, not 5"),
        (editing.name_cluster, (0, None), "must be a text, not None"),
        (editing.name_cluster, ("0", "a"), "must be a whole number from -1, not '0'"),
        (editing.name_segment, ("activity", 0, 5), "name of a segment must be a text, not 5"),
        (editing.comment, ("activity", 0, None), "a comment must be a text, not None"),
        (editing.set_cluster, ("activity", 0, "1"), "must be a whole number from -1, not '1'"),
        (editing.merge_clusters, (0, 7), "no segment is in cluster 7"),
        (editing.merge_clusters, (1, 1), "cannot be merged with itself"),
        (editing.check, ("activity", [0, 5], True), "starts at frame 5"),
        (editing.set_cluster, ("activity", 0, 9), "the next new one is 2"),
        (editing.set_kind, ("activity", 0, "rest"), "kind must be"),
    ],
)
def test_refusals_say_what_to_do(edit, arguments, reason) -> None:
    with pytest.raises(ParameterError, match=reason):
        edit(walk_pause_jump(), *arguments)


@pytest.mark.parametrize(
    ("edit", "arguments"),
    [
        (editing.name_cluster, (1, "hop")),
        (editing.name_segment, ("activity", 40, "hop")),
        (editing.comment, ("activity", 0, "limps")),
        (editing.set_cluster, ("activity", 30, 2)),
        (editing.merge_clusters, (1, 0)),
    ],
)
def test_numbers_and_texts_of_numpy_can_be_saved(tmp_path, edit, arguments) -> None:
    """Such are those of ``np.unique(segments.activities.cluster)``."""
    edited = edit(walk_pause_jump(), *(np.array([value])[0] for value in arguments))
    kineme.write_segments(edited, tmp_path / "edited.json")
    expected = edit(walk_pause_jump(), *arguments)
    assert kineme.read_segments(tmp_path / "edited.json") == edited == expected


def test_a_table_without_primitives_can_be_edited() -> None:
    bare = one_activity(9, 10.0)
    halves = editing.move_border(editing.split(bare, "activity", 4), "activity", 4, 6)
    assert spans(halves, "activity") == "0-6 | 6-9"
    assert not len(halves.primitives)
    assert math.isnan(halves.activities.confidence[0])
    with pytest.raises(ParameterError, match="there is none"):
        editing.delete_border(bare, "primitive", 4)


def table() -> Segmentation:
    rows = [("activity", "activity", start, start + 20, 0, "") for start in (0, 20)]
    rows += [("primitive", "primitive", start, start + 10, 0, "") for start in (0, 10, 20, 30)]
    return editing.name_cluster(from_rows(rows, fps=10), 0, "walk")


def test_a_part_of_a_cluster_is_one_of_its_own() -> None:
    parted = editing.split_cluster(table(), 0, [20, 30])
    assert parted.primitives.cluster.tolist() == [0, 0, 1, 1]
    assert parted.activities.cluster.tolist() == [0, 1]
    assert editing.cluster_names(parted) == {0: "walk"}
    assert editing.split_cluster(table(), 0, [30]).activities.cluster.tolist() == [0, 0]
    with pytest.raises(ParameterError, match="not all"):
        editing.split_cluster(table(), 0, [0, 10, 20, 30])


def test_clusters_in_another_order_keep_their_names() -> None:
    parted = editing.split_cluster(table(), 0, [20, 30])
    turned = editing.order_clusters(parted, [1, 0])
    assert turned.primitives.cluster.tolist() == [1, 1, 0, 0]
    assert editing.cluster_names(turned) == {1: "walk"}
    assert editing.order_clusters(turned, [1, 0]) == parted
    with pytest.raises(ParameterError, match="each cluster once"):
        editing.order_clusters(parted, [0])
