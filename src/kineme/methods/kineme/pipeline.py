"""Method, stage by stage, from features to segments, repetitions and events.

Skeletons and sensors are unknown here: features are any array of frames x dims.

1. *views*: posture and energy of movement, a few times a second, in one or more scales.
2. *segments*: a tree of each view, and the level of it with the shortest description. A segment is
   described by how similar its samples are, or by a repetition of it. Of several views the one
   that agrees most with all is taken. A long recording is segmented in parts, each as if it were
   alone.
3. *borders*: to the frame, and transitions, which neither side explains.
4. *repetitions*: their number in each segment, and where the first begins and the last one ends.
5. *events*: spans that recur elsewhere, now and then.
6. *confidence*: statistics from which probabilities are computed. No other stage reads them.
"""

from __future__ import annotations

from functools import cache
from itertools import pairwise
from math import ceil
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray
from threadpoolctl import ThreadpoolController

from kineme._util.arrays import Floats
from kineme._util.checks import as_features
from kineme._util.parallel import map_threads
from kineme.features.channels import choose_frames
from kineme.methods.kineme.borders import move_fine_borders, refine_borders
from kineme.methods.kineme.confidence import collect_evidence
from kineme.methods.kineme.found import KinemeFound
from kineme.methods.kineme.primitives import (
    divide_into_repetitions,
    find_events,
    merge_similar_clusters,
)
from kineme.methods.kineme.repeating import Repeating
from kineme.methods.kineme.tree import (
    FineLevel,
    Level,
    choose_part_ends,
    compute_median_distance,
    find_fine_level,
    find_level,
    link_parts,
)
from kineme.methods.kineme.views import Views, choose_view, compute_views
from kineme.methods.stages import Progress, time_stages

if TYPE_CHECKING:
    from kineme.methods.kineme.constants import KinemeConstants

SIDE = 2.0
"""Seconds before and after the end of a part, which differ most where parts meet."""
Frames = NDArray[np.int64]
Rows = NDArray[np.float32]


class Part(NamedTuple):
    """A part of a recording: the number of the view that is taken, that view, and its level."""

    scale: int
    view: Rows
    level: Level


def analyze(
    features: ArrayLike,
    preset: KinemeConstants,
    *,
    joints: bool = False,
    progress: Progress | None = None,
) -> KinemeFound:
    """Segments, clusters, repetitions and events of features.

    Parameters
    ----------
    features : (frames, dims) array
        At the working rate; of a body in its sizes.
    preset : KinemeConstants
    joints : bool
        Whether features are of the positions of joints, and not of sensors.
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
    # Parts run side by side, and sums must not depend on threads.
    with _get_thread_limiter().limit(limits=1):
        return _analyze(as_features(features), preset, progress, joints=joints)


@cache
def _get_thread_limiter() -> ThreadpoolController:
    """Return what limits the threads of matrix products; to find their library takes 7 ms."""
    return ThreadpoolController()


def _analyze(
    rows: Floats,
    preset: KinemeConstants,
    progress: Progress | None,
    *,
    joints: bool,
) -> KinemeFound:
    timings: dict[str, float] = {}
    stage = time_stages(timings, progress)
    n = len(rows)
    poses = np.ascontiguousarray(rows - rows.mean(axis=0), np.float32)  # a shift costs no digits
    least = 2 * ceil(preset.working_fps / preset.rate)  # frames, so that each part has a sample
    ends = choose_part_ends(poses, max(least, preset.frames(preset.part)), preset.frames(SIDE))
    spans = [slice(*span) for span in pairwise(ends)]
    with stage("views"):
        views = [compute_views(rows[span], preset, joints=joints) for span in spans]
    with stage("segments"):
        parts = map_threads(
            lambda i: _segment_part(views[i], poses[spans[i]], spans[i], preset), range(len(spans))
        )
        features = parts[0].view
        if len(parts) > 1:
            scale = int(np.bincount([part.scale for part in parts]).argmax())
            features = compute_views(rows, preset.in_scale(scale), joints=joints).views[0]
        unit = compute_median_distance(features, preset.near)
        at = choose_frames(n, preset.working_fps, preset.rate)
        price = preset.cluster_price(len(parts[0].view))
        level = link_parts(features, at, [part.level for part in parts], unit=unit, price=price)
    with stage("borders"):
        starts, stops = refine_borders(rows, level.borders, preset)
        fine = move_fine_borders(level.fine, level.borders, np.append(starts, n))
    with stage("repetitions"):
        segments = divide_into_repetitions(
            poses, starts, stops, level.labels, level.preference, preset
        )
        if preset.min_similarity < 1:
            segments = merge_similar_clusters(poses, segments, preset)
    if preset.event_scale:
        with stage("events"):
            segments = find_events(poses, segments, preset)
    with stage("confidence"):
        statistics = collect_evidence(poses, features, segments, preset)
    return KinemeFound(features, preset, unit, segments, statistics, fine, timings)


def _segment_part(views: Views, poses: Rows, span: slice, preset: KinemeConstants) -> Part:
    """Return a part as if it were alone. Its view is chosen before it is known what repeats."""

    def clusters(fine: FineLevel) -> Frames:
        return find_level(fine, preset).per_sample()

    scale, fine = 0, [find_fine_level(view, preset) for view in views.views]
    if len(fine) > 1:
        answers = [*map(clusters, fine)]
        halves = [clusters(find_fine_level(half, preset)) for half in views.halves]
        scale = choose_view(answers, halves, margin=preset.view_margin)
    level = find_level(fine[scale], preset, Repeating(poses, preset))
    return Part(scale, views.views[scale], level.in_frames(span, preset))
