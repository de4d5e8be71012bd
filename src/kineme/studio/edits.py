"""What each edit that a page may send does to a table."""

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
from kineme.web import requests as sent
from kineme.web.requests import Edit

BY_HAND: Mapping[type[Struct], Callable[..., Segmentation]] = {
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
"""Corrections; the fields of each are the arguments of its function, in this order."""


@dataclass(frozen=True)
class Outcome:
    """Table after an edit, and what to tell people.

    Where it is another table (``replaced``), the one before is kept.
    """

    table: Segmentation
    notes: list[str] = field(default_factory=list)
    replaced: bool = False


class Surroundings(Protocol):
    """Where an edit finds what it names."""

    def knowledge_base(self, name: str) -> Path:
        """Return the file of a knowledge base by its id."""

    def annotation(self, name: str) -> Path:
        """Return a label file by its id."""


def apply_edit(
    table: Segmentation,
    edit: Edit,
    loaded: LoadedRecording,
    files: Surroundings,
    version: Callable[[int], Segmentation],
) -> Outcome:
    """Return the table after an edit other than undo and redo; KinemeError where it cannot be made.

    ``version`` gives a table that was replaced, by its number.
    """
    if isinstance(edit, sent.Together):
        for one in edit.edits:
            table = _correct_table(table, one)
        return Outcome(table)
    if type(edit) in BY_HAND:
        after = _correct_table(table, edit)
        return Outcome(after, _describe_cluster_change(table, after, edit))
    if isinstance(edit, sent.SegmentAgain):
        keep = True if edit.keep is UNSET else edit.keep
        detail = DEFAULT_DETAIL if edit.detail is UNSET else edit.detail
        found = loaded.segment(edit.preset, edit.parameters, detail)
        result = editing.carry_corrections(table, found) if keep else None
        lost = [f"not taken over: {what}" for what in result.lost] if result else []
        after = result.segmentation if result else found
        return Outcome(after, [*found.provenance["notes"], *lost], replaced=True)
    if isinstance(edit, sent.Transfer):
        return _label_table(table, edit, loaded, files.knowledge_base(edit.knowledge_base))
    if isinstance(edit, sent.TakeLabels):
        path = files.annotation(edit.annotation)
        labels = read_labels(
            loaded.listed.called, path, n_frames=table.n_frames, fps=table.fps, clock=table.clock
        )
        return Outcome(labels, [f"the table is that of {path.name}"], replaced=True)
    if isinstance(edit, sent.Restore):
        return Outcome(version(edit.version), replaced=True)
    raise ParameterError(f"there is no edit {type(edit).__name__}")


def _correct_table(table: Segmentation, edit: Struct) -> Segmentation:
    """Return the table after a correction, which it counts; what a person made of it is marked."""
    fields = (getattr(edit, name) for name in edit.__struct_fields__)
    after = BY_HAND[type(edit)](table, *fields)
    if isinstance(edit, sent.Check | sent.Remark | sent.Exclude):
        return after
    after, count = mark_edited(table, after), table.annotation.corrections + 1
    return replace(after, annotation=replace(after.annotation, corrections=count))


def _describe_cluster_change(before: Segmentation, after: Segmentation, edit: Struct) -> list[str]:
    """How many segments a change of a cluster reached, and how many keep a name of their own."""
    if not isinstance(edit, sent.NameCluster | sent.MergeClusters):
        return []
    cluster = edit.cluster if isinstance(edit, sent.NameCluster) else edit.into
    name = editing.cluster_names(after).get(cluster, "")
    members = after.table.select(after.table.cluster == cluster)
    others = int((members.label != name).sum())
    named = (
        f"{len(members) - others} segments are called “{name}”"
        if name
        else (f"{len(members) - others} segments have no name")
    )
    more = f"{others} keep their own name" if others else ""
    moved = int((before.table.cluster == edit.cluster).sum())
    merged = isinstance(edit, sent.MergeClusters)
    joined = f"{moved} segments are in cluster {cluster} now" if merged else ""
    return ["; ".join(filter(None, [joined, named, more]))]


def _label_table(
    table: Segmentation, edit: sent.Transfer, loaded: LoadedRecording, path: Path
) -> Outcome:
    from kineme.transfer import THRESHOLD, KnowledgeBase

    threshold = THRESHOLD if edit.threshold is UNSET else edit.threshold
    spread = False if edit.spread is UNSET else edit.spread
    base = KnowledgeBase.load(path)
    named = loaded.labelled(table, base, threshold=threshold, spread=spread)
    return Outcome(named, [named.provenance["notes"][-1]], replaced=True)
