"""The ``kineme`` method: what each stage finds, in frames of the working rate.

Nothing here knows what a skeleton is: any array of frames × dims will do.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike, NDArray

from kineme._checks import as_features
from kineme.methods.recurrence.found import RecurrenceFound
from kineme.methods.recurrence.paces import surest
from kineme.methods.recurrence.primitives import with_occurrences
from kineme.methods.recurrence.recurrence import Recurrence, phase_windows, recurrence
from kineme.methods.stages import Progress, stopwatch

if TYPE_CHECKING:
    from kineme.methods.recurrence.constants import RecurrenceConstants

# Scales of signals before their unit is known.
_TINY, _HUGE = 1e-9, 1e9


def analyze_actions(
    features: ArrayLike, preset: RecurrenceConstants, *, progress: Progress | None = None
) -> RecurrenceFound:
    """Recurrence, actions and repetitions of a sequence of features.

    Parameters
    ----------
    features : (frames, dims) array
        Stacked poses at the working rate, scaled so that distances are body
        sizes: divided by the size of the body and by the root of the number
        of stacked poses.
    preset : RecurrenceConstants
    progress : callable, optional
        Called with the name of each stage before it runs.

    Returns
    -------
    RecurrenceFound

    Raises
    ------
    ParameterError
        Features of another shape, empty, or not finite.
    """
    rows = as_features(features)
    timings: dict[str, float] = {}
    stage = stopwatch(timings, progress)
    with stage("recurrence"):
        recurring = _recurrence(rows, preset, preset.min_scale, preset.max_scale)
    division = surest(recurring, preset, stage)
    with stage("occurrences"):
        found = with_occurrences(
            division.recurring, division.segments, division.sure.counts, division.preset
        )
    with stage("confidence"):
        if found is not division.segments:
            division = replace(division, segments=found)
        sure = division.sure
    return RecurrenceFound(
        rows,
        division.recurring,
        division.preset,
        found.borders,
        found.labels,
        found.primitives,
        found.clusters,
        found.not_periodic,
        division.evidence,
        sure,
        division.narrow,
        timings,
    )


def recurrence_unit(features: NDArray[np.float64], preset: RecurrenceConstants) -> float:
    """The length in which the median sample of signals recurs at ``preset.recurs_at``.

    1 where nothing is long enough to recur.
    """
    scales = _recurrence(features, preset.replace(max_lag=None), _TINY, _HUGE).scales
    known = scales[scales < _HUGE / 2]
    if not len(known):
        return 1.0
    return max(float(np.median(known)), preset.exact_below) / preset.recurs_at


def _recurrence(
    features: NDArray[np.float64], preset: RecurrenceConstants, low: float, high: float
) -> Recurrence:
    reach = preset.window if preset.max_lag is None else min(preset.window, preset.max_lag)
    return recurrence(
        features,
        step=preset.step,
        width=max(1, preset.samples(reach)),
        phases=phase_windows(preset.samples(preset.phase), preset.phase_shares),
        rank=preset.samples(preset.recurrence_time),
        low=low,
        high=high,
        softness=preset.softness,
    )
