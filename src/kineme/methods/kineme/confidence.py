"""Confidence: the probability that a result is right.

Four kinds of results have a probability:

- the *link* of an activity: it is in the same cluster as equal movements,
- a *border* of an activity: a true border is close by,
- the *count* of an activity: it has this number of repetitions,
- a *cut* between two repetitions: a true cut is close by.

The probabilities follow from three statistics s: the length of an activity times its preference
for its cluster, in seconds; the sharpness of a border, which is the change at the border relative
to the changes nearby; and the correlation of repetitions. Each probability is
1 / (1 + exp(-(constant + weight s))). The constants and weights are fitted to recordings with a
known truth and tested on left-out sources, by ``benchmarks/truth/confidence.py``. No stage of the
method reads them.
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

MIN_PREFERENCE = 0.02
"""Smallest preference of a segment for its own cluster; smaller ones are raised to it."""
MAX_CORRELATION = 0.995
"""Largest correlation; larger ones are reduced to it."""
SIDE = 2.0
"""Seconds before and after a border that are compared, and range of the changes nearby."""
TINY = 1e-9
"""Smallest mean change; below it sharpness is 1."""
MIN_SHARPNESS = 0.05
"""Smallest sharpness of a border; smaller ones are raised to it."""


@dataclass(frozen=True, eq=False)
class Evidence:
    """Statistics from which confidence is computed.

    Attributes
    ----------
    preferred : (segments,) array
        Logarithm of length times preference for the own cluster, s; nan for transitions.
    sharpness : (segments,) array
        Logarithm of the sharpness of the start border (`compute_sharpness`); nan for the first.
    repeated : (segments,) array
        Mean correlation of pairs of repetitions, as Fisher's z; 0 for a single repetition, nan
        if the primitives are not repetitions.
    parents : (primitives,) array
        Segment that contains each primitive.
    """

    preferred: Floats
    sharpness: Floats
    repeated: Floats
    parents: Frames


@dataclass(frozen=True, eq=False)
class Confidence:
    """Probabilities that results are right; nan without a cluster, count, border or cut.

    Attributes
    ----------
    links, counts, borders : (segments,) array
        Probability of the cluster of each segment, of its repetition count, and of its start.
    cuts : (primitives,) array
        Probability of the start of each primitive; for the first one that of the segment.
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
    """Compute the statistics of activities and their repetitions.

    Parameters
    ----------
    rows : (frames, dims) array
        Features at the working rate.
    view : (samples, dims) array
        The chosen view, at ``preset.rate``.
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
        samples = sample_repetitions(movement.poses, movement.path, edges - edges[0], PLACES)
        repeated[segment] = compute_mean_correlation(samples[repeats[first:last]])

    map_threads(correlate, np.unique(parents[repeats]).tolist())
    # Inner borders in samples of the view.
    borders = np.rint(segments.borders[1:-1] / (preset.working_fps / preset.rate)).astype(np.int64)
    sharpness = compute_sharpness(view, borders, max(1, round(preset.samples(SIDE))))
    return Evidence(
        np.log(seconds * np.maximum(segments.preference, MIN_PREFERENCE)),
        np.append(np.nan, np.log(np.maximum(sharpness, MIN_SHARPNESS))),
        repeated,
        parents,
    )


def compute_sharpness(view: NDArray[np.float32], at: Frames, side: int) -> Floats:
    """Return the change of a view at some samples, relative to the changes within `side` of them.

    The change at a sample is the energy distance between the `side` samples before it and those
    after it. Sharpness is this change divided by the mean change of the samples nearby. It is 1
    if the view changes everywhere or nowhere.

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
    sharpness = np.ones(len(at))
    for i, border in enumerate(np.clip(at, 1, len(view) - 1).tolist() if len(view) > 1 else ()):
        first = max(border - 2 * side, 0)
        nearby = np.arange(max(border - side, 1), min(border + side + 1, len(view))) - first
        changes = compute_changes(view[first : border + 2 * side], nearby, side)
        average = changes.mean()
        if average > TINY:
            sharpness[i] = changes[border - first - nearby[0]] / average
    return sharpness


def compute_changes(view: NDArray[np.float32], at: Frames, side: int) -> Floats:
    """Return half the energy distance between the `side` samples before and after some samples."""
    # Cumulative sums along both axes give the sum over any block from four values.
    sums = np.zeros((len(view) + 1, len(view) + 1))
    differences = view[:, None].astype(np.float64) - view
    sums[1:, 1:] = np.linalg.norm(differences, axis=2).cumsum(axis=0).cumsum(axis=1)
    starts, stops = np.maximum(at - side, 0), np.minimum(at + side, len(view))

    def average(low: Frames, high: Frames, left: Frames, right: Frames) -> Floats:
        """Return the mean distance of samples [low, high) to samples [left, right)."""
        block = sums[high, right] - sums[low, right] - sums[high, left] + sums[low, left]
        return np.asarray(block / ((high - low) * (right - left)))

    within = average(starts, at, starts, at) + average(at, stops, at, stops)
    return average(starts, at, at, stops) - within / 2


def compute_mean_correlation(repetitions: Floats) -> float:
    """Return the mean correlation of pairs of repetitions (count, places, dims) as Fisher's z."""
    count = len(repetitions)
    if count < 2:
        return 0.0
    rows = (repetitions - repetitions.mean(axis=1, keepdims=True)).reshape(count, -1)
    rows = rows / np.maximum(np.linalg.norm(rows, axis=1, keepdims=True), 1e-12)
    # |sum of unit vectors|² is count plus the correlations of all ordered pairs.
    pairs = (np.square(rows.sum(axis=0)).sum() - count) / (count * (count - 1))
    return float(np.arctanh(np.clip(pairs, -MAX_CORRELATION, MAX_CORRELATION)))


def compute_confidence(evidence: Evidence, preset: KinemeConstants) -> Confidence:
    """Compute probabilities from the statistics and the weights of the preset."""
    borders = compute_probability(evidence.sharpness, preset.border_weights)
    cuts = compute_probability(evidence.repeated, preset.cut_weights)[evidence.parents]
    # The first primitive of a segment starts at the border of the segment.
    first = np.diff(evidence.parents, prepend=-1) > 0
    return Confidence(
        links=compute_probability(evidence.preferred, preset.link_weights),
        counts=compute_probability(evidence.repeated, preset.count_weights),
        borders=borders,
        cuts=np.where(first, borders[evidence.parents], cuts),
    )


def compute_probability(statistic: Floats, weights: tuple[float, float]) -> Floats:
    """Return the logistic function of (constant, weight) and a statistic; nan stays nan.

    Examples
    --------
    >>> compute_probability(np.array([0.0, 2.0]), (0.0, 1.0)).round(2).tolist()
    [0.5, 0.88]
    """
    # The logistic function as a hyperbolic tangent, which does not overflow.
    probability: Floats = 0.5 + 0.5 * np.tanh((weights[0] + weights[1] * statistic) / 2)
    return probability
