"""Where a recording is like an example: subsequence search by warping.

A match is a warping of the whole example onto successive samples of the recording, at half to twice
its speed. From one pair of samples to the next both go on by one, or one of them by two. Its cost
is the mean over the samples of the example of the distance to the one, or the mean of the two, of
the recording that it is laid on. Every place is looked at; nothing is thinned out.

The distance of a match is its cost in proportion to how far the smaller of both movements goes,

    distance = cost / √(2 · the smaller variance),

so that one threshold serves small movements and large ones: 0 is equal, and from 1 on the two are
as far from each other as any two samples of one of them.

The steps are those of Müller, Information Retrieval for Music and Motion (2007), section 4.4.
"""

from __future__ import annotations

from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from kineme._util.arrays import Float32s, Floats, Ints
from kineme._util.checks import as_floats, is_number
from kineme.errors import ParameterError
from kineme.transfer._kernels import choose_apart, warp_columns

THRESHOLD = 0.85
"""Distance up to which two movements are one, whoever makes them."""
STILL = 0.05
"""Least variance of a movement of unit vectors: of who stands, noise is most of it."""
BLOCK = 4096
"""Samples compared at a time."""


class Matches(NamedTuple):
    """Spans [start, stop) of a recording in samples, apart from each other, the best first.

    Examples
    --------
    >>> import numpy as np
    >>> from kineme.transfer.subsequences import search
    >>> angle = np.arange(100) / 4
    >>> recording = np.stack([np.cos(angle), np.sin(angle)], axis=1)
    >>> search(recording[20:40], recording, top=1).starts.tolist()
    [20]
    """

    starts: Ints
    stops: Ints
    distances: Float32s


class Searched:
    """A recording in which examples are searched.

    Parameters
    ----------
    recording : (n, dims) array
        Matching features.
    """

    def __init__(self, recording: ArrayLike):
        self._features = _check_features(recording, "recording")

    def distances(self, example: ArrayLike, *, most: float) -> tuple[Float32s, NDArray[np.int32]]:
        """``distances[j]``, ``starts[j]``: of the match that ends with sample j.

        A distance above ``most`` is inf.
        """
        short = _check_features(example, "example")
        costs, starts = warp(short, self._features)
        variance = float(short.var(axis=0, dtype=np.float64).sum())
        # The smaller movement goes no farther than the example: what is dearer is no match.
        dearest = most * np.sqrt(2 * max(variance, STILL))
        ends = np.flatnonzero(costs <= dearest)
        smaller = np.maximum(np.minimum(self._variances(starts[ends], ends), variance), STILL)
        found = (costs[ends] / np.sqrt(2 * smaller)).astype(np.float32)
        distances = np.full(len(costs), np.inf, np.float32)
        distances[ends] = np.where(found <= np.float32(most), found, np.inf)
        return distances, starts

    @cached_property
    def _sums(self) -> Floats:
        """Sums of all samples before each, around their mean, and of their squares."""
        n, dims = self._features.shape
        sums = np.zeros((n + 1, dims + 1))
        np.subtract(self._features, self._features.mean(axis=0), out=sums[1:, :dims])
        sums[1:, dims] = np.einsum("ij,ij->i", sums[1:, :dims], sums[1:, :dims])
        return np.cumsum(sums, axis=0, out=sums)

    def _variances(self, starts: NDArray[np.integer], lasts: Ints) -> Floats:
        """Of the samples from each start to each last one, summed over their numbers."""
        stops = lasts + 1
        means = (self._sums[stops] - self._sums[starts]) / (stops - starts)[:, None]
        variances: Floats = means[:, -1] - np.einsum("ij,ij->i", means[:, :-1], means[:, :-1])
        return variances


def search(
    example: ArrayLike,
    recording: ArrayLike,
    *,
    threshold: float = THRESHOLD,
    top: int | None = None,
) -> Matches:
    """Return the matches of an example in a recording that do not overlap, the best first.

    Parameters
    ----------
    example : (m, dims) array
        Matching features.
    recording : (n, dims) array
        In the same features, at the same rate.
    threshold : float
        Largest distance of a match.
    top : int, optional
        Matches wanted at most; all by default.

    Returns
    -------
    Matches

    Raises
    ------
    ParameterError
        Arrays of other shapes, an empty example, or a threshold or number that is not above 0.

    Examples
    --------
    >>> import numpy as np
    >>> angle = np.arange(100) / 4
    >>> recording = np.stack([np.cos(angle), np.sin(angle)], axis=1)
    >>> found = search(recording[20:40], recording, threshold=0.1)
    >>> found.starts.tolist(), found.stops.tolist()
    ([20, 45, 70], [40, 65, 90])
    """
    if not (is_number(threshold) and threshold > 0):
        raise ParameterError(f"the threshold must be a number above 0, not {threshold!r:.60}")
    if top is not None and not (is_number(top) and top >= 1):
        raise ParameterError(f"top must be a whole number above 0, not {top!r:.60}")
    distances, starts = Searched(recording).distances(example, most=threshold)
    ends = np.flatnonzero(np.isfinite(distances))
    ends = ends[np.argsort(distances[ends], kind="stable")]
    chosen = np.empty(len(ends), np.int64)
    most = len(ends) if top is None else int(top)
    n = choose_apart(ends, starts, most, np.zeros(len(starts), np.bool_), chosen)
    ends = chosen[:n]
    return Matches(starts[ends].astype(np.int64), ends + 1, distances[ends])


def warp(example: ArrayLike, recording: ArrayLike) -> tuple[Float32s, NDArray[np.int32]]:
    """``costs[j]``, ``starts[j]``: of the cheapest match that ends with sample j; inf without."""
    short, long = _check_features(example, "example"), _check_features(recording, "recording")
    if short.shape[1] != long.shape[1] or len(short) == 0:
        raise ParameterError(
            f"an example of shape {short.shape} cannot be searched in features of shape "
            f"{long.shape}: both need the same features, and the example a sample"
        )
    n, m = len(long), len(short)
    costs, starts = np.empty(n, np.float32), np.empty(n, np.int32)
    sums = np.full((3, m + 1), np.inf, np.float32)
    begins, rows = np.zeros((3, m + 1), np.int32), np.zeros((2, m), np.float32)
    twice, example_squares = -2 * short.T, _sum_squares(short)
    for first in range(0, n, BLOCK):
        part, span = long[first : first + BLOCK], slice(first, first + BLOCK)
        products = part @ twice
        found = costs[span], starts[span]
        warp_columns(
            products, _sum_squares(part), example_squares, first, sums, begins, rows, *found
        )
    return costs, starts


def _sum_squares(features: Float32s) -> Float32s:
    squares: Float32s = np.einsum("ij,ij->i", features, features)
    return squares


def _check_features(features: ArrayLike, name: str) -> Float32s:
    array = features if isinstance(features, np.ndarray) else as_floats(features, name)
    if array.ndim != 2:
        raise ParameterError(f"the {name} must be samples x dims, not of shape {array.shape}")
    return np.ascontiguousarray(array, np.float32)
