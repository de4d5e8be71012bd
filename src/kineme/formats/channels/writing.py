"""Write signals to files: as rows copied from their source file, or as formatted values.

If the source file still holds the signals, its rows are copied: all columns, including those that
are no channels, in the file's format and unchanged. Otherwise (channels of a C3D or MAT, arrays,
changed or resampled channels) a CSV is written with ``time`` in seconds and one column per channel,
empty in gaps. If the columns do not define the recording's rate, because the user gave it or there
is only one row, a column ``fps`` is added. Files therefore read back unchanged.
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
from kineme.formats.delimited import as_text, make_unique_names
from kineme.formats.dialects import find_table
from kineme.formats.files import FileContent, load
from kineme.recordings import Signals
from kineme.recordings.arrays import mark_spans
from kineme.recordings.cells import replace_decimal_comma
from kineme.recordings.times import RATE, is_rate, is_timing

SEPARATORS = {".csv": ",", ".tsv": "\t"}
"""Separators of text tables by suffix."""
TEXT = ("table", "MOT/STO")
PARQUET = "Parquet table"

# Number of rows in the header of MOT and STO files, which changes if rows are cut.
_ROW_COUNT = re.compile(r"^(\s*(?:nrows\s*=|datarows\s)\s*)\d+", re.IGNORECASE | re.MULTILINE)


def write_signals(
    signals: Signals, path: str | PathLike[str], *, columns: Sequence[str] | None = None
) -> None:
    """Write signals atomically to their original format, a CSV, TSV or Parquet.

    ``columns`` restricts the output to these columns and those of times.
    """
    target, rows = Path(path), make_rows(signals)
    suffix = target.suffix.lower()
    if columns is None and suffix == rows.suffix:
        rows.write(target)
    elif suffix in SEPARATORS:
        _convert_rows(rows, suffix, columns).write(target)
    elif suffix == ".parquet":
        _ParquetRows.from_values(signals).write(target)
    else:
        suffixes = ", ".join(dict.fromkeys((rows.suffix, *SEPARATORS, ".parquet")))
        original = Path(signals.provenance.path or "").suffix.lower()
        why = ": its own times have another rate" if suffix and suffix == original else ""
        raise WriteError(
            target, f"signals are written as {suffixes}, not {suffix or 'that'!r}{why}"
        )


def make_rows(signals: Signals, *, shortest: int | None = None) -> Rows:
    """Return the frames of signals as rows of their source file, or else as rows of a CSV.

    ``shortest`` is the smallest number of rows written to one file; all by default.
    """
    # A single row has no step between times, so it needs a column of the rate.
    may_be_single = min(signals.n_frames, shortest or signals.n_frames) < 2
    path = signals.provenance.path
    if path is not None and Path(path).is_file():
        content = load(path)
        is_unchanged = content.digest == signals.provenance.sha256
        table = _find_source_table(content, signals) if is_unchanged else None
        if table is not None:
            needs_rate = may_be_single or not _has_rate(table, content, signals.fps)
            fps = signals.fps if needs_rate else None
            if signals.provenance.format == PARQUET:
                return _ParquetRows.from_file(content, fps)
            rows = _TextRows.from_file(content, signals.n_frames)
            return rows if fps is None else _add_rate_column(rows, fps)
    rows = _format_values(signals)
    return _add_rate_column(rows, signals.fps) if may_be_single else rows


@dataclass(frozen=True)
class _TextRows:
    """Unchanged lines of a text table; ``records`` are the same lines for a csv reader."""

    suffix: str
    names: Sequence[str] | None
    head: str
    lines: Sequence[str]
    records: Sequence[str]
    separator: str
    has_decimal_comma: bool = False

    @classmethod
    def from_file(cls, content: FileContent, n_rows: int) -> _TextRows:
        """Return the first rows of a file, without blank lines."""
        table = find_table(content).number_columns()
        # Surrogates keep all bytes of other encodings.
        text = content.text if content.is_utf16 else content.data.decode(errors="surrogateescape")
        lines = text.splitlines(keepends=True)
        head, below = lines[: table.first_row], lines[table.first_row :]
        # A quoted cell may span several lines, which belong to one row.
        reader = csv.reader(table.rows, delimiter=table.separator)
        rows: list[str] = []
        start = 0
        for cells in reader:
            if any(map(str.strip, cells)):
                rows.append("".join(below[start : reader.line_num]))
            start = reader.line_num
        numbered = [str(i) for i in range(1, len(table.names) + 1)]
        names = None if table.names == numbered else table.names
        return cls(
            content.path.suffix.lower(), names, "".join(head), rows[:n_rows], table.rows,
            table.separator, table.has_decimal_comma,
        )  # fmt: skip

    def write(self, path: Path, start: int = 0, stop: int | None = None) -> None:
        """Write rows [start, stop) atomically to a file."""
        lines = self.lines[start:stop]
        head = _ROW_COUNT.sub(rf"\g<1>{len(lines)}", self.head)
        text = "".join((head, *lines))
        with atomic_write(path) as draft:
            draft.write_bytes(text.encode("utf-8", errors="surrogateescape"))

    def cells(self) -> Iterator[Sequence[str]]:
        """Yield the cells of each row."""
        reader = csv.reader(self.records, delimiter=self.separator)
        filled = islice((row for row in reader if any(map(str.strip, row))), len(self.lines))
        for cells in filled:
            yield [*map(replace_decimal_comma, cells)] if self.has_decimal_comma else cells


@dataclass(frozen=True)
class _ParquetRows:
    """Rows of an Arrow table."""

    names: Sequence[str]
    table: Any
    suffix: str = ".parquet"

    @classmethod
    def from_file(cls, content: FileContent, fps: float | None) -> _ParquetRows:
        """Return all rows of a file, with a column of the rate if ``fps`` is given."""
        table = open_parquet(content).read()
        if fps is not None:
            import pyarrow as pa

            names = [name for name in table.column_names if not is_rate(name)]
            rates = pa.array([fps] * table.num_rows, pa.float64())
            table = table.select(names).add_column(0, RATE, rates)
        return cls(make_unique_names(table.column_names), table)

    @classmethod
    def from_values(cls, signals: Signals) -> _ParquetRows:
        """Return times and channels, null in gaps."""
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
"""Frames of a recording as rows of a file; ``names`` is None if the file has no names."""


def _find_source_table(content: FileContent, signals: Signals) -> ChannelTable | None:
    """Return the table in a file if its rows are the frames of the signals, apart from gaps."""
    try:
        if signals.provenance.format == PARQUET:
            table = read_parquet_channels(content, open_parquet(content), signals.names)
        elif signals.provenance.format in TEXT:
            table = read_text_channels(find_table(content), signals.names)
        else:
            return None
    except ReadError:  # the file has other channels
        return None
    values = table.values
    if values.shape != signals.values.shape:
        return None
    # Gaps were filled on reading, so values that are missing in the file may differ.
    is_equal = ((values == signals.values) | ~np.isfinite(values)).all()
    return table if is_equal else None


def _has_rate(table: ChannelTable, content: FileContent, fps: float) -> bool:
    """Return whether a table itself defines this rate."""
    try:
        return isclose(table.find_timing(content, None).fps, fps)
    except ReadError:
        return False


def _add_rate_column(rows: _TextRows, fps: float) -> _TextRows:
    """Return the cells of rows as a CSV or TSV, with a column of the rate instead of their own."""
    numbered = (str(i) for i in range(1, len(next(rows.cells(), ())) + 1))
    names = list(rows.names or numbered)
    indices = [i for i, name in enumerate(names) if not is_rate(name)]
    suffix = rows.suffix if rows.suffix in SEPARATORS else ".csv"
    cells = ([repr(float(fps)), *(row[i] for i in indices)] for row in rows.cells())
    return _format_rows(suffix, [RATE, *(names[i] for i in indices)], cells)


def _format_values(signals: Signals) -> _TextRows:
    """Return times and channels as a CSV that reads back to the same numbers."""
    missing = mark_spans(signals.gaps, signals.n_frames)
    empty = [""] * signals.n_channels
    rows = (
        [repr(i / signals.fps), *(empty if gap else map(repr, row))]
        for i, (row, gap) in enumerate(zip(signals.values.tolist(), missing, strict=True))
    )
    return _format_rows(".csv", ["time", *signals.names], rows)


def _convert_rows(rows: Rows, suffix: str, columns: Sequence[str] | None) -> _TextRows:
    """Return cells separated by commas or tabs: all columns, or some and those of times."""
    names = rows.names
    if columns is None:
        return _format_rows(suffix, names, rows.cells())
    if names is None:
        indices = [int(name) - 1 for name in columns]
    else:
        timing = [name for name in names if is_timing(name) and name not in columns]
        indices = [names.index(name) for name in (*timing, *columns)]
        names = [names[i] for i in indices]
    return _format_rows(suffix, names, ([cells[i] for i in indices] for cells in rows.cells()))


def _format_rows(
    suffix: str, names: Sequence[str] | None, rows: Iterable[Sequence[str]]
) -> _TextRows:
    separator = SEPARATORS[suffix]
    head = "" if names is None else _format_line([*map(as_text, names)], separator)
    lines = [_format_line(row, separator) for row in rows]
    return _TextRows(suffix, names, head=head, lines=lines, records=lines, separator=separator)


def _format_line(cells: Sequence[str], separator: str) -> str:
    line = StringIO()
    csv.writer(line, delimiter=separator, lineterminator="\n").writerow(cells)
    return line.getvalue()
