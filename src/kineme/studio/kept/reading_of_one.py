"""How one recording of a folder is read, where people said so on the page.

It is kept in ``.kineme/walk.bvh.reading.json``, and counts before what the studio was started with.
"""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path
from typing import Any

from kineme.errors import KinemeError
from kineme.formats import ReadOptions
from kineme.studio.kept.records import FOLDER, write_file

ASKED = ("person", "fps", "unit", "up")
"""Of the options, those that the page asks for."""


def said_of(recording: Path) -> dict[str, Any]:
    """What people said of a recording, by the names of the options."""
    try:
        said = json.loads(_place(recording).read_text(encoding="utf-8"))
        known = {name: said[name] for name in ASKED if said.get(name)}
        ReadOptions(**known)
    except (OSError, ValueError, TypeError, AttributeError, KinemeError):
        return {}
    return known


def read_options(recording: Path, general: ReadOptions) -> ReadOptions:
    """How a recording is read: as people said of it, else as of all."""
    return replace(general, **said_of(recording))


def keep_options(recording: Path, said: dict[str, Any]) -> None:
    """Keep what people say of a recording.

    Raises
    ------
    ParameterError
        A value that an option does not take.
    WriteError
        It cannot be written.
    """
    known = {name: value for name, value in said.items() if name in ASKED and value}
    ReadOptions(**known)
    write_file(_place(recording), json.dumps(known).encode())


def _place(recording: Path) -> Path:
    return recording.parent / FOLDER / f"{recording.name}.reading.json"
