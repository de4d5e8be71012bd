"""List the least certain results of a segment table as sentences."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from kineme.methods.base import Columns

Doubt = tuple[float, str]
"""Confidence of a result, and the sentence about it."""

MAX_SENTENCES = 5
"""Largest number of sentences: nobody reads a longer list."""
MIN_CONFIDENCE = 0.5
"""Confidence below which a result is listed."""


def list_doubts(columns: Columns, fps: float) -> list[str]:
    """Return one sentence for each doubtful cluster, count or border: the five least certain.

    Parameters
    ----------
    columns : dict of str to array
        Columns of a segment table, with ``confidence`` and ``border_confidence``.
    fps : float
        Frames per second of the table.
    """
    doubts = [*_list_doubtful_activities(columns, fps), *_list_doubtful_counts(columns, fps)]
    worst = sorted(doubts, key=lambda each: each[0])[:MAX_SENTENCES]
    return [text for _, text in worst]


def _list_doubtful_activities(columns: Columns, fps: float) -> Iterator[Doubt]:
    """Yield doubtful clusters and start borders of activities."""
    for row in np.flatnonzero(columns["level"] == "activity"):
        border = float(columns["border_confidence"][row])
        cluster = float(columns["confidence"][row])
        if border < MIN_CONFIDENCE:
            start_s = columns["start_frame"][row] / fps
            yield border, _append_confidence(f"check the border at {start_s:.2f} s", border)
        if cluster < MIN_CONFIDENCE:
            where = _format_span(columns, row, fps)
            yield (
                cluster,
                _append_confidence(f"check the cluster of the activity {where}", cluster),
            )


def _list_doubtful_counts(columns: Columns, fps: float) -> Iterator[Doubt]:
    """Yield doubtful numbers of repetitions."""
    is_primitive = (columns["level"] == "primitive") & (columns["kind"] == "activity")
    is_activity = (columns["level"] == "activity") & (columns["kind"] == "activity")
    for row in np.flatnonzero(is_activity):
        inside = is_primitive & (columns["start_frame"] >= columns["start_frame"][row])
        inside &= columns["stop_frame"] <= columns["stop_frame"][row]
        count = float(columns["confidence"][inside].min(initial=1))
        if count < MIN_CONFIDENCE and np.count_nonzero(inside) > 1:  # one primitive is no count
            where = _format_span(columns, row, fps)
            yield count, _append_confidence(f"check the number of repetitions {where}", count)


def _append_confidence(text: str, probability: float) -> str:
    return f"{text} ({100 * probability:.0f} % sure)"


def _format_span(columns: Columns, row: np.integer, fps: float) -> str:
    start, stop = (columns[f"{name}_frame"][row] / fps for name in ("start", "stop"))
    return f"at {start:.2f} to {stop:.2f} s"
