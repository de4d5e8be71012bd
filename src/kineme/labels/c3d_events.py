"""Events of C3D files as labels: each lasts until the next one.

An event is a moment, such as ``Right Foot Strike``; a label is a stretch. The
events wanted (all, or those of some names) cut the recording: a stretch is
called after the event that starts it, what comes before the first is called
nothing. Of events at the same frame the last one counts.

`kineme.read_segments` takes all events; of a gait, `read_events` with ``names=["Right Foot
Strike"]`` makes each cycle of the right leg one stretch.
"""

from __future__ import annotations

from collections.abc import Collection
from os import PathLike
from pathlib import Path

from kineme.errors import ReadError
from kineme.formats.files import load
from kineme.formats.markers.c3d_file import C3D, parse_c3d
from kineme.labels.spans import Labels, Span, as_segmentation
from kineme.segments.segmentation import Segmentation


def read_events(path: str | PathLike[str], *, names: Collection[str] | None = None) -> Segmentation:
    """The stretches between events of these names (all by default) as activities.

    Raises
    ------
    ReadError : as `read` does
    """
    return as_segmentation(read(Path(path), names), Path(path), "c3d", fps=None, n_frames=None)


def read(path: Path, names: Collection[str] | None = None) -> Labels:
    """The stretches between the events of a C3D file, in seconds from its first frame.

    Parameters
    ----------
    path : the file
    names : of the events that cut; all by default

    Raises
    ------
    ReadError : no C3D file, no events in it, or none of these names
    """
    file = parse_c3d(load(path))
    length = _seconds(file)
    if not length:
        raise ReadError(path, "has no frame rate, which the times of events need")
    inside = [(at, name) for at, name in file.events if 0 <= at < length]
    if not inside:
        raise ReadError(path, "has no events")
    known = sorted({name for _, name in inside})
    for name in names or ():
        if name not in known:
            raise ReadError(path, f"has no event {name!r}; there are {', '.join(known)}")
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
