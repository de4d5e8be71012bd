"""Spans with texts, the content of label formats, and conversion to and from segments.

A segment becomes one text: its label, or else ``transition``, ``cluster 3`` or ``activity``, on
either level. Reading interprets these words; any other text is the label of an activity. So a
labelled segment loses its cluster, a labelled transition its kind, and every segment its
confidence, unless the format has columns for them.

Reading fills gaps: frames without a span are transitions. Spans of one level must not overlap;
those shorter than a frame are left out with a warning. Seconds are rounded to the nearest frame,
which restores the frames that were written.

Seconds may be times of a clock (`convert_clock_times`). A paused recording has fewer seconds than
its clock, and a clock may start at half past nine. Label times may be those of the clock (time
column, time of day, since 1970), seconds from the first frame including pauses, or without pauses
as in kineme's own tables. The interpretation by which most labelled time lies in the recording is
used, with a note. Labels outside the recording are left out and listed.
"""

from __future__ import annotations

import math
import re
import unicodedata
from bisect import bisect_left, bisect_right
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from math import isclose
from os import PathLike
from pathlib import Path
from typing import Any, Literal, NamedTuple

import numpy as np

from kineme._util.arrays import Floats
from kineme._util.checks import format_count
from kineme.errors import ParameterError, ReadError
from kineme.labels.delimited import SAME_RATE
from kineme.recordings.times import HOURLESS, HOURS, Clock
from kineme.segments.segmentation import Segmentation
from kineme.segments.table import Kind, Level, Segment, choose_kind

SAME_LENGTH = 0.01
"""Relative difference of numbers of labels and frames that count as equal."""
TOO_FAR = 2**53
"""Frame number from which on a float cannot represent every integer."""
NAMED = 4
"""Number of labels that a note lists; it counts the others."""


class Row(NamedTuple):
    """A row of the segment table, by the names of its columns."""

    level: Level
    kind: Kind
    start_frame: int
    stop_frame: int
    cluster: int
    label: str
    confidence: float


class Span(NamedTuple):
    """A text from ``start`` to ``stop``, in the unit of its `Labels`.

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
    """Content of a label file with facts about the recording; None if unknown.

    Parameters
    ----------
    spans : sequence of Span
        In any order; stops are exclusive.
    unit : {"seconds", "frames"}
        Unit of starts, stops and length.
    fps : float, optional
        Frames per second of the recording.
    length : float, optional
        Length of the recording.
    notes : tuple of str
        Texts for a warning, for example about joined labels.
    remarks : tuple of str
        Inferences, for the provenance only.

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
    """Return the text of a segment: its label, else its kind or cluster."""
    if row.label or row.kind == "transition":
        return row.label or "transition"
    return f"cluster {row.cluster}" if row.cluster >= 0 else "activity"


def parse_text(text: str) -> tuple[Kind, int, str]:
    """Return kind (of an activity), cluster and label of a text; inverse of `format_text`."""
    if text == "transition":
        return "transition", -1, ""
    if text in ("activity", ""):
        return "activity", -1, ""
    cluster = re.fullmatch(r"cluster[ _]([0-9]{1,9})", text)
    return ("activity", int(cluster[1]), "") if cluster else ("activity", -1, text)


