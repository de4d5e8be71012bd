"""Search for an example in a recording: subsequence search by warping.

A match is a warping of the whole example onto successive samples of the recording, at half to twice
its speed. Each step advances both by one sample, or one of them by two. The cost of a match is the
mean distance of the samples of the example to the matched samples of the recording (to the mean of
two if a sample matches two). The search is exhaustive.

The distance of a match is its cost relative to the size of the smaller movement,

    distance = cost / √(2 · smaller variance),

so that one threshold is valid for small and large movements. A distance of 0 means equal. At 1, two
movements differ as much as random samples of one of them.

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
"""Distance up to which two movements of any people are the same."""
STILL = 0.05
"""Smallest variance of unit vectors that counts as movement; less is mostly noise."""
BLOCK = 4096
"""Number of samples that are compared at a time."""


class Matches(NamedTuple):
    """Matches that do not overlap: spans [start, stop) of a recording in samples, best first.

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
    """A recording prepared for searching examples in it.

    Parameters
    ----------
    recording : (n, dims) array
        Matching features.
    """

    def __init__(self, recording: ArrayLike):
        self._features = _check_features(recording, "recording")

    def distances(self, example: ArrayLike, *, most: float) -> tuple[Float32s, NDArray[np.int32]]:
        """Return distance and start of the best match that ends with each sample.

        Distances above ``most`` are inf.
        """
        short = _check_features(example, "example")
        costs, starts = warp(short, self._features)
        variance = float(short.var(axis=0, dtype=np.float64).sum())
        # The smaller variance is at most that of the example, which bounds the cost.
        max_cost = most * np.sqrt(2 * max(variance, STILL))
        ends = np.flatnonzero(costs <= max_cost)
        smaller = np.maximum(np.minimum(self._variances(starts[ends], ends), variance), STILL)
        match_distances = (costs[ends] / np.sqrt(2 * smaller)).astype(np.float32)
        distances = np.full(len(costs), np.inf, np.float32)
        distances[ends] = np.where(match_distances <= np.float32(most), match_distances, np.inf)
        return distances, starts

    @cached_property
    def _sums(self) -> Floats:
        """Return cumulative sums of centred samples, and of their squared lengths."""
        n, dims = self._features.shape
        sums = np.zeros((n + 1, dims + 1))
        np.subtract(self._features, self._features.mean(axis=0), out=sums[1:, :dims])
        sums[1:, dims] = np.einsum("ij,ij->i", sums[1:, :dims], sums[1:, :dims])
        return np.cumsum(sums, axis=0, out=sums)

    def _variances(self, starts: NDArray[np.integer], lasts: Ints) -> Floats:
        """Return the variances of spans of samples, summed over dimensions."""
        stops = lasts + 1
        # Mean of squares less squared mean.
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
    """Find the matches of an example in a recording that do not overlap, best first.

    Parameters
    ----------
    example : (m, dims) array
        Matching features.
    recording : (n, dims) array
        The same kind of features, at the same rate.
    threshold : float
        Largest distance of a match.
    top : int, optional
        Largest number of matches; by default all.

    Returns
    -------
    Matches

    Raises
    ------
    ParameterError
        Arrays have other shapes, the example is empty, or threshold or number are not above 0.

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
    # Choose matches that do not overlap greedily, the nearest first.
    ends = np.flatnonzero(np.isfinite(distances))
    ends = ends[np.argsort(distances[ends], kind="stable")]
    chosen = np.empty(len(ends), np.int64)
    most = len(ends) if top is None else int(top)
    n = choose_apart(ends, starts, most, np.zeros(len(starts), np.bool_), chosen)
    ends = chosen[:n]
    return Matches(starts[ends].astype(np.int64), ends + 1, distances[ends])


def warp(example: ArrayLike, recording: ArrayLike) -> tuple[Float32s, NDArray[np.int32]]:
    """Return cost and start of the cheapest match that ends with each sample; inf without one."""
    short, long = _check_features(example, "example"), _check_features(recording, "recording")
    if short.shape[1] != long.shape[1] or len(short) == 0:
        raise ParameterError(
            f"an example of shape {short.shape} cannot be searched in features of shape "
            f"{long.shape}: both need the same features, and the example at least one sample"
        )
    n, m = len(long), len(short)
    costs, starts = np.empty(n, np.float32), np.empty(n, np.int32)
    sums = np.full((3, m + 1), np.inf, np.float32)
    begins, rows = np.zeros((3, m + 1), np.int32), np.zeros((2, m), np.float32)
    # |x - y|² = |x|² + |y|² - 2 x·y, by a matrix product for each block of samples.
    twice, example_squares = -2 * short.T, _sum_squares(short)
    for first in range(0, n, BLOCK):
        part, span = long[first : first + BLOCK], slice(first, first + BLOCK)
        products = part @ twice
        # Views, which the kernel fills.
        results = costs[span], starts[span]
        warp_columns(
            products, _sum_squares(part), example_squares, first, sums, begins, rows, *results
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
