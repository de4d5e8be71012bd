"""Rows on the disk while they come: a CSV that only grows, and a Parquet file at the end.

``take.parquet`` is ``take.journal.csv`` before it is complete. Rows are with the system as soon as
they are written, so a program that is killed loses none but those of its last moment; what is
written of the last line is left out when the journal is recovered.
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
"""Pieces of a source that are written before they are taken, at most."""
SYNCHRONISED_S = 0.5
"""Seconds after which rows are on the disk, should the machine go down."""


class Journal:
    """A journal that is open for rows; see `recover_journal` for its end.

    Parameters
    ----------
    path : path
        Of the Parquet file that it becomes, with or without the suffix.
    channels : sequence of str
    fps : float
        Rows without a time are this far apart.

    Raises
    ------
    WriteError
        There is a file of that name, or a journal that was not recovered.
    """

    def __init__(self, path: str | os.PathLike[str], channels: Sequence[str], fps: float) -> None:
        self.target = Path(path).with_suffix(".parquet")
        self.path = self.target.with_suffix(SUFFIX)
        self._fps, self._n_rows, self._synchronised = fps, 0, monotonic()
        if self.target.exists():
            raise WriteError(self.target, "is there already: give another name")
        refuse_link(self.path)
        try:
            self._file = self.path.open("x", encoding="utf-8", newline="")
        except FileExistsError as error:
            advice = f"was left by a run that ended early: kineme live --recover {self.path}"
            raise WriteError(self.path, advice) from error
        except OSError as error:
            raise WriteError(self.path, f"cannot be written: {error.strerror}") from error
        self._writer = csv.writer(self._file)
        self._writer.writerow([TIME, *channels])
        self._file.flush()

    def write(self, rows: Floats, seconds: Floats | None = None) -> None:
        """Append rows; without seconds they are at the frames that follow.

        Raises WriteError where the disk is full.
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
        """Append the rows of a source as soon as they come, however late they are taken."""
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
        """End the journal; return the Parquet file that it became."""
        self._file.close()
        return recover_journal(self.path)


def recover_journal(path: str | os.PathLike[str]) -> Path:
    """Make a Parquet file of the whole lines of a journal, and remove the journal.

    Raises
    ------
    ReadError
        It is no journal, or holds no row.
    WriteError
        The Parquet file is there already.
    MissingDependencyError
        pyarrow is not installed; the journal stays, and `kineme.read` reads it.
    """
    journal = Path(path)
    if not journal.name.endswith(SUFFIX):
        raise ReadError(journal, f"is no journal: its name would end in {SUFFIX}")
    target = journal.with_name(journal.name.removesuffix(SUFFIX) + ".parquet")
    if target.exists():
        raise WriteError(target, "is there already: move it away first")
    with require_extra("pyarrow", "tables"):
        import pyarrow as pa
        from pyarrow import csv as arrow_csv
        from pyarrow import parquet
    with translate_read_errors(journal):
        _cut_last_line(journal)
        with journal.open(encoding="utf-8", newline="") as file:
            names = next(csv.reader(file), [])
        if names[:1] != [TIME]:
            raise ReadError(journal, f"is no journal: its first column would be {TIME}")
        # by their types, as those of empty columns cannot be told
        convert = arrow_csv.ConvertOptions(column_types=dict.fromkeys(names, pa.float64()))
        # piece by piece: the rows of a day need not be in memory
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
    """Remove what follows the last end of a line."""
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