def as_segmentation(
    labels: Labels, path: Path, name: str, *, fps: float | None = None, n_frames: int | None = None
) -> tuple[Segmentation, tuple[str, ...]]:
    """Convert labels to a segmentation; return also texts for a warning.

    Frames without a label are transitions. If all spans are primitives, they become activities,
    since every segmentation needs these; ``provenance["labels"]["level"]`` records it. Counts of
    repetitions, if any, go to ``provenance["labels"]["counts"]``: one per activity row, or None.
    """
    if not labels.spans:
        recording = f" of this recording ({'; '.join(labels.notes)})" if labels.notes else ""
        raise ReadError(path, f"has no labels{recording}")
    # Seconds fit any frame rate; numbers of frames only fit the rate of the file.
    first, second = (fps, labels.fps) if labels.unit == "seconds" else (labels.fps, fps)
    rate = first or second
    if rate is None:
        raise ReadError(
            path, f"{name} does not state the frame rate of the recording: give fps (--fps)"
        )
    if not 0 < rate < math.inf:
        raise ReadError(path, f"the frame rate must be a positive number, not {rate}")
    check_frames(labels, path, n_frames)
    per_unit = rate if labels.unit == "seconds" else 1.0
    rows = [_make_row(span, per_unit, path) for span in labels.spans]
    last = max(row.stop_frame for row in rows)
    notes = [*labels.remarks]
    if n_frames is None and labels.length is not None:
        n_frames = max(last, _to_frame(labels.length, per_unit, path))
    elif n_frames is None:
        n_frames, frames = last, format_count(last, "frame")
        notes.append(f"length of {frames} inferred from the end of the last label")
    elif last > n_frames + 1:  # some programs end with the frame after the last
        raise ReadError(
            path,
            f"has labels up to frame {last}, {last / rate:.3f} s, but the recording has "
            f"{n_frames}, {n_frames / rate:.3f} s",
        )
    if n_frames < 1:
        raise ReadError(path, f"has no label of at least one frame at {rate:g} frames per second")
    warnings = list(labels.notes)
    # Cut at the end of the recording, and drop spans without a frame.
    inside = [row._replace(stop_frame=min(row.stop_frame, n_frames)) for row in rows]
    nonempty = [row for row in inside if row.start_frame < row.stop_frame]
    if len(nonempty) < len(rows):
        short = format_count(len(rows) - len(nonempty), "label")
        warnings.append(f"left out, since they are shorter than a frame: {short}")
    tiled = _fill_levels(nonempty, n_frames, path)
    source: dict[str, Any] = {"path": str(path), "format": name}
    level = "activity" if any(row.level == "activity" for row in nonempty) else "primitive"
    if level == "primitive":
        source["level"] = level
    # Keyed by first frame, which is unique within a level.
    counts = {
        row.start_frame: span.repetitions
        for row, span in zip(rows, labels.spans, strict=True)
        if row.level == level and row.start_frame < row.stop_frame
    }
    if any(count is not None for count in counts.values()):
        source["counts"] = [counts.get(row.start_frame) for row in tiled if row.level == "activity"]
    try:
        segmentation = Segmentation.from_columns(
            dict(zip(Row._fields, zip(*tiled, strict=True), strict=True)),
            n_frames=n_frames,
            fps=rate,
            provenance={"labels": source, "notes": [*notes, *warnings]},
        )
    except ParameterError as error:
        raise ReadError(path, str(error)) from error
    return segmentation, tuple(warnings)


def require_one_recording(found: Mapping[str, Labels], path: Path) -> Labels:
    """Return the labels of the only recording of a table; raise ReadError if it has several."""
    if len(found) > 1:
        names = ", ".join(found)
        raise ReadError(
            path,
            f"has labels of {len(found)} recordings ({names:.60}): keep one, or evaluate the "
            "folder of them: kineme evaluate FOLDER --labels TABLE",
        )
    return next(iter(found.values()), Labels([]))


def check_frames(labels: Labels, path: Path, n_frames: int | None) -> None:
    """Raise ReadError if the frames of labels are not those of the recording, as at another rate.

    Public data sets have a few labels more or fewer than frames.
    """
    if labels.unit != "frames" or not labels.length or not n_frames:
        return
    if not isclose(labels.length, n_frames, rel_tol=SAME_LENGTH, abs_tol=2):
        raise ReadError(
            path, f"has labels of {labels.length:g} frames, but the recording has {n_frames}"
        )


def check_extent(
    found: Segmentation, path: str | PathLike[str], *, fps: float | None, n_frames: int | None
) -> Segmentation:
    """Return labels if they have the frame rate and length of the recording, if these are given."""
    if fps is not None and not isclose(found.fps, fps, rel_tol=SAME_RATE):
        raise ReadError(path, f"has {found.fps:g} frames per second, but the recording has {fps:g}")
    if n_frames is not None and found.n_frames != n_frames:
        raise ReadError(path, f"has {found.n_frames} frames, but the recording has {n_frames}")
    return found


def join_lines(text: str) -> str:
    """Replace tabs, line ends and control characters in a label by blanks."""
    if text.isprintable():
        return text
    bad = ("Cc", "Cs", "Zl", "Zp")
    return "".join(" " if unicodedata.category(letter) in bad else letter for letter in text)


def _make_row(span: Span, per_unit: float, path: Path) -> Row:
    """Convert a span to a row of the table, in frames."""
    start, stop = _to_frame(span.start, per_unit, path), _to_frame(span.stop, per_unit, path)
    if stop < start:
        raise ReadError(path, f"{span.text!r:.60} stops at {span.stop}, before {span.start}")
    kind, cluster, label = parse_text(join_lines(span.text))
    kind = choose_kind(span.level, transition=kind == "transition")
    cluster = max(cluster, span.cluster)
    return Row(span.level, kind, start, stop, cluster, label, confidence=span.confidence)


def _to_frame(value: float, per_unit: float, path: Path) -> int:
    frame = value * per_unit
    # A start may round down to frame 0.
    if not -0.5 <= frame < TOO_FAR:
        raise ReadError(path, f"has a label at {value}, which is beyond any recording")
    return math.floor(frame + 0.5)


