"""The labels that the recordings of a folder share: those on the keys 1 to 9.

They lie in ``.kineme/labels.json`` of the folder, a list of texts.
"""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path

from kineme.studio.kept.records import FOLDER, write_file

FILE = "labels.json"


def shared_labels(root: Path) -> list[str]:
    """The labels of a folder; none where nobody chose any."""
    try:
        said = json.loads((root / FOLDER / FILE).read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return []
    return [label for label in said if isinstance(label, str)] if isinstance(said, list) else []


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
