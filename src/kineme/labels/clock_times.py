"""Labels whose seconds are those of a clock, as seconds of the recording.

A recording that pauses has fewer seconds than its clock, and one that begins at half past nine
has none of those that its clock shows. People label by the clock: of the time column, of the day,
since 1970. They may also be counted from the first frame, pauses included, or without
pauses, as the package's own tables do. That by which most of their time lies in the recording is
taken, and a note says so. Labels that meet nothing are left out by name.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike

from kineme._util.arrays import Floats
from kineme.labels.spans import Labels, Span
from kineme.recordings.clock import Clock

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
    seconds, remarks = _seconds(times, clock, length_s)
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
    notes = (*labels.notes, *lost_labels(lost, "s"))
    spans = [span for span, kept in zip(placed, meets, strict=True) if kept]
    return replace(
        labels, spans=spans, length=None, notes=notes, remarks=(*labels.remarks, *remarks)
    )


def lost_labels(spans: Sequence[Span], unit: str) -> tuple[str, ...]:
    """Return a note that names the labels which no frame has; none where there are none."""
    if not spans:
        return ()
    named = [f"{span.text!r:.60} {span.start:.10g} to {span.stop:.10g} {unit}" for span in spans]
    more = f" and {len(spans) - NAMED} more" if len(spans) > NAMED else ""
    return (f"meeting no frame, left out: {', '.join(named[:NAMED])}{more}",)


def _seconds(times: Floats, clock: Clock, length_s: float) -> tuple[Floats, tuple[str, ...]]:
    """Return the seconds of starts and stops, and a note unless they are the clock's own."""
    candidates: tuple[tuple[Callable[[ArrayLike], Floats], tuple[str, ...]], ...] = (
        (clock.second, ()),
        (
            clock.since_first().second,
            (f"times counted from the first frame, at which the clock shows {clock.shown(0.0)}",),
        ),
        (np.asarray, ("times taken as frames over the rate, without pauses",)),
    )
    answers = [(seconds(times), remark) for seconds, remark in candidates]
    return max(answers, key=lambda answer: _shared_seconds(answer[0], length_s))


def _shared_seconds(seconds: Floats, length_s: float) -> float:
    """Seconds of the recording that labels meet, to the millisecond."""
    # The part of each label that lies in the recording.
    inside = np.clip(seconds, 0.0, length_s)
    return round(float(np.maximum(inside[:, 1] - inside[:, 0], 0.0).sum()), 3)
