"""Parts: repetitions of one action that are two movements, such as a deep squat and a shallow one.

The repetitions of an action are compared by their poses, evenly in time, so that
pace does not count; those of two activities, which may be cut at another phase, after
the one is turned round to where their means agree best. Average linkage makes a tree
of them. Where two branches join at a height far above that at which each of them
joined, they are two clusters. A repetition that joins alone belongs to what it joins.

The method is ours. See ``docs/method.md`` for what it contributes.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from kineme.methods.recurrence.repeating._end_kernels import evenly_in_time
from kineme.methods.samples import spread
from kineme.methods.segments import by_first_appearance

if TYPE_CHECKING:
    from kineme.methods.recurrence.constants import RecurrenceConstants

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

COMPARED = 512
"""Repetitions of an action that are compared with each other, at most; others go to the nearest."""


def clusters_of_repetitions(
    poses: NDArray[np.float32],
    primitives: Ints,
    actions: Ints,
    activities: Ints,
    preset: RecurrenceConstants,
) -> Ints:
    """The cluster of each repetition: its action's number, or one of its own beyond those.

    Of the clusters of an action the one with the most frames keeps the number of the
    action. The others are counted on after the last action, by first appearance.

    Parameters
    ----------
    poses : (frames, dims) array
        Not stacked, in body sizes.
    primitives : (primitives + 1,) array
        Borders, frames.
    actions : (primitives,) array
        Action of each, -1 where it is no repetition.
    activities : (primitives,) array
        Number of the activity that each lies in.
    preset : RecurrenceConstants

    Returns
    -------
    (primitives,) array
    """
    lengths = np.diff(primitives)
    parts = np.full(len(actions), -1)
    count = int(actions.max(initial=-1)) + 1
    for action in range(count):
        own = np.flatnonzero(actions == action)
        rows = evenly_in_time(poses, primitives[own], lengths[own], preset.path_points)
        part = _parts(_in_phase(rows, activities[own]), preset)
        main = np.bincount(part, lengths[own]).argmax()
        parts[own] = np.where(part == main, -1, parts.max(initial=-1) + 1 + part)
    return np.where(parts < 0, actions, count + by_first_appearance(parts))


def _in_phase(rows: Floats, activities: Ints) -> Floats:
    """The repetitions of each activity turned round so that its mean is like that of the first."""
    turned = rows.copy()
    first = rows[activities == activities[0]].mean(axis=0)
    for activity in np.unique(activities)[1:]:
        own = activities == activity
        mean = rows[own].mean(axis=0)
        misfits = [((np.roll(mean, by, axis=0) - first) ** 2).sum() for by in range(len(mean))]
        turned[own] = np.roll(rows[own], int(np.argmin(misfits)), axis=1)
    return turned


def _parts(rows: Floats, preset: RecurrenceConstants) -> Ints:
    """Which cluster each repetition is in, from 0."""
    flat = rows.reshape(len(rows), -1) / rows.shape[1] ** 0.5
    compared = spread(0, len(rows), COMPARED)
    divided = _divided(flat[compared], preset.part_gap, preset.min_scale)
    if len(compared) == len(rows):
        return divided
    means = [flat[compared[divided == part]].mean(axis=0) for part in range(divided.max() + 1)]
    nearest: Ints = np.argmin([((flat - mean) ** 2).sum(axis=1) for mean in means], axis=0)
    return nearest


def _divided(rows: Floats, gap: float, least: float) -> Ints:
    """Branches of the tree of rows that join at ``gap`` times their own heights, or above.

    Heights below ``least`` count as that. A row that joins alone has no say.
    """
    from scipy.cluster.hierarchy import linkage

    n = len(rows)
    branches = np.zeros(n, np.int64)
    if n < 4:  # no two branches of two
        return branches
    tree = linkage(rows, "average")
    heights, sizes = np.append(np.zeros(n), tree[:, 2]), np.append(np.ones(n), tree[:, 3])
    members: list[list[int]] = [[row] for row in range(n)]
    joined: dict[int, tuple[int, int]] = {}
    for node, pair in enumerate(tree[:, :2].astype(int).tolist(), n):
        small, large = sorted(pair, key=lambda each: sizes[each])
        joined[node] = small, large
        members.append(members[small] + members[large])

    def fork(node: int) -> int:
        """Where two branches of two rows or more join, or the last pair."""
        while sizes[node] > 2 and sizes[joined[node][0]] == 1:
            node = joined[node][1]
        return node

    todo = [len(heights) - 1]
    while todo:
        node = fork(todo.pop())
        if sizes[node] < 4:
            continue
        small, large = joined[node]
        if heights[node] >= gap * max(heights[fork(small)], heights[fork(large)], least):
            branches[members[small]] = branches.max() + 1
            todo += [small, large]
    return branches
