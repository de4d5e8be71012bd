"""Doubts: sentences on what has a low confidence in a segment table, the lowest first."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from kineme.methods.base import Columns

Doubt = tuple[float, str]
"""Probability that something is right, and the sentence about it."""

MOST = 5
"""Sentences at most: a longer list is not read."""
UNSURE = 0.5
"""Confidence below which there is a sentence."""


def list_doubts(columns: Columns, fps: float) -> list[str]:
    """Return a sentence for each cluster, count or border of low confidence, at most five.

    Parameters
    ----------
    columns : dict of str to array
        Of a segment table, with ``confidence`` and ``border_confidence``.
    fps : float
        Frames per second of the table.
    """
    found = [*_doubt_activities(columns, fps), *_doubt_counts(columns, fps)]
    worst = sorted(found, key=lambda each: each[0])[:MOST]
    return [text for _, text in worst]


def _doubt_activities(columns: Columns, fps: float) -> Iterator[Doubt]:
    """Clusters and borders."""
    for row in np.flatnonzero(columns["level"] == "activity"):
        border, link = (float(columns[name][row]) for name in ("border_confidence", "confidence"))
        if border < UNSURE:
            at = columns["start_frame"][row] / fps
            yield border, _append_confidence(f"look at the border at {at:.2f} s", border)
        if link < UNSURE:
            where = _span(columns, row, fps)
            yield link, _append_confidence(f"look at the cluster of the activity {where}", link)


def _doubt_counts(columns: Columns, fps: float) -> Iterator[Doubt]:
    """Numbers of repetitions, where there are several."""
    is_primitive = (columns["level"] == "primitive") & (columns["kind"] == "activity")
    is_activity = (columns["level"] == "activity") & (columns["kind"] == "activity")
    for row in np.flatnonzero(is_activity):
        inside = is_primitive & (columns["start_frame"] >= columns["start_frame"][row])
        inside &= columns["stop_frame"] <= columns["stop_frame"][row]
        count = float(columns["confidence"][inside].min(initial=1))
        if count < UNSURE and np.count_nonzero(inside) > 1:  # of one there is nothing to count
            where = _span(columns, row, fps)
            yield count, _append_confidence(f"look at the number of repetitions {where}", count)


def _append_confidence(text: str, probability: float) -> str:
    return f"{text} ({100 * probability:.0f} % sure)"


def _span(columns: Columns, row: np.integer, fps: float) -> str:
    start, stop = (columns[f"{name}_frame"][row] / fps for name in ("start", "stop"))
    return f"at {start:.2f} to {stop:.2f} s"
