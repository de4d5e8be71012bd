"""Spans with a text each: what label formats hold, and the way there and back.

A segment becomes one text: its label; without one ``transition``, ``cluster 3``
or ``activity``, on either level. A text that is read is taken for what those words say, any
other for the label of an activity. So a labelled segment loses its cluster, a
labelled transition its kind, and every segment its confidence, but where the format
has columns for them.

Reading tiles: what no span covers is a transition. Spans of one level must not
overlap; those shorter than a frame are left out with a warning. Seconds become
the nearest frame, which gives back the very frames that were written.

Seconds may be those of a clock (`convert_clock_times`). A recording that pauses has fewer seconds
than its clock, and one that begins at half past nine has none of those that its clock shows. People
label by the clock: of the time column, of the day, since 1970. They may also be counted from the
first frame, pauses included, or without pauses, as the package's own tables do. That by which most
of their time lies in the recording is taken, and a note says so. Labels that meet nothing are left
out by name.
"""

from __future__ import annotations

import math
import re
import unicodedata
from bisect import bisect_left, bisect_right
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from pathlib import Path
from typing import Any, Literal, NamedTuple

import numpy as np

from kineme._util.arrays import Floats
from kineme._util.checks import format_count
from kineme.errors import ParameterError, ReadError
from kineme.recordings.clock import Clock
from kineme.segments.segmentation import Segmentation
from kineme.segments.table import Kind, Level, Segment, choose_kind

TOO_FAR = 2**53
"""Frames from which a float cannot tell neighbours apart."""
COLUMNS = ("level", "kind", "start_frame", "stop_frame", "cluster", "label", "confidence")

Row = tuple[Level, Kind, int, int, int, str, float]


class Span(NamedTuple):
    """From ``start`` to ``stop``, in the unit of its `Labels`, something was called ``text``.

    Examples
    --------
    >>> Span(1.5, 4.0, "walk").level
    'activity'
    """

    start: float
    stop: float
    text: str
    level: Level = "activity"
    cluster: int = -1
    confidence: float = math.nan
    repetitions: int | None = None


@dataclass(frozen=True)
class Labels:
    """What a file holds, and what it says about the recording; None where it is silent.

    Parameters
    ----------
    spans : sequence of Span
        In any order; a stop is where the next span may start.
    unit : {"seconds", "frames"}
        Of starts, stops and length.
    fps : float, optional
        Frames per second of the recording.
    length : float, optional
        Of the recording.
    notes : tuple of str
        What is worth a warning, such as labels that had to be joined.
    remarks : tuple of str
        What was inferred, for the provenance alone.

    Examples
    --------
    >>> labels = Labels([Span(0, 4, "walk"), Span(5, 9, "run")], fps=30, length=10)
    >>> [span.text for span in labels.spans]
    ['walk', 'run']
    """

    spans: Sequence[Span]
    unit: Literal["seconds", "frames"] = "seconds"
    fps: float | None = None
    length: float | None = None
    notes: tuple[str, ...] = ()
    remarks: tuple[str, ...] = ()


def format_text(row: Segment) -> str:
    """Return the text of a segment: its label, or what else tells it from others."""
    if row.label or row.kind == "transition":
        return row.label or "transition"
    return f"cluster {row.cluster}" if row.cluster >= 0 else "activity"


def parse_text(text: str) -> tuple[Kind, int, str]:
    """Kind, on the activity level, cluster and label of a text: the inverse of `format_text`."""
    if text == "transition":
        return "transition", -1, ""
    if text in ("activity", ""):
        return "activity", -1, ""
    cluster = re.fullmatch(r"cluster[ _]([0-9]{1,9})", text)
    return ("activity", int(cluster[1]), "") if cluster else ("activity", -1, text)


