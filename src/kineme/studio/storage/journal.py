"""What became of a table, kept on the disk: undo, redo, and every table that was replaced.

It lies in a hidden folder beside the table, ``.kineme/walk.segments/`` for
``walk.segments.json``:

- ``history.json``: which table is the present one, which come back with undo and with redo,
  which were replaced and kept, and for each the time, the edit that made it and its digest;
- ``1.json``, ``2.json``, …: the tables themselves, each as `kineme.read_segments` reads it.

A table is written before the history that names it, and the history before the table that
people have (`kineme.studio.storage.tables`). So an edit that was acknowledged is in all three; of
one that was cut short by a killed server the last is missing, and it is taken back when the
history is read again. Undo goes back `kineme.segments.history.LONGEST` steps; of the tables
that were replaced the last `MOST_KEPT` are there.
"""

from __future__ import annotations

from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass, field, replace
from datetime import UTC, datetime
from hashlib import sha256
from pathlib import Path

import msgspec

from kineme._util.files import translate_read_errors
from kineme.errors import ParameterError, ReadError
from kineme.labels import json_table
from kineme.segments.history import History
from kineme.segments.segmentation import Segmentation
from kineme.studio.storage.sidecars import FOLDER, delete_file, read_sidecar, write_file
from kineme.studio.storage.tables import encode_table
from kineme.web.requests import Edit

MOST_KEPT = 200
MOST_NAMES = 200
"""Edits whose names are known, so that one that is sent again is not made again."""
SCHEMA = "kineme.history/1"
HISTORY = "history.json"


@dataclass(frozen=True)
class Step:
    """A table of the history: when it came about (ISO 8601), its digest, and by which edit.

    None is for what was found, or written by another program.
    """

    at: str
    sha256: str
    n_frames: int
    edit: Edit | None


@dataclass(frozen=True)
class Record:
    """What ``history.json`` holds; tables by their numbers.

    ``names`` are those of the last changes, empty for one without.
    """

    schema: str = SCHEMA
    revision: int = 0
    history: History[int] = field(default_factory=lambda: History(0))
    kept: tuple[int, ...] = ()
    names: tuple[str, ...] = ()
    steps: dict[int, Step] = field(default_factory=dict)


@dataclass(frozen=True)
class Change:
    """A history that has not been written yet, its present table, and what files hold of that."""

    record: Record
    table: Segmentation
    content: bytes


