"""Naive versions of region growing: the rules as published, with frames counted from 1 inside."""

from __future__ import annotations

import numpy as np


def find_square_cuts(pairs, n, *, min_gap, min_count, min_distance):
    """Return forward and backward cuts (0-based) of square regions, recomputing each count."""

    def count(a, b):
        return sum(a <= t + 1 <= b and a <= j + 1 <= b for t, j in pairs)

    c = {}
    sf = last = 1
    z = 0
    for i in range(2, n + 1):
        c[i] = count(sf, i)
        if c[i] == c.get(i - 1):
            z += 1
            if z == min_gap:
                if any(c.get(f, 0) > min_count for f in range(last, i + 1)):
                    last, sf = i - z, i
                z = 0
        else:
            z = 0
    forward = find_peaks(c, min_count, min_distance)

    c = {}
    ef = last = n
    z = 0
    for i in range(n - 1, 0, -1):
        c[i] = count(i, ef)
        if i in forward:
            last = ef = i
        elif c[i] == c.get(i + 1):
            z += 1
            if z == min_gap:
                z = 0
                if any(c.get(f, 0) > min_count for f in range(i, last + 1)):
                    last = ef = i
        else:
            z = 0
    backward = [min(peak + min_gap, n) for peak in find_peaks(c, min_count, min_distance)]
    return [cut - 1 for cut in forward], [cut - 1 for cut in backward]


def find_peaks(c, min_height, min_distance):
    """Return the keys of ``c`` at peaks: a rise before, and a fall at the next change."""
    found = []
    for i in sorted(c):
        if i - 1 in c and c[i] > c[i - 1] and c[i] > min_height:
            after = i
            while after in c and c[after] == c[i]:
                after += 1
            if after in c and c[after] < c[i]:
                found.append(i)
    kept = []
    for peak in sorted(found, key=lambda i: (-c[i], i)):
        if all(abs(peak - other) > min_distance for other in kept):
            kept.append(peak)
    return sorted(kept)


def find_scan_line_cuts(pairs, n, *, min_gap, min_count):
    """Forward and backward cuts (0-based) of regions scanned line by line."""
    forward, backward = [], []
    s, blob, z = 1, 0, 0
    for i in range(1, n + 1):
        c = sum(t + 1 == i and s <= j + 1 <= i for t, j in pairs)
        blob += c
        if c > 0:
            z = 0
        else:
            z += 1
            if z >= min_gap and blob > min_count:
                forward.append(i - z)
                s, blob, z = i - z, 0, 0
    e, blob, z = n, 0, 0
    for i in range(n, 0, -1):
        c = sum(t + 1 == i and i <= j + 1 <= e for t, j in pairs)
        blob += c
        if i in forward:
            e, blob, z = i, 0, 0
        elif c > 0:
            z = 0
        else:
            z += 1
            if z >= min_gap and blob > min_count:
                backward.append(i + z)
                e, blob, z = i + z, 0, 0
    return [cut - 1 for cut in forward], sorted(cut - 1 for cut in backward)


def mark_coherent_paths(paths, share):
    """Mark paths that a path matches with rows and columns exchanged."""
    return [
        any(
            sum(t in {j for _, j in q} for t, _ in p) >= share * len(p)
            and sum(j in {t for t, _ in q} for _, j in p) >= share * len(p)
            for q in paths
        )
        for p in paths
    ]


def choose_cuts(paths, activity, *, min_length):
    """Return starts of paths that are far from the activity's ends and starts of longer paths."""
    first, last = activity
    kept = []
    for path in sorted(paths, key=len, reverse=True):
        cut = path[0][1]
        if first + min_length <= cut <= last - min_length:
            if not any(abs(cut - other) < min_length for other in kept):
                kept.append(cut)
    return sorted(kept)


def find_linked_segments(paths, borders, g, *, coverage, interpolate):
    """Return segments that paths link to segment g, and the covered share."""

    def overlap(a, b, c, d):
        return len(set(range(a, b + 1)) & set(range(c, d + 1))) / (b - a + 1)

    def row(path, v):
        reached = [at for at in range(len(path)) if path[at][1] <= v] or [0]
        t, j = path[reached[-1]]
        if j < v and reached[-1] + 1 < len(path):
            return int(np.floor((t + 1 + path[reached[-1] + 1][0] + 1) / 2 + 0.5)) - 1
        return t

    links = []
    for path in paths:
        f0, f1 = path[0][1], path[-1][1]
        for h in range(len(borders) - 1):
            r0, r1 = borders[h], borders[h + 1]
            if r1 < f0 or r0 > f1:
                continue
            rows = (row(path, r0), row(path, r1)) if interpolate else (path[0][0], path[-1][0])
            share = min(overlap(r0, r1, f0, f1), overlap(borders[g], borders[g + 1], *rows))
            if share >= coverage:
                links.append((h, share))
    return links


def cluster_segments(links, connection):
    """Label segments that are connected by links (in both directions if strong)."""
    n = len(links)
    reached = np.eye(n, dtype=bool)
    for g, targets in enumerate(links):
        reached[g, list(targets)] = True
    if connection == "weak":
        reached |= reached.T
    for _ in range(n):
        reached = (reached.astype(int) @ reached.astype(int)) > 0
    together = reached & reached.T
    firsts = [int(np.argmax(row)) for row in together]
    order = sorted(set(firsts))
    return [order.index(first) for first in firsts]
