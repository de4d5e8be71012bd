"""Build the columns of a segment table from borders; number clusters by appearance.

@@doubts: List the least certain results of a segment table as sentences.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from kineme._util.arrays import Floats, Ints
from kineme.methods.base import Columns


def make_columns(
    activities: Ints,
    primitives: Ints,
    *,
    is_activity: NDArray[np.bool_],
    is_primitive: NDArray[np.bool_] | None = None,
    clusters: tuple[Ints, Ints],
    confidence: tuple[Floats, Floats],
    border_confidence: tuple[Floats, Floats] | None = None,
) -> Columns:
    """Return the columns of both levels.

    Parameters
    ----------
    activities, primitives : (segments + 1,) array
        Borders of each level, from 0 to the end. Borders of activities are also borders of
        primitives.
    is_activity : (activities,) array of bool
        False for transitions.
    is_primitive : (primitives,) array of bool, optional
        False for transitions; by default all in activities are primitives.
    clusters, confidence : pair of arrays
        For activities, and for primitives.
    border_confidence : pair of arrays, optional
        Probability that the start of each is right, for activities and for primitives.

    Returns
    -------
    dict of str to array
        ``level``, ``kind``, ``start_frame``, ``stop_frame``, ``cluster``, ``confidence``, and
        ``border_confidence`` if given.
    """
    parents = np.searchsorted(activities, primitives[:-1], side="right") - 1
    primitive = is_activity[parents] if is_primitive is None else is_primitive
    columns = {
        "level": np.repeat(["activity", "primitive"], [len(activities) - 1, len(parents)]),
        "kind": np.where(np.append(is_activity, primitive), "activity", "transition"),
        "start_frame": np.concatenate([activities[:-1], primitives[:-1]]),
        "stop_frame": np.concatenate([activities[1:], primitives[1:]]),
        "cluster": np.concatenate(clusters),
        "confidence": np.concatenate(confidence),
    }
    if border_confidence is not None:
        columns["border_confidence"] = np.concatenate(border_confidence)
    return columns


def number_by_appearance(labels: NDArray[np.integer]) -> Ints:
    """Renumber labels from 0 in order of appearance; -1 stays.

    Examples
    --------
    >>> import numpy as np
    >>> number_by_appearance(np.array([7, 7, -1, 2, 7]))
    array([ 0,  0, -1,  1,  0])
    """
    in_cluster = labels >= 0
    _, first, inverse = np.unique(labels[in_cluster], return_index=True, return_inverse=True)
    numbered = np.full(len(labels), -1, np.int64)
    # `argsort` twice gives ranks: the rank of a label's first position is its new number.
    numbered[in_cluster] = np.argsort(np.argsort(first))[inverse]
    return numbered


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
