"""Activities of the ``kineme`` method: segments of one action each, and the transitions between.

Actions are told in samples of the working rate; activities end where their repetitions do, in
frames.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from kineme.methods.recurrence import change_points
from kineme.methods.recurrence.actions import Actions, refine
from kineme.methods.recurrence.linking import link, repeating
from kineme.methods.recurrence.recurrence import Recurrence
from kineme.methods.recurrence.transitions import activity_ends
from kineme.methods.samples import single_poses

if TYPE_CHECKING:
    from kineme.methods.recurrence.constants import RecurrenceConstants

Frames = NDArray[np.int64]


def find_actions(wide: Recurrence, narrow: Recurrence, preset: RecurrenceConstants) -> Actions:
    """Segments of one action each, in samples.

    Parameters
    ----------
    wide, narrow : Recurrence
        Of the same samples, with the phases of the preset and with those for short actions.
    preset : RecurrenceConstants
    """
    borders = change_points.divided(
        _segments(wide, preset),
        _segments(narrow, preset.narrowed),
        narrow,
        softness=preset.merge_softness,
        least=preset.min_repetition,
        elsewhere=preset.distinct_share,
        min_length=max(1, preset.samples(preset.min_segment)),
    )
    labels = link(
        borders,
        wide,
        single_poses(wide.features, preset.offsets) if preset.any_pace else wide.features,
        narrow=narrow.phase,
        gap_share=preset.link_gap,
        similarity=preset.link_similarity,
        softness=preset.link_softness,
        common=preset.link_common,
        samples=preset.link_samples,
        least=preset.least_self_similarity,
        part=max(1, preset.samples(preset.event_window)),
        max_lag=None if preset.max_lag is None else preset.samples(preset.max_lag),
    )
    repeats = repeating(borders, labels, wide, preset)
    return refine(
        borders,
        np.where(repeats, labels, -1),
        narrow,
        switch_cost=preset.switch_cost * preset.working_fps / preset.step,
        no_action_cost=preset.no_action_cost,
        least_similarity=preset.least_similarity,
        least_own=preset.least_self_similarity,
        min_length=max(1, preset.samples(preset.min_action)),
        rounds=preset.rounds,
    )


def activities(
    found: Actions, narrow: Recurrence, preset: RecurrenceConstants, n: int
) -> tuple[Frames, Frames, NDArray[np.float64]]:
    """Borders, labels and confidence of activities and the transitions between them, in frames.

    Parameters
    ----------
    found : Actions
    narrow : Recurrence
        For short actions.
    preset : RecurrenceConstants
    n : int
        Frames of the features.
    """
    ends, begins = activity_ends(
        found,
        narrow,
        factor=preset.transition_factor,
        spread=preset.transition_spread,
        usual=preset.usual_quantile,
        longest=preset.samples(preset.max_transition),
        largest_share=preset.max_transition_share,
    )
    borders = np.column_stack([np.append(0, begins), np.append(ends, n)]).ravel()[:-1]
    labels = np.column_stack([found.labels, np.full_like(found.labels, -1)]).ravel()[:-1]
    confidence = np.repeat(found.confidence, 2)[:-1]
    filled = np.diff(borders, append=n) > 0
    borders, labels, confidence = borders[filled], labels[filled], confidence[filled]
    first = np.concatenate([[True], labels[1:] != labels[:-1]])
    confidence = np.where(labels < 0, np.nan, confidence)
    return np.append(borders[first], n), labels[first], confidence[first]


def _segments(recurring: Recurrence, preset: RecurrenceConstants) -> Frames:
    """Borders between the samples that are similar, but for those between parts of one."""
    borders = change_points.change_points(
        recurring,
        penalty=preset.border_cost * preset.working_fps / preset.step,
        min_length=max(1, preset.samples(preset.min_segment)),
    )
    return change_points.merge_neighbors(
        borders,
        recurring,
        gap=preset.samples(preset.merge_gap),
        softness=preset.merge_softness,
        least=preset.merge_share,
    )
