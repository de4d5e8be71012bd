"""Find occurrences of events: spans of movement that recur anywhere in a recording.

Spans are compared in *movement time*, which passes in proportion to the speed of the body. It
hardly passes while the body stands still, so standing still twice is no event. A sample is a pose
with its velocity, so that a movement does not match its reverse.

Two spans match by a warping path. Its score is the time for which they are similar, in seconds at
usual speed. A set is a span with all spans that match it and do not overlap. Sets are chosen
greedily by the sum of their scores (as in LoCoMotif, Van Wesenbeeck, Yurtman, Meert and Blockeel
2024; scores are ours).
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view
from numpy.typing import NDArray

from kineme._util.arrays import Floats, Ints
from kineme._util.parallel import check_cancelled
from kineme.methods.kineme import _event_kernels as kernels
from kineme.methods.kineme._repetition_kernels import smooth_rows
from kineme.methods.kineme.repetitions import SMOOTHING
from kineme.methods.segments import find_segments, number_by_appearance

if TYPE_CHECKING:
    from kineme.methods.kineme.constants import KinemeConstants

Paths = tuple[Ints, Ints, Floats, Floats, Ints, Ints]

STEP = 0.1
"""Step between samples, in seconds of movement time."""
WINDOW = 300.0
"""Largest distance of two occurrences of an event, in seconds of movement time."""
LEG = 60.0
"""Length of a leg of a path, in seconds of movement time. Run time grows with its square."""
STILL = 4
"""Poses nearer to their mean than `event_scale` divided by this are at rest."""
N_LENGTHS = 24
"""Number of span lengths that are tried, between the shortest and the longest."""


@dataclass(frozen=True, eq=False)
class Occurrences:
    """Spans that recur, in frames at the working rate, in time order and without overlap."""

    starts: Ints
    stops: Ints
    clusters: Ints
    """Set of each occurrence, numbered from 0 by first appearance."""
    similarity: Floats
    """Similarity of each occurrence to the representative of its set, 0 to 1."""

    def __len__(self) -> int:
        return len(self.starts)

    def compute_explained_shares(self, borders: Ints) -> Floats:
        """Return the share of each segment that recurs, weighted by similarity: 0 to 1."""
        lengths = (self.stops - self.starts) * self.similarity
        inside = np.bincount(self._find_segments(borders), lengths, len(borders) - 1)
        return inside / np.diff(borders)

    def select_within(self, borders: Ints, chosen: NDArray[np.bool_]) -> Occurrences:
        """Return the occurrences in chosen segments whose set has another occurrence in them.

        An occurrence belongs to the segment that contains its middle.
        """
        kept = chosen[self._find_segments(borders)]
        # Drop occurrences that are the only one left of their set.
        kept &= np.bincount(self.clusters[kept], minlength=len(self))[self.clusters] > 1
        clusters = number_by_appearance(self.clusters[kept])
        return Occurrences(self.starts[kept], self.stops[kept], clusters, self.similarity[kept])

    def _find_segments(self, borders: Ints) -> Ints:
        """Return the segment that contains the middle of each occurrence."""
        middles = (self.starts + self.stops) // 2
        return find_segments(borders, middles)


def find_occurrences(
    poses: NDArray[np.floating], free: NDArray[np.bool_], preset: KinemeConstants
) -> Occurrences:
    """Find the spans that recur among the free frames.

    Poses (frames, dims) are at the working rate, in body sizes, and not stacked.
    """
    per_second = preset.working_fps / _count_step_frames(preset)
    # Noise gives a body at rest a speed, and all its poses are similar, so it matches itself.
    smooth, _ = smooth_rows(np.ascontiguousarray(poses, np.float32), preset.frames(SMOOTHING))
    nearest = preset.event_scale / STILL
    free = free & _find_moving_frames(smooth, max(1, preset.frames(preset.max_repetition)), nearest)
    samples = _sample_frames(np.asarray(poses, np.float64), free, preset)
    if len(samples.seconds) < 2:
        empty = np.empty(0, np.int64)
        return Occurrences(empty, empty, empty, np.empty(0))
    least = preset.min_recurrence * per_second
    shortest = max(1, round(least))
    starts, ptr, partners, sums, row_ptr, row_paths = find_matching_paths(
        samples.columns,
        preset.event_cost * samples.seconds,
        samples.begins,
        gap=shortest,
        width=round(WINDOW * per_second),
        leg=max(1, round(LEG * per_second)),
        scale=preset.event_scale,
        least=least,
    )
    longest = max(shortest, round(preset.max_repetition * per_second))
    lengths = np.unique(np.geomspace(shortest, longest, N_LENGTHS).round().astype(np.int64))
    all_free = np.ones(len(samples.seconds), np.bool_)
    check_cancelled()
    spans, scores, ranks = kernels.choose_sets(
        lengths, starts, ptr, partners, sums, row_ptr, row_paths, all_free, preset.event_cover
    )
    # Keep a set if its best occurrence is unlikely to be chance. Spans may be parts of paths.
    strongest = np.zeros(len(ranks))
    np.maximum.at(strongest, ranks, scores)
    starts, stops = samples.edges[spans[:, 0], 0], samples.edges[spans[:, 1] - 1, 1]
    is_kept = (strongest[ranks] >= least) & (measure_reaches(smooth, starts, stops) > nearest)
    order = np.flatnonzero(is_kept)[np.argsort(starts[is_kept])]
    spans, ranks, starts, stops = spans[order], ranks[order], starts[order], stops[order]
    similarity = np.clip(scores[order] / np.maximum(np.diff(spans)[:, 0], 1), 0, 1)
    # Neighbouring samples may share a frame.
    stops[:-1] = np.minimum(stops[:-1], starts[1:])
    return Occurrences(starts, stops, number_by_appearance(ranks), similarity)


def _find_moving_frames(poses: Floats, longest: int, near: float) -> NDArray[np.bool_]:
    """Return the frames with poses that differ by more than ``near`` within ``longest`` frames."""
    starts = np.arange(0, len(poses), longest)
    extremes = np.stack([np.maximum.reduceat(poses, starts), -np.minimum.reduceat(poses, starts)])
    # The range of each block together with its two neighbours.
    padded = np.pad(extremes, ((0, 0), (1, 1), (0, 0)), mode="edge")
    ranges = sliding_window_view(padded, 3, axis=1).max(axis=-1).sum(axis=0)
    return np.repeat(np.linalg.norm(ranges, axis=1) > near, longest)[: len(poses)]


def measure_reaches(poses: NDArray[np.floating], starts: Ints, stops: Ints) -> Floats:
    """Return the largest distance of a pose of each span from the mean pose of the span."""
    # Fast samples share a frame, so a span may be empty: its pose is that of its start.
    ends = np.maximum(stops, starts + 1)
    parts = (poses[start:stop] for start, stop in zip(starts, ends, strict=True))
    reaches = [np.linalg.norm(part - part.mean(axis=0), axis=1).max() for part in parts]
    return np.array(reaches, np.float64)


class _Samples(NamedTuple):
    """Samples at equal steps of movement time."""

    columns: Floats
    """Poses and velocities, (dims, samples)."""
    edges: Ints
    """First frame of each sample, and one past its last, (samples, 2)."""
    seconds: Floats
    """Duration of each sample in steps: 1 at the usual speed of the body."""
    begins: NDArray[np.bool_]
    """Whether a free span begins with this sample."""


def _sample_frames(poses: Floats, free: NDArray[np.bool_], preset: KinemeConstants) -> _Samples:
    """Sample the free frames at equal steps of movement time."""
    n = len(poses)
    frames = np.arange(n)
    before, after = np.maximum(frames - 1, 0), np.minimum(frames + 1, n - 1)
    elapsed = np.maximum(after - before, 1)[:, None] / preset.working_fps
    velocities = (poses[after] - poses[before]) / elapsed
    speeds = np.linalg.norm(velocities, axis=1)
    # Movement time is the integral of the relative speed; its inverse gives the sampled frames.
    rates = preset.event_rest + (1 - preset.event_rest) * speeds / max(speeds.mean(), 1e-12)
    time = np.append(0, np.cumsum(rates))
    positions = np.interp(
        np.arange(0, time[-1], _count_step_frames(preset)), time, np.arange(n + 1)
    )
    edges = np.append(np.minimum(positions.astype(np.int64), n - 1), n)
    spans = np.column_stack([edges[:-1], edges[1:]])
    kept = np.flatnonzero(free[spans[:, 0]])
    # A free span begins where the indices of free samples have a gap.
    begins = np.diff(kept, prepend=-2) > 1
    rows = np.hstack([poses, preset.event_velocity * velocities])[spans[kept, 0]]
    seconds = np.diff(positions, append=n)[kept] / _count_step_frames(preset)
    return _Samples(np.ascontiguousarray(rows.T), spans[kept], seconds, begins)


def _count_step_frames(preset: KinemeConstants) -> int:
    """Return the number of frames from one sample to the next at the usual speed."""
    return max(1, preset.frames(STEP))


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
    """Find the warping paths between samples: start, partners and scores, from both sides.

    The ends of a path are found first. Then the path between them is computed in legs, so that run
    time grows with the length of the path and not with its square.

    Parameters
    ----------
    columns : (dims, samples) array
    costs : (samples,) array
        Subtracted from the score of each sample, so that standing still scores nothing.
    begins : (samples,) array of bool
        Samples that a path may not step into, only begin with.
    gap, width : int
        Smallest and largest distance of the two samples of a pair.
    leg : int
        Length of a leg in samples.
    scale : float
        Distance at which the similarity of two samples is 0.
    least : float
        Smallest score of a path.

    Returns
    -------
    starts : (paths,) array
        First sample of each path. A path and its swapped copy follow each other.
    ptr : (paths + 1,) array
        Path p has the entries ``ptr[p]:ptr[p + 1]`` of the next two arrays.
    partners, sums : arrays
        For each sample of each path: its partner, and the score of the path so far.
    row_ptr : (samples + 1,) array
        Sample i lies on the paths ``row_paths[row_ptr[i]:row_ptr[i + 1]]``.
    row_paths : array of int
    """
    ends, _, passed = kernels.find_local_paths(
        columns, costs, begins, gap, width, leg, scale, least
    )
    starts, partners, sums = [], [np.empty(0)], [np.empty(0)]
    for path_ends in ends:
        check_cancelled()
        forward, forward_sums, backward, backward_sums = split_path(
            columns, costs, path_ends, passed, scale
        )
        starts += [path_ends[0], path_ends[1]]
        partners += [forward, backward]
        sums += [forward_sums, backward_sums]
    sizes = np.array([len(path_ends) for path_ends in partners[1:]], np.int64)
    ptr = np.append(0, np.cumsum(sizes))
    first_samples = np.array(starts, np.int64)
    # Sample of each entry; sorting the entries by sample lists the paths of each sample.
    rows = np.repeat(first_samples - ptr[:-1], sizes) + np.arange(ptr[-1])
    row_paths = np.repeat(np.arange(len(sizes)), sizes)[np.argsort(rows, kind="stable")]
    row_ptr = np.append(0, np.cumsum(np.bincount(rows, minlength=len(costs))))
    joined = np.concatenate(partners), np.concatenate(sums)
    return first_samples, ptr, *joined, row_ptr, row_paths


def split_path(
    columns: Floats, costs: Floats, ends: Ints, passed: Ints, scale: float
) -> tuple[Floats, Floats, Floats, Floats]:
    """Compute a path leg by leg; return its partners and scores from both sides.

    ``ends`` holds the first and last pair, and the index in ``passed`` of the last waypoint (-1 if
    none). ``passed`` (pairs, 3) are waypoints, each with the index of the one before; see
    `_event_kernels.find_local_paths`.
    """
    # Follow the linked list of waypoints from the last pair to the first.
    pairs, latest = [ends[2:4]], int(ends[4])
    while latest >= 0:
        pairs.append(passed[latest, :2])
        latest = int(passed[latest, 2])
    pairs.append(ends[:2])
    legs = [
        kernels.trace_path(columns, costs, np.append(start, stop), scale)
        for stop, start in pairwise(pairs)
    ]
    forward, forward_sums, backward, backward_sums = map(_join_legs, zip(*legs[::-1], strict=True))
    return forward, forward_sums, backward, backward_sums


def _join_legs(legs: tuple[Floats, ...]) -> Floats:
    """Concatenate the values of legs, each shifted to continue from the end of the one before."""
    shifts = np.cumsum([before[-1] - after[0] for before, after in pairwise(legs)])
    rest = [leg[1:] + shift for leg, shift in zip(legs[1:], shifts, strict=True)]
    return np.concatenate([legs[0], *rest])
