"""The ``kineme`` method: what each stage finds, in frames of the working rate.

Nothing here knows what a skeleton is: any array of frames × dims will do.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike, NDArray

from kineme._checks import as_features
from kineme._threads import map_threads
from kineme.methods.presets import ActionPreset
from kineme.methods.recurrence import stretches
from kineme.methods.recurrence.actions import Actions, refine
from kineme.methods.recurrence.recurrence import Recurrence, recurrence
from kineme.methods.recurrence.repetitions import SMOOTHING, Repetitions, repetitions
from kineme.methods.recurrence.transitions import activity_ends
from kineme.methods.stages import Progress, stopwatch

if TYPE_CHECKING:
    from kineme.graph import NeighborGraph

Frames = NDArray[np.int64]

# For pictures: neighbours per frame at most.
PICTURED = 256


@dataclass(frozen=True, eq=False)
class ActionAnalysis:
    """What the stages found.

    Parameters
    ----------
    features : (frames, dims), scaled so that distances are body sizes
    recurrence : how alike the moments are
    blocks : (blocks + 1,) borders of activities and transitions, from 0 to n
    labels : (blocks,) action of each block, -1 for transitions
    confidence : (blocks,) how sure the block's action is, nan for transitions
    segments : (segments + 1,) borders of the primitives, from 0 to n, blocks' included
    agreement : (segments,) how certain the count is, 0 to 1, nan in transitions
    timings : seconds per stage
    """

    features: NDArray[np.float64]
    recurrence: Recurrence
    preset: ActionPreset
    blocks: Frames
    labels: Frames
    confidence: NDArray[np.float64]
    segments: Frames
    agreement: NDArray[np.float64]
    timings: dict[str, float] = field(default_factory=dict)

    @cached_property
    def graph(self) -> NeighborGraph:
        """Neighbours of every frame, for pictures; the method itself does not need them."""
        from kineme.graph import neighbor_graph

        return neighbor_graph(
            self.features,
            radius=2 * self.preset.max_scale,
            k=PICTURED,
            max_lag=max(1, self.preset.frames(self.preset.window)),
        )


def analyze_actions(
    features: ArrayLike, preset: ActionPreset, *, progress: Progress | None = None
) -> ActionAnalysis:
    """Recurrence, actions and repetitions of a sequence of features.

    Parameters
    ----------
    features : (frames, dims)
        Stacked poses at the working rate, scaled so that distances are body
        sizes: divided by the size of the body and by the root of the number
        of stacked blocks.
    preset : ActionPreset
    progress : called with the name of each stage before it runs

    Raises
    ------
    ParameterError : features of another shape, empty, or not finite
    """
    rows = as_features(features)
    timings: dict[str, float] = {}
    stage = stopwatch(timings, progress)
    reach = preset.window if preset.max_lag is None else min(preset.window, preset.max_lag)
    with stage("recurrence"):
        likeness = recurrence(
            rows,
            step=preset.step,
            width=max(1, preset.moments(reach)),
            phase=preset.moments(preset.phase),
            rank=preset.moments(preset.recurrence_time),
            low=preset.min_scale,
            high=preset.max_scale,
            softness=preset.softness,
        )
    with stage("actions"):
        found = find_actions(likeness, preset)
        blocks, labels, confidence = _blocks(found, likeness, preset, len(rows))
    with stage("repetitions"):
        counted = _count(likeness, blocks, labels, found.borders * likeness.step, preset)
    segments = np.unique(np.concatenate([blocks, *(c.cuts for c in counted)]))
    parents = np.searchsorted(blocks, segments[:-1], side="right") - 1
    agreement = np.array([c.agreement for c in counted])[parents]
    return ActionAnalysis(
        rows, likeness, preset, blocks, labels, confidence, segments, agreement, timings
    )


def find_actions(likeness: Recurrence, preset: ActionPreset) -> Actions:
    """Stretches of one action each, in moments."""
    borders = stretches.change_points(
        likeness,
        penalty=preset.border_cost * preset.working_fps / preset.step,
        min_length=max(1, preset.moments(preset.min_stretch)),
    )
    borders = stretches.merge_parts(
        borders,
        likeness,
        gap=preset.moments(preset.part_gap),
        softness=preset.part_softness,
        least=preset.part_share,
    )
    labels = stretches.link(
        borders,
        likeness,
        _poses(likeness.features, preset.offsets) if preset.any_pace else likeness.features,
        likeness=preset.likeness,
        softness=preset.likeness_softness,
        max_lag=None if preset.max_lag is None else preset.moments(preset.max_lag),
    )
    repeats = stretches.repeating(
        borders, labels, likeness, softness=preset.part_softness, least=preset.min_repetition
    )
    return refine(
        borders,
        np.where(repeats, labels, -1),
        likeness,
        switch_cost=preset.switch_cost * preset.working_fps / preset.step,
        no_action_cost=preset.no_action_cost,
        min_length=max(1, preset.moments(preset.min_action)),
    )


def _poses(features: NDArray[np.float32], offsets: tuple[float, ...]) -> NDArray[np.float32]:
    """The poses without their neighbours in time; all, if they were not stacked at the offsets."""
    dims, rest = divmod(features.shape[1], len(offsets))
    if rest:
        return features
    first = dims * int(np.argmin(np.abs(offsets)))
    poses: NDArray[np.float32] = features[:, first : first + dims] * len(offsets) ** 0.5
    return poses


def _blocks(
    found: Actions, likeness: Recurrence, preset: ActionPreset, n: int
) -> tuple[Frames, Frames, NDArray[np.float64]]:
    """Borders, labels and confidence of activities and the transitions between them, in frames."""
    ends, begins = activity_ends(
        found,
        likeness,
        factor=preset.transition_factor,
        longest=preset.moments(preset.max_transition),
    )
    borders = np.column_stack([np.append(0, begins), np.append(ends, n)]).ravel()[:-1]
    labels = np.column_stack([found.labels, np.full_like(found.labels, -1)]).ravel()[:-1]
    confidence = np.repeat(found.confidence, 2)[:-1]
    filled = np.diff(borders, append=n) > 0
    borders, labels, confidence = borders[filled], labels[filled], confidence[filled]
    first = np.concatenate([[True], labels[1:] != labels[:-1]])
    confidence = np.where(labels < 0, np.nan, confidence)
    return np.append(borders[first], n), labels[first], confidence[first]


def _count(
    likeness: Recurrence, blocks: Frames, labels: Frames, borders: Frames, preset: ActionPreset
) -> list[Repetitions]:
    """Repetitions of each block; none in transitions.

    An activity's first and last repetition reach into its transitions, so it
    is counted from half-way to the border of its stretch; cuts lie within it.
    """
    smoothing = preset.frames(SMOOTHING)
    limits = np.append(borders[:-1], len(likeness.features))

    def count(block: int) -> Repetitions:
        start, stop = int(blocks[block]), int(blocks[block + 1])
        if labels[block] < 0:
            return Repetitions(np.empty(0, np.int64), np.nan)
        stretch = int(np.searchsorted(limits, (start + stop) // 2, side="right")) - 1
        first = (start + min(start, int(limits[stretch]))) // 2
        last = (stop + max(stop, int(limits[stretch + 1]))) // 2
        found = repetitions(likeness.features, first, last, smoothing=smoothing)
        inside = (start < found.cuts) & (found.cuts < stop)
        return replace(found, cuts=found.cuts[inside])

    return map_threads(count, range(len(labels)))
