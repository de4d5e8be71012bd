"""Paces: a recording divided twice, with all times as they are and with shorter ones.

Exercises of 2 to 4 s want shorter times than those of 10 s, and no one set of them does
for both. The division of which one can be surer is taken: by the probabilities
that counts and borders are right, which are learnt from recordings with a known truth
(see `kineme.methods.confidence`).
"""

from __future__ import annotations

from collections.abc import Callable
from contextlib import AbstractContextManager
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from kineme.methods.confidence import Confidence, confidence
from kineme.methods.evidence import Evidence
from kineme.methods.recurrence.actions import Actions
from kineme.methods.recurrence.activities import activities, find_actions
from kineme.methods.recurrence.evidence import evidence
from kineme.methods.recurrence.primitives import count_repetitions, with_repetitions
from kineme.methods.recurrence.recurrence import Recurrence, narrower, phase_windows
from kineme.methods.recurrence.repeating.placing import Segments

if TYPE_CHECKING:
    from kineme.methods.recurrence.constants import RecurrenceConstants

Stage = Callable[[str], AbstractContextManager[None]]


@dataclass(frozen=True, eq=False)
class Division:
    """Activities and repetitions of a recording, found with one preset.

    Attributes
    ----------
    preset : RecurrenceConstants
    recurring, narrow : Recurrence
        How similar the samples are, and how similar for short actions.
    segments : Segments
    """

    preset: RecurrenceConstants
    recurring: Recurrence
    narrow: Recurrence
    segments: Segments

    @cached_property
    def evidence(self) -> Evidence:
        """By which it is told how sure the division is."""
        return evidence(self.recurring, self.preset, self.segments)

    @property
    def actions(self) -> int:
        """How many are told apart."""
        return _number(self.segments.labels)

    @cached_property
    def sure(self) -> Confidence:
        """How probable it is that each thing found is right."""
        return confidence(self.evidence, self.preset)

    @cached_property
    def sureness(self) -> float:
        """How probably the counts are right, over the whole time, and the borders: their mean."""
        lengths = np.diff(self.segments.borders)
        counts = np.average(np.nan_to_num(self.sure.counts), weights=lengths)
        borders = self.sure.borders[np.isfinite(self.sure.borders)]
        return float(counts + (borders.mean() if len(borders) else 1.0)) / 2


def surest(recurring: Recurrence, preset: RecurrenceConstants, stage: Stage) -> Division:
    """The division with the preset as it is or hurried, whichever is surer.

    Shorter times must tell at least as many actions apart, and repeat something: one action
    with one long chain of repetitions has no borders to be unsure of, nor has one movement.

    Parameters
    ----------
    recurring : Recurrence
        Measured with the windows of the preset.
    preset : RecurrenceConstants
    stage : callable
        See `kineme.methods.stages.stopwatch`.
    """
    with stage("activities"):
        usual = _counted(recurring, preset, *_told_apart(recurring, preset))
    with stage("paces"):
        if usual.sureness >= preset.sure_pace:
            return usual
        short, least = preset.hurried, max(1, usual.actions)
        quick = _windowed(recurring, short)
        narrow, found = _told_apart(quick, short)
        if _number(found.labels) < least:
            return usual
        other = _counted(quick, short, narrow, found)
        repeats = other.segments.counts.max() > 1
        surer = repeats and other.actions >= least and other.sureness > usual.sureness
        return other if surer else usual


def _told_apart(recurring: Recurrence, preset: RecurrenceConstants) -> tuple[Recurrence, Actions]:
    """How similar the samples are for short actions, and the actions."""
    narrow = _windowed(recurring, preset.narrowed)
    return narrow, find_actions(recurring, narrow, preset)


def _counted(
    recurring: Recurrence, preset: RecurrenceConstants, narrow: Recurrence, found: Actions
) -> Division:
    """The activities of the actions, and their repetitions."""
    borders, labels, own = activities(found, narrow, preset, len(recurring.features))
    limits = found.borders * recurring.step
    repeating = count_repetitions(recurring, borders, labels, limits, preset)
    segments = with_repetitions(recurring, borders, labels, own, repeating, preset)
    return Division(preset, recurring, narrow, segments)


def _number(labels: NDArray[np.int64]) -> int:
    """How many actions there are."""
    return len(set(labels.tolist()) - {-1})


def _windowed(recurring: Recurrence, preset: RecurrenceConstants) -> Recurrence:
    """The recurrence of the same samples with the windows of a preset."""
    return narrower(
        recurring,
        phases=phase_windows(preset.samples(preset.phase), preset.phase_shares),
        rank=preset.samples(preset.recurrence_time),
        low=preset.min_scale,
        high=preset.max_scale,
    )
