"""Actions: what each moment of a recording belongs to, known again when it returns.

Stretches (see ``stretches``) say roughly which actions there are. Each moment
then goes to the action it is most like, or to none; changing costs, so that
borders fall where the evidence turns.

The method is ours. See ``docs/method.md`` for what each step contributes.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from kineme._threads import even_slices, map_threads
from kineme.methods.numbering import by_first_appearance
from kineme.methods.recurrence import _action_kernels as kernels
from kineme.methods.recurrence.recurrence import Recurrence
from kineme.methods.recurrence.stretches import Bins

# Moments less like an action than this share of its own are as unlike it as can be.
LEAST_AFFINITY = 0.2


@dataclass(frozen=True, eq=False)
class Actions:
    """Stretches of one action each.

    Parameters
    ----------
    borders : (stretches + 1,) bins, from 0 to the end
    labels : (stretches,) action of each, from 0 by first appearance; -1: none; neighbours differ
    confidence : (stretches,) how much more alike its moments are to their own action than to
        any other, 0 to 1
    """

    borders: Bins
    labels: Bins
    confidence: NDArray[np.float64]


def refine(
    borders: Bins,
    labels: Bins,
    recurrence: Recurrence,
    *,
    switch_cost: float,
    no_action_cost: float,
    min_length: int,
    rounds: int = 2,
) -> Actions:
    """Each moment given to the action it is most like, or to none; changing costs.

    Parameters
    ----------
    borders, labels : stretches and their actions to begin with; -1 for none
    recurrence : Recurrence
    switch_cost : bins of unlikeness that a change of action costs
    no_action_cost : unlikeness, from 0 to 1, at which a moment is better in no action
    min_length : bins; an action with less is given up
    rounds : times that actions are learnt anew from their moments
    """
    per_bin = by_first_appearance(np.repeat(labels, np.diff(borders)))
    for _ in range(rounds):
        relative, actions = _relative_affinity(recurrence, per_bin, min_length)
        none = np.full(len(per_bin), no_action_cost)
        costs = np.column_stack([_unlikeness(relative), none])
        columns = kernels.cheapest_labels(costs, switch_cost)
        actions = np.column_stack([actions, np.full(len(per_bin), -1)])
        per_bin = actions[np.arange(len(per_bin)), columns]
        rare = np.bincount(per_bin + 1)[per_bin + 1] < min_length
        per_bin = by_first_appearance(np.where(rare, -1, per_bin))
    found = np.concatenate([[0], np.flatnonzero(np.diff(per_bin)) + 1, [len(per_bin)]])
    return Actions(found, per_bin[found[:-1]], _confidence(recurrence, per_bin, found, min_length))


def _unlikeness(affinity: NDArray[np.float64]) -> NDArray[np.float64]:
    """0 where an action is at home, more by as much each time affinity halves, 1 at the least."""
    logarithms = np.log(np.maximum(affinity, LEAST_AFFINITY))
    costs: NDArray[np.float64] = logarithms / np.log(LEAST_AFFINITY)
    return costs


def _confidence(
    recurrence: Recurrence, per_bin: Bins, borders: Bins, min_count: int
) -> NDArray[np.float64]:
    """How much more alike the bins of each stretch are to their own action than to the next."""
    relative, actions = _relative_affinity(recurrence, per_bin, min_count)
    is_own = (actions == per_bin[:, None]) & (per_bin[:, None] >= 0)
    own = np.where(is_own, relative, 0).sum(axis=1)
    other = np.where(is_own, 0, relative).max(axis=1, initial=0)
    return np.clip(np.add.reduceat(own - other, borders[:-1]) / np.diff(borders), 0, 1)


def _relative_affinity(
    recurrence: Recurrence, per_bin: Bins, min_count: int
) -> tuple[NDArray[np.float64], Bins]:
    """Mean similarity of each bin to the actions in reach, relative to their own medians, to 1.

    One column per action, or for several; which it is for at each bin comes with it.
    """
    actions, column_of = _columns(per_bin, recurrence.similarity.shape[1] - 1)
    none = actions.shape[1]  # bins of no action count in a column of their own, left out below
    columns = np.where(per_bin < 0, none, column_of[per_bin])
    affinity = np.empty((len(per_bin), none + 1))

    def fill(part: slice) -> None:
        kernels.class_affinities(
            recurrence.similarity, columns, recurrence.phase, min_count, part.start, part.stop,
            affinity,
        )  # fmt: skip

    map_threads(fill, even_slices(len(per_bin)))
    by_action = np.split(np.argsort(per_bin, kind="stable"), np.cumsum(np.bincount(per_bin + 1)))
    own = [np.median(affinity[bins, columns[bins]]) for bins in by_action[1:-1]]
    scale = np.append(np.maximum(own, 0.05), 1.0)[actions]
    return np.minimum(affinity[:, :none] / scale, 1), actions


def _columns(per_bin: Bins, reach: int) -> tuple[Bins, Bins]:
    """Which action each column stands for at each bin (-1: none), and the column of each action.

    Actions that no bin can reach both of share a column, so that there are
    no more columns in a long recording than in a short one.
    """
    n = len(per_bin)
    column_of = np.zeros(int(per_bin.max()) + 2, np.int64)  # one more, for none
    spans: list[tuple[int, int, int]] = []
    free_from: list[int] = []
    for action in range(len(column_of) - 1):
        bins = np.flatnonzero(per_bin == action)
        start, stop = max(0, int(bins[0]) - reach), min(n, int(bins[-1]) + reach + 1)
        free = (column for column, since in enumerate(free_from) if since <= start)
        column = next(free, len(free_from))
        free_from[column : column + 1] = [stop]
        column_of[action] = column
        spans.append((start, stop, column))
    actions = np.full((n, len(free_from)), -1)
    for action, (start, stop, column) in enumerate(spans):
        actions[start:stop, column] = action
    return actions, column_of
