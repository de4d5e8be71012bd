"""Declare how a device lays out its table: the line of names, the clock, the rate, the counters.

A device is one module that ends in one `Dialect`. Its ``layout`` is a `Layout`, or a function from
table to table where patterns do not say it all. Patterns are those of `re`, and begin where the
line or name begins.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from itertools import islice

from kineme.formats.delimited import DelimitedText, cells_of, named, separator_of
from kineme.formats.sniffing import HIGHEST, SEPARATOR, head_cells, is_row, passed_over

Recognise = Callable[[Sequence[str], Sequence[str]], bool]


def begins_with(pattern: str, *, within: int = 1) -> Recognise:
    """Return a test of whether one of the first lines of a file begins as a pattern.

    Blank lines and the ``sep=;`` of spreadsheets do not count.

    Examples
    --------
    >>> begins_with("DeviceTag:")([], ["sep=,", "DeviceTag:,left"])
    True
    """
    compiled = re.compile(pattern)

    def recognises(_: Sequence[str], lines: Sequence[str]) -> bool:
        first = (line for line in lines if line.strip() and not SEPARATOR.fullmatch(line))
        return any(map(compiled.match, islice(first, within)))

    return recognises


@dataclass(frozen=True)
class Layout:
    r"""Where a device's table stands in its file, and what the columns are.

    Parameters
    ----------
    head : str
        Pattern of the line of names, or of the first row. By default it is the first line.
    names : sequence of str
        Of the columns, where a row stands in place of the line of names.
    words : int
        Lines between names and rows. The last one has the units.
    clocks : mapping of str to str
        From patterns of the column of times to its unit, "" for dates. The first that fits counts.
    rate : str
        Pattern of the frame rate, its group, anywhere in the lines above the names.
    hidden : str
        Pattern of columns that are channels only where they are asked for, such as counters.

    Examples
    --------
    >>> from pathlib import Path
    >>> from kineme.formats.files import FileContent
    >>> from kineme.formats.sniffing import sniff
    >>> watch = Layout(head="t,", clocks={"t": "ms"}, rate=r"at (\d+) Hz", hidden="battery")
    >>> text = sniff(FileContent(Path("a.csv"), b"MyWatch at 50 Hz\nt,x,battery\n0,1.5,99\n"))
    >>> table = watch(text)
    >>> table.rate, table.times, table.numeric()
    (50.0, {'t': 'time (ms)'}, ['t', 'x'])
    """

    head: str = ""
    names: Sequence[str] = ()
    words: int = 0
    clocks: Mapping[str, str] = field(default_factory=dict)
    rate: str = ""
    hidden: str = ""

    def __call__(self, text: DelimitedText) -> DelimitedText:
        """Return the table in the lines of a file; ReadError where its head is not there."""
        lines = text.lines
        first = (
            i
            for i, line in enumerate(islice(lines, HIGHEST))
            if line.strip() and not SEPARATOR.fullmatch(line) and re.match(self.head, line)
        )
        head = next(first, None)
        if head is None:
            raise text.content.error("has no line of names where its device writes one")
        separator = separator_of(lines[head])
        cells = cells_of(lines[head], separator)
        passed = sum(
            bool(line.strip()) and line[0] != "#" and not SEPARATOR.fullmatch(line)
            for line in lines[:head]
        )
        has_names = not (self.names and is_row(cells))
        below = head + 1 + self.words if has_names else head
        if has_names:
            row = next(filter(str.strip, islice(lines, below, None)), "")
            cells = head_cells(text.content, lines[head].rstrip(f"{separator} "), row, separator)
        else:
            # a row may end in one more separator than it has cells
            width = len(cells) - (not cells[-1] and len(cells) > len(self.names))
            cells = [*self.names, *map(str, range(len(self.names) + 1, width + 1))][:width]
        names = named(cells)
        clocks = self._clocks(names)
        hidden = {name for name in names if self.hidden and re.fullmatch(self.hidden, name)}
        return replace(
            text,
            names=names,
            head=head,
            below=below,
            separator=separator,
            headless=False,
            blanks=False,
            units=cells_of(lines[below - 1], separator) if self.words and has_names else (),
            rate=self._rate(lines[:head]),
            notes=(*passed_over(passed, "names" if has_names else "rows"),),
            hidden=frozenset(hidden - clocks.keys()),
            clocks=clocks,
        )

    def _clocks(self, names: Sequence[str]) -> dict[str, str]:
        for pattern, unit in self.clocks.items():
            for name in names:
                if re.fullmatch(pattern, name):
                    return {name: unit}
        return {}

    def _rate(self, lines: Sequence[str]) -> float | None:
        matches = (re.search(self.rate, line) for line in lines if self.rate)
        rates = (float(match[1]) for match in matches if match)
        return next((rate for rate in rates if rate > 0), None)
