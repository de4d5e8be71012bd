"""Statistics by which it is told how sure links, borders, counts and cuts are.

All are without a unit: similarities, correlations and logarithms of ratios.
``confidence.py`` makes probabilities of them.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from kineme.methods.samples import spread

if TYPE_CHECKING:
    from scipy.sparse import sparray

Floats = NDArray[np.float64]
Samples = NDArray[np.int64]
Alike = Callable[[Samples, Samples], float]
"""Mean similarity of two sets of samples; 0 where none of them are compared."""

COMPARED = 32
"""Samples that stand for a segment."""
LEAST = 0.05
"""A segment is taken to be at least so similar within."""
CLEAREST = 0.995
"""Correlations are not told apart beyond this."""


@dataclass(frozen=True, eq=False)
class Evidence:
    """A row of statistics for each thing that may be wrong, nan where nothing can be.

    Attributes
    ----------
    links : (segments, 2) array
        See `link_statistics`.
    borders : (segments, 2) array
        Of the start of each segment, see `border_statistics`.
    counts : (segments, 2) array
        See `count_statistics`.
    cuts : (primitives, 2) array
        Of the start of each primitive inside a segment, see `cut_statistics`.
    parents : (primitives,) array
        The segment that each lies in.
    """

    links: Floats
    borders: Floats
    counts: Floats
    cuts: Floats
    parents: Samples


def link_statistics(labels: Samples, alike: sparray, own: Floats) -> Floats:
    """What tells how sure the cluster of each segment is.

    Parameters
    ----------
    labels : (segments,) array
        Clusters; -1 for transitions.
    alike : (segments, segments) sparse array
        Mean similarity of the samples of each two segments; none where they are not compared.
    own : (segments,) array
        How much more similar the samples of each are to their own cluster than to others.

    Returns
    -------
    (segments, 2) array
        Similarity to the most similar segment of another cluster, relative to that within; `own`.
    """
    shares, rows, columns = relative(alike)
    foreign = (labels[rows] != labels[columns]) & (labels[columns] >= 0)
    nearest = np.zeros(len(labels))
    np.maximum.at(nearest, rows[foreign], shares[foreign])
    return np.where(labels[:, None] >= 0, np.column_stack([nearest, own]), np.nan)


def border_statistics(
    borders: Samples, labels: Samples, alike: sparray, similar: Alike, near: int
) -> Floats:
    """What tells how sure the start of each segment is.

    A transition is passed over: it is the activities on either side of a border that differ.

    Parameters
    ----------
    borders, labels : array of int
        Samples, ends included, and clusters; -1 for transitions.
    alike : (segments, segments) sparse array
        See `link_statistics`.
    similar : callable
    near : int
        Samples on either side of a border that are compared with both segments.

    Returns
    -------
    (segments, 2) array
        By how much samples before and after the border are more similar to their own side; and
        the similarity of both sides, relative to that within. Nan for the first segment.
    """
    found = np.full((len(labels), 2), np.nan)
    spans = [spread(start, stop, COMPARED) for start, stop in pairwise(borders.tolist())]
    shares, rows, columns = relative(alike)
    across = dict(zip(zip(rows.tolist(), columns.tolist(), strict=True), shares, strict=True))
    for g in range(1, len(labels)):
        left = max(g - 1 - int(labels[g - 1] < 0), 0)
        right = min(g + int(labels[g] < 0), len(labels) - 1)
        at = int(borders[g])
        before = np.arange(max(at - near, 0), at)
        after = np.arange(at, min(at + near, int(borders[-1])))
        sharpness = [
            similar(side, spans[its]) - similar(side, spans[other])
            for side, its, other in ((before, left, right), (after, right, left))
        ]
        found[g] = sum(sharpness), across.get((left, right), 0.0)
    return found


def count_statistics(similar: Floats, own: float) -> Floats:
    """What tells how sure the count of an activity is.

    Parameters
    ----------
    similar : (count, count) array
        Correlations of its repetitions.
    own : float
        How much more similar the activity is to its own cluster than to others.

    Returns
    -------
    (2,) array
        Mean correlation of any two repetitions, as Fisher's z; `own`. Both are 0 where
        nothing is repeated: one repetition has nothing that speaks for it.
    """
    count = len(similar)
    if count < 2:
        return np.zeros(2)
    pairs = (similar.sum() - count) / (count * (count - 1))
    return np.array([clear(pairs), own])


def cut_statistics(similar: Floats, lengths: Samples, repeats: NDArray[np.bool_]) -> Floats:
    """What tells how sure the start of each primitive of an activity but the first is.

    Parameters
    ----------
    similar : (count, count) array
        As for `count_statistics`.
    lengths : (count,) array
        Frames of each repetition.
    repeats : (primitives,) array of bool
        Which primitives are the repetitions.

    Returns
    -------
    (primitives - 1, 2) array
        Of the repetitions on either side: the lesser mean correlation with the others, as
        Fisher's z, and how much the longer or shorter one differs from the usual length.
    """
    others = (similar.sum(axis=1) - 1) / max(len(similar) - 1, 1)
    usual = max(float(np.median(lengths)), 1.0)
    found = np.column_stack([clear(others), -np.abs(np.log(np.maximum(lengths, 1) / usual))])
    rows = np.full((len(repeats), 2), np.inf)
    rows[repeats] = found
    both: Floats = np.minimum(rows[:-1], rows[1:])
    return np.where(np.isfinite(both), both, 0)


def correlations(repetitions: Floats) -> Floats:
    """Of each two repetitions, (count, count), from poses along the path of each.

    Parameters
    ----------
    repetitions : (count, places, dims) array
    """
    rows = repetitions - repetitions.mean(axis=1, keepdims=True)
    rows = rows.reshape(len(rows), -1)
    rows = rows / np.maximum(np.linalg.norm(rows, axis=1, keepdims=True), 1e-12)
    found: Floats = rows @ rows.T
    return found


def relative(alike: sparray) -> tuple[Floats, Samples, Samples]:
    """Similarity of segments relative to that within them, to 1, and which two each is of."""
    from scipy.sparse import coo_array

    pairs = coo_array(alike)
    within = np.maximum(pairs.diagonal(), 0)
    rows, columns = pairs.coords
    scale = np.sqrt(within[rows] * within[columns])
    return np.minimum(pairs.data / np.maximum(scale, LEAST), 1), rows, columns


def clear(correlation: Floats | float) -> Floats:
    """Fisher's z of correlations."""
    return np.asarray(np.arctanh(np.clip(correlation, -CLEAREST, CLEAREST)), np.float64)
