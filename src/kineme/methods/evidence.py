"""Statistics by which it is told how sure links, borders, counts and cuts are.

All are without a unit: similarities, correlations and logarithms of ratios.
``confidence.py`` makes probabilities of them.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from kineme.methods.samples import spread

Floats = NDArray[np.float64]
Samples = NDArray[np.int64]
Similar = Callable[[Samples, Samples], Floats]
"""Similarities (rows, columns) of two sets of samples, nan where they are not compared."""

COMPARED = 32
"""Samples that stand for a segment."""
LEAST = 0.05
"""A segment is taken to be at least so similar within."""
CLEAREST = 0.995
"""Correlations are not told apart beyond this."""


@dataclass(frozen=True, eq=False)
class Evidence:
    """A row of statistics for each segment, nan where there is nothing to be sure of.

    Attributes
    ----------
    links : (segments, 3) array
        Similarity to the nearest other cluster, relative to that within; similarity within;
        how much more similar its samples are to their own.
    borders : (segments, 3) array
        Of the start of each: how sharply similarity changes there; similarity across it,
        relative to that within; whether two activities touch.
    counts : (segments, 3) array
        See `count_statistics`.
    cuts : (primitives, 2) array
        Of the start of each inside an activity, see `count_statistics`.
    parents : (primitives,) array
        The segment that each lies in.
    """

    links: Floats
    borders: Floats
    counts: Floats
    cuts: Floats
    parents: Samples


def link_statistics(labels: Samples, alike: Floats, own: Floats) -> Floats:
    """What tells how sure the cluster of each segment is, (segments, 3).

    Parameters
    ----------
    labels : (segments,) array
        Clusters; -1 for transitions.
    alike : (segments, segments) array
        Mean similarity of the samples of each two segments; nan where they are not compared.
    own : (segments,) array
        How much more similar the samples of each are to their own cluster than to others.
    """
    within = np.nan_to_num(alike.diagonal())
    foreign = np.not_equal.outer(labels, labels) & (labels >= 0) & np.isfinite(alike)
    relative = np.where(foreign, alike, 0) / np.maximum(np.sqrt(np.outer(within, within)), LEAST)
    found = np.column_stack([np.minimum(relative.max(axis=1), 1), within, own])
    return np.where(labels[:, None] >= 0, found, np.nan)


def border_statistics(
    borders: Samples, labels: Samples, alike: Floats, similar: Similar, near: int
) -> Floats:
    """What tells how sure the start of each segment is, (segments, 3); nan for the first.

    Parameters
    ----------
    borders, labels : array of int
        Samples, ends included, and clusters; -1 for transitions.
    alike : (segments, segments) array
        See `link_statistics`.
    similar : callable
        Similarities of samples.
    near : int
        Samples on either side of a border that are compared with both segments.
    """
    found = np.full((len(labels), 3), np.nan)
    spans = [spread(start, stop, COMPARED) for start, stop in pairwise(borders.tolist())]
    within = np.maximum(np.nan_to_num(alike.diagonal()), 0)
    last = len(labels) - 1
    for g in range(1, len(labels)):
        left = max(g - 1 - int(labels[g - 1] < 0), 0)
        right = min(g + int(labels[g] < 0), last)
        at = int(borders[g])
        before = np.arange(max(at - near, 0), at)
        after = np.arange(at, min(at + near, int(borders[-1])))
        sharpness = [
            mean(similar(side, spans[its])) - mean(similar(side, spans[other]))
            for side, its, other in ((before, left, right), (after, right, left))
        ]
        across = np.nan_to_num(alike[left, right]) / max(
            float(np.sqrt(within[left] * within[right])), LEAST
        )
        touch = labels[g - 1] >= 0 and labels[g] >= 0
        found[g] = sum(sharpness), min(across, 1.0), touch
    return found


def count_statistics(repetitions: Floats, poses: Floats, lengths: Samples) -> tuple[Floats, Floats]:
    """What tells how sure the count of an activity is, (3,), and each cut in it, (count - 1, 2).

    Of the count: the similarity of the repetition that is least similar to the others, that of
    the whole to itself one repetition later, and how much longer than usual the longer end is.
    Similarities are correlations, as Fisher's z; all are 0 where nothing is repeated. Of a cut:
    the similarity of the two repetitions that it parts, and how unequal their lengths are.

    Parameters
    ----------
    repetitions : (count, places, dims) array
        Poses along the path of each.
    poses : (frames, dims) array
        Of the activity.
    lengths : (count,) array
        Frames of each repetition.
    """
    count = len(repetitions)
    if count < 2:
        return np.zeros(3), np.empty((0, 2))
    rows = (repetitions - repetitions.mean(axis=1, keepdims=True)).reshape(count, -1)
    rows = rows / np.maximum(np.linalg.norm(rows, axis=1, keepdims=True), 1e-12)
    similar = rows @ rows.T
    others = (similar.sum(axis=1) - similar.diagonal()) / (count - 1)
    usual = max(float(np.median(lengths)), 1.0)
    counts = np.array(
        [
            _clear(others.min()),
            _clear(_later(poses, round(usual))),
            np.log(max(lengths[0], lengths[-1], 1) / usual),
        ]
    )
    unequal = np.abs(np.diff(np.log(np.maximum(lengths, 1))))
    cuts = np.column_stack([_clear(similar.diagonal(1)), unequal])
    return counts, cuts


def _later(poses: Floats, lag: int) -> float:
    """Correlation of poses with those so many frames later."""
    if lag >= len(poses):
        return 0.0
    centred = poses - poses.mean(axis=0)
    early, late = centred[:-lag], centred[lag:]
    size = np.sqrt(np.square(early).sum() * np.square(late).sum())
    return float((early * late).sum() / max(size, 1e-12))


def _clear(correlation: Floats | float) -> Floats:
    """Fisher's z of correlations."""
    return np.asarray(np.arctanh(np.clip(correlation, -CLEAREST, CLEAREST)), np.float64)


def mean(similarities: Floats) -> float:
    """Of those that are known; 0 where none is."""
    known = similarities[np.isfinite(similarities)]
    return float(known.mean()) if known.size else 0.0
