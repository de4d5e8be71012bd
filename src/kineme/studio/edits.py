"""Apply the edits that a page may send to a table."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Protocol

from msgspec import UNSET, Struct

from kineme.errors import ParameterError
from kineme.labels.collections import read_labels
from kineme.segments import editing
from kineme.segments.editing.annotating import mark_edited
from kineme.segments.hierarchy import DEFAULT_DETAIL
from kineme.segments.segmentation import Segmentation
from kineme.studio.loading import LoadedRecording
from kineme.studio.storage.sidecars import ListedRecording
from kineme.web import requests as sent
from kineme.web.requests import Edit

CORRECTIONS: Mapping[type[Struct], Callable[..., Segmentation]] = {
    sent.MoveBorder: editing.move_border,
    sent.Split: editing.split,
    sent.Merge: editing.merge,
    sent.DeleteBorder: editing.delete_border,
    sent.NameSegment: editing.name_segment,
    sent.NameCluster: editing.name_cluster,
    sent.SetCluster: editing.set_cluster,
    sent.SetKind: editing.set_kind,
    sent.MergeClusters: editing.merge_clusters,
    sent.SplitCluster: editing.split_cluster,
    sent.OrderClusters: editing.order_clusters,
    sent.Remark: editing.comment,
    sent.Check: editing.check,
    sent.Exclude: editing.exclude,
}
"""Function of each correction; its arguments are the fields of the message, in order."""


@dataclass(frozen=True)
class Outcome:
    """Table after an edit, and messages to the user.

    ``replaced`` is True if the edit made a new table; the old one is then kept as a version.
    """

    table: Segmentation
    notes: list[str] = field(default_factory=list)
    replaced: bool = False


class FileLookup(Protocol):
    """Source of the files that an edit names."""

    def knowledge_base(self, name: str) -> Path:
        """Return the file of a knowledge base by its id."""

    def annotation(self, name: str) -> Path:
        """Return a label file by its id."""


def apply_edit(
    table: Segmentation,
    edit: Edit,
    loaded: LoadedRecording,
    files: FileLookup,
    version: Callable[[int], Segmentation],
) -> Outcome:
    """Return the table after an edit other than undo and redo; KinemeError if it cannot be applied.

    ``version`` returns a replaced table by its number.
    """
    if isinstance(edit, sent.Together):
        for one in edit.edits:
            table = _correct_table(table, one)
        return Outcome(table)
    if type(edit) in CORRECTIONS:
        after = _correct_table(table, edit)
        return Outcome(after, _describe_cluster_change(table, after, edit))
    if isinstance(edit, sent.SegmentAgain):
        keep = True if edit.keep is UNSET else edit.keep
        detail = DEFAULT_DETAIL if edit.detail is UNSET else edit.detail
        segments = loaded.segment(edit.preset, edit.parameters, detail)
        carried = editing.carry_corrections(table, segments) if keep else None
        lost = [f"not taken over: {what}" for what in carried.lost] if carried else []
        after = carried.segmentation if carried else segments
        return Outcome(after, [*segments.provenance["notes"], *lost], replaced=True)
    if isinstance(edit, sent.Transfer):
        return _label_table(table, edit, loaded, files.knowledge_base(edit.knowledge_base))
    if isinstance(edit, sent.TakeLabels):
        path = files.annotation(edit.annotation)
        labels = read_table(loaded.listed, path, table)
        return Outcome(labels, [f"the table was taken from {path.name}"], replaced=True)
    if isinstance(edit, sent.Restore):
        return Outcome(version(edit.version), replaced=True)
    raise ParameterError(f"there is no edit {type(edit).__name__}")


def read_table(listed: ListedRecording, path: Path, like: Segmentation) -> Segmentation:
    """Return the labels of a recording in a file, as a table of the same length as ``like``."""
    return read_labels(
        listed.person_path, path, n_frames=like.n_frames, fps=like.fps, clock=like.clock
    )


def _correct_table(table: Segmentation, edit: Struct) -> Segmentation:
    """Apply a correction: count it and mark the rows that changed as edited."""
    fields = (getattr(edit, name) for name in edit.__struct_fields__)
    after = CORRECTIONS[type(edit)](table, *fields)
    if isinstance(edit, sent.Check | sent.Remark | sent.Exclude):
        return after
    after, count = mark_edited(table, after), table.annotation.corrections + 1
    return replace(after, annotation=replace(after.annotation, corrections=count))


def _describe_cluster_change(before: Segmentation, after: Segmentation, edit: Struct) -> list[str]:
    """Return how many segments a change of a cluster affected, and how many keep their own name."""
    if not isinstance(edit, sent.NameCluster | sent.MergeClusters):
        return []
    cluster = edit.cluster if isinstance(edit, sent.NameCluster) else edit.into
    name = editing.cluster_names(after).get(cluster, "")
    members = after.table.select(after.table.cluster == cluster)
    n_others = int((members.label != name).sum())
    n_named = len(members) - n_others
    name_note = f"{n_named} segments " + (f"are called “{name}”" if name else "have no name")
    others_note = f"{n_others} keep their own name" if n_others else ""
    n_moved = int((before.table.cluster == edit.cluster).sum())
    merged = isinstance(edit, sent.MergeClusters)
    merge_note = f"{n_moved} segments are in cluster {cluster} now" if merged else ""
    return ["; ".join(filter(None, [merge_note, name_note, others_note]))]


def _label_table(
    table: Segmentation, edit: sent.Transfer, loaded: LoadedRecording, path: Path
) -> Outcome:
    from kineme.transfer import THRESHOLD, KnowledgeBase, transfer_features, transfer_labels

    threshold = THRESHOLD if edit.threshold is UNSET else edit.threshold
    spread = False if edit.spread is UNSET else edit.spread
    base = KnowledgeBase.load(path)
    features = transfer_features(loaded.motion, effectors=loaded.effectors)
    labelled = transfer_labels(table, features, base, threshold=threshold, spread=spread)
    return Outcome(labelled, [labelled.provenance["notes"][-1]], replaced=True)