def _fill_levels(rows: list[Row], n_frames: int, path: Path) -> list[Row]:
    """Return the rows of each level with gaps filled; fillers do not cross activity borders."""
    activities = [row for row in rows if row.level == "activity"]
    primitives = [row for row in rows if row.level == "primitive"]
    if not activities:  # primitives alone become activities
        for row in primitives:
            kind = choose_kind("activity", transition=row.kind == "transition")
            activities.append(row._replace(level="activity", kind=kind))
        primitives = []
    tiled = list(_fill_between(activities, n_frames, [], path))
    if primitives:
        tiled += _fill_between(primitives, n_frames, [row.start_frame for row in tiled], path)
    return tiled


def _fill_between(rows: list[Row], n_frames: int, borders: list[int], path: Path) -> Iterator[Row]:
    """Yield the rows of one level in time order, with transitions between them."""
    at = 0
    level = rows[0].level if rows else "activity"
    for row in sorted(rows, key=lambda row: (row.start_frame, row.stop_frame)):
        if row.start_frame < at:
            raise ReadError(
                path,
                f"{row.label!r:.60} starts at frame {row.start_frame}, before the previous label "
                f"stops ({at}): labels of one level may touch but not overlap",
            )
        yield from _make_gap(level, at, row.start_frame, borders)
        yield row
        at = row.stop_frame
    yield from _make_gap(level, at, n_frames, borders)


def _make_gap(level: Level, start: int, stop: int, borders: list[int]) -> Iterator[Row]:
    """Yield the transitions of a span."""
    # Split at borders strictly inside the gap: transitions must not cross them.
    inside = borders[bisect_right(borders, start) : bisect_left(borders, stop)]
    for left, right in pairwise([start, *inside, stop]):
        if left < right:
            yield Row(level, "transition", left, right, cluster=-1, label="", confidence=math.nan)


def convert_clock_times(labels: Labels, clock: Clock | None, *, length_s: float) -> Labels:
    """Convert labels from clock times to seconds of the recording, with notes.

    Examples
    --------
    >>> labels = Labels([Span(50, 60, "walk"), Span(100, 130, "rest"), Span(660, 700, "run")])
    >>> found = convert_clock_times(labels, Clock([0, 60], [0, 660]), length_s=120)
    >>> [span[:3] for span in found.spans]
    [(50.0, 60.0, 'walk'), (60.0, 100.0, 'run')]
    >>> found.notes
    ("left out, since they contain no frame: 'rest' 100 to 130 s",)
    """
    if clock is None or labels.unit != "seconds" or not labels.spans:
        return labels
    times = np.array([span[:2] for span in labels.spans], np.float64)
    seconds, remarks = _convert_seconds(times, clock, length_s)
    hours = clock.second(60 * times)
    # Times such as 9:45 are cut to the minute, and no hours if the clock shows them as minutes.
    is_within = hours.min() > -60 and hours.max() < length_s + 60
    if HOURLESS in labels.remarks and is_within and times.max() < clock.times[0]:
        labels = replace(labels, remarks=())
        seconds, remarks = hours, (HOURS,)
    # A label may begin before the recording.
    begin, end = np.maximum(seconds[:, 0], 0.0), seconds[:, 1]
    # Keep reversed labels: they are rejected by name later.
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
    """Return a note listing labels without any frame; empty if there are none."""
    if not spans:
        return ()
    named = [f"{span.text!r:.60} {span.start:.10g} to {span.stop:.10g} {unit}" for span in spans]
    more = f" and {len(spans) - NAMED} more" if len(spans) > NAMED else ""
    return (f"left out, since they contain no frame: {', '.join(named[:NAMED])}{more}",)


def _convert_seconds(
    times: Floats, clock: Clock, length_s: float
) -> tuple[Floats, tuple[str, ...]]:
    """Return starts and stops in seconds, and a note unless they are times of the clock."""
    first = f"times are relative to the first frame, at clock time {clock.format_time(0.0)}"
    interpretations: list[tuple[Floats, tuple[str, ...]]] = [
        (clock.second(times), ()),
        (clock.make_relative().second(times), (first,)),
        (times, ("times computed from frames and frame rate, without pauses",)),
    ]

    def shared_s(answer: tuple[Floats, tuple[str, ...]]) -> float:
        # Labelled time within the recording, rounded to milliseconds.
        inside = np.clip(answer[0], 0.0, length_s)
        return round(float(np.maximum(inside[:, 1] - inside[:, 0], 0.0).sum()), 3)

    return max(interpretations, key=shared_s)
