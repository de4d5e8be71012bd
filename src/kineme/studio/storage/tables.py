"""File in which a recording's table is saved, and the history of its edits.

``walk.bvh`` has ``walk.segments.json`` beside it. If that file belongs to another recording
(``walk.c3d``), to an older recording of that name, or is not a table, it is left alone, and
``walk.bvh.segments.json`` or a numbered name is used. With several people, the name includes the
person: ``walk_anna.segments.json``. Changes by other programs are detected.

The history has undo, redo, and every replaced table. It is a hidden folder beside the table,
``.kineme/walk.segments/`` for ``walk.segments.json``:

- ``history.json``: the numbers of the present table, of those that undo and redo restore, and of
  replaced tables; for each the time, the edit that made it, and its digest;
- ``1.json``, ``2.json``, …: the tables, in the format that `kineme.read_segments` reads.

A table is written before the history that names it, and the history before the user's table. So an
acknowledged edit is in all three. If the server was killed during an edit, the user's table is
still the old one, and the edit is dropped when the history is read again. Undo goes back
`kineme.segments.history.LONGEST` steps; the last `MAX_VERSIONS` replaced tables are kept.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import suppress
from dataclasses import dataclass, field, replace
from datetime import UTC, datetime
from hashlib import sha256
from itertools import count
from pathlib import Path

import msgspec

from kineme._util.files import (
    CORRECTED,
    atomic_write,
    read_file_stamp,
    refuse_pipe,
    translate_read_errors,
)
from kineme.errors import KinemeError, ParameterError, ReadError, WriteError
from kineme.labels import json_table, read_segments
from kineme.segments.history import History
from kineme.segments.segmentation import Segmentation
from kineme.studio.storage.sidecars import (
    FOLDER,
    ListedRecording,
    delete_file,
    read_sidecar,
    write_file,
)
from kineme.web.requests import Edit

MAX_VERSIONS = 200
"""Replaced tables that are kept."""
MAX_NAMES = 200
"""Names of edits that are remembered, so that an edit sent twice is applied once."""
SCHEMA = "kineme.history/1"
HISTORY = "history.json"


class TableFile:
    """File of a table, which may not exist yet; remembers its last known content."""

    def __init__(self, path: Path):
        self.path = path
        self._stamp = read_file_stamp(path)
        self._digest = _compute_digest(path)

    @property
    def exists(self) -> bool:
        """Whether the table has been saved."""
        return self._digest is not None

    def has_changed(self) -> bool:
        """Return whether another program has changed the file."""
        if read_file_stamp(self.path) == self._stamp:
            return False
        return _compute_digest(self.path) != self._digest

    def read(self) -> Segmentation:
        """Return the table in the file and remember its content."""
        self._stamp, self._digest = read_file_stamp(self.path), _compute_digest(self.path)
        return read_segments(self.path, format="json")

    def write(self, content: bytes) -> None:
        """Save a table that `encode_table` encoded, completely or not at all.

        ChangedOnDiskError if another program has changed the file, which is kept; WriteError if it
        cannot be written, or is a link to elsewhere.
        """
        with atomic_write(self.path) as draft:
            with draft.open("wb") as file:
                file.write(content)
            if self.has_changed():
                raise ChangedOnDiskError
            # The rename leaves it unchanged; after that, another program may write the file.
            stamp = read_file_stamp(draft)
        self._stamp, self._digest = stamp, sha256(content).digest()


class ChangedOnDiskError(Exception):
    """Raised if the file has changed since it was last read or written here."""


def encode_table(table: Segmentation) -> bytes:
    """Return the file content of a table."""
    return json_table.dumps(table).encode()


def find_saved_table(
    listed: ListedRecording,
    fits: Callable[[Segmentation], bool],
    others: set[Path],
    belongs_to_other: Callable[[Segmentation], bool],
) -> tuple[TableFile, Segmentation | None, list[str]]:
    """Return the table file of a recording, its table if it is saved, and notes on skipped files.

    ``fits`` tells whether a table is of this recording, ``belongs_to_other`` whether it is of
    another take or person of its file, which is skipped silently. ``others`` are the table files of
    other recordings. WriteError if no name is left.
    """
    notes: list[str] = []
    for path in _list_candidate_paths(listed):
        file = TableFile(path)
        if path in others or path.is_symlink():
            continue
        if not file.exists:
            return file, None, notes
        try:
            table = file.read()
        except KinemeError as error:
            reason = error.reason if isinstance(error, ReadError) else str(error)
            notes.append(f"{path.name} was not used: it {reason}")
            continue
        if fits(table):
            return file, table, notes
        if not belongs_to_other(table):
            notes.append(f"{path.name} was not used: it belongs to another recording")
    raise WriteError(listed.path, "cannot store its table: all its file names are in use")


def list_default_table_paths(listed: ListedRecording) -> list[Path]:
    """Return the two names that nearly every table has."""
    base = listed.table_base
    return [base.with_name(name + CORRECTED) for name in (base.stem, base.name)]


def find_table_path(listed: ListedRecording) -> Path | None:
    """Return the first of these that exists."""
    return next((path for path in list_default_table_paths(listed) if path.is_file()), None)


def _list_candidate_paths(listed: ListedRecording) -> Iterator[Path]:
    yield from list_default_table_paths(listed)
    base = listed.table_base
    for number in count(2):
        yield base.with_name(f"{base.name}.{number}{CORRECTED}")


def _compute_digest(path: Path) -> bytes | None:
    try:
        refuse_pipe(path)
        return sha256(path.read_bytes()).digest()
    except (OSError, ReadError):
        return None


@dataclass(frozen=True)
class Step:
    """A table of the history: its time (ISO 8601), its digest, and the edit that made it.

    ``edit`` is None for a segmentation, or a table that another program wrote.
    """

    at: str
    sha256: str
    n_frames: int
    edit: Edit | None


@dataclass(frozen=True)
class Record:
    """Content of ``history.json``; tables are given by number.

    ``before`` is the table that the last change replaced. If that change was interrupted, it is in
    the user's file. ``names`` are those of the last edits, empty for an edit without a name.
    """

    schema: str = SCHEMA
    revision: int = 0
    history: History[int] = field(default_factory=lambda: History(0))
    before: int | None = None
    kept: tuple[int, ...] = ()
    names: tuple[str, ...] = ()
    steps: dict[int, Step] = field(default_factory=dict)


@dataclass(frozen=True)
class Change:
    """A history that is not written yet, its present table, and the file content of that table."""

    record: Record
    table: Segmentation
    content: bytes


class Journal:
    """Edit history of one table; ``notes`` tell the user about a damaged history.

    ``table`` is the content of the user's file, or the segmentation if there is no file. If the
    history ends with a different table, that one is kept as a version. Nothing is written before
    the first change.
    """

    def __init__(self, table_path: Path, table: Segmentation):
        self.folder = table_path.parent / FOLDER / table_path.name.removesuffix(".json")
        self._record, self.notes = read_record(self.folder)
        self._unsaved: dict[int, Change] = {}
        history, steps = self._record.history, self._record.steps
        digest = sha256(encode_table(table)).hexdigest()
        if steps and steps[history.present].n_frames == table.n_frames:
            # The file holds the present table, or the one before or after an interrupted change.
            numbers = (history.present, self._record.before)
            for step in (history, _try_step(history.undone), _try_step(history.redone)):
                if step is None or step.present not in numbers:
                    continue
                if self._matches(step.present, table, digest):
                    if step is not history:  # the change was interrupted and never acknowledged
                        names, revision = self._record.names[:-1], self._record.revision - 1
                        self._record = replace(
                            self._record, history=step, names=names, revision=revision
                        )
                    return
            # The last edit may have been interrupted: forget its name, so it can be sent again.
            self._record = replace(self._record, names=self._record.names[:-1])
            self._record = self.make_change(table, None, replaced=True).record
        else:
            # The recording has another length now, so its old tables are useless.
            self._record = replace(self._record, history=History(0))
            start = self.make_change(table, None).record
            self._record = replace(start, history=History(start.history.present))

    @property
    def revision(self) -> int:
        """Number that grows with every change and survives restarts of the server."""
        return self._record.revision

    @property
    def can_undo(self) -> bool:
        """Whether there is a step to undo."""
        return bool(self._record.history.past)

    @property
    def can_redo(self) -> bool:
        """Whether there is a step to redo."""
        return bool(self._record.history.future)

    def knows(self, name: str) -> bool:
        """Return whether the edit with this name was applied already."""
        return bool(name) and name in self._record.names

    def versions(self) -> dict[int, Step]:
        """Return the replaced tables, the latest first."""
        steps = self._record.steps
        n_frames = steps[self._record.history.present].n_frames
        numbers = reversed(self._record.kept)
        return {number: steps[number] for number in numbers if steps[number].n_frames == n_frames}

    def table(self, number: int) -> Segmentation:
        """Return a table of the history; ReadError if its file is missing."""
        if number in self._unsaved:
            return self._unsaved[number].table
        return self._read_table(number)[1]

    def make_change(
        self, table: Segmentation, edit: Edit | None, *, replaced: bool = False
    ) -> Change:
        """Return the history with a new table, made by ``edit`` or by another program (None).

        The present table is kept as a version if it is ``replaced``. The last table that could be
        redone is always kept.
        """
        history, steps = self._record.history, self._record.steps
        # Avoid all numbers in the folder, even those that the history does not name.
        number = max([0, *steps, *self._list_numbers()]) + 1
        # A new edit discards the redo steps; keep the last of them as a version.
        kept = [*history.future[-1:], *([history.present] if replaced else [])]
        now = datetime.now(UTC).isoformat(timespec="seconds")
        content = encode_table(table)
        step = Step(now, sha256(content).hexdigest(), table.n_frames, edit)
        record = replace(
            self._record,
            history=history.followed_by(number),
            kept=tuple(dict.fromkeys([*self._record.kept, *kept]))[-MAX_VERSIONS:],
            steps={**steps, number: step},
        )
        change = self._unsaved[number] = Change(record, table, content)
        return change

    def undo_or_redo(self, *, undo: bool) -> Change:
        """Return the history one step back or forward; ParameterError without such a step."""
        history = self._record.history.undone() if undo else self._record.history.redone()
        content, table = self._read_table(history.present)
        return Change(replace(self._record, history=history), table, content)

    def write(
        self, change: Change, save: Callable[[bytes], None], *, revision: int, name: str
    ) -> None:
        """Write a change to the disk, then call ``save`` with the content of its table.

        If ``save`` raises, the change has not been made. Otherwise the table has this revision, and
        the edit is known by its name.
        """
        needed, steps = find_needed_tables(change.record), change.record.steps
        record = replace(
            change.record,
            revision=revision,
            before=self._record.history.present,
            names=(*self._record.names, name)[-MAX_NAMES:],
            steps={number: step for number, step in steps.items() if number in needed},
        )
        try:
            for number in self._unsaved.keys() & record.steps.keys():
                write_file(self._path(number), self._unsaved[number].content)
            write_record(self.folder, record)
            save(change.content)
        finally:
            if not self.folder.parent.is_symlink():
                # Removes only empty folders, after a failed first write.
                for folder in (self.folder, self.folder.parent):
                    with suppress(OSError):
                        folder.rmdir()
        unused = self._record.steps.keys() - record.steps.keys()
        self._record, self._unsaved = record, {}
        # Delete only after the new history is on the disk.
        for number in unused:
            delete_file(self._path(number))

    def _read_table(self, number: int) -> tuple[bytes, Segmentation]:
        """Return content and table of a file; ReadError if it is missing or damaged."""
        path = self._path(number)
        with translate_read_errors(path):
            content = path.read_bytes()
            return content, json_table.loads(content, path)

    def _matches(self, number: int, table: Segmentation, digest: str) -> bool:
        """Return whether a table of the history equals this one, whichever version wrote it."""
        if self._record.steps[number].sha256 == digest:
            return True
        try:
            return self.table(number) == table
        except ReadError:
            return False

    def _list_numbers(self) -> set[int]:
        """Return the numbers of the table files in the folder."""
        return {int(path.stem) for path in self.folder.glob("*.json") if path.stem.isdecimal()}

    def _path(self, number: int) -> Path:
        return self.folder / f"{number}.json"


def read_record(folder: Path) -> tuple[Record, list[str]]:
    """Return the history in a folder, empty if it cannot be read, and notes on it."""
    record, notes = read_sidecar(folder / HISTORY, Record, Record())
    complete = record.schema == SCHEMA and find_needed_tables(record) <= record.steps.keys()
    if complete or record == Record():
        return record, notes
    notes = [*notes, f"{HISTORY} was ignored: it is incomplete"]
    return Record(revision=record.revision), notes


def write_record(folder: Path, record: Record) -> None:
    """Write the history to the disk, completely or not at all."""
    content = msgspec.json.format(msgspec.json.encode(record), indent=1)
    write_file(folder / HISTORY, content)


def find_needed_tables(record: Record) -> set[int]:
    """Return the numbers of the tables that a record uses."""
    history = record.history
    return {*history.past, history.present, *history.future, *record.kept}


def _try_step(step: Callable[[], History[int]]) -> History[int] | None:
    try:
        return step()
    except ParameterError:
        return None
