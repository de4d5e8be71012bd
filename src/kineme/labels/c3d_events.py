"""Events of C3D files as labels: each lasts until the next one.

An event is a point in time, such as ``Right Foot Strike``; a label is a span. The
events wanted (all, or those of some names) cut the recording: a span is
called after the event that starts it, what comes before the first is called
nothing. Of events at the same frame the last one counts.

`kineme.read_segments` takes all events; of a gait, `read_events` with ``names=["Right Foot
Strike"]`` makes each cycle of the right leg one span.
"""

from __future__ import annotations

from collections.abc import Collection
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING

from kineme.errors import ReadError
from kineme.labels.label_format import LabelFormat
from kineme.labels.spans import Labels, Span, as_segmentation
from kineme.segments.segmentation import Segmentation

if TYPE_CHECKING:
    from kineme.formats.markers.c3d_file import C3D


def read_events(path: str | PathLike[str], *, names: Collection[str] | None = None) -> Segmentation:
    """The spans between events as activities, each called after the event that starts it.

    Parameters
    ----------
    path : path-like
        A C3D file.
    names : collection of str, optional
        Of the events that cut; all by default.

    Returns
    -------
    Segmentation
        At the rate and length of the recording; what comes before the first event is a
        transition.

    Raises
    ------
    ReadError
        No C3D file, no events in it, or none of these names.

    Examples
    --------
    The gait cycles of the right leg:

        cycles = read_events("gait.c3d", names=["Right Foot Strike"])
    """
    return as_segmentation(read(Path(path), names), Path(path), FORMAT.name)[0]


def read(path: Path, names: Collection[str] | None = None) -> Labels:
    """The spans between the events of a C3D file, in seconds from its first frame."""
    from kineme.formats.files import load
    from kineme.formats.markers.c3d_file import parse_c3d

    file = parse_c3d(load(path))
    length = _seconds(file)
    if not length:
        raise ReadError(path, "has no frame rate, which the times of events need")
    inside = [(at, name) for at, name in file.events if 0 <= at < length]
    if not inside:
        raise ReadError(path, "has no events")
    present = sorted({name for _, name in inside})
    for name in names or ():
        if name not in present:
            raise ReadError(path, f"has no event {name!r}; there are {', '.join(present)}")
    frames = {round(at * file.rate): name for at, name in inside if not names or name in names}
    starts = sorted(frames)
    stops = [*starts[1:], len(file.points)]
    spans = [
        Span(start / file.rate, stop / file.rate, frames[start])
        for start, stop in zip(starts, stops, strict=True)
        if start < stop
    ]
    return Labels(spans, "seconds", file.rate, length)


def _seconds(file: C3D) -> float:
    return len(file.points) / file.rate if file.rate else 0.0


FORMAT = LabelFormat(
    name="c3d",
    help="Events of a C3D file, read only",
    suffixes=(".c3d",),
    holds="level",
    read=read,
    recognises=lambda _: False,  # it is a recording first of all
)
