"""Confidence: the probability that a result is right.

Four things may be wrong, and each has its own probability:

- the *link* of an activity: its cluster is not that of the same movement elsewhere,
- a *border* of an activity: there is none close by,
- its *count*: it has more repetitions, or fewer,
- a *cut* between two repetitions: there is none close by.

They follow from three statistics s: the length of an activity times its preference of its own
cluster, in seconds; the sharpness of a border, which says how much more the recording changes there
than nearby; and the correlation of repetitions. Each probability is
1 / (1 + exp(-(constant + weight s))). The two numbers of each kind are fitted to recordings with a
known truth and checked on sources that were left out, by ``benchmarks/truth/confidence.py``. No
stage of the method reads them.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from kineme._util.arrays import Floats
from kineme._util.parallel import map_threads
from kineme.methods.kineme._repetition_kernels import sample_repetitions
from kineme.methods.kineme.primitives import Segments
from kineme.methods.kineme.repetitions import PLACES, trace_movement

if TYPE_CHECKING:
    from kineme.methods.kineme.constants import KinemeConstants

Frames = NDArray[np.int64]

LEAST = 0.02
"""Least preference of a segment for its own cluster."""
CLEAREST = 0.995
"""Largest correlation: all beyond it are equal."""
SIDE = 2.0
"""Seconds before and after a border that are compared, and how far from it others are."""
TINY = 1e-9
"""Least mean change: below it nothing changes."""
BLUNTEST = 0.05
"""Least sharpness of a border."""


@dataclass(frozen=True, eq=False)
class Evidence:
    """Statistics from which confidence is computed.

    Attributes
    ----------
    preferred : (segments,) array
        Logarithm of the seconds for which each prefers its own cluster; nan for transitions.
    sharpness : (segments,) array
        Logarithm of `compute_sharpness` of the start of each; nan for the first.
    repeated : (segments,) array
        Mean correlation of any two repetitions, as Fisher's z: 0 of a single one; nan where
        primitives are no repetitions.
    parents : (primitives,) array
        The segment that each primitive lies in.
    """

    preferred: Floats
    sharpness: Floats
    repeated: Floats
    parents: Frames


@dataclass(frozen=True, eq=False)
class Confidence:
    """Probabilities; nan where there is no cluster, count, border or cut.

    Attributes
    ----------
    links, counts, borders : (segments,) array
        That the cluster of each segment, the number of its repetitions, and its start are right.
    cuts : (primitives,) array
        That the start of each is right; that of the segment where it is the first in it.
    """

    links: Floats
    counts: Floats
    borders: Floats
    cuts: Floats


def collect_evidence(
    rows: NDArray[np.float32],
    view: NDArray[np.float32],
    segments: Segments,
    preset: KinemeConstants,
) -> Evidence:
    """Statistics of activities and their repetitions.

    Parameters
    ----------
    rows : (frames, dims) array
        At the working rate.
    view : (samples, dims) array
        What was compared, ``preset.rate`` times a second.
    segments : Segments
    preset : KinemeConstants
    """
    parents, repeats, ends = segments.parents, segments.repeats, segments.firsts
    seconds = np.diff(segments.borders) / preset.working_fps
    repeated = np.full(len(seconds), np.nan)

    def correlate(segment: int) -> None:
        first, last = ends[segment], ends[segment + 1]
        edges = segments.primitives[first : last + 1]
        movement = trace_movement(rows[edges[0] : max(edges[-1], edges[0] + 1)], preset)
        found = sample_repetitions(movement.poses, movement.path, edges - edges[0], PLACES)
        repeated[segment] = mean_correlation(found[repeats[first:last]])

    map_threads(correlate, np.unique(parents[repeats]).tolist())
    at = np.rint(segments.borders[1:-1] / (preset.working_fps / preset.rate)).astype(np.int64)
    sharpness = compute_sharpness(view, at, max(1, round(preset.samples(SIDE))))
    return Evidence(
        np.log(seconds * np.maximum(segments.preference, LEAST)),
        np.append(np.nan, np.log(np.maximum(sharpness, BLUNTEST))),
        repeated,
        parents,
    )


def compute_sharpness(view: NDArray[np.float32], at: Frames, side: int) -> Floats:
    """Return how much more a view changes at some samples than within `side` of these.

    The change at a sample is the energy distance of the `side` samples before it to those after it.
    Sharpness is the change at a border over the mean one of all samples nearby: 1 where nothing
    changes, or everything.

    Parameters
    ----------
    view : (samples, dims) array
    at : (borders,) array
        Samples inside the view.
    side : int

    Examples
    --------
    >>> steps = np.repeat(np.float32([0, 1]), 20)[:, None]
    >>> compute_sharpness(steps, np.array([20, 24]), 5).round(2).tolist()
    [3.24, 0.15]
    """
    found = np.ones(len(at))
    for i, border in enumerate(np.clip(at, 1, len(view) - 1).tolist() if len(view) > 1 else ()):
        first = max(border - 2 * side, 0)
        nearby = np.arange(max(border - side, 1), min(border + side + 1, len(view))) - first
        changes = compute_changes(view[first : border + 2 * side], nearby, side)
        average = changes.mean()
        if average > TINY:
            found[i] = changes[border - first - nearby[0]] / average
    return found


def compute_changes(view: NDArray[np.float32], at: Frames, side: int) -> Floats:
    """Return the energy distance of the `side` samples before some samples to those after."""
    # Sums of distances in blocks of samples, from those of all blocks that begin at 0.
    sums = np.zeros((len(view) + 1, len(view) + 1))
    apart = view[:, None].astype(np.float64) - view
    sums[1:, 1:] = np.linalg.norm(apart, axis=2).cumsum(axis=0).cumsum(axis=1)
    starts, stops = np.maximum(at - side, 0), np.minimum(at + side, len(view))

    def average(low: Frames, high: Frames, left: Frames, right: Frames) -> Floats:
        block = sums[high, right] - sums[low, right] - sums[high, left] + sums[low, left]
        return np.asarray(block / ((high - low) * (right - left)))

    within = average(starts, at, starts, at) + average(at, stops, at, stops)
    return average(starts, at, at, stops) - within / 2


def mean_correlation(repetitions: Floats) -> float:
    """Of any two repetitions, (count, places, dims), as Fisher's z; 0 of one."""
    count = len(repetitions)
    if count < 2:
        return 0.0
    rows = (repetitions - repetitions.mean(axis=1, keepdims=True)).reshape(count, -1)
    rows = rows / np.maximum(np.linalg.norm(rows, axis=1, keepdims=True), 1e-12)
    pairs = (np.square(rows.sum(axis=0)).sum() - count) / (count * (count - 1))
    return float(np.arctanh(np.clip(pairs, -CLEAREST, CLEAREST)))


def compute_confidence(evidence: Evidence, preset: KinemeConstants) -> Confidence:
    """Probabilities from the statistics and the weights of the preset."""
    borders = compute_probability(evidence.sharpness, preset.border_weights)
    cuts = compute_probability(evidence.repeated, preset.cut_weights)[evidence.parents]
    first = np.diff(evidence.parents, prepend=-1) > 0
    return Confidence(
        links=compute_probability(evidence.preferred, preset.link_weights),
        counts=compute_probability(evidence.repeated, preset.count_weights),
        borders=borders,
        cuts=np.where(first, borders[evidence.parents], cuts),
    )


def compute_probability(statistic: Floats, weights: tuple[float, float]) -> Floats:
    """Probability by a statistic, a constant, and its weight; nan where the statistic is.

    Examples
    --------
    >>> compute_probability(np.array([0.0, 2.0]), (0.0, 1.0)).round(2).tolist()
    [0.5, 0.88]
    """
    # The logistic function as a hyperbolic tangent, which does not overflow.
    found: Floats = 0.5 + 0.5 * np.tanh((weights[0] + weights[1] * statistic) / 2)
    return found
