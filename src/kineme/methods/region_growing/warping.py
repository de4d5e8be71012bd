"""Find warping paths: spans of a recording that match under time warping.

Paths run over the stored pairs (t, j) of a neighbour graph instead of a full matrix
of dynamic time warping. A warping step (a, b) leads from (t, j) to (t + a, j + b) if
both are stored. Each minor diagonal of the self-similarity matrix is one weakly
connected component. The cheapest path from its first row to its last matches two
spans frame by frame.

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
from kineme.methods.region_growing import BASIC_STEPS, Step, _kernels
from kineme.methods.region_growing.neighbors import NeighborGraph

Ints = NDArray[np.int32]


@dataclass(frozen=True, eq=False)
class WarpingPaths:
    """Paths of matching frames: ``rows, columns = paths[p]`` are those of path p, in order.

    Stored as flat arrays: path p is ``rows[ptr[p]:ptr[p + 1]]`` and the same slice of
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
        """Return the number of nodes of each path."""
        return np.diff(self.ptr)

    @property
    def starts(self) -> tuple[Ints, Ints]:
        """Return row and column at which each path begins."""
        return self.rows[self.ptr[:-1]], self.columns[self.ptr[:-1]]

    @property
    def ends(self) -> tuple[Ints, Ints]:
        """Return row and column at which each path ends, inclusive."""
        return self.rows[self.ptr[1:] - 1], self.columns[self.ptr[1:] - 1]

    @property
    def slopes(self) -> NDArray[np.float64]:
        """Return columns per row from start to end; 1 if both spans are equally long."""
        (row_start, column_start), (row_end, column_end) = self.starts, self.ends
        return (column_end - column_start) / (row_end - row_start)

    def is_within_slope(self, max_slope: float) -> NDArray[np.bool_]:
        """Mark the paths whose spans differ in length by at most this factor."""
        slopes = self.slopes
        return (slopes >= 1 / max_slope) & (slopes <= max_slope)

    def select(self, mask: NDArray[np.bool_]) -> WarpingPaths:
        """Return the paths for which the mask is True, in the same order."""
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
    """Find the cheapest paths through each connected component inside a box of the graph.

    A path runs from any node in the first row of its component to a node in
    the last row. Its cost is the sum of the distances of its nodes.

    Parameters
    ----------
    graph : NeighborGraph
    rows, columns : (start, stop)
        The box, as half-open spans of frames.
    steps : (a, b) pairs
        Warping steps.
    skip_penalty : float
        Cost of every row and column that a step skips; without it paths
        would skip frames that should be matched.
    zero_cost : float
        Cost of a node whose distance is zero.
    min_nodes : int
        Shorter paths are dropped.
    separation : int, optional
        Keep several paths of a component if their first columns are at least
        this far apart; by default only the cheapest is kept.
    max_slope : float, optional
        Drop paths steeper than this, or flatter than its inverse.

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
    # Number of rows and columns that a step skips.
    skipped = np.maximum(moves - 1, 0).sum(axis=1)
    ptr, path_rows, path_columns, costs = _kernels.find_paths_in_box(
        graph.indptr,
        graph.indices,
        graph.distances,
        *rows,
        *columns,
        moves,
        float(skip_penalty) * skipped,
        float(zero_cost),
        min_nodes,
        # Larger than any distance of columns, so that only the cheapest path is kept.
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
    """Label the stored pairs; pairs that are connected by warping steps have equal labels.

    The label is the index of the first stored pair of the component. So pairs
    with the label of pair (0, 0) belong to the main diagonal.

    Examples
    --------
    >>> import kineme
    >>> from kineme.methods.region_growing.warping import label_components
    >>> graph = kineme.neighbor_graph([[0.0], [1.0], [0.0], [1.0]], radius=0.1)
    >>> label_components(graph).tolist()
    [0, 1, 0, 1, 4, 0, 4, 0]
    """
    indptr = graph.indptr
    # The box is the whole graph: every row begins at its pointer, and nodes are entries.
    labels: NDArray[np.int32] = _kernels.find_component_roots(
        graph.indices, indptr[:-1], indptr, _as_steps(steps), 0, graph.n_columns
    )
    return labels


def _find_box(frames: tuple[int, int], name: str) -> tuple[int, int]:
    bounds = as_indices(frames, name)
    if len(bounds) != 2:
        raise ParameterError(f"{name} must be a start and a stop frame, not {frames!r:.60}")
    return bounds[0], bounds[1]


def _as_steps(steps: Sequence[Step]) -> NDArray[np.int64]:
    """Return warping steps as an array (steps, 2); raise ParameterError for anything else."""
    try:
        pairs = np.array(steps)
    except ValueError:  # tuples of different lengths
        pairs = np.empty(0)
    is_valid = pairs.dtype.kind in "iu" and pairs.ndim == 2 and pairs.shape[1] == 2
    # Anything but pairs of whole numbers becomes an empty array, which is refused below.
    moves = pairs.astype(np.int64) if is_valid else np.empty((0, 2), np.int64)
    if not len(moves) or moves.min() < 0 or (moves.sum(axis=1) == 0).any():
        raise ParameterError(
            f"warping steps are pairs (a, b) from 0, not both 0; got {steps!r:.60}"
        )
    return moves
