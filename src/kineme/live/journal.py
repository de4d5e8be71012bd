"""Write rows to disk as they arrive: an append-only CSV that becomes a Parquet file at the end.

While ``take.parquet`` is recorded it is ``take.journal.csv``. Each row is flushed to the operating
system, so a killed program loses only the rows of its last moment. An incomplete last line is
dropped when the journal is recovered.
"""

from __future__ import annotations

import csv
import os
from collections.abc import Iterable, Iterator, Sequence
from math import isnan
from pathlib import Path
from queue import Queue
from threading import Thread
from time import monotonic

import numpy as np

from kineme._util.arrays import Floats
from kineme._util.checks import require_extra
from kineme._util.files import atomic_write, refuse_link, translate_read_errors
from kineme.errors import ReadError, WriteError
from kineme.live.sources import Rows

SUFFIX = ".journal.csv"
TIME = "time_s"
AHEAD = 100
"""Largest number of pieces that are written but not processed yet."""
SYNCHRONISED_S = 0.5
"""Seconds between two calls of fsync, for the case that the machine goes down."""


class Journal:
    """A journal that is open for writing; `close` turns it into a Parquet file.

    Parameters
    ----------
    path : path
        The Parquet file to make, with or without the suffix.
    channels : sequence of str
    fps : float
        Frames per second of rows without times.

    Raises
    ------
    WriteError
        The file exists, or a journal that was not recovered.
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
            advice = f"is from a run that ended early: kineme live --recover {self.path}"
            raise WriteError(self.path, advice) from error
        except OSError as error:
            raise WriteError(self.path, f"cannot be written: {error.strerror}") from error
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

    Raises
    ------
    ReadError
        It is not a journal, or holds no row.
    WriteError
        The Parquet file exists.
    MissingDependencyError
        pyarrow is not installed; the journal stays, and `kineme.read` reads it.
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
