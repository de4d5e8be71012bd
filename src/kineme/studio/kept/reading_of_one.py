"""How one recording of a folder is read, where people said so on the page.

It is kept in ``.kineme/walk.bvh.reading.json``, and counts before what the studio was started with.
"""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path
from typing import Any, TypedDict

from kineme.errors import KinemeError
from kineme.formats import ReadOptions
from kineme.studio.kept.records import FOLDER, kept_beside, write_file

ASKED = ("person", "fps", "unit", "up")
"""Of the options, those that the page asks for."""


class _Said(TypedDict, total=False):
    person: str | None
    fps: float | None
    unit: str | float | None
    up: str | None


def said_of(recording: Path) -> dict[str, Any]:
    """What people said of a recording, by the names of the options."""
    return _read(recording)[0]


def notes_on_reading(recording: Path) -> list[str]:
    """That what was said of a recording cannot be read, where it cannot."""
    return _read(recording)[1]


def _read(recording: Path) -> tuple[dict[str, Any], list[str]]:
    place = _place(recording)
    said, notes = kept_beside(place, _Said, _Said())
    known = {name: value for name, value in said.items() if value}
    try:
        ReadOptions(**known)  # type: ignore[arg-type]  # its values are of these types
    except KinemeError as error:
        return {}, [*notes, f"{place.name} was left alone: it holds a wrong option: {error}"]
    return known, notes


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
