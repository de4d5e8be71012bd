"""Search for examples in recordings, and match primitives in both directions, by warping.

**Search.** A match is a warping of the whole example onto successive samples of the recording, at
half to twice its speed. Each step advances both by one sample, or one of them by two. The cost of a
match is the mean distance of the samples of the example to the matched samples of the recording (to
the mean of two if a sample matches two). The search is exhaustive.

The distance of a match is its cost relative to the size of the smaller movement,

    distance = cost / √(2 · smaller variance),

so that one threshold is valid for small and large movements. A distance of 0 means equal. At 1, two
movements differ as much as random samples of one of them.

The steps are those of Müller, Information Retrieval for Music and Motion (2007), section 4.4.

**Matching of unlabelled primitives with labelled ones.** A primitive u matches a run L of labelled
primitives if all of u can be warped onto successive samples of L, at half to twice its speed
(subsequence warping), and if primitives of L can be warped onto the run of u. The cost of the match
is the larger of both. With one direction alone, a part of a movement would match the whole. A *run*
consists of adjacent primitives with the same label or cluster. Cyclic movements may be cut at
another phase, so a warping may cross from one primitive to the next of a run, but not to another
run.

Source: Vögele, Krüger and Klein 2014, section 6.1; the backward match is our own.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from kineme._util.arrays import Float32s, Floats, Ints
from kineme._util.checks import as_floats, is_number
from kineme._util.parallel import map_threads
from kineme.errors import ParameterError
from kineme.transfer._kernels import choose_apart, warp_columns

Pairs = tuple[Ints, Ints, Floats]
"""Primitive, run of the other side, and cost of each match."""
_WALL = 1e6
"""Value of the features of a separator between two runs, far from all others."""
THRESHOLD = 0.85
"""Distance up to which two movements of any people are the same."""
STILL = 0.05
"""Smallest variance of unit vectors that counts as movement; less is mostly noise."""
BLOCK = 4096
"""Number of samples that are compared at a time."""


class Matches(NamedTuple):
    """Matches that do not overlap: spans [start, stop) of a recording in samples, best first."""

    starts: Ints
    stops: Ints
    distances: Float32s


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
    ends = ends[choose_disjoint(starts[ends], ends + 1, len(starts), most=top)]
    return Matches(starts[ends].astype(np.int64), ends + 1, distances[ends])


def choose_disjoint(
    starts: ArrayLike, stops: ArrayLike, n: int, *, most: int | None = None
) -> Ints:
    """Return the indices of spans of ``n`` samples that overlap no preceding chosen span."""
    firsts, ends = np.asarray(starts, np.int64), np.asarray(stops, np.int64)
    chosen = np.empty(len(firsts), np.int64)
    limit = len(firsts) if most is None else int(most)
    count = choose_apart(firsts, ends, limit, np.zeros(n, np.bool_), chosen)
    return chosen[:count]


class Searched:
    """Matching features (n, dims) of a recording, prepared for searching examples in them."""

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


def warp(example: ArrayLike, recording: ArrayLike) -> tuple[Float32s, NDArray[np.int32]]:
    """Return cost and start of the cheapest match that ends at each sample; inf without a match."""
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


@dataclass(frozen=True, eq=False)
class Primitives:
    """Primitives end to end: primitive p is ``features[starts[p]:starts[p + 1]]``.

    ``features`` (frames, dims) are those of all, ``lengths`` the frames of each primitive, and
    ``runs`` the run of each, numbered from 0, ascending.
    """

    features: NDArray[np.floating]
    lengths: Ints
    runs: Ints

    @cached_property
    def starts(self) -> Ints:
        return np.concatenate([[0], np.cumsum(self.lengths)])

    @cached_property
    def frame_runs(self) -> Ints:
        """Return the run of each frame."""
        return np.repeat(self.runs, self.lengths)

    def __len__(self) -> int:
        return len(self.lengths)


def compute_label_costs(
    unknown: Primitives, examples: Primitives, codes: Ints, n_labels: int, *, radius: float
) -> Floats:
    """Return the cost of the cheapest match of each primitive with each label; inf without a match.

    ``codes`` are the labels of the examples, from 0, equal within a run. Matches that cost more
    than the radius are ignored.
    """
    costs = np.full((len(unknown), n_labels), np.inf)
    run_codes = np.empty(int(examples.runs[-1]) + 1, np.int64)
    run_codes[examples.runs] = codes
    u, run, cost = find_mutual_matches(unknown, examples, radius)
    np.minimum.at(costs, (u, run_codes[run]), cost)
    return costs


def find_mutual_matches(unknown: Primitives, examples: Primitives, radius: float) -> Pairs:
    """Return the matches of unknown primitives with runs of examples that exist both ways.

    The cost is the larger of that of the forward match and the median of the backward matches.
    """
    # Forward: primitive u matches a run of examples. Backward: example k matches an unknown run.
    u, example_run, forward = _find_matches(unknown, examples, np.arange(len(unknown)), radius)
    reached = np.flatnonzero(np.isin(examples.runs, example_run))
    k, unknown_run, backward = _find_matches(examples, unknown, reached, radius)
    n = int(examples.runs[-1]) + 1
    run_sizes = np.bincount(examples.runs)
    # Pairs of runs as one number: unknown run * n + example run.
    pairs, medians = _compute_medians(unknown_run * n + examples.runs[k], backward, run_sizes)
    keys = unknown.runs[u] * n + example_run
    # Keep forward matches whose pair of runs also has backward matches.
    positions = np.searchsorted(pairs, keys)
    both = positions < len(pairs)
    both[both] = pairs[positions[both]] == keys[both]
    return u[both], example_run[both], np.maximum(forward[both], medians[positions[both]])


def number_movements(primitives: Primitives, radius: float) -> Ints:
    """Number the movements of primitives: those that match, directly or indirectly, are equal."""
    u, run, _ = find_mutual_matches(primitives, primitives, radius)
    # Connected components of a graph of primitives and runs.
    n = len(primitives)
    size = n + int(primitives.runs[-1]) + 1
    links = coo_array((np.ones(len(u)), (u, n + run)), shape=(size, size))
    numbers: Ints = connected_components(links, directed=False)[1][:n].astype(np.int64)
    return numbers


def _find_matches(examples: Primitives, others: Primitives, numbers: Ints, radius: float) -> Pairs:
    """Find the cheapest warping of some examples inside each run of others, within the radius."""
    separated, run_starts = _append_walls(others)
    starts = examples.starts
    features = np.asarray(examples.features, np.float32)

    def match_one(p: np.int64) -> tuple[Ints, Floats]:
        """Return the runs that example p matches, and the costs."""
        costs, _ = warp(features[starts[p] : starts[p + 1]], separated)
        # Cheapest warping that ends in each run.
        cheapest = np.minimum.reduceat(costs, run_starts)
        runs = np.flatnonzero(cheapest <= radius)
        return runs, cheapest[runs].astype(np.float64)

    matches = map_threads(match_one, numbers)
    if not matches:
        return np.empty(0, np.int64), np.empty(0, np.int64), np.empty(0)
    runs, costs = (np.concatenate(part) for part in zip(*matches, strict=True))
    return np.repeat(numbers, [len(part) for part, _ in matches]), runs, costs


def _append_walls(primitives: Primitives) -> tuple[NDArray[np.float32], Ints]:
    """Append a separator to each run; return the features and the start of each run in them."""
    # Each frame is shifted by the number of separators before it: its run.
    frames = np.arange(len(primitives.frame_runs)) + primitives.frame_runs
    n_runs = int(primitives.runs[-1]) + 1
    separated = np.full((len(frames) + n_runs, primitives.features.shape[1]), _WALL, np.float32)
    separated[frames] = primitives.features
    starts = np.searchsorted(primitives.frame_runs, np.arange(n_runs)) + np.arange(n_runs)
    return separated, starts


def _compute_medians(keys: Ints, costs: Floats, sizes: Ints) -> tuple[Ints, Floats]:
    """Return the distinct keys, ascending, with the lower median of their costs.

    ``keys % len(sizes)`` is a run with ``sizes`` primitives. Primitives without a match count as
    infinite costs: a key is left out if less than half of its primitives have a match.
    """
    order = np.lexsort((costs, keys))
    unique, first, counts = np.unique(keys[order], return_index=True, return_counts=True)
    middle = (sizes[unique % len(sizes)] - 1) // 2
    matched = middle < counts
    return unique[matched], costs[order][(first + middle)[matched]]
