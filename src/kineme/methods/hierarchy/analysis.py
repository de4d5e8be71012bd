"""The method for sensors: what each stage finds, in frames of the working rate.

Any array of frames × channels will do; equal deviations of the channels give
them equal weight.
"""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise

import numpy as np
from numpy.typing import ArrayLike, NDArray

from kineme._checks import as_features
from kineme._threads import map_threads
from kineme.methods.evidence import Evidence
from kineme.methods.hierarchy import tree
from kineme.methods.hierarchy.constants import HierarchyConstants
from kineme.methods.hierarchy.evidence import evidence
from kineme.methods.hierarchy.found import HierarchyFound
from kineme.methods.hierarchy.statistics import channel_statistics
from kineme.methods.recurrence.evidence import counted
from kineme.methods.recurrence.repetitions import Repetitions, repetitions
from kineme.methods.samples import unstacked
from kineme.methods.segments import by_first_appearance
from kineme.methods.stages import Progress, stopwatch

Frames = NDArray[np.int64]


def analyze_channels(
    channels: ArrayLike, preset: HierarchyConstants, *, progress: Progress | None = None
) -> HierarchyFound:
    """Segments, clusters and repetitions of channels.

    Parameters
    ----------
    channels : (frames, channels * offsets) array
        At the working rate, stacked at the offsets of the preset.
    preset : HierarchyConstants
    progress : callable, optional
        Called with the name of each stage before it runs.

    Returns
    -------
    HierarchyFound

    Raises
    ------
    ParameterError
        Channels of another shape, empty, or not finite.
    """
    rows = as_features(channels)
    bare = unstacked(rows, preset.offsets)
    timings: dict[str, float] = {}
    stage = stopwatch(timings, progress)
    with stage("statistics"):
        features = np.ascontiguousarray(
            channel_statistics(
                rows if bare is None else bare,
                preset.working_fps,
                rate=preset.rate,
                window=preset.averaging,
                bands=preset.bands,
            ),
            np.float32,
        )
        unit = tree.median_distance(features)
    with stage("tree"):
        fine = tree.fine_borders(
            features,
            unit,
            width=max(1, round(preset.samples(preset.max_fine))),
            cost=preset.samples(preset.fine_cost),
        )
        sums = tree.between_segments(features, fine, unit)
    with stage("level"):
        level = tree.best_level(
            fine,
            sums,
            segment_cost=preset.samples(preset.segment_cost),
            cluster_cost=preset.samples(preset.cluster_cost),
            most_clusters=preset.max_clusters,
        )
        borders, labels = _joined(level, round(preset.samples(preset.min_action)))
        own = _preference(fine, sums, level, borders)
    with stage("repetitions"):
        frames = _in_frames(borders, preset, len(rows))
        repeated = _count(rows, frames, preset)
    primitives = np.unique(np.concatenate([frames, *(each.cuts for each in repeated)]))
    parents = np.searchsorted(frames, primitives[:-1], side="right") - 1
    with stage("confidence"):
        links, starts = evidence(features, unit, borders, labels, own, preset)
        counts, cuts = _counted(rows, primitives, parents, own, preset)
        shown = Evidence(links, starts, counts, cuts, parents)
    return HierarchyFound(features, preset, unit, frames, labels, primitives, shown, fine, timings)


def _joined(level: tree.Level, shortest: int) -> tuple[Frames, Frames]:
    """Borders and labels with neighbours of one cluster as one segment.

    A cluster of less than `shortest` samples is what a change looks like while it is
    averaged over: its segments are parted between their neighbours.
    """
    lengths = np.diff(level.borders)
    rare = np.bincount(level.labels, lengths)[level.labels] < shortest
    if rare.all():
        return level.borders[[0, -1]], np.zeros(1, np.int64)
    per_sample = np.repeat(np.where(rare, -1, level.labels), lengths)
    known = np.flatnonzero(per_sample >= 0)
    samples = np.arange(len(per_sample))
    after = np.minimum(np.searchsorted(known, samples), len(known) - 1)
    before = np.maximum(after - 1, 0)
    later = np.abs(known[after] - samples) <= np.abs(samples - known[before])
    per_sample = per_sample[known[np.where(later, after, before)]]
    first = np.flatnonzero(np.diff(per_sample, prepend=-1))
    return np.append(first, len(samples)), by_first_appearance(per_sample[first])


def _preference(
    fine: Frames, sums: NDArray[np.float64], level: tree.Level, borders: Frames
) -> NDArray[np.float64]:
    """How much nearer each segment is to its own cluster than to the next, where it began."""
    at = np.searchsorted(fine, level.borders[:-1])
    lengths = np.diff(level.borders).astype(np.float64)
    inner = np.add.reduceat(np.add.reduceat(sums, at, 0), at, 1)
    members = np.eye(int(level.labels.max()) + 1)[level.labels]
    means = (inner @ members) / np.outer(lengths, lengths @ members)
    own = means[np.arange(len(lengths)), level.labels]
    means[np.arange(len(lengths)), level.labels] = np.inf
    surer = np.clip(1 - own / np.maximum(means.min(axis=1), 1e-12), 0, 1)
    middles = (borders[:-1] + borders[1:]) // 2
    return np.asarray(surer[np.searchsorted(level.borders, middles, "right") - 1], np.float64)


def _in_frames(borders: Frames, preset: HierarchyConstants, n: int) -> Frames:
    """Borders in frames of the working rate, each with a frame at least."""
    frames: Frames = np.rint(borders * (preset.working_fps / preset.rate)).astype(np.int64)
    frames[-1] = n
    return frames


def _count(
    channels: NDArray[np.float64], borders: Frames, preset: HierarchyConstants
) -> list[Repetitions]:
    """The repetitions in each segment."""
    rows, slower, step = _thinned(channels, preset)

    def count(span: tuple[int, int]) -> Repetitions:
        start, stop = span[0] // step, max(span[1] // step, span[0] // step + 1)
        found = repetitions(rows, start, min(stop, len(rows)), slower)
        cuts = step * found.cuts
        return replace(found, cuts=cuts[(span[0] < cuts) & (cuts < span[1])])

    return map_threads(count, list(pairwise(borders.tolist())))


def _counted(
    channels: NDArray[np.float64],
    primitives: Frames,
    parents: Frames,
    own: NDArray[np.float64],
    preset: HierarchyConstants,
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Statistics of counts and of the starts of repetitions."""
    rows, slower, step = _thinned(channels, preset)
    edges = np.minimum(primitives // step, len(rows) - 1)
    repeats = np.full(len(parents), True)
    return counted(rows, np.append(edges[:-1], len(rows)), parents, repeats, own, slower)


def _thinned(
    channels: NDArray[np.float64], preset: HierarchyConstants
) -> tuple[NDArray[np.float32], HierarchyConstants, int]:
    """Channels at the rate at which repetitions are counted, the preset for it, and the step."""
    step = max(1, round(preset.working_fps / preset.counting_fps))
    rows = np.ascontiguousarray(channels[::step], np.float32)
    return rows, preset.replace(working_fps=preset.working_fps / step), step
