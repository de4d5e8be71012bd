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
    """Move the border at ``frame`` of a level to ``to``."""

    level: Level
    frame: Integer
    to: Integer


class Split(EditBase, frozen=True, kw_only=True, tag="split"):
    """A new border at ``frame``."""

    level: Level
    frame: Integer


class Merge(EditBase, frozen=True, kw_only=True, tag="merge"):
    """Make the segments of ``[start_frame, stop_frame)`` one."""

    level: Level
    start_frame: Integer
    stop_frame: Integer


class DeleteBorder(EditBase, frozen=True, kw_only=True, tag="delete_border"):
    """Make the two segments that meet at ``frame`` one, like the longer of them."""

    level: Level
    frame: Integer


class NameSegment(EditBase, frozen=True, kw_only=True, tag="name_segment"):
    """Label the segment that starts at ``frame``; an empty label removes it."""

    level: Level
    frame: Integer
    label: Text


class NameCluster(EditBase, frozen=True, kw_only=True, tag="name_cluster"):
    """All segments of a cluster, of both levels, get a label."""

    cluster: Integer
    label: Text


class SetCluster(EditBase, frozen=True, kw_only=True, tag="set_cluster"):
    """Put the segment that starts at ``frame`` into a cluster; -1: into none."""

    level: Level
    frame: Integer
    cluster: Integer


class SetKind(EditBase, frozen=True, kw_only=True, tag="set_kind"):
    """Make the segment that starts at ``frame`` a transition in no cluster, or no transition.

    ``to`` is ``transition``, or what its level says.
    """

    level: Level
    frame: Integer
    to: Kind


class SegmentAgain(EditBase, frozen=True, kw_only=True, tag="segment"):
    """Segment the recording again by a preset; ``keep`` takes over corrections and names.

    ``detail`` is 1 by default, less is coarser.
    """

    preset: Text
    parameters: dict[Text, Number]
    keep: bool | UnsetType = UNSET
    detail: Number | UnsetType = UNSET


class MergeClusters(EditBase, frozen=True, kw_only=True, tag="merge_clusters"):
    """Move the segments of a cluster into another one, ``into``."""

    cluster: Integer
    into: Integer


class SplitCluster(EditBase, frozen=True, kw_only=True, tag="split_cluster"):
    """Move the primitives of a cluster that start at ``frames`` into a new cluster."""

    cluster: Integer
    frames: list[Integer]


class OrderClusters(EditBase, frozen=True, kw_only=True, tag="order_clusters"):
    """Number the clusters in this order."""

    order: list[Integer]


class Remark(EditBase, frozen=True, kw_only=True, tag="comment"):
    """Comment the segment that starts at ``frame``; an empty comment removes it."""

    level: Level
    frame: Integer
    text: Annotated[str, Meta(max_length=LONGEST_COMMENT)]


class Check(EditBase, frozen=True, kw_only=True, tag="check"):
    """Mark the segments that start at ``frames`` as checked, or no longer."""

    level: Level
    frames: list[Integer]
    checked: bool


class Exclude(EditBase, frozen=True, kw_only=True, tag="exclude"):
    """Leave the primitives that start at ``frames`` out of all means, or count them again."""

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
    """Undo the last edit."""


class Redo(EditBase, frozen=True, kw_only=True, tag="redo"):
    """Redo the last edit that was undone."""


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

    ``name`` is the edit's own: one that is sent again, for want of an answer, is made once.
    """

    revision: Integer
    edit: Edit
    name: Text | UnsetType = UNSET


class PreviewRequest(Request, frozen=True, kw_only=True):
    """A segmentation to look at, as ``SegmentAgain`` would make it."""

    preset: Text
    parameters: dict[Text, Number]
    keep: bool
    detail: Number | UnsetType = UNSET


class LabelsRequest(Request, frozen=True, kw_only=True):
    """Labels that all recordings of the folder share, those on the keys 1 to 9 first."""

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


class PosesRequest(Request, frozen=True, kw_only=True):
    """Videos whose poses are to be estimated."""

    recordings: list[Text]


class ReadRequest(Request, frozen=True, kw_only=True):
    """How a recording is read: what is to be other than the file says, by its name.

    The names are those of `kineme.formats.ReadOptions`. ``everybody`` shows all people in it.
    """

    options: dict[Text, Text | Number | bool | list[Text]]
    everybody: bool = False


class CompareRequest(Request, frozen=True, kw_only=True):
    """Another result to lay beside the shown one: a preset's, or a file's of the folder."""

    preset: Text | UnsetType = UNSET
    annotation: Text | UnsetType = UNSET
