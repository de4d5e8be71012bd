"""Signals to files: rows of the file that they came from, to the last digit, or their values.

Where the file of a recording still holds what was read, its own rows are written: every
column, channel or not, in the file's format and with its cells untouched. Elsewhere (channels
of a C3D or MAT, arrays, channels that were changed or brought to even times) a CSV is, of
``time`` in seconds and one column per channel, empty in gaps. Where the columns of a file do not
tell the rate that the recording has, as when people gave it, or one row alone tells none, a column
``fps`` does, so that everything that is written is read again as it was.
"""

from __future__ import annotations

import csv
import re
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from io import StringIO
from itertools import islice
from math import isclose
from os import PathLike
from pathlib import Path
from typing import Any

import numpy as np

from kineme._util.checks import require_extra
from kineme._util.files import atomic_write
from kineme.errors import ReadError, WriteError
from kineme.formats.channels.parquet import open_parquet, read_parquet_channels
from kineme.formats.channels.reading import ChannelTable, read_text_channels
from kineme.formats.delimited import as_text, make_unique_names, replace_decimal_comma
from kineme.formats.dialects import find_table
from kineme.formats.files import FileContent, load
from kineme.formats.gaps import mark_spans
from kineme.recordings import Signals
from kineme.recordings.times import RATE, is_rate, is_timing

SEPARATORS = {".csv": ",", ".tsv": "\t"}
TEXT = ("table", "MOT/STO")
PARQUET = "Parquet table"

_ROW_COUNT = re.compile(r"^(\s*(?:nrows\s*=|datarows\s)\s*)\d+", re.IGNORECASE | re.MULTILINE)


def write_signals(
    signals: Signals, path: str | PathLike[str], *, columns: Sequence[str] | None = None
) -> None:
    """Leave signals in a file of their own format, a CSV, TSV or Parquet, whole or not at all.

    Of columns that are given, these alone and those of times.
    """
    target, rows = Path(path), make_rows(signals)
    suffix = target.suffix.lower()
    if columns is None and suffix == rows.suffix:
        rows.write(target)
    elif suffix in SEPARATORS:
        _convert_rows(rows, suffix, columns).write(target)
    elif suffix == ".parquet":
        _ParquetRows.of_values(signals).write(target)
    else:
        suffixes = ", ".join(dict.fromkeys((rows.suffix, *SEPARATORS, ".parquet")))
        original = Path(signals.provenance.path or "").suffix.lower()
        why = ": its own times tell another rate" if suffix and suffix == original else ""
        raise WriteError(
            target, f"signals are written as {suffixes}, not {suffix or 'that'!r}{why}"
        )


def make_rows(signals: Signals, *, shortest: int | None = None) -> Rows:
    """Return the frames of signals as rows of their own file, or of a CSV where these are others.

    ``shortest`` is how many rows are written at once at least; all by default.
    """
    alone = min(signals.n_frames, shortest or signals.n_frames) < 2
    path = signals.provenance.path
    if path is not None and Path(path).is_file():
        content = load(path)
        same = content.digest == signals.provenance.sha256
        table = _find_source_table(content, signals) if same else None
        if table is not None:
            fps = None if not alone and _has_rate(table, content, signals.fps) else signals.fps
            if signals.provenance.format == PARQUET:
                return _ParquetRows.of(content, fps)
            rows = _TextRows.of(content, signals.n_frames)
            return rows if fps is None else _add_rate_column(rows, fps)
    rows = _format_values(signals)
    return _add_rate_column(rows, signals.fps) if alone else rows


@dataclass(frozen=True)
class _TextRows:
    """Lines of a text table as they stand, and the same lines for a csv reader (``records``)."""

    suffix: str
    names: Sequence[str] | None
    head: str
    lines: Sequence[str]
    records: Sequence[str]
    separator: str
    comma: bool = False

    @classmethod
    def of(cls, content: FileContent, n_rows: int) -> _TextRows:
        """Return the first rows of a file, blank lines left out."""
        table = find_table(content).numbered()
        text = (
            content.text
            if content.is_utf16
            else content.data.decode("utf-8", errors="surrogateescape")
        )
        lines = text.splitlines(keepends=True)
        head, below = lines[: table.below], lines[table.below :]
        reader = csv.reader(table.rows, delimiter=table.separator)
        kept: list[str] = []
        start = 0
        for cells in reader:
            if any(map(str.strip, cells)):
                kept.append("".join(below[start : reader.line_num]))
            start = reader.line_num
        numbered = [str(i) for i in range(1, len(table.names) + 1)]
        names = None if table.names == numbered else table.names
        suffix = content.path.suffix.lower()
        return cls(
            suffix, names, "".join(head), kept[:n_rows], table.rows, table.separator, table.comma
        )

    def write(self, path: Path, start: int = 0, stop: int | None = None) -> None:
        """Leave rows [start, stop) in a file of the suffix, whole or not at all."""
        lines = self.lines[start:stop]
        head = _ROW_COUNT.sub(rf"\g<1>{len(lines)}", self.head)
        text = "".join((head, *lines))
        with atomic_write(path) as draft:
            draft.write_bytes(text.encode("utf-8", errors="surrogateescape"))

    def cells(self) -> Iterator[Sequence[str]]:
        """Yield the cells of each row."""
        reader = csv.reader(self.records, delimiter=self.separator)
        full = (cells for cells in reader if any(map(str.strip, cells)))
        as_read = ([*map(replace_decimal_comma, cells)] if self.comma else cells for cells in full)
        return islice(as_read, len(self.lines))


