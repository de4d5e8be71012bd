"""``history.json``: which tables a table had before, and what is known of each."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TypeVar

import msgspec

from kineme._files import atomic_write, refuse_link
from kineme._json import loaded
from kineme.errors import ReadError, WriteError
from kineme.segments.history import History
from kineme.studio.kept.identities import Identities
from kineme.web.edits import Edit

SCHEMA = "kineme.history/1"
FOLDER = ".kineme"
HISTORY = "history.json"
Kept = TypeVar("Kept")


@dataclass(frozen=True)
class Step:
    """A table of the history, and how it came about.

    Parameters
    ----------
    at : str
        When, ISO 8601.
    sha256 : str
        Of the file.
    n_frames : int
        Of the recording.
    edit : Edit or None
        As a page sent it; None for what was found, or written by another program.
    ids : Identities
        Who its segments are.
    """

    at: str
    sha256: str
    n_frames: int
    edit: Edit | None
    ids: Identities = field(default_factory=Identities)


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


def read_record(folder: Path) -> tuple[Record, list[str]]:
    """The history in a folder, and what people should know of it.

    Parameters
    ----------
    folder : Path

    Returns
    -------
    record : Record
        An empty one where there is none that can be read.
    notes : list of str
        That a damaged one was left alone.
    """
    record, notes = kept_beside(folder / HISTORY, Record, Record())
    whole = record.schema == SCHEMA and needed_by(record) <= record.steps.keys()
    if whole or record == Record():
        return record, notes
    return Record(revision=record.revision), [*notes, f"{HISTORY} was left alone: it is not whole"]


def kept_beside(path: Path, shape: type[Kept], otherwise: Kept) -> tuple[Kept, list[str]]:
    """What a side file holds, and what people should know of it.

    Parameters
    ----------
    path : Path
        It need not be there.
    shape : type
        Of what it holds.
    otherwise : object
        What counts where there is none, or none that can be read.

    Returns
    -------
    kept : object
    notes : list of str
        That a damaged file was left alone, and why.
    """
    try:
        return loaded(path, shape), []
    except ReadError as error:
        if isinstance(error.__cause__, FileNotFoundError | NotADirectoryError):
            return otherwise, []
        return otherwise, [f"{path.name} was left alone: it {error.reason}"]


def write_record(folder: Path, record: Record) -> None:
    """Have the history on the disk: whole or not at all."""
    content = msgspec.json.format(msgspec.json.encode(record), indent=1)
    write_file(folder / HISTORY, content)


def write_file(path: Path, content: bytes) -> None:
    """Have a file of ``.kineme`` on the disk, whole or not at all, with the folders around it.

    Raises
    ------
    WriteError
        It cannot be written; it, ``.kineme`` or a folder between is a link.
    """
    _make(path.parent)
    with atomic_write(path) as draft:
        draft.write_bytes(content)


def _make(folder: Path) -> None:
    if folder.name != FOLDER:
        _make(folder.parent)
    refuse_link(folder)
    try:
        folder.mkdir(exist_ok=True)
    except OSError as error:
        raise WriteError(folder, f"cannot be made: {error.strerror or error}") from error


def pruned(record: Record) -> Record:
    """The record without the steps that nothing needs any more."""
    needed = needed_by(record)
    return replace(record, steps={n: step for n, step in record.steps.items() if n in needed})


def needed_by(record: Record) -> set[int]:
    """The numbers of the tables that a record names."""
    history = record.history
    return {*history.past, history.present, *history.future, *record.kept}