def as_segmentation(
    labels: Labels, path: Path, name: str, *, fps: float | None = None, n_frames: int | None = None
) -> tuple[Segmentation, tuple[str, ...]]:
    """Return the segmentation that labels speak of, and sentences on what of it is worth a warning.

    What no label covers is a transition. Where all spans are of the primitive level they become
    activities, which every segmentation has; the provenance has the level, ``["labels"]["level"]``.
    Counts of repetitions, where the labels have some, are kept there, too,
    ``["labels"]["counts"]``: one per row of the activity level, or None.
    """
    if not labels.spans:
        recording = f" of this recording ({'; '.join(labels.notes)})" if labels.notes else ""
        raise ReadError(path, f"has no labels{recording}")
    rate = fps or labels.fps
    if rate is None:
        raise ReadError(
            path, f"{name} does not tell the frame rate of the recording: give fps (--fps)"
        )
    if not 0 < rate < math.inf:
        raise ReadError(path, f"the frame rate must be a positive number, not {rate}")
    per_unit = rate if labels.unit == "seconds" else 1.0
    rows = [_make_row(span, per_unit, path) for span in labels.spans]
    last = max(row[3] for row in rows)
    notes = [*labels.remarks]
    if n_frames is None and labels.length is not None:
        n_frames = max(last, _to_frame(labels.length, per_unit, path))
    elif n_frames is None:
        n_frames, frames = last, format_count(last, "frame")
        notes.append(f"length of {frames} taken from the end of the last label")
    elif last > n_frames + 1:  # 1: some programs close with the frame after the last
        raise ReadError(
            path,
            f"has labels up to frame {last}, {last / rate:.3f} s, but the recording has "
            f"{n_frames}, {n_frames / rate:.3f} s",
        )
    if n_frames < 1:
        raise ReadError(path, f"has no label that lasts a frame at {rate:g} frames per second")
    unusual = list(labels.notes)
    # Cut off at the end of the recording, without those of which no frame is left.
    inside: list[Row] = [(*row[:3], min(row[3], n_frames), *row[4:]) for row in rows]
    full = [row for row in inside if row[2] < row[3]]
    if len(full) < len(rows):
        short = format_count(len(rows) - len(full), "label")
        unusual.append(f"shorter than a frame, left out: {short}")
    tiled = _fill_levels(full, n_frames, path)
    source: dict[str, Any] = {"path": str(path), "format": name}
    level = "activity" if any(row[0] == "activity" for row in full) else "primitive"
    if level == "primitive":
        source["level"] = level
    # By first frame, which tells rows of a level apart.
    counts = {
        row[2]: span.repetitions
        for row, span in zip(rows, labels.spans, strict=True)
        if row[0] == level and row[2] < row[3]
    }
    if any(count is not None for count in counts.values()):
        source["counts"] = [counts.get(row[2]) for row in tiled if row[0] == "activity"]
    try:
        segmentation = Segmentation.from_columns(
            dict(zip(COLUMNS, zip(*tiled, strict=True), strict=True)),
            n_frames=n_frames,
            fps=rate,
            provenance={"labels": source, "notes": [*notes, *unusual]},
        )
    except ParameterError as error:
        raise ReadError(path, str(error)) from error
    return segmentation, tuple(unusual)


def join_lines(text: str) -> str:
    """Return the text with a blank for all that a label may not hold: tabs, line ends, controls."""
    if text.isprintable():
        return text
    bad = ("Cc", "Cs", "Zl", "Zp")
    return "".join(" " if unicodedata.category(letter) in bad else letter for letter in text)


def _make_row(span: Span, per_unit: float, path: Path) -> Row:
    """Return a row of the table, with frames for the unit of the file."""
    start, stop = _to_frame(span.start, per_unit, path), _to_frame(span.stop, per_unit, path)
    if stop < start:
        raise ReadError(path, f"{span.text!r:.60} stops at {span.stop}, before {span.start}")
    kind, cluster, label = parse_text(join_lines(span.text))
    kind = choose_kind(span.level, transition=kind == "transition")
    return span.level, kind, start, stop, max(cluster, span.cluster), label, span.confidence


def _to_frame(value: float, per_unit: float, path: Path) -> int:
    frame = value * per_unit
    # A start may round down to frame 0.
    if not -0.5 <= frame < TOO_FAR:
        raise ReadError(path, f"has a label at {value}, which no recording reaches")
    return math.floor(frame + 0.5)


def _fill_levels(full: list[Row], n_frames: int, path: Path) -> list[Row]:
    """Return the rows of each level, gaps between them filled but not across an activity's end."""
    if all(row[0] == "primitive" for row in full):
        activity: Level = "activity"
        full = [
            (activity, choose_kind(activity, transition=row[1] == "transition"), *row[2:])
            for row in full
        ]
    inner = [row for row in full if row[0] == "primitive"]
    tiled = list(_fill_between([row for row in full if row[0] == "activity"], n_frames, [], path))
    if inner:
        tiled += _fill_between(inner, n_frames, [row[2] for row in tiled], path)
    return tiled


