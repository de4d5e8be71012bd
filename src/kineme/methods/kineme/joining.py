"""Neighbours that are one set: activities that differ in posture, but not in movement.

A set drifts: the hand moves on, the body sinks, the camera turns. Means over a second see another
activity in this, above all where repetitions are fast. So two neighbours are divided once more, as
one span. They are one set if

- one of them has too few repetitions to be sure by itself;
- the division of both has as many repetitions on each side as the side has alone. Divisions that
  agree are no chance, however short the repetitions are;
- it is one movement by the tests of a segment that repeats (`share_of_one_movement`);
- without their mean pose, repetitions near the border are nearly as like those beyond it as they
  are like each other, and last nearly as long: by at least `same_set`.

The last is relative, as sets done badly correlate less with themselves than two exercises done well
do with each other. The method is ours; see ``docs/method.md``.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import NDArray

from kineme._util.arrays import Floats
from kineme._util.parallel import map_threads
from kineme.methods.kineme._repeating_kernels import ROUGH
from kineme.methods.kineme._repetition_kernels import sample_repetitions
from kineme.methods.kineme.ends import fit_edges
from kineme.methods.kineme.repeating import SPAN, share_of_one_movement
from kineme.methods.kineme.repetitions import PLACES, find_repetitions, trace_movement
from kineme.methods.segments import number_by_appearance

if TYPE_CHECKING:
    from kineme.methods.kineme.constants import KinemeConstants

Frames = NDArray[np.int64]
Rows = NDArray[np.float32]

NEAR = 4
"""Repetitions on each side of a border that are compared: farther ones have drifted."""
COVERED = 0.8
"""Share of the side with fewer repetitions that they must cover."""
ONE_MOVEMENT = 0.5
"""Least `share_of_one_movement` of a set."""
SURE = 2
"""Times `chance_count`: a side with so many repetitions is an activity by itself."""
TINY = 1e-12
"""Least similarity that something is divided by."""


class Sets(NamedTuple):
    """Activities in time order: frames, clusters, preferences as in `Segments`, and repetitions.

    ``cuts`` are the frames at which the second, third, ... repetition of each begins.
    """

    starts: Frames
    stops: Frames
    labels: Frames
    preference: Floats
    cuts: list[Frames]


class Merger(NamedTuple):
    """Two neighbours as one: how like their repetitions are across the border, and its cuts."""

    likeness: float
    cuts: Frames


def join_sets(rows: Rows, found: Sets, preset: KinemeConstants) -> Sets:
    """Return the activities, where neighbours that are one set are one, the surest joined first.

    A joined activity has the cluster of its longer part.

    Parameters
    ----------
    rows : (frames, dims) array
        At the working rate.
    found : Sets
        What lies between two of them is a transition.
    preset : KinemeConstants
    """
    starts, stops, labels, preference = (values.tolist() for values in found[:4])
    cuts = list(found.cuts)

    def union(left: int) -> Merger:
        right = left + 1
        counts = len(cuts[left]) + 1, len(cuts[right]) + 1
        start, stop = starts[left], stops[right]
        # Of fewer than three repetitions none lies between two others. Two sides that both have
        # enough of them to be sure, as walking and running have, stay apart.
        is_sure = min(counts) >= SURE * preset.chance_count
        if max(counts) < 3 or is_sure or stop - start > preset.frames(SPAN[1]):
            return Merger(0.0, np.empty(0, np.int64))
        together = find_repetitions(rows, start, stop, preset)
        border = (stops[left] + starts[right]) // 2 - start
        likeness = measure_likeness(rows[start:stop], together - start, border, counts, preset)
        return Merger(likeness, together)

    unions = map_threads(union, range(len(starts) - 1))
    while unions:
        at = int(np.argmax([each.likeness for each in unions]))
        if unions[at].likeness < preset.same_set:
            break
        longer = at + int(stops[at + 1] - starts[at + 1] > stops[at] - starts[at])
        labels[at], preference[at] = labels[longer], preference[longer]
        stops[at] = stops[at + 1]
        cuts[at] = unions[at].cuts
        del starts[at + 1], stops[at + 1], labels[at + 1], preference[at + 1], cuts[at + 1]
        del unions[at]
        # Only the union has new neighbours.
        for left in (at - 1, at):
            if 0 <= left < len(unions):
                unions[left] = union(left)
    clusters = number_by_appearance(np.array(labels, np.int64))
    return Sets(np.array(starts), np.array(stops), clusters, np.array(preference), cuts)


def measure_likeness(
    rows: Rows, cuts: Frames, border: int, counts: tuple[int, int], preset: KinemeConstants
) -> float:
    """Return how like repetitions are across a border, as a share of how like they are beside it.

    0 if the span, divided as a whole, is not one movement with so many repetitions on each side.

    Parameters
    ----------
    rows : (frames, dims) array
        Of both sides.
    cuts : array of int
        Where the second, third, ... repetition begins if both are divided as one.
    border : int
        Frame at which the right side begins.
    counts : tuple of int
        Repetitions of each side where it is divided alone.
    preset : KinemeConstants
    """
    if len(cuts) < 2:  # nothing lies between two cuts
        return 0.0
    edges = fit_edges(rows, cuts)
    durations = np.diff(edges)
    before = int(np.count_nonzero(edges[:-1] + durations / 2 < border))
    # The count of a side with two is no evidence: it may be any two halves.
    agree = all(
        abs(alone - together) <= 1
        for alone, together in zip(counts, (before, len(durations) - before), strict=True)
        if alone > 2
    )
    head, tail = border - edges[0], edges[-1] - border
    covered = (counts[0] > counts[1] or head >= COVERED * border) and (
        counts[1] > counts[0] or tail >= COVERED * (len(rows) - border)
    )
    if not (agree and covered and 0 < before < len(durations)):
        return 0.0
    movement = trace_movement(rows, preset)
    repeated = sample_repetitions(movement.poses, movement.path, edges, PLACES)
    centered = repeated - repeated.mean(axis=1, keepdims=True)
    even = 1 - min(float(np.log(durations).std()) / preset.uneven, 1.0) ** 2
    if even < preset.same_set or share_of_one_movement(centered, preset) < ONE_MOVEMENT:
        return 0.0
    near = repeated[max(before - NEAR, 0) : before + NEAR]
    beside, across = compare_at_border(near, min(before, NEAR), preset.centering)
    # Of sets done well nearly all is alike: little may be unlike across the border, too.
    if 1 - beside + ROUGH < preset.two_movements * (1 - across + ROUGH):
        return 0.0
    return even * across / max(beside, TINY)


def compare_at_border(repeated: Floats, border: int, centering: float) -> tuple[float, float]:
    """Return the mean correlation of two repetitions beside a border, and of two across it.

    Parameters
    ----------
    repeated : (repetitions, places, dims) array
        Three at least.
    border : int
        The first repetition of the right side.
    centering : float
        Share of its mean pose that is subtracted from each.

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
    alike = rows @ rows.T
    sides = [alike[:border, :border], alike[border:, border:]]
    # A side of one repetition has no pair.
    beside = [side[np.triu_indices(len(side), 1)].mean() for side in sides if len(side) > 1]
    return float(np.mean(beside)), float(alike[:border, border:].mean())
