"""Audacity labels: per line the start, the stop and the text, seconds, tabs between.

One level; no frame rate, no length. A label whose start is its stop is a
point, which is no segment. Lines that begin with a backslash (the frequencies
of a spectral selection) are skipped.

Source: https://manual.audacityteam.org/man/importing_and_exporting_labels.html
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from kineme._util.files import atomic_write
from kineme.errors import ReadError
from kineme.labels.delimited import head, number
from kineme.labels.registry import LabelFormat
from kineme.labels.spans import Labels, Span, text_of
from kineme.segments.segmentation import Segmentation
from kineme.segments.table import Segment


def write(rows: Sequence[Segment], _: Segmentation, path: Path) -> None:
    """Leave one line per row at ``path``."""
    lines = (f"{row.start_s!r}\t{row.stop_s!r}\t{text_of(row)}\n" for row in rows)
    with atomic_write(path) as draft, draft.open("w", encoding="utf-8", newline="\n") as file:
        file.writelines(lines)


def read(path: Path) -> Labels:
    """Return the labels at ``path``."""
    spans = []
    with path.open(encoding="utf-8-sig", newline="\n") as file:
        for line, text in enumerate(file, 1):
            cells = text.rstrip("\r\n").split("\t", 2)
            if cells == [""] or cells[0].startswith("\\"):
                continue
            if len(cells) < 2:
                raise ReadError(path, "a label is a start, a stop and a text with tabs", line=line)
            start = number(cells[0], "the start", path, line)
            stop = number(cells[1], "the stop", path, line)
            spans.append(Span(start, stop, cells[2] if len(cells) > 2 else ""))
    return Labels(spans)


def _recognises(path: Path) -> bool:
    """Return whether the first label has two times with a tab between."""
    for line in head(path).decode(errors="replace").splitlines():
        cells = line.split("\t", 2)
        if cells != [""] and not cells[0].startswith("\\"):
            return len(cells) > 1
    return False


FORMAT = LabelFormat(
    name="audacity",
    help="Audacity label track, one level",
    suffixes=(".txt",),
    holds="level",
    read=read,
    write=write,
    recognises=_recognises,
)
