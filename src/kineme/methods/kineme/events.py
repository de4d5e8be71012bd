"""Occurrences: spans of movement that recur anywhere, whether or not back to back.

Spans are compared in *movement time*. It passes in proportion to the speed of the body, and hardly
while the body stands still, so that standing still twice is no event. A sample is a pose with its
velocity: a movement played backwards passes the same poses, but does not match.

Two spans match by a warping path, whose score is the time for which they are similar, in seconds
of usual movement. A set is a span with all others that match it and do not overlap. The span whose
matches score most is taken first, then the best of what is left (sets chosen greedily as in
LoCoMotif, Van Wesenbeeck, Yurtman, Meert and Blockeel 2024; scores are ours).
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from kineme._util.arrays import Floats, Ints
from kineme._util.parallel import check_cancelled
from kineme.methods.kineme import _event_kernels as kernels
from kineme.methods.segments import number_by_appearance

if TYPE_CHECKING:
    from kineme.methods.kineme.constants import KinemeConstants

Paths = tuple[Ints, Ints, Floats, Floats, Ints, Ints]

STEP = 0.1
"""Seconds of usual movement from one sample to the next."""
WINDOW = 300.0
"""Seconds of movement that two occurrences of an event are apart, at most."""
LEG = 60.0
"""Seconds of movement of one leg of a path: its work grows with the square of that."""
LENGTHS = 24
"""Lengths of spans that are tried, between the shortest and the longest."""
JOINS = 0.6
"""Share of `min_recurrence` from which a span joins a set in which another has all of it."""
PAIR = 2.0
"""Times `min_recurrence` that a set of two must score."""
WORST = -2.0
"""Lowest score of a pair of samples, however far they are apart."""


@dataclass(frozen=True, eq=False)
class Occurrences:
    """Spans that recur, in time order; none overlaps another.

    Attributes
    ----------
    starts, stops : (occurrences,) array of int
        Frames of the working rate.
    clusters : (occurrences,) array of int
        Equal numbers recur as each other; from 0 by first appearance.
    similarity : (occurrences,) array
        Similarity of each to the one that stands for its set, 0 to 1.
    """

    starts: Ints
    stops: Ints
    clusters: Ints
    similarity: Floats

    def __len__(self) -> int:
        return len(self.starts)

    def explained(self, borders: Ints) -> Floats:
        """Return the share of each segment that recurs, weighted by similarity: 0 to 1."""
        lengths = (self.stops - self.starts) * self.similarity
        inside = np.bincount(self._segments(borders), lengths, len(borders) - 1)
        return inside / np.diff(borders)

    def within(self, borders: Ints, chosen: NDArray[np.bool_]) -> Occurrences:
        """Those with their middle in one of the chosen segments that recur in these."""
        kept = chosen[self._segments(borders)]
        kept &= np.bincount(self.clusters[kept], minlength=len(self))[self.clusters] > 1
        clusters = number_by_appearance(self.clusters[kept])
        return Occurrences(self.starts[kept], self.stops[kept], clusters, self.similarity[kept])

    def _segments(self, borders: Ints) -> Ints:
        """Return the segment in which the middle of each lies."""
        middles = (self.starts + self.stops) // 2
        segments: Ints = np.searchsorted(borders, middles, side="right") - 1
        return segments


def find_occurrences(
    poses: NDArray[np.floating], free: NDArray[np.bool_], preset: KinemeConstants
) -> Occurrences:
    """Return what recurs among the frames that are free.

    Parameters
    ----------
    poses : (frames, dims) array
        At the working rate, in body sizes, without their neighbours in time.
    free : (frames,) array of bool
        Where occurrences may lie.
    preset : KinemeConstants
    """
    per_second = preset.working_fps / _step(preset)

    def in_samples(seconds: float) -> int:
        return round(seconds * per_second)

    samples = _sample_frames(np.asarray(poses, np.float64), free, preset)
    if len(samples.seconds) < 2:
        none = np.empty(0, np.int64)
        return Occurrences(none, none, none, np.empty(0))
    shortest = max(1, in_samples(preset.min_recurrence))
    starts, ptr, partners, sums, row_ptr, row_paths = find_matching_paths(
        samples.columns,
        preset.event_cost * samples.seconds,
        samples.begins,
        gap=shortest,
        width=in_samples(WINDOW),
        leg=max(1, in_samples(LEG)),
        scale=preset.event_scale,
        least=JOINS * preset.min_recurrence * per_second,
    )
    longest = max(shortest, in_samples(preset.max_repetition))
    lengths = np.unique(np.geomspace(shortest, longest, LENGTHS).round().astype(np.int64))
    all_free = np.ones(len(samples.seconds), np.bool_)
    check_cancelled()
    spans, scores, ranks = kernels.choose_sets(
        lengths, starts, ptr, partners, sums, row_ptr, row_paths, all_free, preset.event_cover
    )
    # A set is kept if its strongest path is no chance; of two spans there is no second witness.
    strongest = np.zeros(len(ranks))
    np.maximum.at(strongest, ranks, scores)
    factors = np.where(np.bincount(ranks)[ranks] == 2, PAIR, 1.0)
    strong = strongest[ranks] >= factors * preset.min_recurrence * per_second
    order = np.flatnonzero(strong)[np.argsort(spans[strong, 0])]
    spans, ranks = spans[order], ranks[order]
    similarity = np.clip(scores[order] / np.maximum(np.diff(spans)[:, 0], 1), 0, 1)
    starts, stops = samples.edges[spans[:, 0], 0], samples.edges[spans[:, 1] - 1, 1]
    stops[:-1] = np.minimum(stops[:-1], starts[1:])
    return Occurrences(starts, stops, number_by_appearance(ranks), similarity)


# --- samples at equal steps of movement time ----------------------------------------------------


@dataclass(frozen=True, eq=False)
class _Samples:
    """Frames at equal steps of movement time.

    Attributes
    ----------
    columns : (dims, samples) array
        Poses and velocities.
    edges : (samples, 2) array
        First frame of each sample, and one past its last.
    seconds : (samples,) array
        How long each lasts, in steps: 1 where the body moves as fast as usual.
    begins : (samples,) array of bool
        Whether the frames before it are not free.
    """

    columns: Floats
    edges: Ints
    seconds: Floats
    begins: NDArray[np.bool_]


def _sample_frames(poses: Floats, free: NDArray[np.bool_], preset: KinemeConstants) -> _Samples:
    """Return the free frames at equal steps of movement time."""
    n = len(poses)
    frames = np.arange(n)
    before, after = np.maximum(frames - 1, 0), np.minimum(frames + 1, n - 1)
    elapsed = np.maximum(after - before, 1)[:, None] / preset.working_fps
    velocities = (poses[after] - poses[before]) / elapsed
    speeds = np.linalg.norm(velocities, axis=1)
    if speeds.mean() * preset.max_repetition < preset.event_scale:
        free = np.zeros(n, np.bool_)  # nobody moves: all is one pose
    rates = preset.event_rest + (1 - preset.event_rest) * speeds / max(speeds.mean(), 1e-12)
    time = np.append(0, np.cumsum(rates))
    at = np.interp(np.arange(0, time[-1], _step(preset)), time, np.arange(n + 1))
    edges = np.append(np.minimum(at.astype(np.int64), n - 1), n)
    spans = np.column_stack([edges[:-1], edges[1:]])
    kept = np.flatnonzero(free[spans[:, 0]])
    begins = np.diff(kept, prepend=-2) > 1
    rows = np.hstack([poses, preset.event_velocity * velocities])[spans[kept, 0]]
    seconds = np.diff(at, append=n)[kept] / _step(preset)
    return _Samples(np.ascontiguousarray(rows.T), spans[kept], seconds, begins)


def _step(preset: KinemeConstants) -> int:
    """Frames of usual movement from one sample to the next."""
    return max(1, preset.frames(STEP))


# --- warping paths by which the samples match each other ----------------------------------------


def find_matching_paths(
    columns: Floats,
    costs: Floats,
    begins: NDArray[np.bool_],
    *,
    gap: int,
    width: int,
    leg: int,
    scale: float,
    least: float,
) -> Paths:
    """Paths by which samples match others: start, partners and scores, from either side.

    The ends of a path are found first. Then it is computed between them, in legs: from each of the
    pairs that it passed to the next, so that the work grows with its length and not its square.

    Parameters
    ----------
    columns : (dims, samples) array
    costs : (samples,) array
        Subtracted from the score of each sample, so that stillness gains nothing.
    begins : (samples,) array of bool
        Samples into which no path steps.
    gap, width : int
        Samples that pairs are apart, at least and at most.
    leg : int
        Samples of one leg.
    scale : float
        Distance from which two samples are not similar.
    least : float
        Score of a path at least.

    Returns
    -------
    starts : (paths,) array
        First sample of each; a path and the same from the other side are neighbours.
    ptr : (paths + 1,) array
        Where the samples of each begin in the next two.
    partners, sums : arrays
        Of each sample of each path: its partner, and the score up to there.
    row_ptr : (samples + 1,) array
        Where the paths of each sample begin in the last.
    row_paths : array of int
    """
    ends, _, passed = kernels.find_local_paths(
        columns, costs, begins, gap, width, leg, scale, WORST, least
    )
    starts, partners, sums = [], [np.empty(0)], [np.empty(0)]
    for each in ends:
        check_cancelled()
        forth, forth_sums, back, back_sums = split_path(columns, costs, each, passed, scale)
        starts += [each[0], each[1]]
        partners += [forth, back]
        sums += [forth_sums, back_sums]
    sizes = np.array([len(each) for each in partners[1:]], np.int64)
    ptr = np.append(0, np.cumsum(sizes))
    first = np.array(starts, np.int64)
    rows = np.repeat(first - ptr[:-1], sizes) + np.arange(ptr[-1])
    row_paths = np.repeat(np.arange(len(sizes)), sizes)[np.argsort(rows, kind="stable")]
    row_ptr = np.append(0, np.cumsum(np.bincount(rows, minlength=len(costs))))
    return first, ptr, np.concatenate(partners), np.concatenate(sums), row_ptr, row_paths


def split_path(
    columns: Floats, costs: Floats, ends: Ints, passed: Ints, scale: float
) -> tuple[Floats, Floats, Floats, Floats]:
    """Partners and scores of a path, from its first side and from the second.

    Parameters
    ----------
    columns, costs, scale
        See `find_matching_paths`.
    ends : (5,) array
        First and last pair, and the latest of the pairs passed.
    passed : (pairs, 3) array
        Pairs, and the one passed before each; see `_event_kernels.find_local_paths`.
    """
    pairs, latest = [ends[2:4]], int(ends[4])
    while latest >= 0:
        pairs.append(passed[latest, :2])
        latest = int(passed[latest, 2])
    pairs.append(ends[:2])
    legs = [
        kernels.trace_path(columns, costs, np.append(start, stop), scale, WORST)
        for stop, start in pairwise(pairs)
    ]
    forth, forth_sums, back, back_sums = map(_join_legs, zip(*legs[::-1], strict=True))
    return forth, forth_sums, back, back_sums


def _join_legs(legs: tuple[Floats, ...]) -> Floats:
    """Values of legs one after the other, each going on from the last value of the one before."""
    shifts = np.cumsum([before[-1] - after[0] for before, after in pairwise(legs)])
    rest = [leg[1:] + shift for leg, shift in zip(legs[1:], shifts, strict=True)]
    return np.concatenate([legs[0], *rest])