def _fill_between(rows: list[Row], n_frames: int, borders: list[int], path: Path) -> Iterator[Row]:
    """Yield the rows of one level in time order, and transitions where there are none."""
    at = 0
    level = rows[0][0] if rows else "activity"
    for row in sorted(rows, key=lambda row: row[2:4]):
        if row[2] < at:
            raise ReadError(
                path,
                f"{row[5]!r:.60} starts at frame {row[2]}, before the label ahead of it stops "
                f"({at}): labels of one level may touch but not overlap",
            )
        yield from _make_gap(level, at, row[2], borders)
        yield row
        at = row[3]
    yield from _make_gap(level, at, n_frames, borders)


def _make_gap(level: Level, start: int, stop: int, borders: list[int]) -> Iterator[Row]:
    # Borders strictly inside of the gap: a transition must not cross an activity's end.
    inside = borders[bisect_right(borders, start) : bisect_left(borders, stop)]
    for left, right in pairwise([start, *inside, stop]):
        if left < right:
            yield level, "transition", left, right, -1, "", math.nan


NAMED = 4
"""Labels that a note names before it only counts."""


def convert_clock_times(labels: Labels, clock: Clock | None, *, length_s: float) -> Labels:
    """Return the labels in seconds of the recording, and notes on how they were taken.

    Examples
    --------
    >>> labels = Labels([Span(50, 60, "walk"), Span(100, 130, "rest"), Span(660, 700, "run")])
    >>> found = convert_clock_times(labels, Clock([0, 60], [0, 660]), length_s=120)
    >>> [span[:3] for span in found.spans]
    [(50.0, 60.0, 'walk'), (60.0, 100.0, 'run')]
    >>> found.notes
    ("meeting no frame, left out: 'rest' 100 to 130 s",)
    """
    if clock is None or labels.unit != "seconds" or not labels.spans:
        return labels
    times = np.array([span[:2] for span in labels.spans], np.float64)
    seconds, remarks = _convert_seconds(times, clock, length_s)
    # A label may begin before the recording.
    begin, end = np.maximum(seconds[:, 0], 0.0), seconds[:, 1]
    # Labels that run backwards are kept, so that they are refused by name later.
    backward = times[:, 1] < times[:, 0]
    meets = backward | ((begin < np.minimum(end, length_s)) & (end > 0))
    placed = [
        span._replace(start=float(a), stop=float(b))
        for span, a, b in zip(labels.spans, begin, end, strict=True)
    ]
    lost = [span for span, kept in zip(labels.spans, meets, strict=True) if not kept]
    notes = (*labels.notes, *note_lost_labels(lost, "s"))
    spans = [span for span, kept in zip(placed, meets, strict=True) if kept]
    return replace(
        labels, spans=spans, length=None, notes=notes, remarks=(*labels.remarks, *remarks)
    )


def note_lost_labels(spans: Sequence[Span], unit: str) -> tuple[str, ...]:
    """Return a note that names the labels which no frame has; none where there are none."""
    if not spans:
        return ()
    named = [f"{span.text!r:.60} {span.start:.10g} to {span.stop:.10g} {unit}" for span in spans]
    more = f" and {len(spans) - NAMED} more" if len(spans) > NAMED else ""
    return (f"meeting no frame, left out: {', '.join(named[:NAMED])}{more}",)


def _convert_seconds(
    times: Floats, clock: Clock, length_s: float
) -> tuple[Floats, tuple[str, ...]]:
    """Return the seconds of starts and stops, and a note unless they are the clock's own."""
    first = f"times counted from the first frame, at which the clock shows {clock.shown(0.0)}"
    answers: list[tuple[Floats, tuple[str, ...]]] = [
        (clock.second(times), ()),
        (clock.since_first().second(times), (first,)),
        (times, ("times taken as frames over the rate, without pauses",)),
    ]

    def shared_s(answer: tuple[Floats, tuple[str, ...]]) -> float:
        # The parts of labels that lie in the recording, to the millisecond.
        inside = np.clip(answer[0], 0.0, length_s)
        return round(float(np.maximum(inside[:, 1] - inside[:, 0], 0.0).sum()), 3)

    return max(answers, key=shared_s)