@dataclass(frozen=True)
class _ParquetRows:
    """An Arrow table."""

    names: Sequence[str]
    table: Any
    suffix: str = ".parquet"

    @classmethod
    def of(cls, content: FileContent, fps: float | None) -> _ParquetRows:
        """Return all of a file, with a column of the rate where one is given."""
        table = open_parquet(content).read()
        if fps is not None:
            import pyarrow as pa

            timeless = [name for name in table.column_names if not is_rate(name)]
            rates = pa.array([fps] * table.num_rows, pa.float64())
            table = table.select(timeless).add_column(0, RATE, rates)
        return cls(make_unique_names(table.column_names), table)

    @classmethod
    def of_values(cls, signals: Signals) -> _ParquetRows:
        """Times and channels, null in gaps."""
        with require_extra("pyarrow", "tables"):
            import pyarrow as pa
        missing = mark_spans(signals.gaps, signals.n_frames)
        rate = {RATE: pa.array([signals.fps])} if signals.n_frames < 2 else {}
        columns = {**rate, "time": pa.array(signals.times)} | {
            name: pa.array(values, mask=missing)
            for name, values in zip(signals.names, signals.values.T, strict=True)
        }
        return cls(list(columns), pa.table(columns))

    def write(self, path: Path, start: int = 0, stop: int | None = None) -> None:
        from pyarrow import parquet

        stop = self.table.num_rows if stop is None else stop
        with atomic_write(path) as draft:
            parquet.write_table(self.table.slice(start, stop - start), draft)

    def cells(self) -> Iterator[Sequence[str]]:
        columns = (column.to_pylist() for column in self.table.columns)
        for row in zip(*columns, strict=True):
            yield ["" if cell is None else str(cell) for cell in row]


Rows = _TextRows | _ParquetRows
"""Frames of a recording as rows of a file; ``names`` is None where the file has none."""


def _find_source_table(content: FileContent, signals: Signals) -> ChannelTable | None:
    """Return the table on disk whose rows are the frames of signals, holes aside.

    None for another.
    """
    try:
        if signals.provenance.format == PARQUET:
            table = read_parquet_channels(content, open_parquet(content), signals.names)
        elif signals.provenance.format in TEXT:
            table = read_text_channels(find_table(content), signals.names)
        else:
            return None
    except ReadError:  # channels of other names
        return None
    values = table.values
    if values.shape != signals.values.shape:
        return None
    same = ((values == signals.values) | ~np.isfinite(values)).all()
    return table if same else None


def _has_rate(table: ChannelTable, content: FileContent, fps: float) -> bool:
    """Return whether a table says by itself that it is of this rate."""
    try:
        return isclose(table.timed(content, None).fps, fps)
    except ReadError:
        return False


def _add_rate_column(rows: _TextRows, fps: float) -> _TextRows:
    """Return the cells of rows as a CSV or TSV, below a rate in place of any of their own."""
    numbered = (str(i) for i in range(1, len(next(rows.cells(), ())) + 1))
    names = list(rows.names or numbered)
    at = [i for i, name in enumerate(names) if not is_rate(name)]
    suffix = rows.suffix if rows.suffix in SEPARATORS else ".csv"
    cells = ([repr(float(fps)), *(row[i] for i in at)] for row in rows.cells())
    return _format_rows(suffix, [RATE, *(names[i] for i in at)], cells)


def _format_values(signals: Signals) -> _TextRows:
    """Times and channels as a CSV that reads back to the same numbers."""
    missing = mark_spans(signals.gaps, signals.n_frames)
    empty = [""] * signals.n_channels
    rows = (
        [repr(i / signals.fps), *(empty if gap else map(repr, row))]
        for i, (row, gap) in enumerate(zip(signals.values.tolist(), missing, strict=True))
    )
    return _format_rows(".csv", ["time", *signals.names], rows)


def _convert_rows(rows: Rows, suffix: str, columns: Sequence[str] | None) -> _TextRows:
    """Return same cells between commas or tabs: all of them, or some columns and those of times."""
    names = rows.names
    if columns is None:
        return _format_rows(suffix, names, rows.cells())
    if names is None:
        at = [int(name) - 1 for name in columns]
    else:
        timing = [name for name in names if is_timing(name) and name not in columns]
        at = [names.index(name) for name in (*timing, *columns)]
        names = [names[i] for i in at]
    return _format_rows(suffix, names, ([cells[i] for i in at] for cells in rows.cells()))


def _format_rows(
    suffix: str, names: Sequence[str] | None, rows: Iterable[Sequence[str]]
) -> _TextRows:
    separator = SEPARATORS[suffix]
    head = "" if names is None else _format_line([*map(as_text, names)], separator)
    lines = [_format_line(row, separator) for row in rows]
    return _TextRows(suffix, names, head, lines, lines, separator)


def _format_line(cells: Sequence[str], separator: str) -> str:
    line = StringIO()
    csv.writer(line, delimiter=separator, lineterminator="\n").writerow(cells)
    return line.getvalue()
