"""The method for sensors: what each stage finds, in frames of the working rate.

Any array of frames × channels will do; equal deviations of the channels give
them equal weight.
"""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise

import numpy as np
from numpy.typing import ArrayLike, NDArray
from threadpoolctl import threadpool_limits

from kineme._checks import as_features
from kineme._threads import map_threads
from kineme.methods.evidence import Evidence
from kineme.methods.hierarchy.agreement import most_agreed
from kineme.methods.hierarchy.borders import carried_over, to_the_frame
from kineme.methods.hierarchy.constants import HierarchyConstants
from kineme.methods.hierarchy.evidence import evidence
from kineme.methods.hierarchy.found import HierarchyFound
from kineme.methods.hierarchy.level import Segments, segments_of
from kineme.methods.hierarchy.parts import linked, part_ends
from kineme.methods.hierarchy.tree import median_distance
from kineme.methods.hierarchy.views import seen
from kineme.methods.recurrence.evidence import counted
from kineme.methods.recurrence.repeating.repetitions import Repetitions, repetitions
from kineme.methods.samples import unstacked
from kineme.methods.stages import Progress, stopwatch

Frames = NDArray[np.int64]


def analyze_channels(
    channels: ArrayLike,
    preset: HierarchyConstants,
    *,
    carried: ArrayLike | None = None,
    joints: bool = False,
    progress: Progress | None = None,
) -> HierarchyFound:
    """Segments, clusters and repetitions of channels.

    Parameters
    ----------
    channels : (frames, channels * offsets) array
        At the working rate, stacked at the offsets of the preset.
    preset : HierarchyConstants
    carried : (frames,) array, optional
        1 where a ride goes upwards, -1 where it goes downwards, 0 elsewhere.
    joints : bool
        Whether channels are places of joints, and not what sensors measure.
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
    with threadpool_limits(1):  # segments run side by side; sums do not hang on threads
        rows = as_features(channels)
        ridden = np.zeros(len(rows)) if carried is None else np.asarray(carried, np.float64)
        return _analyze(rows, ridden, preset, progress, joints=joints)


def _analyze(
    rows: NDArray[np.float64],
    carried: NDArray[np.float64],
    preset: HierarchyConstants,
    progress: Progress | None,
    *,
    joints: bool,
) -> HierarchyFound:
    bare = unstacked(rows, preset.offsets)
    timings: dict[str, float] = {}
    stage = stopwatch(timings, progress)
    with stage("statistics"):
        channels = rows if bare is None else bare
        statistics = seen(channels, preset, carried, joints=joints)
    with stage("tree"):
        answers = [_in_parts(view, preset) for view in statistics.views]
        others = [_in_parts(view, preset) for view in statistics.halves]
    with stage("level"):
        best = most_agreed(*([_per_sample(each) for each in found] for found in (answers, others)))
        features = statistics.views[best]
        unit = median_distance(features)
        level = linked(features, answers[best])
    with stage("borders"):
        frames = _in_frames(level.borders, preset, len(rows))
        frames = to_the_frame(channels, frames, preset, joints=joints)
        borders = _in_samples(frames, preset, len(features))
        fine = carried_over(level.fine, level.borders, borders)
    with stage("repetitions"):
        repeated = _count(rows, frames, preset)
    primitives = np.unique(np.concatenate([frames, *(each.cuts for each in repeated)]))
    parents = np.searchsorted(frames, primitives[:-1], side="right") - 1
    with stage("confidence"):
        own = level.preference
        links, starts = evidence(features, unit, borders, level.labels, own, preset)
        counts, cuts = _counted(rows, primitives, parents, own, preset)
        shown = Evidence(links, starts, counts, cuts, parents)
    return HierarchyFound(
        features, preset, unit, frames, level.labels, primitives, shown, fine, timings
    )


def _in_parts(view: NDArray[np.float32], preset: HierarchyConstants) -> list[Segments]:
    """The segments of each part of a recording."""
    ends = part_ends(len(view), max(1, round(preset.samples(preset.part))))
    spans = list(pairwise(ends))
    return map_threads(lambda span: segments_of(view[slice(*span)], preset), spans)


def _per_sample(parts: list[Segments]) -> list[Frames]:
    return [part.per_sample() for part in parts]


def _in_frames(borders: Frames, preset: HierarchyConstants, n: int) -> Frames:
    """Borders in frames of the working rate, each with a frame at least."""
    frames: Frames = np.rint(borders * (preset.working_fps / preset.rate)).astype(np.int64)
    frames[-1] = n
    return frames


def _in_samples(frames: Frames, preset: HierarchyConstants, n: int) -> Frames:
    """The nearest samples to borders in frames."""
    borders: Frames = np.rint(frames / (preset.working_fps / preset.rate)).astype(np.int64)
    borders[-1] = n
    return borders


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
