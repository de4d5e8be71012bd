"""What became of the edits of a library, so that the last of them can be taken back.

Names, merges and splits of a library are one small file; ``.kineme/library.json`` in its folder
has what that held before each edit made here. An edit that was made elsewhere since is never
taken back unseen: then there is nothing to undo.
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

MOST_STEPS = 200
NAME = "library.json"


class Step(Struct, frozen=True):
    """An edit in words, what the file of edits held before it, and the digest of what it left."""

    what: str
    before: dict[str, Any]
    after: str


class LibraryHistory:
    """Edits of a library that were made here, the last of which can be taken back."""

    def __init__(self, folder: Path):
        self._folder = folder
        self._path = folder / FOLDER / NAME

    def present(self) -> dict[str, Any]:
        """Return what the file of edits holds."""
        return read_json(self._folder / EDITS)

    def add(self, what: str, before: dict[str, Any]) -> None:
        """Keep what was there before an edit that has been made."""
        after = self.present()
        if after != before:
            self._write([*self._steps(), Step(what, before, _compute_digest(after))])

    def last(self) -> str:
        """Return the edit that can be taken back, in words; empty where there is none."""
        steps = self._steps()
        return (
            steps[-1].what if steps and steps[-1].after == _compute_digest(self.present()) else ""
        )

    def undo(self) -> None:
        """Take the last edit back; ParameterError where there is none, or others came since."""
        with lock_for_writing(self._folder, "try again", LOCK_EDITS):
            if not self.last():
                raise ParameterError("there is nothing to undo, or the library was changed since")
            *steps, last = self._steps()
            if last.before:
                write_json(self._folder / EDITS, last.before)
            else:  # the first edit of all
                Edits().write(self._folder)
        self._write(steps)

    def _steps(self) -> list[Step]:
        return read_sidecar(self._path, list[Step], [])[0]

    def _write(self, steps: list[Step]) -> None:
        content = [
            {"what": each.what, "before": each.before, "after": each.after} for each in steps
        ]
        write_file(self._path, json.dumps(content[-MOST_STEPS:], indent=1).encode())


def _compute_digest(content: dict[str, Any]) -> str:
    return sha256(json.dumps(content, sort_keys=True).encode()).hexdigest()
