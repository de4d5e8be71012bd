"""Occurrences: stretches of movement that recur anywhere, whether or not back to back.

What is looked at is not time but *movement time*: it goes by as fast as the body
moves, hardly while it stands still, so that standing still twice is no event. A sample
is a pose and its velocity, which nothing that merely passes the same pose shares: played
backwards, no recording that was looked at recurs in itself.

Two stretches match along a warping path, whose score is the time for which they
are similar, in seconds of usual movement. A set is a stretch with all others that
match it and do not overlap. Of all stretches the one whose matches score most is
taken, then the next best of what is left (sets chosen greedily as in LoCoMotif,
Van Wesenbeeck, Yurtman, Meert and Blockeel 2024; scores are ours).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from kineme.methods.kineme import _event_kernels as kernels
from kineme.methods.kineme.paths import matching_paths
from kineme.methods.segments import by_first_appearance

if TYPE_CHECKING:
    from kineme.methods.kineme.constants import KinemeConstants

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

STEP = 0.1
"""Seconds of usual movement from one moment to the next that is compared."""
WINDOW = 300.0
"""Seconds of movement that two occurrences of an event are apart, at most."""
LEG = 60.0
"""Seconds of movement for which a path is followed at a time."""
LENGTHS = 24
"""Lengths of stretches that are tried, between the shortest and the longest."""
JOINS = 0.6
"""Share of the recurrence that is no chance, from which one joins a set in which another has it."""
PAIR = 2.0
"""Sets of two must recur so many times as much as larger ones."""


@dataclass(frozen=True, eq=False)
class Occurrences:
    """Stretches that recur, in time order; none overlaps another.

    Attributes
    ----------
    starts, stops : (occurrences,) array of int
        Frames of the working rate.
    clusters : (occurrences,) array of int
        Equal numbers recur as each other; from 0 by first appearance.
    similarity : (occurrences,) array
        How similar each is to the one that stands for its set, 0 to 1.
    """

    starts: Ints
    stops: Ints
    clusters: Ints
    similarity: Floats

    def __len__(self) -> int:
        return len(self.starts)

    def explained(self, borders: Ints) -> Floats:
        """The share of each segment that recurs, by how similarly: 0 to 1."""
        lengths = (self.stops - self.starts) * self.similarity
        inside = np.bincount(self._segments(borders), lengths, len(borders) - 1)
        return inside / np.diff(borders)

    def within(self, borders: Ints, wanted: NDArray[np.bool_]) -> Occurrences:
        """Those with their middle in a segment that is wanted, as long as they recur there."""
        kept = wanted[self._segments(borders)]
        kept &= np.bincount(self.clusters[kept], minlength=len(self))[self.clusters] > 1
        clusters = by_first_appearance(self.clusters[kept])
        return Occurrences(self.starts[kept], self.stops[kept], clusters, self.similarity[kept])

    def _segments(self, borders: Ints) -> Ints:
        middles = (self.starts + self.stops) // 2
        segments: Ints = np.searchsorted(borders, middles, side="right") - 1
        return segments


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
        Whether it follows something that is not looked at.
    """

    columns: Floats
    edges: Ints
    seconds: Floats
    begins: NDArray[np.bool_]

    def __len__(self) -> int:
        return len(self.seconds)


