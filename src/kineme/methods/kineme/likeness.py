"""How alike two movements are, and which clusters are one movement at another pace or phase.

A movement is its mean repetition, evenly along its path, so that pace does not matter. Two are
compared at the phase at which they fit best:

    likeness = 1 - mean square distance / (variance of the one + variance of the other)

It is 1 where both are the same, 0 where they have nothing but their place in common, and below
where they are elsewhere. It goes by how far the movements go: two small ones must be nearer to
each other than two large ones.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from kineme.methods.kineme import _repeating_kernels as kernels
from kineme.methods.kineme._repetition_kernels import repetitions_between
from kineme.methods.kineme.placing import Segments
from kineme.methods.kineme.repetitions import PLACES, movement

if TYPE_CHECKING:
    from kineme.methods.kineme.constants import KinemeConstants

Floats = NDArray[np.float64]
Frames = NDArray[np.int64]
Rows = NDArray[np.float32]

COMPARED = 8
"""Segments of a cluster that are compared with those of others, at most."""


def likeness(first: Floats, second: Floats) -> float:
    """Of two movements, (places, dims) each, at the phase at which they are most alike.

    Examples
    --------
    >>> angles = np.linspace(0, 2 * np.pi, 16, endpoint=False)
    >>> circle = np.column_stack([np.cos(angles), np.sin(angles)])
    >>> likeness(circle, np.roll(circle, 5, axis=0))
    1.0
    >>> likeness(circle, circle + 2.0)
    -3.0
    """
    return round(float(kernels.likenesses(np.stack([first, second]))[0, 1]), 9)


def mean_repetitions(poses: Rows, segments: Segments, preset: KinemeConstants) -> dict[int, Floats]:
    """By segment that repeats itself, its mean repetition (places, dims)."""
    found = {}
    ends = np.searchsorted(segments.parents, np.arange(len(segments.labels) + 1))
    for segment in np.flatnonzero(segments.counts > 1).tolist():
        inside = np.flatnonzero(segments.repeats[ends[segment] : ends[segment + 1]])
        edges = segments.primitives[ends[segment] + inside[0] : ends[segment] + inside[-1] + 2]
        along = movement(poses[edges[0] : edges[-1]], preset)
        repeated = repetitions_between(along.poses, along.path, edges - edges[0], PLACES)
        found[segment] = repeated.mean(axis=0) + along.middle
    return found


def linked(labels: Frames, movements: dict[int, Floats], least: float) -> Frames:
    """The labels of segments, those of clusters that are one movement made one.

    Parameters
    ----------
    labels : (segments,) array
        Cluster of each.
    movements : dict of int to (places, dims) array
        By segment; see `mean_repetitions`.
    least : float
        Likeness of two clusters that are one, in the mean of their segments.
    """
    labels = labels.copy()
    known = np.array(sorted(movements), np.int64)
    if not len(known):
        return labels
    _, rank = np.unique(labels[known], return_inverse=True)
    first = np.argsort(rank, kind="stable")
    within = np.arange(len(known)) - np.searchsorted(rank[first], rank[first])
    own = known[np.sort(first[within < COMPARED])]
    alike = kernels.likenesses(np.stack([movements[segment] for segment in own.tolist()]))
    while True:
        names, of = np.unique(labels[own], return_inverse=True)
        members = np.eye(len(names))[of]
        means = (members.T @ alike @ members) / np.outer(members.sum(axis=0), members.sum(axis=0))
        np.fill_diagonal(means, -np.inf)
        one, other = sorted(divmod(int(means.argmax()), len(names)))
        if means[one, other] < least:
            return labels
        labels[labels == names[other]] = names[one]
