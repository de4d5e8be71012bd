"""The method, stage by stage, from features to segments, repetitions and events.

Nothing here knows what a skeleton or a sensor is: any array of frames x dims will do.

1. *views*: what is compared, some times a second: posture and energy of movement.
2. *segments*: a tree of each view, and of it the level of the shortest description. A segment is
   told by its samples staying alike, or by repeating itself. Of several views that is taken
   which all agree with most.
3. *borders*: to the frame, and transitions, which neither side explains.
4. *repetitions*: how often each segment repeats itself, and where the first and the last one end.
5. *events*: what recurs elsewhere, now and then.
6. *confidence*: statistics by which it is told how sure all that is. Nothing above reads them.
"""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray
from threadpoolctl import threadpool_limits

from kineme._checks import as_features
from kineme._threads import map_threads
from kineme.methods.kineme.borders import carried_over, in_samples, to_the_frame
from kineme.methods.kineme.confidence import evidence
from kineme.methods.kineme.found import KinemeFound
from kineme.methods.kineme.level import Level, level_of, linked, part_ends
from kineme.methods.kineme.primitives import with_clusters, with_events, with_repetitions
from kineme.methods.kineme.repeating import Repeating
from kineme.methods.kineme.tree import median_distance
from kineme.methods.kineme.views import most_agreed, seen
from kineme.methods.stages import Progress, stopwatch

if TYPE_CHECKING:
    from kineme.methods.kineme.constants import KinemeConstants

Floats = NDArray[np.float64]
Frames = NDArray[np.int64]
Rows = NDArray[np.float32]


class Agreed(NamedTuple):
    """A view, (samples, dims), the distance in it that counts as 1, and its level."""

    view: Rows
    unit: float
    level: Level


def analyze(
    features: ArrayLike,
    preset: KinemeConstants,
    *,
    carried: ArrayLike | None = None,
    joints: bool = False,
    progress: Progress | None = None,
) -> KinemeFound:
    """Segments, clusters, repetitions and events of features.

    Parameters
    ----------
    features : (frames, dims) array
        At the working rate; of a body in its sizes.
    preset : KinemeConstants
    carried : (frames,) array, optional
        1 where a ride goes upwards, -1 where it goes downwards, 0 elsewhere.
    joints : bool
        Whether channels are places of joints, and not what sensors measure.
    progress : callable, optional
        Called with the name of each stage before it runs.

    Returns
    -------
    KinemeFound

    Raises
    ------
    ParameterError
        Features of another shape, empty, or not finite.
    """
    with threadpool_limits(1):  # segments run side by side; sums do not hang on threads
        rows = as_features(features)
        ridden = np.zeros(len(rows)) if carried is None else np.asarray(carried, np.float64)
        return _analyze(rows, ridden, preset, progress, joints=joints)


def _analyze(
    rows: Floats,
    carried: Floats,
    preset: KinemeConstants,
    progress: Progress | None,
    *,
    joints: bool,
) -> KinemeFound:
    timings: dict[str, float] = {}
    stage = stopwatch(timings, progress)
    step, counting = preset.step, preset.counting()
    slower = np.ascontiguousarray(rows[::step], np.float32)
    with stage("views"):
        statistics = seen(rows, preset, carried, joints=joints)
    with stage("segments"):
        features, unit, level = _agreed(statistics.views, statistics.halves, slower, preset)
    with stage("borders"):
        starts, stops = to_the_frame(rows, _in_frames(level.borders, preset, len(rows)), preset)
        frames = np.append(starts, len(rows))
    with stage("repetitions"):
        stops = np.append(stops[:-1] // step, len(slower))
        segments = with_repetitions(
            slower, starts // step, stops, level.labels, level.preference, counting
        )
        if preset.same < 1:
            segments = with_clusters(slower, segments, counting)
    if preset.event_scale:
        with stage("events"):
            segments = with_events(slower, segments, counting)
    with stage("confidence"):
        shown = evidence(slower, segments, counting)
    fine = carried_over(level.fine, level.borders, in_samples(frames, preset, len(features)))
    return KinemeFound(features, preset, unit, segments, len(rows), shown, fine, timings)


def _agreed(views: list[Rows], halves: list[Rows], slower: Rows, preset: KinemeConstants) -> Agreed:
    """The view that all agree with most, by samples that stay alike; its level, by both forms."""
    n, counting = len(views[0]), preset.counting()
    spans = list(pairwise(part_ends(n, max(1, round(preset.samples(preset.part))))))

    def plain(view: Rows) -> list[Frames]:
        return map_threads(lambda span: level_of(view[slice(*span)], preset).per_sample(), spans)

    def whole(span: tuple[int, int]) -> Level:
        first, last = (round(end / preset.rate * counting.working_fps) for end in span)
        return level_of(chosen[slice(*span)], preset, Repeating(slower[first:last], counting))

    chosen = views[0]
    if len(views) > 1:
        answers, others = [plain(view) for view in views], [plain(half) for half in halves]
        chosen = views[most_agreed(answers, others)]
    unit = median_distance(chosen, preset.near)
    return Agreed(chosen, unit, linked(chosen, map_threads(whole, spans), unit))


def _in_frames(borders: Frames, preset: KinemeConstants, n: int) -> Frames:
    """Borders in frames of the working rate, each with a frame at least."""
    frames: Frames = np.rint(borders * (preset.working_fps / preset.rate)).astype(np.int64)
    frames[-1] = n
    return frames
