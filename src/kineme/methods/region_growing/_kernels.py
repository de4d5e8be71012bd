"""Compiled loops of the published methods: neighbours, growing regions, warping paths, links.

Kernels do not check their arguments; the functions that call them do. Frames count from 0. Naive
versions are in ``tests/helpers/naive``. Signatures are explicit, so that each kernel is compiled
once, and compiled code is cached on disk.

Components and cheapest paths are found on the neighbour graph. A node is a stored pair (t, j)
inside a box of rows and columns. Nodes are numbered row by row, ascending in j. A warping step
(a, b) leads from (t - a, j - b) to (t, j). ``first[r]`` is the first stored entry of row r inside
the box, and ``node[r]`` the number of its node. So node v of row r is entry
``v + first[r] - node[r]``. The last few rows are stored densely in a ring buffer, in which a step
is one look-up.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from kineme._util.parallel import OPTIONS

RUN = 32
"""Number of columns that are screened at a time, by one vectorised comparison."""


@njit("Tuple((int64[::1], int32[::1]))(int64[::1], int32[::1], boolean)", **OPTIONS)
def group_pairs(indptr, indices, by_later):
    """Group the stored pairs by their later or earlier frame; return pointers and other frames."""
    n = len(indptr) - 1
    # Counting sort: count the pairs of each frame, then compute where they begin.
    grouped = np.zeros(n + 1, np.int64)
    for i in range(n):
        for e in range(indptr[i], indptr[i + 1]):
            key = max(i, indices[e]) if by_later else min(i, indices[e])
            grouped[key + 1] += 1
    # Next free position among the pairs of each frame.
    position = np.empty(n, np.int64)
    for i in range(n):
        position[i] = grouped[i]
        grouped[i + 1] += grouped[i]
    others = np.empty(len(indices), np.int32)
    for i in range(n):
        for e in range(indptr[i], indptr[i + 1]):
            j = indices[e]
            key, other = (max(i, j), min(i, j)) if by_later else (min(i, j), max(i, j))
            others[position[key]] = other
            position[key] += 1
    return grouped, others


@njit("int64(int64[::1], int64, int64)", **OPTIONS)
def find_most(counts, first, last):
    """Return the largest of the counts from first to last, both inclusive."""
    largest = counts[first]
    for i in range(first + 1, last + 1):
        largest = max(largest, counts[i])
    return largest


@njit("int64[::1](int64[::1], int32[::1], int64, int64)", **OPTIONS)
def grow_squares_forward(indptr, earlier, min_gap, min_count):
    """Count the neighbour pairs inside the growing square at each frame; -1 if undefined.

    ``earlier[indptr[i]:indptr[i + 1]]`` holds the earlier frame of every
    stored pair whose later frame is i.
    """
    n = len(indptr) - 1
    counts = np.full(n, -1, np.int64)
    start = last = still = count = 0
    for i in range(1, n):
        for e in range(indptr[i], indptr[i + 1]):
            # Count pairs with both frames in the square from `start` to i.
            count += earlier[e] >= start
        counts[i] = count
        if counts[i] != counts[i - 1]:
            still = 0
            continue
        still += 1
        if still == min_gap:
            # A region with too few neighbours is continued instead of cut.
            if find_most(counts, last, i) > min_count:
                last = i - still
                start = i
                # The new square begins with the pairs of frame i alone.
                count = 0
                for e in range(indptr[i], indptr[i + 1]):
                    count += earlier[e] >= start
            still = 0
    return counts


@njit("int64[::1](int64[::1], int32[::1], boolean[::1], int64, int64)", **OPTIONS)
def grow_squares_backward(indptr, later, forward_cuts, min_gap, min_count):
    """Count the pairs as `grow_squares_forward`, from the end; regions also end at forward cuts.

    ``later[indptr[i]:indptr[i + 1]]`` holds the later frame of every stored
    pair whose earlier frame is i.
    """
    n = len(indptr) - 1
    counts = np.full(n, -1, np.int64)
    end = last = n - 1
    still = count = 0
    # Start at the last frame but one: the last frame has no later frame.
    for i in range(n - 2, -1, -1):
        for e in range(indptr[i], indptr[i + 1]):
            count += later[e] <= end
        counts[i] = count
        # At a forward cut another activity ends: start a new region.
        restart = forward_cuts[i]
        if not restart:
            if counts[i] != counts[i + 1]:
                still = 0
                continue
            still += 1
            if still == min_gap:
                still = 0
                restart = find_most(counts, i, last) > min_count
        if restart:
            last = end = i
            count = 0
            for e in range(indptr[i], indptr[i + 1]):
                count += later[e] <= end
    return counts


@njit("int64[::1](int64[::1], int32[::1], int64, int64)", **OPTIONS)
def scan_lines_forward(indptr, indices, min_gap, min_count):
    """Return the frames at which a region, scanned line by line, stops finding neighbours."""
    cuts = []
    # First frame of the region, number of its neighbours, and frames in a row without any.
    start = region = still = 0
    for i in range(len(indptr) - 1):
        count = 0
        for e in range(indptr[i], indptr[i + 1]):
            count += start <= indices[e] <= i
        region += count
        still = 0 if count else still + 1
        if still >= min_gap and region > min_count:
            start = i - still
            cuts.append(start)
            region = still = 0
    return np.array(cuts, dtype=np.int64)


@njit("int64[::1](int64[::1], int32[::1], boolean[::1], int64, int64)", **OPTIONS)
def scan_lines_backward(indptr, indices, forward_cuts, min_gap, min_count):
    """Scan as `scan_lines_forward`, from the end; regions also end at forward cuts."""
    cuts = []
    end = len(indptr) - 2
    region = still = 0
    for i in range(len(indptr) - 2, -1, -1):
        count = 0
        for e in range(indptr[i], indptr[i + 1]):
            count += i <= indices[e] <= end
        region += count
        still = 0 if count else still + 1
        if forward_cuts[i]:
            end = i
            region = still = 0
        elif still >= min_gap and region > min_count:
            # The last frame, in this direction, that had a neighbour.
            end = i + still
            cuts.append(end)
            region = still = 0
    # Reverse to order of time.
    return np.array(cuts[::-1], dtype=np.int64)


@njit("int64(int32[::1], int32[::1])", **OPTIONS)
def count_members(values, others):
    """Count the values of an ascending array that occur in another ascending array."""
    count = k = 0
    for value in values:
        while k < len(others) and others[k] < value:
            k += 1
        count += k < len(others) and others[k] == value
    return count


@njit("boolean[::1](int64[::1], int32[::1], int32[::1], float64)", **OPTIONS)
def mark_coherent_paths(ptr, rows, columns, share):
    """Mark the paths with a mirror image: a path with rows and columns exchanged."""
    n = len(ptr) - 1
    coherent = np.zeros(n, np.bool_)
    for p in range(n):
        # A path may be its own mirror image, so q runs over all paths.
        p_rows, p_columns = rows[ptr[p] : ptr[p + 1]], columns[ptr[p] : ptr[p + 1]]
        needed = share * len(p_rows)
        for q in range(n):
            q_rows, q_columns = rows[ptr[q] : ptr[q + 1]], columns[ptr[q] : ptr[q + 1]]
            if (
                count_members(p_rows, q_columns) >= needed
                and count_members(p_columns, q_rows) >= needed
            ):
                coherent[p] = True
                break
    return coherent


@njit("int64(int32[::1], int32[::1], int64)", **OPTIONS)
def find_row_at_column(rows, columns, column):
    """Return the row at which a path passes a column; between two nodes, their rounded mean."""
    node = max(np.searchsorted(columns, column, side="right") - 1, 0)
    if columns[node] < column and node + 1 < len(rows):
        return (rows[node] + rows[node + 1] + 1) // 2
    return rows[node]


@njit(
    "Tuple((int64[::1], float64[::1]))(int64[::1], int32[::1], int32[::1], int64[::1], int64,"
    " float64, boolean)",
    **OPTIONS,
)
def find_linked_segments(ptr, rows, columns, borders, g, coverage, interpolate):
    """Return the segments h that paths link to segment g, and the smaller covered share of both.

    Segments are the frames ``borders[h]..borders[h + 1]``, both inclusive. A
    segment may be linked by several paths.
    """
    linked, shares = [], []
    g_first, g_last = borders[g], borders[g + 1]
    for p in range(len(ptr) - 1):
        path_rows, path_columns = rows[ptr[p] : ptr[p + 1]], columns[ptr[p] : ptr[p + 1]]
        low, high = path_columns[0], path_columns[-1]
        # Segments share their border frame, so the one that ends at `low` counts as well.
        h = max(np.searchsorted(borders, low, side="right") - 2, 0)
        while h < len(borders) - 1 and borders[h] <= high:
            first, last = borders[h], borders[h + 1]
            # 2014: all rows of the path. 2017: only the rows between the borders of h.
            row_low, row_high = path_rows[0], path_rows[-1]
            if interpolate:
                row_low = find_row_at_column(path_rows, path_columns, first)
                row_high = find_row_at_column(path_rows, path_columns, last)
            # Covered share of the frames of h, and of g; ends are inclusive.
            of_h = (min(last, high) - max(first, low) + 1) / (last - first + 1)
            of_g = (min(g_last, row_high) - max(g_first, row_low) + 1) / (g_last - g_first + 1)
            if min(of_h, of_g) >= coverage:
                linked.append(h)
                shares.append(min(of_h, of_g))
            h += 1
    return np.array(linked, dtype=np.int64), np.array(shares, dtype=np.float64)


@njit("int64[::1](int64[::1], int32[::1], int64[::1])", **OPTIONS)
def count_inner_neighbors(indptr, indices, borders):
    """Count the neighbours of each frame inside its own block ``[borders[b], borders[b + 1])``."""
    counts = np.zeros(len(indptr) - 1, np.int64)
    for b in range(len(borders) - 1):
        for i in range(borders[b], borders[b + 1]):
            for e in range(indptr[i], indptr[i + 1]):
                counts[i] += borders[b] <= indices[e] < borders[b + 1]
    return counts


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


@njit("float32(float32[::1], int64, int64)", **OPTIONS)
def select_smallest(values, count, rank):
    """Return the value of rank ``rank``, from 0, among the first ``count``; reorder these.

    Hoare's quickselect, because numpy's partition takes seconds to compile.
    """
    low, high = 0, count - 1
    while low < high:
        # Partition: values up to the pivot to the left, values from the pivot on to the right.
        pivot = values[(low + high) // 2]
        left, right = low, high
        while left <= right:
            while values[left] < pivot:
                left += 1
            while values[right] > pivot:
                right -= 1
            if left <= right:
                values[left], values[right] = values[right], values[left]
                left += 1
                right -= 1
        # Continue in the part that contains the rank.
        if rank <= right:
            high = right
        elif rank >= left:
            low = left
        else:
            break
    return values[rank]


@njit(
    "void(float32[:, ::1], float32[::1], float32[::1], int64[::1], int64[::1], int32[:, ::1],"
    " int64[::1])",
    **OPTIONS,
)
def screen_columns(product, row_limits, column_norms, starts, stops, columns, counts):
    """Write the columns of ``[starts[i], stops[i])`` that may be near row i to ``columns[i]``.

    ``counts[i]`` is their number. A column j passes if
    ``column_norms[j] - 2 product[i, j] <= row_limits[i]``, in float32.
    """
    # A literal 2 would make the expression double precision.
    two = np.float32(2)
    for i in range(product.shape[0]):
        limit = row_limits[i]
        count = 0
        # Most runs have no near column and end after one vectorised count.
        for first in range(starts[i], stops[i], RUN):
            last = min(first + RUN, stops[i])
            hits = 0
            # |y|² - 2 x·y <= r² - |x|² + margin.
            for j in range(first, last):
                hits += column_norms[j] - two * product[i, j] <= limit
            if hits:
                for j in range(first, last):
                    if column_norms[j] - two * product[i, j] <= limit:
                        columns[i, count] = j
                        count += 1
        counts[i] = count


@njit(
    "Tuple((int32[::1], float32[::1]))"
    "(float64[:, ::1], float64[:, ::1], float64, int64, int32[:, ::1], int64[::1])",
    fastmath={"reassoc", "contract"},
    **OPTIONS,
)
def measure_columns(rows, others, radius, first_column, columns, counts):
    """Return the screened columns within the radius, row by row, and their distances.

    Distances are computed in float64. ``counts`` is updated.
    """
    indices = np.empty(counts.sum(), np.int32)
    distances = np.empty(len(indices), np.float32)
    kept = 0
    for i in range(rows.shape[0]):
        before = kept
        for c in range(counts[i]):
            j = columns[i, c]
            square = 0.0
            for d in range(rows.shape[1]):
                difference = rows[i, d] - others[j, d]
                square += difference * difference
            distance = np.sqrt(square)
            if distance <= radius:
                # Convert columns of the block to columns of the graph.
                indices[kept] = first_column + j
                distances[kept] = distance
                kept += 1
        counts[i] = kept - before
    return indices[:kept], distances[:kept]


@njit("boolean[::1](int64[::1], float32[::1], int64)", **OPTIONS)
def mark_nearest(indptr, distances, k):
    """Mark the k nearest entries of each row; at a tie the earlier entry.

    Row i is ``distances[indptr[i] - indptr[0]:indptr[i + 1] - indptr[0]]``.
    """
    is_nearest = np.ones(len(distances), np.bool_)
    longest = 0
    for i in range(len(indptr) - 1):
        longest = max(longest, indptr[i + 1] - indptr[i])
    values = np.empty(longest, np.float32)
    for i in range(len(indptr) - 1):
        first = indptr[i] - indptr[0]
        count = indptr[i + 1] - indptr[i]
        if count <= k:
            continue
        for e in range(count):
            values[e] = distances[first + e]
        # The k-th smallest distance of the row.
        limit = select_smallest(values, count, k - 1) if k > 0 else np.float32(-1)
        # Number of entries with exactly this distance that are kept.
        ties = k
        for e in range(first, first + count):
            ties -= distances[e] < limit
        for e in range(first, first + count):
            tie = distances[e] == limit and ties > 0
            ties -= tie
            is_nearest[e] = tie or distances[e] < limit
    return is_nearest


@njit(
    "int64(int64[::1], int32[::1], float32[::1], float32, int64, int64[::1], int32[::1],"
    " float32[::1])",
    **OPTIONS,
)
def copy_restricted(
    indptr, indices, distances, radius, min_lag, out_indptr, out_indices, out_distances
):
    """Copy the entries within the radius and at least min_lag off the diagonal; count them."""
    kept = 0
    for i in range(indptr.shape[0] - 1):
        for e in range(indptr[i], indptr[i + 1]):
            # Without a branch: write every entry, and overwrite it if it is not kept.
            out_indices[kept] = indices[e]
            out_distances[kept] = distances[e]
            kept += distances[e] <= radius and abs(indices[e] - i) >= min_lag
        out_indptr[i + 1] = kept
    return kept
