"""The labels that the recordings of a folder share: those on the keys 1 to 9.

They lie in ``.kineme/labels.json`` of the folder, a list of texts.
"""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path

from kineme.studio.kept.records import FOLDER, kept_beside, write_file

FILE = "labels.json"


def shared_labels(root: Path) -> list[str]:
    """The labels of a folder; none where nobody chose any."""
    return _read(root)[0]


def notes_on_labels(root: Path) -> list[str]:
    """That the labels of a folder cannot be read, where they cannot."""
    return _read(root)[1]


def _read(root: Path) -> tuple[list[str], list[str]]:
    return kept_beside(root / FOLDER / FILE, list[str], [])


def share_labels(root: Path, labels: Sequence[str]) -> list[str]:
    """Keep these labels, each once, for the folder.

    Raises
    ------
    WriteError
        They cannot be written.
    """
    kept = list(dict.fromkeys(label.strip() for label in labels if label.strip()))
    write_file(root / FOLDER / FILE, json.dumps(kept, ensure_ascii=False, indent=1).encode())
    return kept
