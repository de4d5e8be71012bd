"""Save the state of a stream, and write its rows to disk as they arrive.

The state is an NPZ file with arrays, and JSON inside for the rest. Rows are appended to a journal,
``take.journal.csv``, which becomes ``take.parquet`` at the end. Each row is flushed to the
operating system, so a killed program loses only the rows of its last moment. An incomplete last
line is dropped when the journal is recovered.
"""

from __future__ import annotations

import csv
import json
import os
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass, field, fields
from math import isnan
from os import PathLike
from pathlib import Path
from queue import Queue
from threading import Thread
from time import monotonic
from typing import Any

import numpy as np

from kineme._util.arrays import Floats
from kineme._util.checks import require_extra
from kineme._util.files import (
    atomic_write,
    is_locked,
    lock_shared,
    refuse_link,
    translate_read_errors,
)
from kineme._util.json import convert_json
from kineme.errors import ReadError, WriteError
from kineme.live.events import Finals, Look
from kineme.live.intake import Intake
from kineme.live.looking import RecentPast
from kineme.live.sources import Rows

SCHEMA = "kineme.stream/2"
EXAMPLE = "example "
NUMBERS = ("gap", "now", "next_look", "is_timed", "is_finished")
Settings = dict[str, Any]


@dataclass
class Announced:
    """Activity that was announced last, and the number of its repetitions announced."""

    start: int = 0
    cluster: int = -1
    n_repetitions: int = 0


@dataclass
class StreamState:
    """Everything that changes in a stream."""

    intake: Intake
    finals: Finals
    past: RecentPast
    before: Look | None = None  # result of the last segmentation of the recent past
    announced: Announced = field(default_factory=Announced)
    gap: int | None = None  # first frame of the current gap
    now: int = 0  # number of frames so far
    next_look: int = 0  # number of frames at which the recent past is segmented next
    is_timed: bool | None = None  # whether rows have times; None before the first
    is_finished: bool = False


def save_state(state: StreamState, settings: Mapping[str, Any], path: str | PathLike[str]) -> None:
    """Write a state and the arguments of the stream."""
    past = state.past
    past.collect()
    intake = {each.name: getattr(state.intake, each.name) for each in fields(Intake)}
    arrays: dict[str, Any] = {
        n: value for n, value in intake.items() if isinstance(value, np.ndarray)
    }
    arrays |= {"values": past.values, "missing": past.missing, "known": past.known}
    arrays |= {f"{EXAMPLE}{cluster}": rows for cluster, rows in past.examples.items()}
    content = {
        "schema": SCHEMA,
        "settings": settings,
        "intake": {name: value for name, value in intake.items() if name not in arrays},
        "finals": asdict(state.finals),
        "start": past.start,
        "before": state.before,
        "announced": asdict(state.announced),
        "numbers": {name: getattr(state, name) for name in NUMBERS},
    }
    text = np.frombuffer(json.dumps(content).encode(), np.uint8)
    with atomic_write(path) as draft, draft.open("wb") as file:
        np.savez(file, content=text, **arrays)


def load_state(path: str | PathLike[str]) -> tuple[Settings, Callable[[StreamState], None]]:
    """Return the arguments of a saved stream, and a function that restores its state."""
    with translate_read_errors(path):
        try:
            with np.load(path, allow_pickle=False) as file:
                arrays: dict[str, Any] = {name: file[name] for name in file.files}
            content = json.loads(arrays.pop("content").tobytes())
        except (ValueError, KeyError, AttributeError) as error:
            raise ReadError(path, "is not a stream saved by kineme") from error
    if content.get("schema") != SCHEMA:
        raise ReadError(path, f"has another version: {content.get('schema')!r:.40}")

    def fill(state: StreamState) -> None:
        own = {each.name for each in fields(Intake)} & arrays.keys()
        state.intake = Intake(**content["intake"], **{name: arrays[name] for name in own})
        state.finals = convert_json(content["finals"], Finals)
        past = state.past
        past.start, past.known = content["start"], arrays["known"]
        past.values, past.missing = arrays["values"], arrays["missing"]
        past.examples = {
            int(name.removeprefix(EXAMPLE)): rows
            for name, rows in arrays.items()
            if name.startswith(EXAMPLE)
        }
        if content["before"] is not None:
            state.before = convert_json(content["before"], Look)
        state.announced = Announced(**content["announced"])
        for name, value in content["numbers"].items():
            setattr(state, name, value)

    return content["settings"], fill


SUFFIX = ".journal.csv"
TIME = "time_s"
AHEAD = 100
"""Largest number of pieces that are written but not processed yet."""
SYNCHRONISED_S = 0.5
"""Seconds between two calls of fsync, for the case that the machine goes down."""


