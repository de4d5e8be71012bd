"""What the pages send: edits of a table, and what to make of it or compare it with.

Fields are checked as they are decoded (`kineme.web.encoding.from_json`):
types strictly, texts and numbers within the limits below, no unknown fields.
"""

from __future__ import annotations

from typing import Annotated

from msgspec import UNSET, Meta, Struct, UnsetType

from kineme.segments.table import Kind, Level

LONGEST_TEXT = 500
"""Characters; nobody names a movement with more."""
LONGEST_COMMENT = 5000
LARGEST = 2**53
"""Whole numbers up to here are the same in the page and in Python."""

Text = Annotated[str, Meta(max_length=LONGEST_TEXT)]
Integer = Annotated[int, Meta(ge=-LARGEST, le=LARGEST)]
Number = Annotated[float, Meta(ge=-LARGEST, le=LARGEST)]


class Request(Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """What every request has in common."""


class EditBase(Request, frozen=True, kw_only=True, tag_field="kind"):
    """An edit; ``kind`` tells which."""


class MoveBorder(EditBase, frozen=True, kw_only=True, tag="move_border"):
    """The border at ``frame`` of a level goes to ``to``."""

    level: Level
    frame: Integer
    to: Integer


class Split(EditBase, frozen=True, kw_only=True, tag="split"):
    """A new border at ``frame``."""

    level: Level
    frame: Integer


class Merge(EditBase, frozen=True, kw_only=True, tag="merge"):
    """The segments of ``[start_frame, stop_frame)`` become one."""

    level: Level
    start_frame: Integer
    stop_frame: Integer


class DeleteBorder(EditBase, frozen=True, kw_only=True, tag="delete_border"):
    """The two segments that meet at ``frame`` become one, like the longer of them."""

    level: Level
    frame: Integer


class NameSegment(EditBase, frozen=True, kw_only=True, tag="name_segment"):
    """The segment that starts at ``frame`` gets a label; an empty one takes it away."""

    level: Level
    frame: Integer
    label: Text


class NameCluster(EditBase, frozen=True, kw_only=True, tag="name_cluster"):
    """All segments of a cluster, of both levels, get a label."""

    cluster: Integer
    label: Text


class SetCluster(EditBase, frozen=True, kw_only=True, tag="set_cluster"):
    """The segment that starts at ``frame`` joins a cluster; -1: none."""

    level: Level
    frame: Integer
    cluster: Integer


class SetKind(EditBase, frozen=True, kw_only=True, tag="set_kind"):
    """The segment that starts at ``frame`` is a transition and in no cluster, or none.

    ``to`` is ``transition``, or what its level says.
    """

    level: Level
    frame: Integer
    to: Kind


class SegmentAgain(EditBase, frozen=True, kw_only=True, tag="segment"):
    """The whole table anew, by a preset; with ``keep``, corrections and names are taken over.

    ``detail`` is 1 by default, less is coarser.
    """

    preset: Text
    parameters: dict[Text, Number]
    keep: bool | UnsetType = UNSET
    detail: Number | UnsetType = UNSET


class MergeClusters(EditBase, frozen=True, kw_only=True, tag="merge_clusters"):
    """The segments of a cluster are in another one, ``into``, from then on."""

    cluster: Integer
    into: Integer


class SplitCluster(EditBase, frozen=True, kw_only=True, tag="split_cluster"):
    """The primitives of a cluster that start at ``frames`` are a new cluster."""

    cluster: Integer
    frames: list[Integer]


class OrderClusters(EditBase, frozen=True, kw_only=True, tag="order_clusters"):
    """The clusters are numbered in this order."""

    order: list[Integer]


class Remark(EditBase, frozen=True, kw_only=True, tag="comment"):
    """The segment that starts at ``frame`` has a comment; an empty one takes it away."""

    level: Level
    frame: Integer
    text: Annotated[str, Meta(max_length=LONGEST_COMMENT)]


class Check(EditBase, frozen=True, kw_only=True, tag="check"):
    """The segments that start at ``frames`` are checked, or not any more."""

    level: Level
    frames: list[Integer]
    checked: bool


class Exclude(EditBase, frozen=True, kw_only=True, tag="exclude"):
    """The primitives that start at ``frames`` count in no mean, or do so again."""

    frames: list[Integer]
    excluded: bool


class TakeLabels(EditBase, frozen=True, kw_only=True, tag="take_labels"):
    """What a label file of the folder says becomes the table."""

    annotation: Text


class Restore(EditBase, frozen=True, kw_only=True, tag="restore"):
    """A table that was replaced is the present one again."""

    version: Integer


class Transfer(EditBase, frozen=True, kw_only=True, tag="transfer"):
    """Labels from a knowledge base of the folder."""

    knowledge_base: Text
    threshold: Number | UnsetType = UNSET
    spread: bool | UnsetType = UNSET


class Undo(EditBase, frozen=True, kw_only=True, tag="undo"):
    """The last edit is taken back."""


class Redo(EditBase, frozen=True, kw_only=True, tag="redo"):
    """The last edit taken back is done again."""


ByHand = (
    MoveBorder
    | Split
    | Merge
    | DeleteBorder
    | NameSegment
    | NameCluster
    | SetCluster
    | SetKind
    | MergeClusters
    | SplitCluster
    | OrderClusters
    | Remark
    | Check
    | Exclude
)


class Together(EditBase, frozen=True, kw_only=True, tag="together"):
    """Several edits, one after the other, which are one step of undo; all of them or none."""

    edits: list[ByHand]


Edit = ByHand | Together | SegmentAgain | TakeLabels | Transfer | Restore | Undo | Redo


class EditRequest(Request, frozen=True, kw_only=True):
    """An edit of the table as it was at ``revision``.

    ``name`` is the edit's own: one that is sent again, for want of an answer, is made once. With
    ``brief`` the answer has only the rows that differ from those at ``revision``.
    """

    revision: Integer
    edit: Edit
    name: Text | UnsetType = UNSET
    brief: bool | UnsetType = UNSET


class PreviewRequest(Request, frozen=True, kw_only=True):
    """A segmentation to look at, as ``SegmentAgain`` would make it."""

    preset: Text
    parameters: dict[Text, Number]
    keep: bool
    detail: Number | UnsetType = UNSET


class LabelsRequest(Request, frozen=True, kw_only=True):
    """The labels that all recordings of the folder share, those on the keys 1 to 9 first."""

    labels: list[Text]


class KnowledgeRequest(Request, frozen=True, kw_only=True):
    """A knowledge base of that name, of the named primitives of recordings."""

    name: Text
    recordings: list[Text]


class ClipsRequest(Request, frozen=True, kw_only=True):
    """Segments by their rows in the table, as motion files; with ``loops`` made to close."""

    rows: list[Integer]
    loops: bool


class VideoRequest(Request, frozen=True, kw_only=True):
    """Where the recording starts in its reference video, seconds."""

    offset_s: Number


class ReadingRequest(Request, frozen=True, kw_only=True):
    """How a recording is read; empty: as the file says.

    Of several people in it ``person`` is to be shown, or ``everybody``.
    """

    person: Text = ""
    everybody: bool = False
    take: Text = ""
    fps: Number = 0
    unit: Text = ""
    up: Text = ""


class CompareRequest(Request, frozen=True, kw_only=True):
    """Another result to lay beside the shown one: a preset's, or a file's of the folder."""

    preset: Text | UnsetType = UNSET
    annotation: Text | UnsetType = UNSET
