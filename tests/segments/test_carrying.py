"""Corrections that are carried over to a new segmentation."""

from __future__ import annotations

from dataclasses import replace

import hypothesis.strategies as st
import numpy as np
from hypothesis import given
from test_editing import EDITS, spans, walk_pause_jump

from kineme.errors import ParameterError
from kineme.segments import editing
from kineme.segments.editing.annotating import find_marked, get_span, mark_edited
from kineme.segments.segmentation import Segmentation
from segmentations import from_rows, segmentations


def by_hand(segmentation: Segmentation, edit: str, *arguments: object) -> Segmentation:
    return mark_edited(segmentation, getattr(editing, edit)(segmentation, *arguments))


def other_way() -> Segmentation:
    """Return the same minute with other cuts and reversed cluster numbers."""
    rows = [
        ("activity", "activity", 0, 33, 1, ""),
        ("activity", "transition", 33, 38, -1, ""),
        ("activity", "activity", 38, 60, 0, ""),
        ("primitive", "primitive", 0, 11, 1, ""),
        ("primitive", "primitive", 11, 22, 1, ""),
        ("primitive", "primitive", 22, 33, 1, ""),
        ("primitive", "transition", 33, 38, -1, ""),
        ("primitive", "primitive", 38, 60, 0, ""),
    ]
    return from_rows(rows)


def test_numbers_and_names_go_to_the_clusters_and_segments_that_match() -> None:
    before = editing.name_cluster(walk_pause_jump(), 1, "jump")
    result = editing.carry_corrections(before, other_way())
    assert spans(result.segmentation, "activity") == "0-33 c0 walk | 33-38 t | 38-60 c1 jump"
    assert spans(result.segmentation, "primitive") == (
        "0-11 c0 walk | 11-22 c0 limp | 22-33 c0 walk | 33-38 t | 38-60 c1 jump"
    )
    assert (result.corrections, result.names, result.lost) == (0, 3, [])


def test_names_that_match_nothing_are_listed() -> None:
    before = editing.name_segment(walk_pause_jump(), "primitive", 50, "hop")
    result = editing.carry_corrections(before, other_way())  # no half of 38-60 is 50-60
    assert result.lost == ["the name “hop” of the primitive at 1.67 s: no segment matches it"]


def test_what_was_made_by_hand_stays_as_it_was_made() -> None:
    before = by_hand(walk_pause_jump(), "move_border", "activity", 30, 28)
    result = editing.carry_corrections(before, other_way())
    assert spans(result.segmentation, "activity") == "0-28 c0 walk | 28-40 t | 40-60 c1"
    assert spans(result.segmentation, "primitive") == (
        "0-11 c0 walk | 11-20 c0 limp | 20-28 c0 walk | 28-40 t | 40-60 c1"
    )
    assert result.corrections == 4
    assert find_marked(result.segmentation, "by_hand") == find_marked(before, "by_hand")
    again = editing.carry_corrections(result.segmentation, walk_pause_jump())
    assert again.corrections == 4
    assert spans(again.segmentation, "activity").startswith("0-28 c0 walk | 28-40 t | ")


def test_a_cluster_given_by_hand_is_kept_though_none_matches() -> None:
    before = by_hand(walk_pause_jump(), "set_cluster", "primitive", 10, 2)
    result = editing.carry_corrections(before, other_way())
    assert "10-20 c2 limp" in spans(result.segmentation, "primitive")


def test_what_is_left_beside_a_checked_primitive_stays_in_its_activity() -> None:
    rows = [(level, "activity", start, start + 30, -1, "")
            for level in ("activity", "primitive") for start in (0, 30)]  # fmt: skip
    found = from_rows(rows)
    before = editing.split(editing.split(found, "primitive", 12), "primitive", 29)
    checked = editing.check(before, "primitive", [12], True)
    result = editing.carry_corrections(checked, found)
    assert spans(result.segmentation, "primitive") == "0-12 | 12-29 | 29-30 | 30-60"


@given(segmentations(), st.data())
def test_checked_segments_are_never_changed(before, data) -> None:
    found = data.draw(segmentations(like=before))
    chosen = data.draw(st.sets(st.integers(0, len(before) - 1), max_size=6))
    for i in chosen:
        row = before.table[i]
        before = editing.check(before, row.level, [row.start_frame], True)
    result = editing.carry_corrections(before, found)
    there = {get_span(row): row.kind for row in result.segmentation}
    for i in chosen:
        row = before.table[i]
        if row.level == "activity" or len(found.primitives):
            assert there[get_span(row)] == row.kind
    own = editing.cluster_names(before)
    assert result.names == len(own) + sum(
        row.label not in ("", own.get(row.cluster, "")) for row in before
    )


@given(segmentations(), st.lists(EDITS, min_size=1, max_size=6))
def test_carrying_over_to_the_same_segments_changes_none(before, edits) -> None:
    # Transitions of the methods and of edits: in no cluster, with one primitive of this kind.
    table, inner = before.table, before.primitives
    counts = np.bincount(inner.activity, 1 + (inner.kind != "transition"), len(before.activities))
    is_whole = np.append(counts <= 1, np.full(len(inner), True))
    kinds = np.where(is_whole, table.kind, "activity")
    clusters = np.where(kinds == "transition", -1, table.cluster)
    now = replace(before, table=table.with_columns(kind=kinds, cluster=clusters))
    for edit, *arguments in edits:
        try:
            now = mark_edited(now, edit(now, *arguments))
        except ParameterError:
            continue
    result = editing.carry_corrections(now, now)
    assert result.lost == []
    for name in ("level", "kind", "start_frame", "stop_frame", "cluster"):
        assert (getattr(result.segmentation.table, name) == getattr(now.table, name)).all()


def test_a_mark_holds_for_the_frames_that_it_was_made_for() -> None:
    checked = editing.check(walk_pause_jump(), "primitive", [0, 10], True)
    assert find_marked(checked, "checked") == {("primitive", 0, 10), ("primitive", 10, 20)}
    moved = editing.move_border(checked, "primitive", 20, 18)
    assert find_marked(moved, "checked") == {("primitive", 0, 10)}
    assert find_marked(editing.check(checked, "primitive", [0], False), "checked") == {
        ("primitive", 10, 20)
    }