class Journal:
    """History of one table; ``notes`` say that a damaged one was left alone.

    ``table`` is what the file that people have holds, or what was found if it is not there. Where
    the history ends with another table, that one is kept. Nothing is written before the first
    change.
    """

    def __init__(self, table_path: Path, table: Segmentation):
        self.folder = table_path.parent / FOLDER / table_path.name.removesuffix(".json")
        self._record, self.notes = read_record(self.folder)
        self._unsaved: dict[int, Change] = {}
        history, steps = self._record.history, self._record.steps
        digest = sha256(encode_table(table)).hexdigest()
        if steps and steps[history.present].n_frames == table.n_frames:
            # The present table, else that before or after the last change, which was cut short.
            for step in (history, _try_step(history.undone), _try_step(history.redone)):
                if step is not None and self._is(step.present, table, digest):
                    if step is not history:  # the last change was cut short, and has no answer
                        names, revision = self._record.names[:-1], self._record.revision - 1
                        self._record = replace(
                            self._record, history=step, names=names, revision=revision
                        )
                    return
            self._record = self.changed(table, None, replaced=True).record
        else:
            # A history of a recording of another length is of no use.
            self._record = replace(self._record, history=History(0))
            start = self.changed(table, None).record
            self._record = replace(start, history=History(start.history.present))

    @property
    def revision(self) -> int:
        """It grows with every change, and outlives the server."""
        return self._record.revision

    @property
    def can_undo(self) -> bool:
        """Return whether there is a table before the present one."""
        return bool(self._record.history.past)

    @property
    def can_redo(self) -> bool:
        """Return whether one was taken back."""
        return bool(self._record.history.future)

    def knows(self, name: str) -> bool:
        """Return whether the edit of that name has been made."""
        return bool(name) and name in self._record.names

    def versions(self) -> dict[int, Step]:
        """Return the tables that were replaced, the latest first."""
        steps = self._record.steps
        n_frames = steps[self._record.history.present].n_frames
        numbers = reversed(self._record.kept)
        return {number: steps[number] for number in numbers if steps[number].n_frames == n_frames}

    def table(self, number: int) -> Segmentation:
        """Return a table of the history; ReadError where it is not there any more."""
        if number in self._unsaved:
            return self._unsaved[number].table
        return self._kept(number)[1]

    def changed(self, table: Segmentation, edit: Edit | None, *, replaced: bool = False) -> Change:
        """Return the history with a new table, made by an edit or by nobody.

        The present one is kept where it is ``replaced``; so is, in any case, the last of those that
        could have been redone.
        """
        history, steps = self._record.history, self._record.steps
        # Above every number in the folder, also of files that the history does not name.
        number = max([0, *steps, *self._numbers()]) + 1
        # A table that could have been redone is about to be lost.
        before = [*history.future[-1:], *([history.present] if replaced else [])]
        at = datetime.now(UTC).isoformat(timespec="seconds")
        content = encode_table(table)
        step = Step(at, sha256(content).hexdigest(), table.n_frames, edit)
        record = replace(
            self._record,
            history=history.followed_by(number),
            kept=tuple(dict.fromkeys([*self._record.kept, *before]))[-MOST_KEPT:],
            steps={**steps, number: step},
        )
        change = self._unsaved[number] = Change(record, table, content)
        return change

    def undone(self) -> Change:
        """Return the history one step back; ParameterError where there is nothing to undo."""
        return self._moved_to(self._record.history.undone())

    def redone(self) -> Change:
        """Return the history one step forward again; ParameterError where nothing was undone."""
        return self._moved_to(self._record.history.redone())

    def write(
        self,
        change: Change,
        save: Callable[[bytes], None],
        *,
        revision: int,
        name: str = "",
    ) -> None:
        """Have a change on the disk, and then what ``save`` does with the content of its table.

        Where that raises, the change has not been made. From then on the table has this revision,
        and the edit is known by its name.
        """
        names = (*self._record.names, name)[-MOST_NAMES:]
        record = prune_steps(replace(change.record, revision=revision, names=names))
        try:
            self._write(record)
            save(change.content)
        finally:
            if not self.folder.parent.is_symlink():
                for place in (self.folder, self.folder.parent):  # empty where nothing was written
                    with suppress(OSError):
                        place.rmdir()
        forgotten = self._record.steps.keys() - record.steps.keys()
        self._record, self._unsaved = record, {}
        # Only once the new history is on the disk.
        for number in forgotten:
            delete_file(self._path(number))

    def _write(self, record: Record) -> None:
        for number in self._unsaved.keys() & record.steps.keys():
            write_file(self._path(number), self._unsaved[number].content)
        write_record(self.folder, record)

    def _moved_to(self, history: History[int]) -> Change:
        content, table = self._kept(history.present)
        return Change(replace(self._record, history=history), table, content)

    def _kept(self, number: int) -> tuple[bytes, Segmentation]:
        """What the file of a table holds; ReadError where it is not there any more, or damaged."""
        path = self._path(number)
        with translate_read_errors(path):
            content = path.read_bytes()
            return content, json_table.loads(content, path)

    def _is(self, number: int, table: Segmentation, digest: str) -> bool:
        """Whether a table of the history is this one, by whichever version it was written."""
        if self._record.steps[number].sha256 == digest:
            return True
        try:
            return self.table(number) == table
        except ReadError:
            return False

    def _numbers(self) -> set[int]:
        """Of the tables in the folder."""
        return {int(path.stem) for path in self.folder.glob("*.json") if path.stem.isdecimal()}

    def _path(self, number: int) -> Path:
        return self.folder / f"{number}.json"


def read_record(folder: Path) -> tuple[Record, list[str]]:
    """Return the history in a folder, empty where none can be read, and notes on it."""
    record, notes = read_sidecar(folder / HISTORY, Record, Record())
    complete = record.schema == SCHEMA and find_needed_tables(record) <= record.steps.keys()
    if complete or record == Record():
        return record, notes
    return Record(revision=record.revision), [*notes, f"{HISTORY} was left alone: it is not whole"]


def write_record(folder: Path, record: Record) -> None:
    """Have the history on the disk: whole or not at all."""
    content = msgspec.json.format(msgspec.json.encode(record), indent=1)
    write_file(folder / HISTORY, content)


def prune_steps(record: Record) -> Record:
    """Return the record without the steps that nothing needs any more."""
    needed = find_needed_tables(record)
    return replace(record, steps={n: step for n, step in record.steps.items() if n in needed})


def find_needed_tables(record: Record) -> set[int]:
    """Return the numbers of the tables that a record names."""
    history = record.history
    return {*history.past, history.present, *history.future, *record.kept}


def _try_step(step: Callable[[], History[int]]) -> History[int] | None:
    try:
        return step()
    except ParameterError:
        return None