class Journal:
    """A journal that is open for writing; `close` turns it into a Parquet file.

    ``path`` is the Parquet file to make, with or without the suffix, and ``fps`` the rate of rows
    without times. WriteError if the file exists, or a journal that was not recovered.
    """

    def __init__(self, path: str | os.PathLike[str], channels: Sequence[str], fps: float) -> None:
        self.target = Path(path).with_suffix(".parquet")
        self.path = self.target.with_suffix(SUFFIX)
        self._fps, self._n_rows, self._synchronised = fps, 0, monotonic()
        if self.target.exists():
            raise WriteError(self.target, "exists already: give another name")
        refuse_link(self.path)
        try:
            self._file = self.path.open("x", encoding="utf-8", newline="")
        except FileExistsError as error:
            reason = (
                "exists already: give another name, or if its run has ended, recover it with "
                f"kineme live --recover {self.path}"
            )
            raise WriteError(self.path, reason) from error
        except OSError as error:
            raise WriteError(self.path, f"cannot be written: {error.strerror}") from error
        lock_shared(self._file.fileno())
        self._writer = csv.writer(self._file)
        self._writer.writerow([TIME, *channels])
        self._file.flush()

    def write(self, rows: Floats, seconds: Floats | None = None) -> None:
        """Append rows; without seconds they follow at the frame rate.

        Raises WriteError if the disk is full.
        """
        if seconds is None:
            seconds = (self._n_rows + np.arange(len(rows))) / self._fps
        self._n_rows += len(rows)
        table = np.column_stack([seconds, rows])
        cells = [[None if isnan(cell) else cell for cell in row] for row in table.tolist()]
        try:
            self._writer.writerows(cells)
            self._file.flush()
            if monotonic() - self._synchronised > SYNCHRONISED_S:
                os.fsync(self._file.fileno())
                self._synchronised = monotonic()
        except OSError as error:
            raise WriteError(self.path, f"cannot be written: {error.strerror}") from error

    def write_ahead(self, source: Iterable[Rows]) -> Iterator[Rows]:
        """Write the rows of a source as soon as they arrive, even if they are processed later."""
        queue: Queue[Rows | BaseException | None] = Queue(AHEAD)

        def write() -> None:
            try:
                for rows in source:
                    self.write(rows.values, rows.seconds)
                    queue.put(rows)
                queue.put(None)
            except BaseException as error:  # noqa: BLE001 (raised where rows are taken)
                queue.put(error)

        Thread(target=write, daemon=True).start()
        while (taken := queue.get()) is not None:
            if isinstance(taken, BaseException):
                raise taken
            yield taken

    def close(self) -> Path:
        """Close the journal; return the Parquet file made from it."""
        self._file.close()
        return recover_journal(self.path)


def recover_journal(path: str | os.PathLike[str]) -> Path:
    """Convert the complete lines of a journal to a Parquet file, and delete the journal.

    ReadError if it is not a journal, or holds no row; WriteError if the Parquet file exists, or a
    run still writes the journal; MissingDependencyError without pyarrow: the journal stays, and
    `kineme.read` reads it.
    """
    journal = Path(path)
    if not journal.name.endswith(SUFFIX):
        raise ReadError(journal, f"is not a journal: its name must end in {SUFFIX}")
    target = journal.with_name(journal.name.removesuffix(SUFFIX) + ".parquet")
    if target.exists():
        raise WriteError(target, "exists already: move it away first")
    with require_extra("pyarrow", "tables"):
        import pyarrow as pa
        from pyarrow import csv as arrow_csv
        from pyarrow import parquet
    with translate_read_errors(journal):
        if is_locked(journal, if_unknown=False):
            raise WriteError(journal, "is still being written: recover it when its run has ended")
        _cut_last_line(journal)
        with journal.open(encoding="utf-8", newline="") as file:
            names = next(csv.reader(file), [])
        if names[:1] != [TIME]:
            raise ReadError(journal, f"is not a journal: its first column must be {TIME}")
        # Types are given, as they cannot be inferred from empty columns.
        convert = arrow_csv.ConvertOptions(column_types=dict.fromkeys(names, pa.float64()))
        # In batches, so that the rows of a day need not fit into memory.
        with (
            arrow_csv.open_csv(journal, convert_options=convert) as rows,
            atomic_write(target) as at,
            parquet.ParquetWriter(at, rows.schema) as writer,
        ):
            for batch in rows:
                writer.write_batch(batch)
    journal.unlink()
    return target


def _cut_last_line(journal: Path) -> None:
    """Truncate the file after its last line break."""
    with journal.open("r+b") as file:
        size = file.seek(0, os.SEEK_END)
        while size:
            start = max(0, size - 65536)
            file.seek(start)
            end = file.read(size - start).rfind(b"\n")
            if end >= 0:
                file.truncate(start + end + 1)
                return
            size = start
