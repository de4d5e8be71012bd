"""Text tables of channels: where they begin, what parts cells, and which columns are numbers."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

from kineme.formats.channels.table import (
    ChannelTable,
    asked_for,
    channel_table,
    named,
    wanted_columns,
)
from kineme.formats.columns import dated, is_timing
from kineme.formats.delimited import EMPTY, dotted, from_text, rows_of
from kineme.formats.files import FileContent, numbers
from kineme.formats.interleaved import refuse_interleaved
from kineme.formats.keypoints.deeplabcut import is_deeplabcut
from kineme.formats.layout import COMMAS, cells_of, first_full, has_commas, layout_of


@dataclass(frozen=True)
class TextTable:
    """The lines of a text table.

    Parameters
    ----------
    names : list of str
        Of the columns; numbers from 1 where the first line holds numbers and names no time.
    rows : list of str
        The lines below.
    first_row : int
        The number of the first of these in the file.
    separator : str
        Between cells.
    head : list of str
        The cells of the first line, whatever they are.
    notes : tuple of str
        On lines that were passed over, and how numbers are written.
    """

    names: list[str]
    rows: list[str]
    first_row: int
    separator: str
    head: list[str]
    notes: tuple[str, ...] = ()

    @classmethod
    def of(cls, content: FileContent) -> TextTable:
        """The table in a file; ReadError where there is none."""
        lines = content.text.splitlines()
        ended = [i for i, line in enumerate(lines) if line.strip().lower() == "endheader"]
        start = ended[0] + 1 if ended else 0
        layout = layout_of(lines, start)
        if layout is None:
            raise content.error("has no lines of numbers")
        first, below, separator = layout.names, layout.below, layout.separator
        if is_deeplabcut(lines[first]):
            raise content.error("is a DeepLabCut table of joints, which is a motion")
        if ended or separator not in lines[first]:
            lines[first:] = ["\t".join(line.split()) for line in lines[first:]]
            separator = "\t"
        cells = cells_of(lines[first], separator)
        if any(map(_is_number, cells)) and not any(map(is_timing, cells)):
            names, below = [str(i) for i in range(1, len(cells) + 1)], first
        else:
            names = named(map(from_text, cells))
        return cls(names, lines[below:], below + 1, separator, cells, layout.notes)

    @cached_property
    def comma(self) -> bool:
        """Whether its numbers have a decimal comma."""
        return has_commas(self.rows, self.separator)

    def numeric(self) -> list[str]:
        """The columns whose first cell is a number or empty, and those of dates."""
        given = map(dotted, self.first_cells()) if self.comma else self.first_cells()
        cells = list(zip(self.names, given, strict=False))
        dates = {self.names[i] for i in dated(self.names, self.first_cells())}
        return [
            name
            for name, cell in cells
            if cell.lower() in EMPTY or name in dates or _is_number(cell)
        ]

    def first_cells(self) -> list[str]:
        """The cells of the first row that is not blank."""
        row = first_full(self.rows)
        return cells_of(row, self.separator) if row else []


def text_channels(
    content: FileContent, text: TextTable, columns: Sequence[str] | None
) -> ChannelTable:
    """The channels of a text table: those wanted, or all that hold numbers.

    Parameters
    ----------
    content : FileContent
    text : TextTable
        In it.
    columns : sequence of str or None
        By name or pattern, in this order.

    Returns
    -------
    ChannelTable

    Raises
    ------
    ReadError
        There is no such column, a cell is no number, or nothing is a channel.
    """
    refuse_interleaved(content, text.names, text.rows, text.separator)
    columns = asked_for(content, text.names, columns, text.numeric())
    wanted = wanted_columns(columns, text.numeric())
    places = {name: i for i, name in enumerate(text.names)}  # each is there once
    at = [places[name] for name in wanted]
    values = rows_of(
        content,
        text.rows,
        text.first_row,
        text.separator,
        len(text.names),
        at,
        dates=dated(text.names, text.first_cells()),
        comma=text.comma,
    )
    table = channel_table(content, text.names, dict(zip(wanted, values.T, strict=True)), columns)
    commas = (COMMAS,) if text.comma else ()
    return replace(table, notes=(*text.notes, *commas, *table.notes))


def _is_number(cell: str) -> bool:
    try:
        numbers([cell])
    except ValueError:
        return False
    return True
