"""Compiled loops over the neighbour graph: components and cheapest paths.

A node is a stored pair (t, j) inside a box of rows and columns. Nodes are
numbered row by row, ascending in j. A warping step (a, b) leads from
(t - a, j - b) to (t, j). Naive versions are in ``tests/helpers/naive``.

``first[r]`` is the first stored entry of row r inside the box, and ``node[r]``
the number of its node. So node v of row r is entry ``v + first[r] - node[r]``.
The last few rows are stored densely in a ring buffer, in which a step is one look-up.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from kineme._util.parallel import OPTIONS


@njit(
    "Tuple((int64[::1], int64[::1]))(int64[::1], int32[::1], int64, int64, int64, int64)", **OPTIONS
)
def find_box_rows(indptr, indices, row_start, row_stop, column_start, column_stop):
    """Return ``first`` and ``node`` for the rows of a box; see the module docstring."""
    rows = row_stop - row_start
    first = np.empty(rows, np.int64)
    node = np.zeros(rows + 1, np.int64)
    for r in range(rows):
        row = indices[indptr[row_start + r] : indptr[row_start + r + 1]]
        # Rows are sorted, so the nodes inside the box are one slice.
        low = np.searchsorted(row, column_start)
        first[r] = indptr[row_start + r] + low
        node[r + 1] = node[r] + np.searchsorted(row, column_stop) - low
    return first, node


@njit("Tuple((int64, int64))(int32[::1], int64[::1], int64[::1])", **OPTIONS)
def find_used_columns(indices, first, node):
    """Return the first column with a node, and the number of columns up to the last one."""
    # The largest index stands for "none yet".
    low, high = np.int64(np.iinfo(np.int32).max), np.int64(-1)
    for r in range(len(first)):
        nodes = node[r + 1] - node[r]
        if nodes:
            low = min(low, np.int64(indices[first[r]]))
            high = max(high, np.int64(indices[first[r] + nodes - 1]))
    return (low, high - low + 1) if high >= 0 else (np.int64(0), np.int64(0))


@njit("Tuple((int32[::1], int64, int64))(int64[:, ::1], int64)", **OPTIONS)
def make_ring(steps, width):
    """Return an empty ring buffer, the length of its rows, and how far steps reach to the left."""
    # As many rows as the longest step goes back, plus the current one.
    depth, reach = 1, 0
    for s in range(len(steps)):
        depth = max(depth, steps[s, 0] + 1)
        reach = max(reach, steps[s, 1])
    # Padding to the left, so that a step never leaves its row.
    return np.full(depth * (width + reach), -1, np.int32), width + reach, reach


@njit(
    "void(int32[::1], int64, int64[::1], int64, int32[::1], int64[::1], int64[::1],"
    " int64[:, ::1], int64)",
    **OPTIONS,
)
def enter_row(ring, line, slots, r, indices, first, node, steps, offset):
    """Replace the oldest row of the ring buffer by row r.

    Afterwards the node one step s before column j of row r is
    ``ring[slots[s] + j]``, or -1.
    """
    depth = len(ring) // line
    # Column j of the row is at `here + j`.
    here = (r % depth) * line + offset
    if r >= depth:
        # Clear only the entries that were set, which is cheaper than a whole row.
        old = r - depth
        for e in range(first[old], first[old] + node[old + 1] - node[old]):
            ring[here + indices[e]] = -1
    shift = first[r] - node[r]
    for v in range(node[r], node[r + 1]):
        ring[here + indices[v + shift]] = v
    for s in range(len(steps)):
        # Position of the node before step s, without the column j.
        slots[s] = ((r - steps[s, 0]) % depth) * line + offset - steps[s, 1]


@njit("int32[::1](int32[::1], int64[::1], int64[::1], int64[:, ::1], int64, int64)", **OPTIONS)
def find_component_roots(indices, first, node, steps, column_start, width):
    """Return the first node of the weakly connected component of each node."""
    n = node[-1]
    # Union-find; the root of a component is its smallest node.
    parents = np.empty(n, np.int32)
    ring, line, reach = make_ring(steps, width)
    slots = np.empty(len(steps), np.int64)
    for r in range(len(first)):
        enter_row(ring, line, slots, r, indices, first, node, steps, reach - column_start)
        shift = first[r] - node[r]
        for v in range(node[r], node[r + 1]):
            j = indices[v + shift]
            root = np.int32(v)
            for slot in slots:
                u = ring[slot + j]
                # A step (0, b) looks into the same row, where later nodes are not yet set.
                if u < 0 or u >= v:
                    continue
                up = parents[u]
                if up == root:
                    continue
                # Path halving: attach nodes on the way to the root to their grandparents.
                while up != u:
                    parents[u] = parents[up]
                    u = parents[u]
                    up = parents[u]
                # The smaller root becomes the root of the union.
                if u < root:
                    if root < v:
                        parents[root] = u
                    root = u
                else:
                    parents[u] = root
            parents[v] = root
    # Parents have smaller numbers, so one pass in order resolves all roots.
    for v in range(n):
        parents[v] = parents[parents[v]]
    return parents


@njit(
    "Tuple((float64[::1], int32[::1], int32[::1]))(int32[::1], float32[::1], int64[::1],"
    " int64[::1], int64[:, ::1], float64[::1], int64, int64, int32[::1], boolean[::1], float64)",
    **OPTIONS,
)
def find_cheapest_arrivals(
    indices, distances, first, node, steps, penalties, column_start, width, roots, valid, zero_cost
):
    """Return cost, predecessor and first column of the cheapest path to every node.

    Paths begin at any node of the first row of their component. A node costs
    its distance (``zero_cost`` if that is zero) plus the penalty of the step
    that led to it. Nodes of components that are not ``valid`` are skipped.
    """
    n = node[-1]
    costs = np.full(n, np.inf)
    before = np.full(n, -1, np.int32)
    origins = np.full(n, -1, np.int32)
    ring, line, reach = make_ring(steps, width)
    slots = np.empty(len(steps), np.int64)
    for r in range(len(first)):
        enter_row(ring, line, slots, r, indices, first, node, steps, reach - column_start)
        shift = first[r] - node[r]
        for v in range(node[r], node[r + 1]):
            # Skip components that are too small.
            if not valid[roots[v]]:
                continue
            j = indices[v + shift]
            best = np.inf
            # If the component begins in this row, a path may begin here at no cost.
            if roots[v] >= node[r]:
                best = 0.0
                origins[v] = j
            for s in range(len(slots)):
                u = ring[slots[s] + j]
                if u >= 0 and costs[u] + penalties[s] < best:
                    best = costs[u] + penalties[s]
                    before[v] = u
            # Inherit the first column of the path.
            if before[v] >= 0:
                origins[v] = origins[before[v]]
            # Equal poses also have a cost, so that no path is free.
            distance = np.float64(distances[v + shift])
            costs[v] = best + (distance if distance > 0 else zero_cost)
    return costs, before, origins


@njit("Tuple((boolean[::1], int64[::1]))(int32[::1], int64[::1], int64)", **OPTIONS)
def survey_components(roots, node, min_nodes):
    """Mark components of at least ``min_nodes`` nodes and two rows; return also their last rows."""
    n = node[-1]
    counts = np.zeros(n, np.int64)
    last_rows = np.zeros(n, np.int64)
    valid = np.zeros(n, np.bool_)
    for r in range(len(node) - 1):
        for v in range(node[r], node[r + 1]):
            root = roots[v]
            counts[root] += 1
            last_rows[root] = r
            # The root is the first node: if it lies in an earlier row, there are two rows or more.
            valid[root] = root < node[r] and counts[root] >= min_nodes
    return valid, last_rows


@njit(
    "int32[::1](int32[::1], boolean[::1], int64[::1], float64[::1], int32[::1], int64[::1], int64)",
    **OPTIONS,
)
def choose_ends(roots, valid, last_rows, costs, origins, node, separation):
    """Return the nodes of the last row of each component at which paths end, cheapest first.

    If two paths begin less than ``separation`` columns apart, only the cheaper one is
    kept. A node without a path from the first row is skipped.
    """
    ends = []
    for r in range(len(node) - 1):
        rest = [
            v
            for v in range(node[r], node[r + 1])
            if valid[roots[v]] and last_rows[roots[v]] == r and costs[v] < np.inf
        ]
        while len(rest) > 0:
            end = rest[0]
            for v in rest:
                if roots[v] == roots[end] and costs[v] < costs[end]:
                    end = v
            ends.append(end)
            # Keep ends of other components, and ends whose paths begin far enough away.
            rest = [
                v
                for v in rest
                if roots[v] != roots[end]
                or (v != end and abs(origins[v] - origins[end]) >= separation)
            ]
    return np.array(ends, dtype=np.int32)


@njit(
    "Tuple((int64[::1], int32[::1], int32[::1], float64[::1]))"
    "(int64[::1], int32[::1], float32[::1], int64, int64, int64, int64, int64[:, ::1],"
    " float64[::1], float64, int64, int64)",
    **OPTIONS,
)
def find_paths_in_box(
    indptr, indices, distances, row_start, row_stop, column_start, column_stop, steps, penalties,
    zero_cost, min_nodes, separation,
):  # fmt: skip
    """Return the cheapest paths through the components of a box: pointers, rows, columns, costs."""
    first, node = find_box_rows(indptr, indices, row_start, row_stop, column_start, column_stop)
    column_start, width = find_used_columns(indices, first, node)
    roots = find_component_roots(indices, first, node, steps, column_start, width)
    valid, last_rows = survey_components(roots, node, min_nodes)
    costs, before, origins = find_cheapest_arrivals(
        indices, distances, first, node, steps, penalties, column_start, width, roots, valid,
        zero_cost,
    )  # fmt: skip
    ends = choose_ends(roots, valid, last_rows, costs, origins, node, separation)
    # Backtrack to count the nodes of each path; cumulative counts are the pointers.
    ptr = np.zeros(len(ends) + 1, np.int64)
    for p in range(len(ends)):
        v = ends[p]
        while v >= 0:
            ptr[p + 1] += 1
            v = before[v]
        ptr[p + 1] += ptr[p]
    rows = np.empty(ptr[-1], np.int32)
    columns = np.empty(ptr[-1], np.int32)
    for p in range(len(ends)):
        v = ends[p]
        # Fill from the end, as predecessors lead backwards.
        for position in range(ptr[p + 1] - 1, ptr[p] - 1, -1):
            # Row of a node: the last row that begins at or before it.
            r = np.searchsorted(node, v, side="right") - 1
            rows[position] = row_start + r
            columns[position] = indices[v + first[r] - node[r]]
            v = before[v]
    return ptr, rows, columns, costs[ends]
