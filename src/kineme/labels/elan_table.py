"""ELAN's tab-delimited text: a line per annotation, or a column per tier.

Without a line of names a line is tier, participant, begin, end and perhaps duration, each in one or
more ways of writing times, and the text last. With one, columns are ``Begin Time - …`` and
``End Time - …``, and then ``Tier`` or one column for each tier. Tiers are chosen as in `.eaf`.

Source: ELAN manual, "Export as tab-delimited text".
"""

from __future__ import annotations

import csv
import re
from collections.abc import Iterator, Sequence
from pathlib import Path

from kineme.errors import ReadError
from kineme.formats.label_tables import is_elan_table
from kineme.labels.delimited import head, number
from kineme.labels.elan import chosen_tiers
from kineme.labels.registry import LabelFormat
from kineme.labels.spans import Labels, Span

_CLOCK = re.compile(r"(\d+):(\d\d):(\d\d\.\d+)")
_TIME = re.compile(r"\d+(?:\.\d+)?|\d+:\d\d:\d\d\.\d+")
_TIMES = re.compile(r"(begin|end) time - (.*)", re.IGNORECASE)
_NO_TIERS = re.compile(
    r"(begin|end) time|duration|tier|participant|annotation|file|$", re.IGNORECASE
)
Annotation = tuple[str, float, float, str]


def read(path: Path) -> Labels:
    """Read the annotations at ``path``."""
    with path.open(encoding="utf-8-sig", newline="") as file:
        rows = list(csv.reader(file, delimiter="\t", quoting=csv.QUOTE_NONE))
    full = [
        (line, row) for line, row in enumerate(rows, 1) if any(row) and not row[0].startswith('"#')
    ]
    if not full:
        return Labels([])
    is_named = any(map(_TIMES.fullmatch, full[0][1]))
    found = list(_read_named_columns(full, path) if is_named else _read_unnamed_columns(full, path))
    levels = chosen_tiers(list(dict.fromkeys(tier for tier, *_ in found)), path)
    return Labels(
        [Span(start, stop, text, levels[t]) for t, start, stop, text in found if t in levels]
    )


def _read_named_columns(rows: Sequence[tuple[int, list[str]]], path: Path) -> Iterator[Annotation]:
    names = rows[0][1]
    times: dict[str, tuple[int, bool]] = {}
    for i, name in enumerate(names):
        if (match := _TIMES.fullmatch(name.strip())) and "hh:mm:ss:ff" not in name.lower():
            times.setdefault(match[1].lower(), (i, match[2].strip().lower() == "msec"))
    if len(times) < 2:
        raise ReadError(path, "has no begin and end of annotations in hh:mm:ss.ms, ss.msec or msec")
    lowered = [name.strip().lower() for name in names]
    tier = lowered.index("tier") if "tier" in lowered else None
    text = lowered.index("annotation") if "annotation" in lowered else len(names) - 1
    tiers = [i for i, name in enumerate(names) if not _NO_TIERS.match(name.strip())]
    for line, cells in rows[1:]:
        row = [*cells, *[""] * (len(names) - len(cells))]
        start, stop = (
            _seconds(row[times[end][0]], path, line, is_ms=times[end][1])
            for end in ("begin", "end")
        )
        if tier is not None:
            yield row[tier], start, stop, row[text]
            continue
        for i in tiers:
            if row[i]:
                yield names[i], start, stop, row[i]


def _read_unnamed_columns(
    rows: Sequence[tuple[int, list[str]]], path: Path
) -> Iterator[Annotation]:
    first = rows[0][1]
    columns = [i for i in range(2, len(first) - 1) if _TIME.fullmatch(first[i])]
    clocks = [i for i in columns if _CLOCK.fullmatch(first[i])]
    # begin and end stand first, each in all ways of writing times that were chosen
    chosen = clocks or columns
    if len(chosen) < 2:
        raise ReadError(path, "has no begin and end of annotations", line=rows[0][0])
    is_ms = not clocks and not any("." in row[i] for _, row in rows for i in chosen[:1])
    for line, row in rows:
        if len(row) <= chosen[1]:
            raise ReadError(path, f"{len(row)} cells, where others have {len(first)}", line=line)
        start, stop = (_seconds(row[i], path, line, is_ms=is_ms) for i in chosen[:2])
        yield row[0], start, stop, row[len(first) - 1] if len(row) >= len(first) else ""


def _seconds(text: str, path: Path, line: int, *, is_ms: bool) -> float:
    if match := _CLOCK.fullmatch(text.strip()):
        return 3600 * int(match[1]) + 60 * int(match[2]) + float(match[3])
    return number(text, "a time", path, line) / (1000 if is_ms else 1)


FORMAT = LabelFormat(
    name="elan-table",
    help="ELAN's tab-delimited text",
    suffixes=(".txt", ".tsv", ".csv"),
    holds="levels",
    read=read,
    recognises=lambda path: is_elan_table(head(path).decode(errors="replace")),
)
