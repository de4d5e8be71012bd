"""The preset of the ``kineme`` method, one for every recording.

``docs/experiments.md`` says what other values measure.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike, NDArray

from kineme.methods import weights
from kineme.methods.base import Mirror
from kineme.methods.recurrence.constants import RecurrenceConstants
from kineme.methods.stages import Progress

if TYPE_CHECKING:
    from kineme.methods.recurrence.found import RecurrenceFound


@dataclass(frozen=True, kw_only=True)
class RecurrencePreset(RecurrenceConstants):
    """The ``kineme`` method by its constants."""

    def analyze(
        self,
        features: ArrayLike,
        *,
        mirror: Mirror | None = None,  # noqa: ARG002 (left and right are told apart)
        progress: Progress | None = None,
    ) -> RecurrenceFound:
        """Recurrence, actions and repetitions; see `kineme.methods.recurrence.analysis`."""
        from kineme.methods.recurrence.analysis import analyze_actions  # compiled code

        return analyze_actions(features, self, progress=progress)

    def signal_unit(self, features: NDArray[np.float64]) -> float:
        """The length in which the median sample recurs at ``recurs_at``; 1 if nothing can."""
        from kineme.methods.recurrence.analysis import recurrence_unit  # compiled code

        return recurrence_unit(features, self)


KINEME = RecurrencePreset(
    name="kineme",
    help="Finds activities and counts their repetitions; for use.",
    offsets=(-0.2, -0.1, 0.0, 0.1, 0.2),
    resolution=0.1,
    window=60.0,
    phase=1.25,
    phase_shares=(0.6, 0.8, 1.0),
    recurrence_time=3.0,
    min_scale=0.08,
    max_scale=0.16,
    softness=1.6,
    border_cost=1.75,
    min_segment=0.6,
    merge_gap=0.75,
    merge_softness=2.0,
    merge_share=0.3,
    narrow_share=0.55,
    distinct_share=0.65,
    sure_pace=0.9,
    link_similarity=0.6,
    link_softness=1.3,
    link_common=0.35,
    link_gap=0.25,
    link_samples=20,
    any_pace=True,
    least_self_similarity=0.05,
    min_repetition=0.5,
    switch_cost=0.6,
    no_action_cost=0.55,
    least_similarity=0.2,
    rounds=2,
    min_action=1.0,
    transition_factor=1.15,
    transition_spread=0.3,
    usual_quantile=0.9,
    max_transition=0.4,
    max_transition_share=0.25,
    max_unexplained=0.57,
    part_gap=1.75,
    min_periodic=0.55,
    event_scale=0.45,
    event_velocity=0.2,
    event_rest=0.1,
    max_stand=2.0,
    event_cost=0.25,
    event_cover=0.8,
    event_window=300.0,
    min_event=0.5,
    max_event=6.0,
    min_recurrence=0.6,
    event_link=0.6,
    pair_factor=2.0,
    whole_share=0.3,
    few_activities=4,
    link_weights=weights.LINK,
    border_weights=weights.BORDER,
    recurs_at=0.2,
    exact_below=0.02,
)
