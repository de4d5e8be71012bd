"""Neighbour graph: for every frame, the frames that are similar to it.

A sparse self-similarity matrix. Search is exact: blocks of one float32 matrix
product estimate all distances, and every pair that may lie within the radius
is measured again in float64. Memory grows with the neighbours found, never
with frames × frames.

Source: Vögele, Krüger and Klein 2014, section 3 (there a kd-tree).
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property, partial
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from kineme._util.arrays import Floats
from kineme._util.checks import as_features, as_indices, is_number
from kineme._util.parallel import make_even_slices, map_threads
from kineme.errors import ParameterError
from kineme.methods.region_growing import _neighbor_kernels as _kernels


@dataclass(frozen=True, eq=False)
class NeighborGraph:
    """``graph[i]`` holds the frames j with ‖x_i − y_j‖ ≤ radius, nearest first, at most k.

    Stored as compressed sparse rows in the order of columns (the canonical
    form of scipy), which is the order in which warping paths walk:
    row i is ``indices[indptr[i]:indptr[i + 1]]`` with its ``distances``.

    Parameters
    ----------
    indptr : (rows + 1,) int64
    indices : ndarray of int32 of shape (entries,)
        Ascending within a row.
    distances : ndarray of float32 of shape (entries,)
        In the unit of the features.
    n_columns : int
        Frames that could be neighbours.
    radius : float
        The radius searched.

    Examples
    --------
    >>> import kineme
    >>> graph = kineme.neighbor_graph([[0.0], [0.1], [5.0]], radius=1.0)
    >>> frames, distances = graph[0]
    >>> frames.tolist()
    [0, 1]
    """

    indptr: NDArray[np.int64]
    indices: NDArray[np.int32]
    distances: NDArray[np.float32]
    n_columns: int
    radius: float

    def __len__(self) -> int:
        return len(self.indptr) - 1

    def __getitem__(self, i: int) -> tuple[NDArray[np.int32], NDArray[np.float32]]:
        """Neighbours of frame i and their distances, nearest first; ties by frame."""
        (i,) = as_indices([i], "frames")
        if not -len(self) <= i < len(self):
            raise IndexError(f"frame {i} of a graph of {len(self)}")
        # The row's bounds: two neighbouring pointers.
        row = slice(*self.indptr[i % len(self) :][:2])
        # Stable: ties stay in the order of frames.
        order = np.argsort(self.distances[row], kind="stable")
        return self.indices[row][order], self.distances[row][order]

    def __iter__(self) -> Iterator[tuple[NDArray[np.int32], NDArray[np.float32]]]:
        return (self[i] for i in range(len(self)))

    def __repr__(self) -> str:
        return (
            f"NeighborGraph({len(self)} x {self.n_columns}, {self.n_entries} entries, "
            f"radius {self.radius:g})"
        )

    @property
    def n_entries(self) -> int:
        """Stored pairs (i, j)."""
        return len(self.indices)

    @cached_property
    def counts(self) -> NDArray[np.int64]:
        """Neighbours stored per frame."""
        return np.diff(self.indptr)

    def nearest(self, k: int) -> NeighborGraph:
        """Return the same graph with the k nearest of each frame only.

        Ties to the earlier frame.
        """
        if not (is_number(k) and k >= 1):
            raise ParameterError(f"the number of neighbours must be at least 1, not {k!r}")
        # Nothing to leave out.
        if self.n_entries == 0 or k >= self.counts.max():
            return self

        def mask(rows: slice) -> NDArray[np.bool_]:
            # Pointers of these rows; the kernel counts from the first of them.
            indptr = self.indptr[rows.start : rows.stop + 1]
            kept: NDArray[np.bool_] = _kernels.mark_nearest(
                indptr, self.distances[indptr[0] : indptr[-1]], k
            )
            return kept

        return self.select(np.concatenate(map_threads(mask, make_even_slices(len(self)))))

    def select(self, mask: NDArray[np.bool_]) -> NeighborGraph:
        """Return the same graph with the stored entries where the mask is true."""
        # Number of kept entries before each row: the new pointers.
        indptr = np.concatenate([[0], np.cumsum(mask)])[self.indptr]
        return NeighborGraph(
            indptr, self.indices[mask], self.distances[mask], self.n_columns, self.radius
        )

    def restrict(self, *, radius: float | None = None, min_lag: int = 0) -> NeighborGraph:
        """Return same graph with the entries within a smaller radius and with |j − i| ≥ min_lag."""
        radius = self.radius if radius is None else min(radius, self.radius)
        # Filled by the kernel, which returns how many entries it kept.
        indptr = np.zeros_like(self.indptr)
        indices = np.empty_like(self.indices)
        distances = np.empty_like(self.distances)
        kept = _kernels.copy_restricted(
            self.indptr, self.indices, self.distances, radius, min_lag, indptr, indices, distances
        )
        return NeighborGraph(indptr, indices[:kept], distances[:kept], self.n_columns, radius)

    def to_scipy(self) -> Any:
        """As ``scipy.sparse.csr_array`` of distances. Stored zeros are neighbours, too."""
        from scipy.sparse import csr_array

        return csr_array(
            (self.distances, self.indices, self.indptr), shape=(len(self), self.n_columns)
        )


def neighbor_graph(
    features: ArrayLike,
    others: ArrayLike | None = None,
    *,
    radius: float,
    k: int | None = None,
    max_lag: int | None = None,
) -> NeighborGraph:
    """``graph[i]``: frames within ``radius`` of frame i, nearest first, at most ``k``.

    Parameters
    ----------
    features : array_like of shape (frames, dims)
        One vector per frame, finite.
    others : array_like of shape (other frames, dims), optional
        Where to look for neighbours; by default among ``features``, where
        every frame is its own nearest neighbour.
    radius : float
        Largest Euclidean distance, in the unit of the features.
    k : int, optional
        Neighbours to keep of each frame at most, the nearest; ties to the
        earlier frame.
    max_lag : int, optional
        Search frames with ``|j - i| <= max_lag`` only: time and memory then
        grow linearly with the recording.

    Raises
    ------
    ParameterError
        Shapes disagree, values are not finite, or a parameter is out of range.

    Examples
    --------
    >>> import kineme
    >>> graph = kineme.neighbor_graph([[0.0], [0.1], [5.0]], radius=1.0)
    >>> len(graph), graph.counts.tolist()
    (3, [2, 2, 1])
    """
    rows = as_features(features)
    columns = rows if others is None else as_features(others, "others")
    if rows.shape[1] != columns.shape[1]:
        raise ParameterError(f"features have {rows.shape[1]} dimensions, others {columns.shape[1]}")
    if not (is_number(radius) and radius >= 0):
        raise ParameterError(f"the radius must be a finite number from 0, not {radius!r}")
    for name, value in (("k", k), ("max_lag", max_lag)):
        if value is not None and not (is_number(value) and value >= 1):
            raise ParameterError(f"{name} must be at least 1, not {value!r}")
    # Without a limit all frames are within reach.
    lag = max(len(rows), len(columns)) if max_lag is None else max_lag

    blocks = iterate_neighbors(rows, columns, radius=float(radius), k=k, lag=lag)
    # Blocks consist of parts that threads made, in order.
    parts = [part for block in blocks for part in block]
    counts, indices, distances = (np.concatenate(part) for part in zip(*parts, strict=True))
    indptr = np.concatenate([[0], np.cumsum(counts)])
    return NeighborGraph(indptr, indices, distances, len(columns), float(radius))


# Entries of one block of the matrix product: 8 MB of float32.
BLOCK_ENTRIES = 1 << 21

# Rows of a graph: neighbours per row, their indices, their distances.
Part = tuple[NDArray[np.int64], NDArray[np.int32], NDArray[np.float32]]


def iterate_neighbors(
    rows: Floats, columns: Floats, *, radius: float, k: int | None, lag: int
) -> Iterator[list[Part]]:
    """Yield all neighbours, block of rows by block of rows.

    The estimate ``|x|² + |y|² - 2 x·y`` errs in float32 by no more than
    ``margin``; what it lets through is measured in float64.
    """
    # Distances do not change by a shift, but float32 is finest near 0.
    center = columns.mean(axis=0)
    spread = max(np.abs(columns - center).max(), np.abs(rows - center).max())
    scale = max(spread, 1e-6 * radius) or 1.0  # so that radius / scale stays within float32
    rows32 = ((rows - center) / scale).astype(np.float32)
    columns32 = rows32 if columns is rows else ((columns - center) / scale).astype(np.float32)
    # Squared lengths of the rows.
    row_norms = np.einsum("ij,ij->i", rows32, rows32)
    column_norms = np.einsum("ij,ij->i", columns32, columns32)
    # Bound of the rounding errors of float32, which grow with the number of terms.
    margin = 4 * (rows.shape[1] + 4) * 2.0**-24 * (row_norms + column_norms.max())
    # The condition |y|² - 2 x·y <= r² - |x|² is the same as a distance within r.
    limits = ((radius / scale) ** 2 - row_norms + margin).astype(np.float32)

    height, width = _choose_block_shape(len(rows), len(columns), lag)
    # Allocated once and used by all blocks.
    product = np.empty(height * width, np.float32)
    screened = np.empty((height, width), np.int32)
    for start in range(0, len(rows), height):
        stop = min(start + height, len(rows))
        # Columns that some row of the block may reach.
        low = min(max(0, start - lag), len(columns))
        high = min(stop + lag, len(columns))
        estimate = product[: (stop - start) * (high - low)].reshape(stop - start, high - low)
        np.matmul(rows32[start:stop], columns32[low:high].T, out=estimate)
        frames = np.arange(start, stop)
        near = partial(
            _measure,
            estimate,
            limits[start:stop],
            column_norms[low:high],
            # Columns that each row may reach, counted within the block.
            np.clip(frames - lag, low, high) - low,
            np.clip(frames + lag + 1, low, high) - low,
            screened,
            rows[start:stop],
            columns[low:high],
            low,
            radius,
            k,
        )
        yield map_threads(near, make_even_slices(stop - start))


def _measure(
    estimate: NDArray[np.float32],
    limits: NDArray[np.float32],
    column_norms: NDArray[np.float32],
    starts: NDArray[np.int64],
    stops: NDArray[np.int64],
    screened: NDArray[np.int32],
    rows: Floats,
    columns: Floats,
    first_column: int,
    radius: float,
    k: int | None,
    part: slice,
) -> Part:
    """Return neighbours of some rows of a block: screened by estimate, measured, the k nearest."""
    counts = np.empty(part.stop - part.start, np.int64)
    hits = screened[part]
    _kernels.screen_columns(
        estimate[part], limits[part], column_norms, starts[part], stops[part], hits, counts
    )
    indices, distances = _kernels.measure_columns(
        rows[part], columns, radius, first_column, hits, counts
    )
    if k is None or counts.max(initial=0) <= k:
        return counts, indices, distances
    # The counts of the rows as pointers, for the kernel.
    indptr = np.concatenate([[0], np.cumsum(counts)])
    mask = _kernels.mark_nearest(indptr, distances, k)
    return np.minimum(counts, k), indices[mask], distances[mask]


def _choose_block_shape(n_rows: int, n_columns: int, lag: int) -> tuple[int, int]:
    """Rows per block and the columns they can reach, within BLOCK_ENTRIES."""
    height = max(1, BLOCK_ENTRIES // n_columns)
    # In a narrow band a block has 2 lag more columns than rows: low blocks would waste work.
    if 2 * lag < n_columns:
        height = max(height, min(2 * lag, int(BLOCK_ENTRIES**0.5)))
    height = min(height, n_rows)
    return height, min(n_columns, height + 2 * lag)
