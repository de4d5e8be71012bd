"""Text tables of channels: where they begin, what parts cells, and which columns are numbers."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from kineme.formats.columns import dated
from kineme.formats.delimited import EMPTY, separator_of
from kineme.formats.files import Source, numbers, unique
from kineme.formats.keypoints.deeplabcut import is_deeplabcut

NAMELESS = "(no name)"
"""What a column is called whose name is empty."""


@dataclass(frozen=True)
class TextTable:
    """The lines of a text table."""

    names: list[str]
    rows: list[str]
    first_row: int
    separator: str

    @classmethod
    def of(cls, source: Source) -> TextTable:
        """The table in a file; ReadError where there is none."""
        lines = source.text.splitlines()
        ended = [i for i, line in enumerate(lines) if line.strip().lower() == "endheader"]
        start = ended[0] + 1 if ended else 0
        starts = (i for i in range(start, len(lines)) if lines[i].strip() and lines[i][0] != "#")
        first = next(starts, None)
        if first is None:
            raise source.error("has no lines of numbers")
        if is_deeplabcut(lines[first]):
            raise source.error("is a DeepLabCut table of joints, which is a motion")
        separator = separator_of(lines[first])
        if ended or separator not in lines[first]:
            lines[first:] = ["\t".join(line.split()) for line in lines[first:]]
            separator = "\t"
        cells = _cells(lines[first], separator)
        if any(map(_is_number, cells)):
            names = [str(i) for i in range(1, len(cells) + 1)]
            return cls(names, lines[first:], first + 1, separator)
        return cls(named(cells), lines[first + 1 :], first + 2, separator)

    def numeric(self) -> list[str]:
        """The columns whose first cell is a number or empty, and those of dates."""
        cells = list(zip(self.names, self.first_cells(), strict=False))
        dates = {self.names[i] for i in dated(self.names, self.first_cells())}
        return [
            name
            for name, cell in cells
            if cell.lower() in EMPTY or name in dates or _is_number(cell)
        ]

    def first_cells(self) -> list[str]:
        """The cells of the first row."""
        return _cells(self.rows[0], self.separator) if self.rows else []


def named(names: Iterable[str]) -> list[str]:
    """The names, each of them once, and none of them empty."""
    return unique(name.strip() or NAMELESS for name in names)


def _cells(line: str, separator: str) -> list[str]:
    return [cell.strip().strip('"').strip() for cell in line.split(separator)]


def _is_number(cell: str) -> bool:
    try:
        numbers([cell])
    except ValueError:
        return False
    return True
