"""What each edit that a page may send does to a table."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from pathlib import Path

from msgspec import UNSET, Struct

from kineme.errors import ParameterError
from kineme.segments import editing
from kineme.segments.segmentation import Segmentation
from kineme.studio.loading import LoadedRecording
from kineme.web import requests
from kineme.web.requests import Edit

BY_HAND: Mapping[type[Struct], Callable[..., Segmentation]] = {
    requests.MoveBorder: editing.move_border,
    requests.Split: editing.split,
    requests.Merge: editing.merge,
    requests.DeleteBorder: editing.delete_border,
    requests.NameSegment: editing.name_segment,
    requests.NameCluster: editing.name_cluster,
    requests.SetCluster: editing.set_cluster,
    requests.SetKind: editing.set_kind,
}
"""Corrections; the fields of each are the arguments of its function, in this order."""


def edited(
    table: Segmentation,
    edit: Edit,
    loaded: LoadedRecording,
    knowledge_base: Callable[[str], Path],
) -> tuple[Segmentation, list[str]]:
    """The table after an edit other than undo and redo.

    Parameters
    ----------
    table : Segmentation
    edit : Edit
    loaded : LoadedRecording
        What the table is of.
    knowledge_base : callable
        The file of a knowledge base by its id.

    Returns
    -------
    table : Segmentation
    notes : list of str
        What to tell people.

    Raises
    ------
    KinemeError
        The edit cannot be made, and why.
    """
    if type(edit) in BY_HAND:
        fields = (getattr(edit, name) for name in edit.__struct_fields__)
        return _counted(BY_HAND[type(edit)](table, *fields)), []
    if isinstance(edit, requests.SegmentAgain):
        found = loaded.segment(edit.preset, edit.parameters)
        return found, list(found.provenance["notes"])
    if isinstance(edit, requests.Transfer):
        return _labelled(table, edit, loaded, knowledge_base(edit.knowledge_base))
    raise ParameterError(f"there is no edit {type(edit).__name__}")


def _labelled(
    table: Segmentation, edit: requests.Transfer, loaded: LoadedRecording, path: Path
) -> tuple[Segmentation, list[str]]:
    from kineme.transfer import THRESHOLD, KnowledgeBase

    threshold = THRESHOLD if edit.threshold is UNSET else edit.threshold
    spread = False if edit.spread is UNSET else edit.spread
    base = KnowledgeBase.load(path)
    named = loaded.labelled(table, base, threshold=threshold, spread=spread)
    return named, [named.provenance["notes"][-1]]


def _counted(table: Segmentation) -> Segmentation:
    """The table with one more correction in its provenance."""
    before = table.provenance.get("corrections")
    count = before + 1 if isinstance(before, int) else 1
    return replace(table, provenance={**table.provenance, "corrections": count})
