"""Confidence: the probability that a result is right.

Three kinds of results have statistics s:

- the *cluster* of an activity: its length times its preference for the cluster over the next, and
  how well all views agree with the cluster,
- a *border* of an activity: how much more changes there than nearby (sharpness),
- a *cut* between two repetitions: how much the repetitions of the activity correlate.

The probability is 1 / (1 + exp(-(constant + weights · s))). The numbers are fitted to recordings
with a known truth, and tested on left-out sources, by ``benchmarks/truth/confidence.py``. What
predicts left-out sources no better than one probability for all has no confidence: the number of
repetitions, and borders and cuts of signals. No stage of the method reads the confidence.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import NDArray

from kineme._util.arrays import Floats
from kineme._util.parallel import map_threads
from kineme.methods.kineme._repetition_kernels import sample_repetitions
from kineme.methods.kineme.borders import convert_to_samples
from kineme.methods.kineme.primitives import Segments
from kineme.methods.kineme.repetitions import PLACES, trace_movement
from kineme.methods.kineme.tree import sum_between_segments
from kineme.methods.segments import find_segments

if TYPE_CHECKING:
    from kineme.methods.kineme.constants import KinemeConstants

Frames = NDArray[np.int64]
Weights = tuple[float, ...]
"""Constant, and weight of each statistic, in the logistic function."""


class Calibration(NamedTuple):
    """Weights for each kind of result; None for results without confidence."""

    clusters: Weights
    borders: Weights | None = None
    cuts: Weights | None = None


OF_BODIES = Calibration((-0.409, 1.666, 2.874), (-0.469, 6.862), (-0.183, 1.63))
OF_SIGNALS = Calibration((-2.993, 0.43, 5.18))
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


class Answers(NamedTuple):
    """Clusters that each view of a part of the recording finds."""

    frames: Frames
    """Frames of the samples, at the working rate."""
    clusters: list[Frames]
    """Cluster of each sample, for each view."""


@dataclass(frozen=True, eq=False)
class Evidence:
    """Statistics from which confidence is computed, each when it is first needed."""

    rows: NDArray[np.float32]
    """Features (frames, dims) at the working rate."""
    view: NDArray[np.float32]
    """Chosen view (samples, dims), at ``preset.rate``."""
    segments: Segments
    answers: Sequence[Answers]
    """One for each part of the recording."""
    preset: KinemeConstants

    @cached_property
    def preferred(self) -> Floats:
        """Return log(length times preference for the own cluster, s); nan for transitions."""
        seconds = np.diff(self.segments.borders) / self.preset.working_fps
        preferences = [
            measure_preferences(self.view, self._samples[borders], self.segments.labels[rows])
            for _, rows, borders in self._list_parts()
        ]
        return np.log(seconds * np.maximum(np.concatenate(preferences), MIN_PREFERENCE))

    @cached_property
    def agreement(self) -> Floats:
        """Return how well the views agree with the cluster of each segment; nan for transitions."""
        return np.concatenate(
            [
                measure_agreement(self.segments.borders[borders], self.segments.labels[rows], part)
                for part, rows, borders in self._list_parts()
            ]
        )

    @cached_property
    def sharpness(self) -> Floats:
        """Return log(`compute_sharpness`) of the start of each segment; nan for the first."""
        side = max(1, round(self.preset.samples(SIDE)))
        sharpness = compute_sharpness(self.view, self._samples[1:-1], side)
        return np.append(np.nan, np.log(np.maximum(sharpness, MIN_SHARPNESS)))

    @cached_property
    def repetition_similarity(self) -> Floats:
        """Return the mean correlation of pairs of repetitions of each segment, as Fisher's z.

        It is 0 for a single repetition, and nan if the primitives are not repetitions.
        """
        parents, repeats = self.segments.parents, self.segments.repeats
        correlations = np.full(len(self.segments.labels), np.nan)

        def store_correlation(segment: int) -> None:
            """Write the mean correlation of a segment to ``correlations``."""
            # Primitives of the segment, and their borders in frames at the working rate.
            first, last = self.segments.firsts[segment : segment + 2]
            borders = self.segments.primitives[first : last + 1]
            start, stop = borders[0], max(borders[-1], borders[0] + 1)  # at least one frame
            movement = trace_movement(self.rows[start:stop], self.preset)
            samples = sample_repetitions(movement.poses, movement.path, borders - start, PLACES)
            correlations[segment] = compute_mean_correlation(samples[repeats[first:last]])

        map_threads(store_correlation, np.unique(parents[repeats]).tolist())
        return correlations

    @cached_property
    def _samples(self) -> Frames:
        """Return the borders of segments in samples of the view."""
        return convert_to_samples(self.segments.borders, self.preset, len(self.view))

    def _list_parts(self) -> list[tuple[Answers, slice, slice]]:
        """Return the answers for each part, and the segments and borders with their middle in it.

        Clusters of views hold for one part only.
        """
        middles = (self.segments.borders[:-1] + self.segments.borders[1:]) // 2
        ends = np.searchsorted(middles, [*(part.frames[0] for part in self.answers), np.inf])
        return [
            (part, slice(first, last), slice(first, last + 1))
            for part, (first, last) in zip(self.answers, pairwise(ends.tolist()), strict=True)
        ]


@dataclass(frozen=True, eq=False)
class Confidence:
    """Probabilities that results are right; nan where there is none."""

    clusters: Floats
    """Probability of the cluster of each segment."""
    borders: Floats
    """Probability of the start of each segment."""
    cuts: Floats
    """Probability of the start of each primitive; for the first one that of the segment."""


def measure_preferences(view: NDArray[np.float32], borders: Frames, labels: Frames) -> Floats:
    """Return how much nearer each segment is to its own cluster than to the next, 0 to 1.

    It is 1 less the ratio of both mean distances; 1 if there is no other cluster. Borders are in
    samples of the view. Transitions have the label -1, and get nan.

    Examples
    --------
    >>> view = np.repeat(np.float32([0, 1, 5, 6]), 2)[:, None]
    >>> borders, labels = np.array([0, 2, 4, 6, 8]), np.array([0, 0, 1, 1])
    >>> measure_preferences(view, borders, labels).round(2).tolist()
    [0.91, 0.89, 0.89, 0.91]
    """
    own = np.flatnonzero(labels >= 0)
    preferences = np.full(len(labels), np.nan)
    if len(own):
        lengths = np.diff(borders)[own]
        sums = sum_between_segments(view, borders, 1.0)[np.ix_(own, own)]
        clusters, cluster = np.unique(labels[own], return_inverse=True)
        members = np.eye(len(clusters))[cluster]
        means = (sums @ members) / np.outer(lengths, lengths @ members)
        rows = np.arange(len(own))
        inside = means[rows, cluster]
        means[rows, cluster] = np.inf  # excludes the own cluster from the minimum
        preferences[own] = np.clip(1 - inside / np.maximum(means.min(axis=1), 1e-12), 0, 1)
    return preferences


def measure_agreement(borders: Frames, labels: Frames, part: Answers) -> Floats:
    """Return how well the views agree with the cluster of each segment of a part, 0 to 1.

    A view has a cluster with which it covers most of the segment. Its agreement is twice the number
    of samples that this cluster shares with the segment's cluster, over the sum of both sizes
    (F1 score). Borders are frames. Transitions have the label -1, and get nan.

    Examples
    --------
    >>> views = [np.array([0, 0, 1, 1]), np.array([0, 0, 0, 0])]
    >>> part = Answers(np.arange(4), views)
    >>> measure_agreement(np.array([0, 2, 4]), np.array([0, 1]), part).round(2).tolist()
    [0.83, 0.83]
    """
    segment = find_segments(borders, part.frames)
    inside = (segment >= 0) & (segment < len(labels))
    members = np.eye(labels.max(initial=-1) + 2)[labels, :-1]  # -1 has no column
    own = np.flatnonzero(labels >= 0)
    scores = []
    for clusters in part.clusters:
        # Samples of each segment (row) in each cluster of the view (column).
        shared = np.zeros((len(labels), clusters.max() + 1))
        np.add.at(shared, (segment[inside], clusters[inside]), 1)
        both = members.T @ shared
        sizes = np.add.outer(both.sum(axis=1), shared.sum(axis=0))
        scores.append((2 * both / np.maximum(sizes, 1))[labels[own], shared[own].argmax(axis=1)])
    agreement = np.full(len(labels), np.nan)
    agreement[own] = np.mean(scores, axis=0)
    return agreement


def compute_sharpness(view: NDArray[np.float32], at: Frames, side: int) -> Floats:
    """Return the change of a view at some samples, relative to the changes within `side` of them.

    The change at a sample is the energy distance between the `side` samples before it and those
    after it. Sharpness is this change divided by the mean change of the samples nearby. It is 1
    if the view changes everywhere or nowhere.

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


