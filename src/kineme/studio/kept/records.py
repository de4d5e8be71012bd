"""``history.json``: which tables a table had before, and what is known of each."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from pathlib import Path

import msgspec

from kineme._files import atomic_write
from kineme.segments.history import History
from kineme.studio.kept.identities import Identities
from kineme.web.edits import Edit

SCHEMA = "kineme.history/1"
FOLDER = ".kineme"
HISTORY = "history.json"


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


def read_record(folder: Path) -> Record:
    """The history in a folder; an empty one where there is none that can be read."""
    try:
        record = msgspec.json.decode((folder / HISTORY).read_bytes(), type=Record)
    except (OSError, ValueError, RecursionError):
        return Record()
    needed = needed_by(record)
    whole = record.schema == SCHEMA and needed <= record.steps.keys()
    return record if whole else Record(revision=record.revision)


def write_record(folder: Path, record: Record) -> None:
    """Have the history on the disk: whole or not at all."""
    content = msgspec.json.format(msgspec.json.encode(record), indent=1)
    write_file(folder / HISTORY, content)


def write_file(path: Path, content: bytes) -> None:
    """Have a file on the disk: whole or not at all."""
    with atomic_write(path) as draft:
        draft.write_bytes(content)


def pruned(record: Record) -> Record:
    """The record without the steps that nothing needs any more."""
    needed = needed_by(record)
    return replace(record, steps={n: step for n, step in record.steps.items() if n in needed})


def needed_by(record: Record) -> set[int]:
    """The numbers of the tables that a record names."""
    history = record.history
    return {*history.past, history.present, *history.future, *record.kept}
