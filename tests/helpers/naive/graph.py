"""Naive versions of neighbour search and warping."""

from __future__ import annotations

import numpy as np

# --- neighbour graph and warping paths: pair by pair ------------------------------------------
# A graph is a dict of stored pairs {(i, j): distance}; a path is a list of pairs.


def find_neighbors(features, others=None, *, radius, k=None, max_lag=None):
    others = features if others is None else others
    pairs = {}
    for i, x in enumerate(features):
        for j, y in enumerate(others):
            distance = np.sqrt(sum((a - b) ** 2 for a, b in zip(x, y, strict=True)))
            if distance <= radius and (max_lag is None or abs(j - i) <= max_lag):
                pairs[i, j] = np.float32(distance)
    return pairs if k is None else select_nearest(pairs, k)


def select_nearest(pairs, k):
    kept = {}
    for row in {i for i, _ in pairs}:
        found = sorted((distance, j) for (i, j), distance in pairs.items() if i == row)
        kept |= {(row, j): distance for distance, j in found[:k]}
    return kept


def label_components(pairs, steps):
    """Return the first pair, in order of rows and columns, that is connected with each pair."""
    edges = {pair: set() for pair in pairs}
    for t, j in pairs:
        for a, b in steps:
            if (t + a, j + b) in pairs:
                edges[t, j].add((t + a, j + b))
                edges[t + a, j + b].add((t, j))
    firsts = {}
    for pair in sorted(pairs):
        waiting = [] if pair in firsts else [pair]
        while waiting:
            at = waiting.pop()
            if at not in firsts:
                firsts[at] = pair
                waiting += edges[at]
    return firsts


def find_paths_in_box(pairs, rows, columns, *, steps, skip_penalty, zero_cost, separation=None):
    """Return paths and costs of all components of a box, by relaxing edges until convergence."""
    inside = {
        (t, j): float(distance) or zero_cost
        for (t, j), distance in pairs.items()
        if rows[0] <= t < rows[1] and columns[0] <= j < columns[1]
    }
    firsts = label_components(inside, steps)
    found = []
    for first in set(firsts.values()):
        nodes = sorted(pair for pair in inside if firsts[pair] == first)
        top, bottom = nodes[0][0], nodes[-1][0]
        if top == bottom:
            continue
        best = {node: (inside[node], [node]) for node in nodes if node[0] == top}
        changed = True
        while changed:
            changed = False
            for t, j in list(best):
                for a, b in steps:
                    to = (t + a, j + b)
                    if to not in inside:
                        continue
                    passed_over = max(0, a - 1) + max(0, b - 1)
                    cost = best[t, j][0] + inside[to] + skip_penalty * passed_over
                    if to not in best or cost < best[to][0] - 1e-12:
                        best[to] = (cost, [*best[t, j][1], to])
                        changed = True
        kept = []
        for cost, path in sorted(best[node] for node in best if node[0] == bottom):
            away = separation if separation is not None else np.inf
            if all(abs(path[0][1] - other[0][1]) >= away for _, other in kept):
                kept.append((cost, path))
        found += kept
    return found


# --- matching: every warping of an example onto a recording, one by one ------------------------


def find_warpings(distances):
    """Return the least mean distance of a warping of the example that ends at each sample.

    ``distances`` (samples, m) are those of a recording from the example. A warping advances both by
    one, or one of them by two. Two samples that match one of the example count half each.
    """
    n, m = distances.shape

    def cheapest(j, i):
        """Return sum and start of the cheapest warping of samples up to i that ends at j."""
        if i == 0:
            return distances[j, 0], j
        found = []
        if j >= 1:
            total, begin = cheapest(j - 1, i - 1)
            found.append((total + distances[j, i], begin))
        if j >= 2:
            total, begin = cheapest(j - 2, i - 1)
            found.append((total + (distances[j - 1, i] + distances[j, i]) / 2, begin))
        if j >= 1 and i >= 2:
            total, begin = cheapest(j - 1, i - 2)
            found.append((total + distances[j, i - 1] + distances[j, i], begin))
        return min(found, default=(np.inf, -1))

    ends = [cheapest(j, m - 1) for j in range(n)]
    return [total / m for total, _ in ends], [begin for _, begin in ends]


def find_smallest_distances(windows, wanted, finer):
    """Return the least squared distance of each window to the wanted ones."""
    return [
        min(sum((finer * a - b) ** 2 for a, b in zip(window, one)) for one in wanted)
        for window in windows
    ]