def occurrences(
    poses: NDArray[np.floating], free: NDArray[np.bool_], preset: KinemeConstants
) -> Occurrences:
    """What recurs among the frames that are free.

    Parameters
    ----------
    poses : (frames, dims) array
        At the working rate, in body sizes, without their neighbours in time.
    free : (frames,) array of bool
        Where to look.
    preset : KinemeConstants

    Returns
    -------
    Occurrences
    """
    per_second = preset.working_fps / _step(preset)

    def moments(seconds: float) -> int:
        return round(seconds * per_second)

    samples = _samples(np.asarray(poses, np.float64), free, preset)
    if len(samples) < 2:
        none = np.empty(0, np.int64)
        return Occurrences(none, none, none, np.empty(0))
    costs = preset.event_cost * samples.seconds
    shortest = max(1, moments(preset.min_recurrence))
    paths = matching_paths(
        samples.columns,
        costs,
        samples.begins,
        gap=shortest,
        width=moments(WINDOW),
        leg=max(1, moments(LEG)),
        scale=preset.event_scale,
        least=JOINS * preset.min_recurrence * per_second,
    )
    longest = max(shortest, moments(preset.max_repetition))
    lengths = np.unique(np.geomspace(shortest, longest, LENGTHS).round().astype(np.int64))
    spans, scores, ranks = kernels.best_sets(
        lengths,
        *paths,
        np.ones(len(samples), np.bool_),
        preset.event_cover,
    )
    strongest = np.zeros(len(ranks))
    np.maximum.at(strongest, ranks, scores)
    factors = np.where(np.bincount(ranks)[ranks] == 2, PAIR, 1.0)
    sure = strongest[ranks] >= factors * preset.min_recurrence * per_second
    order = np.flatnonzero(sure)[np.argsort(spans[sure, 0])]
    spans, ranks = spans[order], ranks[order]
    similarity = np.clip(scores[order] / np.maximum(np.diff(spans)[:, 0], 1), 0, 1)
    starts, stops = samples.edges[spans[:, 0], 0], samples.edges[spans[:, 1] - 1, 1]
    stops[:-1] = np.minimum(stops[:-1], starts[1:])
    return Occurrences(starts, stops, by_first_appearance(ranks), similarity)


def _velocities(poses: Floats, preset: KinemeConstants) -> Floats:
    """Of each frame, body sizes a second."""
    frames = np.arange(len(poses))
    before, after = np.maximum(frames - 1, 0), np.minimum(frames + 1, len(poses) - 1)
    elapsed = np.maximum(after - before, 1)[:, None] / preset.working_fps
    velocities: Floats = (poses[after] - poses[before]) / elapsed
    return velocities


def _time_of(velocities: Floats, preset: KinemeConstants) -> Floats:
    """Movement time where poses have these velocities."""
    speeds = np.linalg.norm(velocities, axis=1)
    rates = preset.event_rest + (1 - preset.event_rest) * speeds / max(speeds.mean(), 1e-12)
    return np.append(0, np.cumsum(rates))


def _samples(poses: Floats, free: NDArray[np.bool_], preset: KinemeConstants) -> _Samples:
    """The free frames at equal steps of movement time."""
    n = len(poses)
    velocities = _velocities(poses, preset)
    if np.linalg.norm(velocities, axis=1).mean() * preset.max_repetition < preset.event_scale:
        free = np.zeros(n, np.bool_)  # nobody moves: all is one pose
    lasting, edges = _steps(_time_of(velocities, preset), preset)
    spans = np.column_stack([edges[:-1], edges[1:]])
    kept = np.flatnonzero(free[spans[:, 0]])
    begins = np.diff(kept, prepend=-2) > 1
    rows = np.hstack([poses, preset.event_velocity * velocities])[spans[kept, 0]]
    seconds = lasting[kept] / _step(preset)
    return _Samples(np.ascontiguousarray(rows.T), spans[kept], seconds, begins)


def _steps(time: Floats, preset: KinemeConstants) -> tuple[Floats, Ints]:
    """How many frames equal steps of movement time last, and the frames at which they begin.

    The last of these is the end.
    """
    n = len(time) - 1
    at = np.interp(np.arange(0, time[-1], _step(preset)), time, np.arange(n + 1))
    return np.diff(at, append=n), np.append(np.minimum(at.astype(np.int64), n - 1), n)


def _step(preset: KinemeConstants) -> int:
    """Frames of usual movement from one moment to the next."""
    return max(1, preset.frames(STEP))
