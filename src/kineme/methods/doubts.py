"""Doubts: sentences on what is not sure in a segment table, the least sure first."""

from __future__ import annotations

import numpy as np

from kineme.methods.base import Columns
from kineme.methods.confidence import ConfidencePreset

MOST = 5
"""Sentences; who is told more looks at none."""


def doubts(columns: Columns, fps: float, preset: ConfidencePreset) -> list[str]:
    """A sentence for each cluster, count or border that is not sure, at most five.

    Parameters
    ----------
    columns : dict of str to array
        Of a segment table, with ``score`` and ``border_confidence``.
    fps : float
        Frames per second of the table.
    preset : ConfidencePreset
        Whose ``unsure_...`` say what is not sure.
    """
    is_activity = columns["level"] == "activity"
    seconds = {name: columns[f"{name}_frame"] / fps for name in ("start", "stop")}
    found: list[tuple[float, str]] = []

    def doubt(probability: float, least: float, text: str) -> None:
        if probability < least:
            found.append((probability, f"{text} ({100 * probability:.0f} % sure)"))

    for row in np.flatnonzero(is_activity):
        start, stop = seconds["start"][row], seconds["stop"][row]
        border = float(columns["border_confidence"][row])
        doubt(border, preset.unsure_border, f"look at the border at {start:.2f} s")
        if columns["kind"][row] == "transition":
            continue
        span = f"at {start:.2f} to {stop:.2f} s"
        link = float(columns["score"][row])
        doubt(link, preset.unsure_action, f"look at the cluster of the activity {span}")
        inside = ~is_activity & (columns["kind"] == "activity")
        inside &= columns["start_frame"] >= columns["start_frame"][row]
        inside &= columns["stop_frame"] <= columns["stop_frame"][row]
        if np.count_nonzero(inside) > 1:
            count = float(columns["score"][inside][0])
            doubt(count, preset.unsure_count, f"look at the number of repetitions {span}")
    return [text for _, text in sorted(found, key=lambda each: each[0])[:MOST]]
