"""Messages that pages send: edits of a table, and requests for segmentations and comparisons.

Messages are validated when they are decoded (`kineme.web.encoding.from_json`): strict types, limits
for texts and numbers, no unknown fields.
"""

from __future__ import annotations

from typing import Annotated

from msgspec import UNSET, Meta, Struct, UnsetType

from kineme.segments.table import Kind, Level

LONGEST_TEXT = 500
"""Characters of a name or label."""
LONGEST_COMMENT = 5000
"""Characters of a comment."""
LARGEST = 2**53
"""Integers up to this are exact in JavaScript."""

Text = Annotated[str, Meta(max_length=LONGEST_TEXT)]
Integer = Annotated[int, Meta(ge=-LARGEST, le=LARGEST)]
Number = Annotated[float, Meta(ge=-LARGEST, le=LARGEST)]


class Request(Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Base of all requests."""


class EditBase(Request, frozen=True, kw_only=True, tag_field="kind"):
    """Base of all edits; ``kind`` tells which edit it is."""


class MoveBorder(EditBase, frozen=True, kw_only=True, tag="move_border"):
    """Move the border at ``frame`` of a level to ``to``."""

    level: Level
    frame: Integer
    to: Integer


class Split(EditBase, frozen=True, kw_only=True, tag="split"):
    """Insert a border at ``frame``."""

    level: Level
    frame: Integer


class Merge(EditBase, frozen=True, kw_only=True, tag="merge"):
    """Merge the segments in ``[start_frame, stop_frame)``."""

    level: Level
    start_frame: Integer
    stop_frame: Integer


class DeleteBorder(EditBase, frozen=True, kw_only=True, tag="delete_border"):
    """Merge the two segments that meet at ``frame``; the longer one sets label and cluster."""

    level: Level
    frame: Integer


class NameSegment(EditBase, frozen=True, kw_only=True, tag="name_segment"):
    """Label the segment that starts at ``frame``; an empty label removes it."""

    level: Level
    frame: Integer
    label: Text


class NameCluster(EditBase, frozen=True, kw_only=True, tag="name_cluster"):
    """Label all segments of a cluster, on both levels."""

    cluster: Integer
    label: Text


class SetCluster(EditBase, frozen=True, kw_only=True, tag="set_cluster"):
    """Move the segment that starts at ``frame`` to a cluster; -1 means none."""

    level: Level
    frame: Integer
    cluster: Integer


class SetKind(EditBase, frozen=True, kw_only=True, tag="set_kind"):
    """Turn the segment that starts at ``frame`` into a transition without cluster, or back.

    ``to`` is ``transition`` or the name of the level.
    """

    level: Level
    frame: Integer
    to: Kind


class SegmentAgain(EditBase, frozen=True, kw_only=True, tag="segment"):
    """Segment the recording again by a preset; ``keep`` transfers corrections and names.

    ``detail`` is 1 by default; lower is coarser.
    """

    preset: Text
    parameters: dict[Text, Number]
    keep: bool | UnsetType = UNSET
    detail: Number | UnsetType = UNSET


class MergeClusters(EditBase, frozen=True, kw_only=True, tag="merge_clusters"):
    """Move all segments of a cluster to the cluster ``into``."""

    cluster: Integer
    into: Integer


class SplitCluster(EditBase, frozen=True, kw_only=True, tag="split_cluster"):
    """Move the primitives that start at ``frames`` from their cluster to a new one."""

    cluster: Integer
    frames: list[Integer]


class OrderClusters(EditBase, frozen=True, kw_only=True, tag="order_clusters"):
    """Renumber the clusters in this order."""

    order: list[Integer]


class Remark(EditBase, frozen=True, kw_only=True, tag="comment"):
    """Comment on the segment that starts at ``frame``; an empty comment removes it."""

    level: Level
    frame: Integer
    text: Annotated[str, Meta(max_length=LONGEST_COMMENT)]


class Check(EditBase, frozen=True, kw_only=True, tag="check"):
    """Mark the segments that start at ``frames`` as checked or unchecked."""

    level: Level
    frames: list[Integer]
    checked: bool


class Exclude(EditBase, frozen=True, kw_only=True, tag="exclude"):
    """Exclude the primitives that start at ``frames`` from all means, or include them again."""

    frames: list[Integer]
    excluded: bool


class TakeLabels(EditBase, frozen=True, kw_only=True, tag="take_labels"):
    """Replace the table by a label file of the folder."""

    annotation: Text


class Restore(EditBase, frozen=True, kw_only=True, tag="restore"):
    """Restore a table that was replaced."""

    version: Integer


class Transfer(EditBase, frozen=True, kw_only=True, tag="transfer"):
    """Label segments from a knowledge base of the folder."""

    knowledge_base: Text
    threshold: Number | UnsetType = UNSET
    spread: bool | UnsetType = UNSET


class Undo(EditBase, frozen=True, kw_only=True, tag="undo"):
    """Undo the last edit."""


class Redo(EditBase, frozen=True, kw_only=True, tag="redo"):
    """Redo the edit that was undone last."""


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
    """Apply several edits as one undo step; all or none."""

    edits: list[ByHand]


Edit = ByHand | Together | SegmentAgain | TakeLabels | Transfer | Restore | Undo | Redo


class EditRequest(Request, frozen=True, kw_only=True):
    """An edit of the table with this revision.

    ``name`` identifies the edit: if it is sent again, because no answer arrived, it is applied
    once.
    """

    revision: Integer
    edit: Edit
    name: Text | UnsetType = UNSET


class PreviewRequest(Request, frozen=True, kw_only=True):
    """Preview the result of ``SegmentAgain``."""

    preset: Text
    parameters: dict[Text, Number]
    keep: bool
    detail: Number | UnsetType = UNSET


class LabelsRequest(Request, frozen=True, kw_only=True):
    """Labels that all recordings of the folder share; the first nine are on the keys 1 to 9."""

    labels: list[Text]


class KnowledgeRequest(Request, frozen=True, kw_only=True):
    """Create a knowledge base with this name from the named primitives of recordings."""

    name: Text
    recordings: list[Text]


class ClipsRequest(Request, frozen=True, kw_only=True):
    """Export these rows of the table as motion files; with ``loops`` their ends are blended."""

    rows: list[Integer]
    loops: bool


class VideoRequest(Request, frozen=True, kw_only=True):
    """Time in the reference video at which the recording starts, in seconds."""

    offset_s: Number


class PosesRequest(Request, frozen=True, kw_only=True):
    """Videos whose poses are to be estimated."""

    recordings: list[Text]


class ReadRequest(Request, frozen=True, kw_only=True):
    """Reading options of a recording by name; they replace what the file states.

    The names are those of `kineme.formats.ReadOptions`. ``everybody`` opens all people in the file.
    """

    options: dict[Text, Text | Number | bool | list[Text]]
    everybody: bool = False


class CompareRequest(Request, frozen=True, kw_only=True):
    """Compare with another result: that of a preset, or a label file of the folder."""

    preset: Text | UnsetType = UNSET
    annotation: Text | UnsetType = UNSET
