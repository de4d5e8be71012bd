"""Merge neighbouring activities that are one set of repetitions with a drifting posture.

Posture drifts during a set: the hand moves on, the body sinks, the camera turns. The tree can take
this for a new activity, above all if repetitions are fast. So two neighbours are divided into
repetitions again as one span. They are merged if

- one of them has too few repetitions to be a certain activity by itself;
- the joint division has the same number of repetitions on each side as the side has alone, which
  is unlikely by chance;
- it passes the tests for a single movement (`score_one_movement`);
- without their mean pose, repetitions near the border are about as similar to those across it as
  to each other, and last about as long (at least `same_set`).

The last test is relative, because repetitions of a badly performed set correlate less with each
other than two well performed exercises do. The method is ours; see ``docs/method.md``.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import NDArray

from kineme._util.arrays import Floats
from kineme._util.parallel import map_threads
from kineme.methods.kineme._repetition_kernels import ROUGH, sample_repetitions
from kineme.methods.kineme.borders import fit_edges
from kineme.methods.kineme.repetitions import (
    PLACES,
    SPAN,
    find_repetitions,
    score_one_movement,
    trace_movement,
)
from kineme.methods.segments import number_by_appearance

if TYPE_CHECKING:
    from kineme.methods.kineme.constants import KinemeConstants

Frames = NDArray[np.int64]
Rows = NDArray[np.float32]

N_COMPARED = 4
"""Number of repetitions on each side of a border that are compared; others have drifted."""
MIN_COVERED = 0.8
"""Share of the side with fewer repetitions that these must cover."""
MIN_ONE_MOVEMENT = 0.5
"""Smallest `score_one_movement` of a set."""
CERTAIN_FACTOR = 2
"""A side with this many times `chance_count` repetitions is an activity by itself."""
TINY = 1e-12
"""Smallest divisor."""


class Sets(NamedTuple):
    """Activities in time order: frames, clusters, preferences as in `Segments`, and repetitions.

    ``cuts`` are the starts of the second, third, ... repetition of each activity.
    """

    starts: Frames
    stops: Frames
    labels: Frames
    preference: Floats
    cuts: list[Frames]


class MergeCandidate(NamedTuple):
    """Two neighbours as one: similarity of repetitions across the border, and joint cuts."""

    similarity: float
    cuts: Frames


def join_sets(rows: Rows, found: Sets, preset: KinemeConstants) -> Sets:
    """Merge neighbouring activities that are one set, the most similar ones first.

    A merged activity has the cluster of its longer part.

    Parameters
    ----------
    rows : (frames, dims) array
        At the working rate.
    found : Sets
        Frames between two of them are a transition.
    preset : KinemeConstants
    """
    starts, stops, labels, preference = (values.tolist() for values in found[:4])
    cuts = list(found.cuts)

    def evaluate(left: int) -> MergeCandidate:
        right = left + 1
        counts = len(cuts[left]) + 1, len(cuts[right]) + 1
        start, stop = starts[left], stops[right]
        # With fewer than three repetitions there is no inner one to compare. Two sides that are
        # both certain, such as walking and running, are not merged.
        is_certain = min(counts) >= CERTAIN_FACTOR * preset.chance_count
        if max(counts) < 3 or is_certain or stop - start > preset.frames(SPAN[1]):
            return MergeCandidate(0.0, np.empty(0, np.int64))
        joint_cuts = find_repetitions(rows, start, stop, preset)
        border = (stops[left] + starts[right]) // 2 - start
        similarity = compare_sides(rows[start:stop], joint_cuts - start, border, counts, preset)
        return MergeCandidate(similarity, joint_cuts)

    candidates = map_threads(evaluate, range(len(starts) - 1))
    while candidates:
        best = int(np.argmax([each.similarity for each in candidates]))
        if candidates[best].similarity < preset.same_set:
            break
        longer = best + int(stops[best + 1] - starts[best + 1] > stops[best] - starts[best])
        labels[best], preference[best] = labels[longer], preference[longer]
        stops[best] = stops[best + 1]
        cuts[best] = candidates[best].cuts
        for values in (starts, stops, labels, preference, cuts):
            del values[best + 1]
        del candidates[best]
        # Only the merged activity has new neighbours.
        for left in (best - 1, best):
            if 0 <= left < len(candidates):
                candidates[left] = evaluate(left)
    clusters = number_by_appearance(np.array(labels, np.int64))
    return Sets(np.array(starts), np.array(stops), clusters, np.array(preference), cuts)


def compare_sides(
    rows: Rows, cuts: Frames, border: int, counts: tuple[int, int], preset: KinemeConstants
) -> float:
    """Return the similarity of repetitions across a border, relative to that on each side.

    Return 0 if the joint division fails one of the other tests; see the module docstring.

    Parameters
    ----------
    rows : (frames, dims) array
        Frames of both sides.
    cuts : array of int
        Starts of the second, third, ... repetition of the joint division.
    border : int
        First frame of the right side.
    counts : tuple of int
        Number of repetitions of each side when divided alone.
    preset : KinemeConstants
    """
    if len(cuts) < 2:  # there is no inner repetition
        return 0.0
    edges = fit_edges(rows, cuts)
    durations = np.diff(edges)
    before = int(np.count_nonzero(edges[:-1] + durations / 2 < border))
    # A count of two is no evidence: any span has two halves.
    agree = all(
        abs(alone - together) <= 1
        for alone, together in zip(counts, (before, len(durations) - before), strict=True)
        if alone > 2
    )
    head, tail = border - edges[0], edges[-1] - border
    covered = (counts[0] > counts[1] or head >= MIN_COVERED * border) and (
        counts[1] > counts[0] or tail >= MIN_COVERED * (len(rows) - border)
    )
    if not (agree and covered and 0 < before < len(durations)):
        return 0.0
    movement = trace_movement(rows, preset)
    repeated = sample_repetitions(movement.poses, movement.path, edges, PLACES)
    centered = repeated - repeated.mean(axis=1, keepdims=True)
    # 1 for equal durations, 0 if the standard deviation of their logarithms reaches `uneven`.
    evenness = 1 - min(float(np.log(durations).std()) / preset.uneven, 1.0) ** 2
    if evenness < preset.same_set or score_one_movement(centered, preset) < MIN_ONE_MOVEMENT:
        return 0.0
    compared = repeated[max(before - N_COMPARED, 0) : before + N_COMPARED]
    beside, across = compare_at_border(compared, min(before, N_COMPARED), preset.centering)
    # If each side is very uniform, even a small difference across the border is significant.
    if 1 - beside + ROUGH < preset.two_movements * (1 - across + ROUGH):
        return 0.0
    return evenness * across / max(beside, TINY)


def compare_at_border(repeated: Floats, border: int, centering: float) -> tuple[float, float]:
    """Return the mean correlation of repetitions on the same side of a border, and across it.

    Parameters
    ----------
    repeated : (repetitions, places, dims) array
        At least three.
    border : int
        Index of the first repetition of the right side.
    centering : float
        Share of its mean pose that is subtracted from each repetition.

    Examples
    --------
    >>> swing = np.array([[0.0], [1.0], [0.0], [-1.0]])
    >>> beside, across = compare_at_border(np.stack([swing, swing + 5, -swing]), 2, 1.0)
    >>> round(beside, 2), round(across, 2)
    (1.0, -1.0)
    """
    rows = repeated - centering * repeated.mean(axis=1, keepdims=True)
    rows = rows.reshape(len(rows), -1)
    rows = rows / np.maximum(np.linalg.norm(rows, axis=1, keepdims=True), TINY)
    correlations = rows @ rows.T
    sides = [correlations[:border, :border], correlations[border:, border:]]
    # A side with one repetition has no pairs.
    beside = [side[np.triu_indices(len(side), 1)].mean() for side in sides if len(side) > 1]
    return float(np.mean(beside)), float(correlations[:border, border:].mean())
