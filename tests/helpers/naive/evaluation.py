"""Naive versions of scores, one pair of labels and one frame at a time."""

from __future__ import annotations

import numpy as np


def one_to_one_accuracy(wanted, given):
    """Return the best share of right frames over all assignments of found labels to classes."""
    from itertools import permutations

    classes, names = sorted(set(wanted)), sorted(set(given))
    fixed = "transition" in names
    if fixed:
        names.remove("transition")
        classes = [c for c in classes if c != "transition"]
    slots = classes + [None] * len(names)
    best = 0
    for chosen in set(permutations(slots, len(names))):
        to = dict(zip(names, chosen))
        if fixed:
            to["transition"] = "transition"
        best = max(best, sum(to[g] == w for g, w in zip(given, wanted)))
    return best / len(wanted)


def find_cheapest_cost(cost, step):
    """Return the cost of dynamic time warping by its recursion."""
    total = np.full((cost.shape[0] + 1, cost.shape[1] + 1), np.inf)
    total[0, 0] = 0
    for i in range(cost.shape[0]):
        for j in range(cost.shape[1]):
            total[i + 1, j + 1] = cost[i, j] + min(
                total[i, j], total[i, j + 1] + step, total[i + 1, j] + step
            )
    return total[-1, -1]


def compute_cloud_distance(points, i, j, *, half):
    """Return Kovar and Gleicher's distance by trying all turns in steps of 0.1 degrees."""
    a, b = (points[f - half : f + half + 1].reshape(-1, 3) for f in (i, j))
    best = np.inf
    for angle in np.arange(0, 2 * np.pi, np.radians(0.1)):
        c, s = np.cos(angle), np.sin(angle)
        turned = b @ np.array([[c, 0, s], [0, 1, 0], [-s, 0, c]]).T
        difference = a - turned
        difference[:, [0, 2]] -= difference[:, [0, 2]].mean(axis=0)
        best = min(best, (difference**2).sum() / len(a))
    return best**0.5
