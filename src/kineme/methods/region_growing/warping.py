"""Warping paths: spans of a recording that match under time warping.

Instead of filling a dynamic-time-warping matrix, paths walk over the stored
pairs (t, j) of a neighbour graph. A warping step (a, b) leads from (t, j) to
(t + a, j + b) if both are stored. Each minor diagonal of the self-similarity
matrix is one weakly connected component, and its cheapest path from its first
row to its last matches two spans frame by frame.

Source: Vögele, Krüger and Klein 2014, sections 3 and 3.2; the graph after
Krüger, Tautges, Weber and Zinke 2010.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from kineme._util.checks import as_indices, check_type, is_number
from kineme.errors import ParameterError
from kineme.methods.region_growing import _path_kernels
from kineme.methods.region_growing.neighbors import NeighborGraph

Step = tuple[int, int]
Ints = NDArray[np.int32]

BASIC_STEPS: tuple[Step, ...] = ((1, 1), (1, 0), (0, 1))


@dataclass(frozen=True, eq=False)
class WarpingPaths:
    """``rows, columns = paths[p]``: the frames that path p matches, in order.

    Held flat: path p is ``rows[ptr[p]:ptr[p + 1]]`` and the same of
    ``columns``; ``costs[p]`` is the sum over its nodes.

    Examples
    --------
    >>> import kineme
    >>> graph = kineme.neighbor_graph([[0.0], [1.0], [0.0], [1.0]], radius=0.1)
    >>> paths = kineme.warping_paths(graph, (0, 2), (2, 4))
    >>> len(paths), paths.costs.tolist()
    (1, [2e-06])
    """

    ptr: NDArray[np.int64]
    rows: Ints
    columns: Ints
    costs: NDArray[np.float64]

    def __len__(self) -> int:
        return len(self.ptr) - 1

    def __getitem__(self, p: int) -> tuple[Ints, Ints]:
        if not 0 <= p < len(self):
            raise IndexError(f"path {p} of {len(self)}")
        nodes = slice(self.ptr[p], self.ptr[p + 1])
        return self.rows[nodes], self.columns[nodes]

    def __iter__(self) -> Iterator[tuple[Ints, Ints]]:
        return (self[p] for p in range(len(self)))

    @property
    def n_nodes(self) -> NDArray[np.int64]:
        """Nodes per path."""
        return np.diff(self.ptr)

    @property
    def starts(self) -> tuple[Ints, Ints]:
        """Row and column at which each path begins."""
        return self.rows[self.ptr[:-1]], self.columns[self.ptr[:-1]]

    @property
    def ends(self) -> tuple[Ints, Ints]:
        """Row and column at which each path ends, inclusive."""
        return self.rows[self.ptr[1:] - 1], self.columns[self.ptr[1:] - 1]

    @property
    def slopes(self) -> NDArray[np.float64]:
        """Columns per row from start to end; 1 where both spans last equally long."""
        (row_start, column_start), (row_end, column_end) = self.starts, self.ends
        return (column_end - column_start) / (row_end - row_start)

    def is_within_slope(self, max_slope: float) -> NDArray[np.bool_]:
        """Return which paths match spans that differ by this factor at most in length."""
        slopes = self.slopes
        return (slopes >= 1 / max_slope) & (slopes <= max_slope)

    def select(self, mask: NDArray[np.bool_]) -> WarpingPaths:
        """Return the paths where the mask is true, in the same order."""
        # The mask of each path for all of its nodes.
        nodes = np.repeat(mask, self.n_nodes)
        ptr = np.concatenate([[0], np.cumsum(self.n_nodes[mask])])
        return WarpingPaths(ptr, self.rows[nodes], self.columns[nodes], self.costs[mask])


def warping_paths(
    graph: NeighborGraph,
    rows: tuple[int, int],
    columns: tuple[int, int],
    *,
    steps: Sequence[Step] = BASIC_STEPS,
    skip_penalty: float = 0.0,
    zero_cost: float = 1e-6,
    min_nodes: int = 2,
    separation: int | None = None,
    max_slope: float | None = None,
) -> WarpingPaths:
    """Cheapest paths through each connected component inside a box of the graph.

    A path runs from any node in the first row of its component to a node in
    the last. It costs the distances of its nodes.

    Parameters
    ----------
    graph : NeighborGraph
    rows, columns : (start, stop)
        The box, half-open frames.
    steps : (a, b) pairs
        Warping steps.
    skip_penalty : float
        Added for every row and column a step passes over; without it paths
        hop in long steps over what should be matched.
    zero_cost : float
        Cost of a node whose distance is zero.
    min_nodes : int
        Shorter paths are dropped.
    separation : int, optional
        Several paths of a component are kept if their first columns are at
        least this far apart; by default only the cheapest is kept.
    max_slope : float, optional
        Paths steeper than this, or flatter than its inverse, are dropped.

    Examples
    --------
    >>> import kineme
    >>> graph = kineme.neighbor_graph([[0.0], [1.0], [0.0], [1.0]], radius=0.1)
    >>> rows, columns = kineme.warping_paths(graph, (0, 2), (2, 4))[0]
    >>> rows.tolist(), columns.tolist()
    ([0, 1], [2, 3])
    """
    check_type(graph, NeighborGraph, "warping_paths", "kineme.neighbor_graph(...) gives one")
    rows, columns = _find_box(rows, "rows"), _find_box(columns, "columns")
    numbers = {"skip_penalty": skip_penalty, "zero_cost": zero_cost, "min_nodes": min_nodes}
    chosen = {"separation": separation, "max_slope": max_slope}
    numbers |= {name: value for name, value in chosen.items() if value is not None}
    for name, value in numbers.items():
        if not (is_number(value) and value >= 0):
            raise ParameterError(f"{name} must be a number from 0, not {value!r:.60}")
    moves = _as_steps(steps)
    # Rows and columns that a step passes over, beyond the next one.
    skipped = np.maximum(moves - 1, 0).sum(axis=1)
    ptr, path_rows, path_columns, costs = _path_kernels.find_paths_in_box(
        graph.indptr,
        graph.indices,
        graph.distances,
        *rows,
        *columns,
        moves,
        float(skip_penalty) * skipped,
        float(zero_cost),
        min_nodes,
        # More than any two columns are apart: only the cheapest path is kept.
        graph.n_columns + 1 if separation is None else separation,
    )
    paths = WarpingPaths(ptr, path_rows, path_columns, costs)
    keep = paths.n_nodes >= min_nodes
    if max_slope is not None:
        keep &= paths.is_within_slope(max_slope)
    return paths.select(keep)


def label_components(
    graph: NeighborGraph, *, steps: Sequence[Step] = BASIC_STEPS
) -> NDArray[np.int32]:
    """One label per stored pair: equal where warping steps connect two pairs.

    The label is the position of the first stored pair of the component, so
    pairs that share the label of pair (0, 0) lie on the main diagonal's.

    Examples
    --------
    >>> import kineme
    >>> from kineme.methods.region_growing.warping import label_components
    >>> graph = kineme.neighbor_graph([[0.0], [1.0], [0.0], [1.0]], radius=0.1)
    >>> label_components(graph).tolist()
    [0, 1, 0, 1, 4, 0, 4, 0]
    """
    indptr = graph.indptr
    # The whole graph as a box: every row begins at its pointer, and nodes are entries.
    labels: NDArray[np.int32] = _path_kernels.find_component_roots(
        graph.indices, indptr[:-1], indptr, _as_steps(steps), 0, graph.n_columns
    )
    return labels


def _find_box(frames: tuple[int, int], name: str) -> tuple[int, int]:
    found = as_indices(frames, name)
    if len(found) != 2:
        raise ParameterError(f"{name} are a start and a stop frame, not {frames!r:.60}")
    return found[0], found[1]


def _as_steps(steps: Sequence[Step]) -> NDArray[np.int64]:
    try:
        given = np.array(steps)
    except ValueError:  # of different lengths
        given = np.empty(0)
    integral = given.dtype.kind in "iu" and given.ndim == 2 and given.shape[1] == 2
    # Anything but pairs of whole numbers becomes an empty array, which is refused below.
    moves = given.astype(np.int64) if integral else np.empty((0, 2), np.int64)
    if not len(moves) or moves.min() < 0 or (moves.sum(axis=1) == 0).any():
        raise ParameterError(
            f"warping steps are pairs (a, b) from 0, not both 0; got {steps!r:.60}"
        )
    return moves
