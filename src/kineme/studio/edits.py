"""What each edit that a page may send does to a table."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

from kineme.errors import ParameterError
from kineme.segments import editing
from kineme.segments.segmentation import Segmentation
from kineme.studio.takes import Take
from kineme.web.messages import Edit

BY_HAND: Mapping[str, tuple[Callable[..., Segmentation], tuple[str, ...]]] = {
    "move_border": (editing.move_border, ("level", "frame", "to")),
    "split": (editing.split, ("level", "frame")),
    "merge": (editing.merge, ("level", "start_frame", "stop_frame")),
    "delete_border": (editing.delete_border, ("level", "frame")),
    "name_segment": (editing.name_segment, ("level", "frame", "label")),
    "name_cluster": (editing.name_cluster, ("cluster", "label")),
    "set_cluster": (editing.set_cluster, ("level", "frame", "cluster")),
    "set_kind": (editing.set_kind, ("level", "frame", "to")),
}
Bases = Callable[[str], Path]


def edited(
    table: Segmentation, edit: Edit, take: Take, knowledge_base: Bases
) -> tuple[Segmentation, list[str]]:
    """The table after an edit (but undo and redo), and what to say about it.

    Parameters
    ----------
    take : the recording
    knowledge_base : the file of a knowledge base by its id

    Raises
    ------
    KinemeError : the edit cannot be made, and why
    """
    sent: dict[str, Any] = dict(edit)
    if edit["kind"] in BY_HAND:
        function, arguments = BY_HAND[edit["kind"]]
        return _counted(function(table, *(sent[name] for name in arguments))), []
    if edit["kind"] == "segment":
        found = take.segment(edit["preset"], edit["parameters"])
        return found, list(found.provenance["notes"])
    if edit["kind"] == "transfer":
        from kineme.transfer import THRESHOLD, KnowledgeBase

        base = KnowledgeBase.load(knowledge_base(edit["knowledge_base"]))
        threshold, spread = edit.get("threshold", THRESHOLD), edit.get("spread", False)
        named = take.labelled(table, base, threshold=threshold, spread=spread)
        return named, [named.provenance["notes"][-1]]
    raise ParameterError(f"there is no edit {edit['kind']!r}")


def _counted(table: Segmentation) -> Segmentation:
    """The table with one more correction in its provenance."""
    before = table.provenance.get("corrections")
    count = before + 1 if isinstance(before, int) else 1
    return replace(table, provenance={**table.provenance, "corrections": count})
