"""Actions: what each sample of a recording belongs to, known again when it returns.

The segments between change points say roughly which actions there are. Each sample
then goes to the action it is most similar to, or to none; changing costs, so that
borders fall where the evidence turns.

The method is ours. See ``docs/method.md`` for what each step contributes.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from kineme._threads import even_slices, map_threads
from kineme.methods.recurrence import _action_kernels as kernels
from kineme.methods.recurrence.change_points import Samples
from kineme.methods.recurrence.recurrence import SHORT, Recurrence
from kineme.methods.segments import by_first_appearance


@dataclass(frozen=True, eq=False)
class Actions:
    """Segments of one action each.

    Attributes
    ----------
    borders : (segments + 1,) array
        Samples, from 0 to the end.
    labels : (segments,) array
        Action of each, from 0 by first appearance; -1: none; neighbours differ.
    confidence : (segments,) array
        How much more similar its samples are to their own action than to any other, 0 to 1.
    """

    borders: Samples
    labels: Samples
    confidence: NDArray[np.float64]


def refine(
    borders: Samples,
    labels: Samples,
    recurrence: Recurrence,
    *,
    switch_cost: float,
    no_action_cost: float,
    least_similarity: float,
    least_own: float,
    min_length: int,
    rounds: int,
) -> Actions:
    """Each sample given to the action it is most similar to, or to none; changing costs.

    Parameters
    ----------
    borders, labels : array of int
        Segments and their actions to begin with; -1 for none.
    recurrence : Recurrence
    switch_cost : float
        Samples of dissimilarity that a change of action costs.
    no_action_cost : float
        Dissimilarity, from 0 to 1, at which a sample is better in no action.
    least_similarity : float
        Similarity, relative to that within the action, at which dissimilarity is 1.
    least_own : float
        An action is taken to be at least so similar within.
    min_length : int
        Samples; an action with less is given up.
    rounds : int
        Times that actions are learnt anew from their samples.

    Returns
    -------
    Actions
    """
    if (labels < 0).all():
        return Actions(borders[[0, -1]], np.array([-1]), np.zeros(1))
    per_sample = by_first_appearance(np.repeat(labels, np.diff(borders)))
    relative, actions = _relative_affinity(recurrence, per_sample, least_own)
    for _ in range(rounds):
        none = np.full(len(per_sample), no_action_cost)
        costs = np.column_stack([_dissimilarity(relative, least_similarity), none])
        columns = kernels.cheapest_labels(costs, switch_cost)
        choices = np.column_stack([actions, np.full(len(per_sample), -1)])
        given = choices[np.arange(len(per_sample)), columns]
        rare = np.bincount(given + 1)[given + 1] < min_length
        given = by_first_appearance(np.where(rare, -1, given))
        if (given == per_sample).all():
            break
        per_sample = given
        relative, actions = _relative_affinity(recurrence, per_sample, least_own)
    found = np.concatenate([[0], np.flatnonzero(np.diff(per_sample)) + 1, [len(per_sample)]])
    confidence = _confidence(relative, actions, per_sample, found)
    return Actions(found, per_sample[found[:-1]], confidence)


def _dissimilarity(affinity: NDArray[np.float64], least: float) -> NDArray[np.float64]:
    """0 where an action is at home, more by as much each time affinity halves, 1 at the least."""
    logarithms = np.log(np.maximum(affinity, least))
    costs: NDArray[np.float64] = logarithms / np.log(least)
    return costs


def _confidence(
    relative: NDArray[np.float64], actions: Samples, per_sample: Samples, borders: Samples
) -> NDArray[np.float64]:
    """How much more similar the samples of each segment are to their own action than to others."""
    is_own = (actions == per_sample[:, None]) & (per_sample[:, None] >= 0)
    own = np.where(is_own, relative, 0).sum(axis=1)
    other = np.where(is_own, 0, relative).max(axis=1, initial=0)
    return np.clip(np.add.reduceat(own - other, borders[:-1]) / np.diff(borders), 0, 1)


def _relative_affinity(
    recurrence: Recurrence, per_sample: Samples, least: float
) -> tuple[NDArray[np.float64], Samples]:
    """Mean similarity of each sample to the actions in reach, relative to their medians, to 1.

    One column per action, or for several; which it is for at each sample comes with it.
    """
    actions, column_of = _columns(per_sample, recurrence.similarity.shape[1] - 1)
    none = actions.shape[1]  # samples of no action count in a column of their own, left out below
    columns = np.where(per_sample < 0, none, column_of[per_sample])
    affinity = np.empty((len(per_sample), none + 1))

    def fill(part: slice) -> None:
        kernels.class_affinities(
            recurrence.similarity, columns, recurrence.phase, part.start, part.stop, affinity
        )

    map_threads(fill, even_slices(len(per_sample), SHORT))
    by_action = np.split(
        np.argsort(per_sample, kind="stable"), np.cumsum(np.bincount(per_sample + 1))
    )
    own = [_usual(affinity[samples, columns[samples]]) for samples in by_action[1:-1]]
    scale = np.append(np.maximum(own, least), 1.0)[actions]
    return np.minimum(affinity[:, :none] / scale, 1), actions


def _usual(affinities: NDArray[np.float64]) -> float:
    """Their median; samples of a short action may have none of it in reach, and say nothing."""
    known = affinities[affinities > 0]
    return float(np.median(known)) if len(known) else 0.0


def _columns(per_sample: Samples, reach: int) -> tuple[Samples, Samples]:
    """The action of each column at each sample (-1: none), and the column of each action.

    Actions that no sample can reach both of share a column, so that there are
    no more columns in a long recording than in a short one.
    """
    n = len(per_sample)
    column_of = np.zeros(int(per_sample.max()) + 2, np.int64)  # one more, for none
    spans: list[tuple[int, int, int]] = []
    free_from: list[int] = []
    for action in range(len(column_of) - 1):
        own = np.flatnonzero(per_sample == action)
        start, stop = max(0, int(own[0]) - reach), min(n, int(own[-1]) + reach + 1)
        free = (column for column, since in enumerate(free_from) if since <= start)
        column = next(free, len(free_from))
        free_from[column : column + 1] = [stop]
        column_of[action] = column
        spans.append((start, stop, column))
    actions = np.full((n, len(free_from)), -1)
    for action, (start, stop, column) in enumerate(spans):
        actions[start:stop, column] = action
    return actions, column_of
