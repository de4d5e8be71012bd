"""Describe the layout of a device's table: line of names, clock, rate, counters.

`kineme.formats.devices.layouts` holds the devices that a `Layout` describes. Others have a module
with a function from table to table, or their own reader. Both are listed in
`kineme.formats.dialects`.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import islice

from kineme.formats.delimited import DelimitedText, find_separator, make_unique_names
from kineme.formats.sniffing import (
    MAX_HEADER_LINES,
    SEPARATOR,
    is_row,
    is_text_line,
    note_skipped_lines,
    split_head,
)

Recognise = Callable[[Sequence[str], Sequence[str]], bool]


def begins_with(pattern: str, *, within: int = 1) -> Recognise:
    """Return a test of whether one of the first lines of a file starts with a pattern.

    Blank lines and the ``sep=;`` of spreadsheets do not count.

    Examples
    --------
    >>> begins_with("DeviceTag:")([], ["sep=,", "DeviceTag:,left"])
    True
    """
    compiled = re.compile(pattern)

    def recognises(_: Sequence[str], lines: Sequence[str]) -> bool:
        full = (line for line in lines if line.strip() and not SEPARATOR.fullmatch(line))
        return any(map(compiled.match, islice(full, within)))

    return recognises


@dataclass(frozen=True)
class Layout:
    r"""The position of a device's table in its file, and the meaning of its columns.

    Parameters
    ----------
    head : str
        Pattern at the start of the line of names or the first row; by default the first line.
    names : sequence of str
        Names of the columns, if the file has no line of names.
    words : int
        Number of lines between names and rows, such as units.
    clocks : mapping of str to str
        Patterns of the name of the column of times, and its unit ("" for dates). The first pattern
        that matches a column is used.
    rate : str
        Pattern whose group is the frame rate, searched in the lines above the names.
    hidden : str
        Pattern of names of columns that are channels only if requested, such as counters.

    Examples
    --------
    >>> from pathlib import Path
    >>> from kineme.formats.files import FileContent
    >>> from kineme.formats.sniffing import sniff
    >>> watch = Layout(head="t,", clocks={"t": "ms"}, rate=r"at (\d+) Hz", hidden="battery")
    >>> text = sniff(FileContent(Path("a.csv"), b"MyWatch at 50 Hz\nt,x,battery\n0,1.5,99\n"))
    >>> table = watch(text)
    >>> table.rate, table.times, table.find_numeric_columns()
    (50.0, {'t': 'time (ms)'}, ['t', 'x'])
    """

    head: str = ""
    names: Sequence[str] = ()
    words: int = 0
    clocks: Mapping[str, str] = field(default_factory=dict)
    rate: str = ""
    hidden: str = ""

    def __call__(self, text: DelimitedText) -> DelimitedText:
        """Return the table in the lines of a file; raise ReadError if its head is missing."""
        lines, head = text.lines, self._find_head(text)
        separator = find_separator(lines[head])
        # Names and rows may end with an additional separator.
        cells = split_head(text.content, lines[head].rstrip(f"{separator} "), "", separator)
        first_row = head + 1 + self.words
        # Without a line of names the first row is in its place.
        if has_no_names := bool(self.names) and is_row(cells):
            numbered = map(str, range(len(self.names) + 1, len(cells) + 1))
            cells, first_row = [*self.names, *numbered][: len(cells)], head
        names = make_unique_names(cells)
        clocks = self._find_clock(names)
        hidden = {name for name in names if self.hidden and re.fullmatch(self.hidden, name)}
        n_skipped = sum(map(is_text_line, lines[:head]))
        return DelimitedText(
            text.content,
            lines,
            names,
            head=head,
            first_row=first_row,
            separator=separator,
            rate=self._find_rate(lines[:head]),
            notes=note_skipped_lines(n_skipped, "rows" if has_no_names else "names"),
            hidden=frozenset(hidden - clocks.keys()),
            clocks=clocks,
        )

    def _find_head(self, text: DelimitedText) -> int:
        for i, line in enumerate(islice(text.lines, MAX_HEADER_LINES)):
            if line.strip() and not SEPARATOR.fullmatch(line) and re.match(self.head, line):
                return i
        raise text.content.error("has no line of column names where this device writes it")

    def _find_clock(self, names: Sequence[str]) -> dict[str, str]:
        """Return the column of times with its unit, as one entry; empty if there is none."""
        matches = (
            {name: unit}
            for pattern, unit in self.clocks.items()
            for name in names
            if re.fullmatch(pattern, name)
        )
        return next(matches, {})

    def _find_rate(self, lines: Sequence[str]) -> float | None:
        matches = (re.search(self.rate, line) for line in lines if self.rate)
        rates = (float(match[1]) for match in matches if match)
        return next((rate for rate in rates if rate > 0), None)