def compute_confidence(evidence: Evidence, calibration: Calibration) -> Confidence:
    """Compute probabilities from the statistics; nan for results without weights."""
    parents = evidence.segments.parents
    borders = cuts = np.full(len(evidence.segments.labels), np.nan)
    if calibration.borders:
        borders = compute_probability(calibration.borders, evidence.sharpness)
    if calibration.cuts:
        cuts = compute_probability(calibration.cuts, evidence.repetition_similarity)
    # The first primitive of a segment starts at the border of the segment.
    is_first = np.diff(parents, prepend=-1) > 0
    return Confidence(
        clusters=compute_probability(calibration.clusters, evidence.preferred, evidence.agreement),
        borders=borders,
        cuts=np.where(is_first, borders[parents], cuts[parents]),
    )


def compute_probability(weights: Weights, *statistics: Floats) -> Floats:
    """Return the logistic function of constant + weights · statistics.

    Examples
    --------
    >>> compute_probability((0.0, 1.0), np.array([0.0, 2.0])).round(2).tolist()
    [0.5, 0.88]
    """
    constant, *factors = weights
    exponent = constant + sum(map(np.multiply, factors, statistics))
    # The logistic function as a hyperbolic tangent, which does not overflow.
    probability: Floats = 0.5 + 0.5 * np.tanh(exponent / 2)
    return probability
