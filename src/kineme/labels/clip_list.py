"""Clip lists for motion matching: ``file``, ``start``, ``stop``, ``mirror``, and the text.

A CSV whose rows say which frames of which recording go into the database, stop
excluded, as the list at the head of orangeduck's ``generate_database.py``
does; ``mirror`` is 1 for a clip that is to be mirrored. Written are one level,
unmirrored, with seconds beside the frames and the text as ``label``; clusters
only where there is no label, no scores.

Read are the rows of one file (a mirrored twin of a clip is the clip again).
The frame rate follows from frames and seconds where there are seconds.

Source: https://github.com/orangeduck/Motion-Matching.
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from kineme._util.files import atomic_write
from kineme.errors import ReadError
from kineme.labels.csv_table import roundest_rate
from kineme.labels.delimited import columns, integer, number, read_rows, write_rows
from kineme.labels.registry import LabelFormat
from kineme.labels.spans import Labels, Span, text_of
from kineme.segments.segmentation import Segmentation
from kineme.segments.table import Segment

NEEDED = ("file", "start", "stop")


def write(rows: Sequence[Segment], segmentation: Segmentation, path: Path) -> None:
    """Leave one row per segment at ``path``."""
    source = str((segmentation.provenance.get("input") or {}).get("path") or "")
    file_name = source.encode(errors="backslashreplace").decode()
    with atomic_write(path) as draft, draft.open("w", encoding="utf-8", newline="") as file:
        write_rows(
            file,
            (*NEEDED, "mirror", "start_s", "stop_s", "label"),
            (
                (file_name, r.start_frame, r.stop_frame, 0, r.start_s, r.stop_s, text_of(r))
                for r in rows
            ),
        )


def read(path: Path) -> Labels:
    """Return the clips at ``path``."""
    spans: dict[Span, None] = {}
    sources: dict[str, None] = {}
    seconds: tuple[int, float] | None = None
    with path.open(encoding="utf-8-sig", newline="") as file:
        for line, cells in read_rows(file, path, [NEEDED]):
            start, stop = (integer(cells[name], name, path, line) for name in NEEDED[1:])
            spans[Span(start, stop, cells.get("label", ""))] = None
            sources[cells["file"]] = None
            if cells.get("stop_s"):
                seconds = max(
                    seconds or (0, 0.0), (stop, number(cells["stop_s"], "stop_s", path, line))
                )
    if len(sources) > 1:
        names = ", ".join(sources)
        raise ReadError(path, f"lists clips of {len(sources)} files ({names:.100}): keep one")
    rate = roundest_rate(*seconds) if seconds and min(seconds) > 0 else None
    return Labels(list(spans), "frames", rate)


FORMAT = LabelFormat(
    name="clips",
    help="Clip list for motion matching, one level",
    suffixes=(".csv",),
    holds="level",
    read=read,
    write=write,
    recognises=lambda path: set(NEEDED) <= columns(path),
)
