"""Neighbour graph: the similar frames of every frame, as a sparse self-similarity matrix.

The search is exact. Matrix products in float32 estimate all distances block by
block. Pairs that may lie within the radius are measured again in float64. Memory
grows with the number of neighbours, not with frames × frames.

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
from kineme.methods.region_growing import _kernels

Part = tuple[NDArray[np.int64], NDArray[np.int32], NDArray[np.float32]]
"""Rows of a graph: number of neighbours per row, their indices, their distances."""
BLOCK_ENTRIES = 1 << 21
"""Number of entries of one block of the matrix product: 8 MB of float32."""


@dataclass(frozen=True, eq=False)
class NeighborGraph:
    """Graph whose row i holds the frames j with ‖x_i − y_j‖ ≤ radius, at most k of them.

    ``graph[i]`` returns these frames nearest first. They are stored as compressed sparse rows
    in the order of columns (the canonical form of scipy): row i is
    ``indices[indptr[i]:indptr[i + 1]]`` with its ``distances``.

    Parameters
    ----------
    indptr : (rows + 1,) int64
    indices : ndarray of int32 of shape (entries,)
        Ascending within a row.
    distances : ndarray of float32 of shape (entries,)
        In the unit of the features.
    n_columns : int
        Number of frames among which neighbours were searched.
    radius : float
        The search radius.

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
        """Return the neighbours of frame i and their distances, nearest first; ties by frame."""
        (i,) = as_indices([i], "frames")
        if not -len(self) <= i < len(self):
            raise IndexError(f"frame {i} of a graph of {len(self)}")
        # `i % len` supports negative indices; the row is bounded by two successive pointers.
        row = slice(*self.indptr[i % len(self) :][:2])
        # A stable sort keeps ties in the order of frames.
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
        """Return the number of stored pairs (i, j)."""
        return len(self.indices)

    @cached_property
    def counts(self) -> NDArray[np.int64]:
        """Return the number of neighbours of each frame."""
        return np.diff(self.indptr)

    def nearest(self, k: int) -> NeighborGraph:
        """Return the graph of the k nearest neighbours of each frame; ties by frame."""
        if not (is_number(k) and k >= 1):
            raise ParameterError(f"the number of neighbours must be at least 1, not {k!r}")
        if self.n_entries == 0 or k >= self.counts.max():
            return self

        def mark_rows(rows: slice) -> NDArray[np.bool_]:
            """Mark the entries of some rows that are kept."""
            # Pointers of these rows; the kernel subtracts the first of them.
            indptr = self.indptr[rows.start : rows.stop + 1]
            kept: NDArray[np.bool_] = _kernels.mark_nearest(
                indptr, self.distances[indptr[0] : indptr[-1]], k
            )
            return kept

        return self.select(np.concatenate(map_threads(mark_rows, make_even_slices(len(self)))))

    def select(self, mask: NDArray[np.bool_]) -> NeighborGraph:
        """Return the graph of the stored entries for which the mask is True."""
        # New pointers: the number of kept entries before each row.
        indptr = np.concatenate([[0], np.cumsum(mask)])[self.indptr]
        return NeighborGraph(
            indptr, self.indices[mask], self.distances[mask], self.n_columns, self.radius
        )

    def restrict(self, *, radius: float | None = None, min_lag: int = 0) -> NeighborGraph:
        """Return the graph of the entries within a smaller radius and with |j − i| ≥ min_lag."""
        radius = self.radius if radius is None else min(radius, self.radius)
        # The kernel fills these and returns the number of entries.
        indptr = np.zeros_like(self.indptr)
        indices = np.empty_like(self.indices)
        distances = np.empty_like(self.distances)
        kept = _kernels.copy_restricted(
            self.indptr, self.indices, self.distances, radius, min_lag, indptr, indices, distances
        )
        return NeighborGraph(indptr, indices[:kept], distances[:kept], self.n_columns, radius)

    def to_scipy(self) -> Any:
        """Return a ``scipy.sparse.csr_array`` of distances; stored zeros are also neighbours."""
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
    """Find the frames within ``radius`` of each frame, at most the ``k`` nearest.

    Parameters
    ----------
    features : array_like of shape (frames, dims)
        One vector per frame, finite.
    others : array_like of shape (other frames, dims), optional
        Frames to search; by default ``features``, where every frame is its own
        nearest neighbour.
    radius : float
        Largest Euclidean distance, in the unit of the features.
    k : int, optional
        Largest number of neighbours of each frame; at a tie the earlier frame
        is kept.
    max_lag : int, optional
        Search only frames with ``|j - i| <= max_lag``. Time and memory then
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
    # Without a limit, search all frames.
    lag = max(len(rows), len(columns)) if max_lag is None else max_lag

    blocks = iterate_neighbors(rows, columns, radius=float(radius), k=k, lag=lag)
    # Each block is a list of parts, one for each thread, in order.
    parts = [part for block in blocks for part in block]
    counts, indices, distances = (np.concatenate(part) for part in zip(*parts, strict=True))
    indptr = np.concatenate([[0], np.cumsum(counts)])
    return NeighborGraph(indptr, indices, distances, len(columns), float(radius))


def iterate_neighbors(
    rows: Floats, columns: Floats, *, radius: float, k: int | None, lag: int
) -> Iterator[list[Part]]:
    """Yield all neighbours, for one block of rows at a time.

    The error of the estimate ``|x|² + |y|² - 2 x·y`` in float32 is at most ``margin``.
    Pairs that pass are measured in float64.
    """
    # Centring does not change distances, and float32 is most precise near 0.
    center = columns.mean(axis=0)
    spread = max(np.abs(columns - center).max(), np.abs(rows - center).max())
    scale = max(spread, 1e-6 * radius) or 1.0  # so that radius / scale stays within float32
    rows32 = ((rows - center) / scale).astype(np.float32)
    columns32 = rows32 if columns is rows else ((columns - center) / scale).astype(np.float32)
    # Squared lengths of the rows.
    row_norms = np.einsum("ij,ij->i", rows32, rows32)
    column_norms = np.einsum("ij,ij->i", columns32, columns32)
    # Upper bound of the rounding errors of float32, which grow with the number of terms.
    margin = 4 * (rows.shape[1] + 4) * 2.0**-24 * (row_norms + column_norms.max())
    # |y|² - 2 x·y <= r² - |x|² is equivalent to a distance within r.
    limits = ((radius / scale) ** 2 - row_norms + margin).astype(np.float32)

    height, width = _choose_block_shape(len(rows), len(columns), lag)
    # Allocated once and used by all blocks.
    product = np.empty(height * width, np.float32)
    screened = np.empty((height, width), np.int32)
    for start in range(0, len(rows), height):
        stop = min(start + height, len(rows))
        # Columns within the lag of any row of the block.
        low = min(max(0, start - lag), len(columns))
        high = min(stop + lag, len(columns))
        estimate = product[: (stop - start) * (high - low)].reshape(stop - start, high - low)
        np.matmul(rows32[start:stop], columns32[low:high].T, out=estimate)
        frames = np.arange(start, stop)
        measure_part = partial(
            _measure_part,
            estimate,
            limits[start:stop],
            column_norms[low:high],
            # Columns within the lag of each row, counted within the block.
            np.clip(frames - lag, low, high) - low,
            np.clip(frames + lag + 1, low, high) - low,
            screened,
            rows[start:stop],
            columns[low:high],
            low,
            radius,
            k,
        )
        yield map_threads(measure_part, make_even_slices(stop - start))


def _measure_part(
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
    """Screen some rows of a block by estimate, measure distances, and keep the k nearest.

    ``estimate`` (rows, columns) are those of `iterate_neighbors`, ``starts`` and ``stops``
    (rows,) the columns within the lag, and ``screened`` is memory for the columns that pass.
    """
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
    # The kernel takes pointers instead of counts.
    indptr = np.concatenate([[0], np.cumsum(counts)])
    is_nearest = _kernels.mark_nearest(indptr, distances, k)
    return np.minimum(counts, k), indices[is_nearest], distances[is_nearest]


def _choose_block_shape(n_rows: int, n_columns: int, lag: int) -> tuple[int, int]:
    """Return the number of rows per block and of columns they can reach, within BLOCK_ENTRIES."""
    height = max(1, BLOCK_ENTRIES // n_columns)
    # With a lag, a block has 2 lag more columns than rows, so low blocks would be inefficient.
    if 2 * lag < n_columns:
        height = max(height, min(2 * lag, int(BLOCK_ENTRIES**0.5)))
    height = min(height, n_rows)
    return height, min(n_columns, height + 2 * lag)
