"""Undo history of a library's clusters.

Names, merges and splits of a library are one small file. ``.kineme/library.json`` in its folder
keeps what that file held before each edit in the studio. If another program has edited the library
since, nothing can be undone.
"""

from __future__ import annotations

import json
from hashlib import sha256
from pathlib import Path
from typing import Any

from msgspec import Struct

from kineme.errors import ParameterError
from kineme.library.edits import Edits
from kineme.library.storage.layout import EDITS, LOCK_EDITS, lock_for_writing, read_json, write_json
from kineme.studio.storage.sidecars import FOLDER, read_sidecar, write_file

MAX_STEPS = 200
"""Undo steps kept in the file."""
NAME = "library.json"


class Step(Struct, frozen=True):
    """An edit: its description, the content before it, and the digest of the content after it."""

    what: str
    before: dict[str, Any]
    after: str


class LibraryHistory:
    """Edits of a library in the studio, of which the last can be undone."""

    def __init__(self, folder: Path):
        self._folder = folder
        self._path = folder / FOLDER / NAME

    def present(self) -> dict[str, Any]:
        """Return the content of the edits file."""
        return read_json(self._folder / EDITS)

    def add(self, what: str, before: dict[str, Any]) -> None:
        """Record an edit that has been made; ``before`` is the content before it."""
        after = self.present()
        if after != before:
            self._write([*self._steps(), Step(what, before, _compute_digest(after))])

    def last(self) -> str:
        """Return the description of the edit that can be undone; empty if there is none."""
        steps = self._steps()
        return (
            steps[-1].what if steps and steps[-1].after == _compute_digest(self.present()) else ""
        )

    def undo(self) -> None:
        """Undo the last edit; ParameterError if there is none, or the library has changed since."""
        with lock_for_writing(self._folder, "try again", LOCK_EDITS):
            if not self.last():
                raise ParameterError("nothing to undo, or the library was changed meanwhile")
            *steps, last = self._steps()
            if last.before:
                write_json(self._folder / EDITS, last.before)
            else:  # before the first edit there was no file
                Edits().write(self._folder)
        self._write(steps)

    def _steps(self) -> list[Step]:
        return read_sidecar(self._path, list[Step], [])[0]

    def _write(self, steps: list[Step]) -> None:
        content = [
            {"what": step.what, "before": step.before, "after": step.after} for step in steps
        ]
        write_file(self._path, json.dumps(content[-MAX_STEPS:], indent=1).encode())


def _compute_digest(content: dict[str, Any]) -> str:
    return sha256(json.dumps(content, sort_keys=True).encode()).hexdigest()
