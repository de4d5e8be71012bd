"""Read events of C3D files as labels that last until the next event, and write events.

An event is a point in time, such as ``Right Foot Strike``; a label is a span. All events, or
those with given names, cut the recording. A span is named after the event at its start; the part
before the first event has no name. The last of several events in one frame counts.

`kineme.read_segments` uses all events, and the last one lasts to the end. `read_events` with
``names=["Right Foot Strike"]`` makes each gait cycle of the right leg one span; what follows the
last strike is no cycle, hence a transition. `write_events` adds events to a copy of a file.
"""

from __future__ import annotations

import math
from collections.abc import Collection, Iterable, Sequence
from itertools import pairwise
from os import PathLike
from pathlib import Path

from numpy.typing import ArrayLike

from kineme._util.checks import as_floats, as_texts, check_path
from kineme._util.files import atomic_write, translate_read_errors
from kineme.errors import ParameterError, ReadError, WriteError
from kineme.labels.registry import LabelFormat
from kineme.labels.spans import Labels, Span, as_segmentation
from kineme.segments.segmentation import Segmentation

SIDES = ("left", "right", "general")
"""First words of event names that denote the side."""
SAME_S = 0.2
"""Seconds within which two events with one name are the same."""


def read_events(path: str | PathLike[str], *, names: Collection[str] | None = None) -> Segmentation:
    """Return the spans between events as activities, each named after its first event.

    Parameters
    ----------
    path : path-like
        A C3D file.
    names : collection of str, optional
        Names of the events that cut, in upper or lower case; all by default.

    Returns
    -------
    Segmentation
        With rate and length of the recording. The part before the first event is a transition, and
        with ``names`` also the part after the last.

    Raises
    ------
    ParameterError
        ``names`` is not a list of texts.
    ReadError
        Not a C3D file, no events, or none with these names.

    Examples
    --------
    The gait cycles of the right leg:

    >>> from kineme.labels.c3d_events import read_events
    >>> cycles = read_events("gait.c3d", names=["Right Foot Strike"])  # doctest: +SKIP
    """
    texts = None if names is None else as_texts(names, "names of events")
    return as_segmentation(read(Path(path), texts), Path(path), FORMAT.name)[0]


def write_events(
    source: str | PathLike[str],
    path: str | PathLike[str],
    times: ArrayLike,
    names: Iterable[str],
    *,
    subject: str | None = None,
) -> int:
    """Write a copy of a C3D file with events added.

    Parameters
    ----------
    source : path-like
        The C3D file, which is not changed.
    path : path-like
        The copy. Parameters, points and analog samples are copied from the source.
    times : (n,) array
        Seconds from the first frame.
    names : iterable of str
        Name of each event. ``left foot strike`` becomes side and label: ``Left``, ``Foot Strike``.
    subject : str, optional
        Name of their subject, by default the first one in the file.

    Returns
    -------
    int
        Number of events added. Events within 0.2 s of one with the same name (ignoring case) and
        subject in the file are skipped.

    Raises
    ------
    ReadError
        ``source`` is not a C3D file, or has no frame rate.
    ParameterError
        A time is outside the recording, or the numbers of times and names differ.
    WriteError
        ``path`` is ``source``, cannot be written, or there are more than 255 events.

    Examples
    --------
    Foot contacts, found from the markers of the same file:

    >>> import kineme
    >>> from kineme.cycles import foot_events
    >>> from kineme.labels.c3d_events import write_events
    >>> events = foot_events(kineme.read("walk.c3d"))  # doctest: +SKIP
    >>> write_events(
    ...     "walk.c3d", "walk_events.c3d", events.times, events.names
    ... )  # doctest: +SKIP
    """
    from kineme.formats.files import load
    from kineme.formats.markers.c3d_file import parse_c3d
    from kineme.formats.markers.c3d_writer import C3DEvent, add_events

    check_path(path, "write_events")
    seconds = as_floats(times, "times").ravel().tolist()
    texts = as_texts(names, "names of events")
    if len(seconds) != len(texts):
        raise ParameterError(
            f"{len(seconds)} times, but {len(texts)} names: give one name for each time"
        )
    target = Path(path)
    if target.exists() and Path(source).exists() and target.samefile(source):
        raise WriteError(target, "is the recording itself: name another file")
    require_c3d(source)
    if target.suffix.lower() != ".c3d":
        raise WriteError(target, "must end in .c3d")
    with translate_read_errors(source):
        content = load(source)
        file = parse_c3d(content)
    length = len(file.points) / file.rate if file.rate else math.inf
    for at in seconds:
        if not 0 <= at <= length:
            raise ParameterError(
                f"there is no time {at:g} s in the recording, which lasts {length:g} s"
            )
    present = [
        (at, _simplify(name))
        for (at, name), whose in zip(file.events, file.event_subjects, strict=True)
        if not (subject and whose) or subject == whose
    ]
    events = [C3DEvent(at, *_split_side(name), subject or "")
              for at, name in zip(seconds, texts, strict=True)]  # fmt: skip
    added = [
        each
        for each in events
        if not any(
            name == _simplify(f"{each.side} {each.label}") and abs(at - each.seconds) < SAME_S
            for at, name in present
        )
    ]
    with translate_read_errors(source):
        data = add_events(content, added)
    with atomic_write(target) as draft:
        draft.write_bytes(data)
    return len(added)


def _simplify(name: str) -> str:
    """Return a name in lower case with single blanks, for comparisons."""
    return " ".join(name.lower().split())


def _split_side(name: str) -> tuple[str, str]:
    """Split a name into side and label in Vicon's spelling; the side may be empty."""
    side, _, label = " ".join(name.split()).partition(" ")
    if side.lower() not in SIDES or not label:
        return "", " ".join(name.split())
    return side.capitalize(), label.title() if label.islower() else label


def require_c3d(source: str | PathLike[str]) -> None:
    """Raise ReadError unless a file has the suffix of C3D."""
    if Path(source).suffix.lower() != ".c3d":
        raise ReadError(source, "is not a C3D file: events can only be written to a copy of a C3D")


def read(path: Path, names: Sequence[str] | None = None) -> Labels:
    """Read the spans between events of a C3D file, in seconds from its first frame."""
    from kineme.formats.files import load
    from kineme.formats.markers.c3d_file import parse_c3d

    file = parse_c3d(load(path))
    length = len(file.points) / file.rate if file.rate else 0.0
    if not length:
        raise ReadError(path, "has no frame rate, so the times of events are unknown")
    inside = [(at, name) for at, name in file.events if 0 <= at < length]
    if not inside:
        raise ReadError(path, "has no events")
    present = {_simplify(name): name for _, name in sorted(inside)}
    for name in names or ():
        if _simplify(name) not in present:
            listed = ", ".join(sorted(present.values()))
            raise ReadError(path, f"has no event {name!r}; there are {listed}")
    chosen = {*map(_simplify, names)} if names else present.keys()
    # The last of several events in one frame counts.
    frames = {round(at * file.rate): name for at, name in inside if _simplify(name) in chosen}
    borders = sorted(frames)
    if not names:
        borders.append(len(file.points))
    elif len(borders) < 2:
        raise ReadError(path, f"has one event {names[0]!r}, but a span needs two")
    spans = [
        Span(start / file.rate, stop / file.rate, frames[start])
        for start, stop in pairwise(borders)
        if start < stop
    ]
    return Labels(spans, "seconds", file.rate, length)


FORMAT = LabelFormat(
    name="c3d",
    help="Events of a C3D file, read only",
    suffixes=(".c3d",),
    holds="level",
    read=read,
    recognises=lambda _: False,  # C3D files are recordings
)
