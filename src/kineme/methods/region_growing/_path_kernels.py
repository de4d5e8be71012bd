"""Compiled walks over the neighbour graph: components, cheapest paths, symmetry.

A node is a stored pair (t, j) inside a box of rows and columns; nodes are
numbered row by row, ascending in j. A warping step (a, b) leads from
(t - a, j - b) to (t, j). Naive twins are in ``tests/helpers/naive.py``.

``first[r]`` is the first stored entry of row r inside the box and ``node[r]``
the number of its node, so that node v of row r is entry ``v + first[r] - node[r]``.
The last few rows are kept in a ring of dense rows, in which a step is one look-up.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from kineme._util.parallel import OPTIONS


@njit(
    "Tuple((int64[::1], int64[::1]))(int64[::1], int32[::1], int64, int64, int64, int64)", **OPTIONS
)
def find_box_rows(indptr, indices, row_start, row_stop, column_start, column_stop):
    """``first`` and ``node`` of the rows of a box."""
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
    """First column with a node, and how many from there hold all: what a ring must span."""
    # The largest number of an index stands for no column yet.
    low, high = np.int64(np.iinfo(np.int32).max), np.int64(-1)
    for r in range(len(first)):
        nodes = node[r + 1] - node[r]
        if nodes:
            low = min(low, np.int64(indices[first[r]]))
            high = max(high, np.int64(indices[first[r] + nodes - 1]))
    return (low, high - low + 1) if high >= 0 else (np.int64(0), np.int64(0))


@njit("Tuple((int32[::1], int64, int64))(int64[:, ::1], int64)", **OPTIONS)
def make_ring(steps, width):
    """Return the ring, the length of its rows, and how far steps reach to the left."""
    # As many rows as the longest step goes back, plus the current one.
    depth, reach = 1, 0
    for s in range(len(steps)):
        depth = max(depth, steps[s, 0] + 1)
        reach = max(reach, steps[s, 1])
    # Room to the left, so that a step never leaves its row.
    return np.full(depth * (width + reach), -1, np.int32), width + reach, reach


@njit(
    "void(int32[::1], int64, int64[::1], int64, int32[::1], int64[::1], int64[::1],"
    " int64[:, ::1], int64)",
    **OPTIONS,
)
def enter_row(ring, line, slots, r, indices, first, node, steps, offset):
    """Put row r into the ring in place of the row that falls out of reach.

    Afterwards the node one step s before column j of row r is
    ``ring[looks[s] + j]``, or -1.
    """
    depth = len(ring) // line
    # The row's place in the ring; column j is at `here + j`.
    here = (r % depth) * line + offset
    if r >= depth:
        # Only entries that were set are cleared: cheaper than a whole row.
        old = r - depth
        for e in range(first[old], first[old] + node[old + 1] - node[old]):
            ring[here + indices[e]] = -1
    shift = first[r] - node[r]
    for v in range(node[r], node[r + 1]):
        ring[here + indices[v + shift]] = v
    for s in range(len(steps)):
        # Place of column j of the row from which step s comes, less the columns that it goes.
        slots[s] = ((r - steps[s, 0]) % depth) * line + offset - steps[s, 1]


@njit("int32[::1](int32[::1], int64[::1], int64[::1], int64[:, ::1], int64, int64)", **OPTIONS)
def find_component_roots(indices, first, node, steps, column_start, width):
    """``roots[v]``: the first node of the weakly connected component of v."""
    n = node[-1]
    # Union-find over nodes; a root has the smallest number of its component.
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
                # A step of (0, b) looks into the same row, where later nodes are not yet known.
                if u < 0 or u >= v:
                    continue
                up = parents[u]
                if up == root:
                    continue
                # Path halving: nodes on the way to the root are attached to their grandparents.
                while up != u:
                    parents[u] = parents[up]
                    u = parents[u]
                    up = parents[u]
                # The smaller root wins, so a root is the first node of its component.
                if u < root:
                    if root < v:
                        parents[root] = u
                    root = u
                else:
                    parents[u] = root
            parents[v] = root
    # Parents come first, so one pass leaves the root everywhere.
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
    """Cost, predecessor and first column of the cheapest path to every node.

    Paths begin at any node of the first row of their component. A node costs
    its distance, ``zero_cost`` where that is zero, and the penalty of the step
    that led there. Nodes of components that are not ``valid`` are skipped.
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
            # Too small components are not worth a path.
            if not valid[roots[v]]:
                continue
            j = indices[v + shift]
            best = np.inf
            # The component begins in this row: a path may begin here at no cost.
            if roots[v] >= node[r]:
                best = 0.0
                origins[v] = j
            for s in range(len(slots)):
                u = ring[slots[s] + j]
                if u >= 0 and costs[u] + penalties[s] < best:
                    best = costs[u] + penalties[s]
                    before[v] = u
            # The path keeps the column of its first node.
            if before[v] >= 0:
                origins[v] = origins[before[v]]
            # Equal poses have a cost as well, so that a longer path is never free.
            distance = np.float64(distances[v + shift])
            costs[v] = best + (distance if distance > 0 else zero_cost)
    return costs, before, origins


@njit("Tuple((boolean[::1], int64[::1]))(int32[::1], int64[::1], int64)", **OPTIONS)
def survey_components(roots, node, min_nodes):
    """Which components have ``min_nodes`` nodes over two rows or more, and their last rows."""
    n = node[-1]
    counts = np.zeros(n, np.int64)
    last_rows = np.zeros(n, np.int64)
    valid = np.zeros(n, np.bool_)
    for r in range(len(node) - 1):
        for v in range(node[r], node[r + 1]):
            root = roots[v]
            counts[root] += 1
            last_rows[root] = r
            # The root is the first node, so an earlier row means two rows or more.
            valid[root] = root < node[r] and counts[root] >= min_nodes
    return valid, last_rows


@njit(
    "int32[::1](int32[::1], boolean[::1], int64[::1], float64[::1], int32[::1], int64[::1], int64)",
    **OPTIONS,
)
def choose_ends(roots, valid, last_rows, costs, origins, node, separation):
    """Nodes of the last row of each component at which a path ends, cheapest first.

    Of two ends whose paths begin less than ``separation`` columns apart the
    cheaper stays. No path may lead from the first row to a node of the last.
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
            # Ends of other components, and of this one those whose paths begin far enough away.
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
    """Cheapest paths through the components of a box: pointers, rows, columns, costs."""
    first, node = find_box_rows(indptr, indices, row_start, row_stop, column_start, column_stop)
    column_start, width = find_used_columns(indices, first, node)
    roots = find_component_roots(indices, first, node, steps, column_start, width)
    valid, last_rows = survey_components(roots, node, min_nodes)
    costs, before, origins = find_cheapest_arrivals(
        indices, distances, first, node, steps, penalties, column_start, width, roots, valid,
        zero_cost,
    )  # fmt: skip
    ends = choose_ends(roots, valid, last_rows, costs, origins, node, separation)
    # Lengths of the paths, found by going back, become pointers.
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
        # Filled from the end, since predecessors lead backwards.
        for position in range(ptr[p + 1] - 1, ptr[p] - 1, -1):
            # Row of a node: the last row that begins at or before it.
            r = np.searchsorted(node, v, side="right") - 1
            rows[position] = row_start + r
            columns[position] = indices[v + first[r] - node[r]]
            v = before[v]
    return ptr, rows, columns, costs[ends]
