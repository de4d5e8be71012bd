"""The search for all neighbours: estimated block by block in float32, measured in float64."""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial

import numpy as np
from numpy.typing import NDArray

from kineme._arrays import Floats
from kineme._threads import even_slices, map_threads
from kineme.graph import _kernels

# Entries of one block of the matrix product: 8 MB of float32.
BLOCK_ENTRIES = 1 << 21

# Rows of a graph: neighbours per row, their indices, their distances.
Part = tuple[NDArray[np.int64], NDArray[np.int32], NDArray[np.float32]]


def all_neighbors(
    rows: Floats, columns: Floats, *, radius: float, k: int | None, lag: int
) -> Iterator[list[Part]]:
    """Yield all neighbours, block of rows by block of rows.

    The estimate ``|x|² + |y|² - 2 x·y`` errs in float32 by no more than
    ``margin``; what it lets through is measured in float64.
    """
    center = columns.mean(axis=0)
    spread = max(np.abs(columns - center).max(), np.abs(rows - center).max())
    scale = max(spread, 1e-6 * radius) or 1.0  # so that radius / scale stays within float32
    rows32 = ((rows - center) / scale).astype(np.float32)
    columns32 = rows32 if columns is rows else ((columns - center) / scale).astype(np.float32)
    row_norms = np.einsum("ij,ij->i", rows32, rows32)
    column_norms = np.einsum("ij,ij->i", columns32, columns32)
    margin = 4 * (rows.shape[1] + 4) * 2.0**-24 * (row_norms + column_norms.max())
    limits = ((radius / scale) ** 2 - row_norms + margin).astype(np.float32)

    height, width = _block_shape(len(rows), len(columns), lag)
    product = np.empty(height * width, np.float32)
    screened = np.empty((height, width), np.int32)
    for start in range(0, len(rows), height):
        stop = min(start + height, len(rows))
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
            np.clip(frames - lag, low, high) - low,
            np.clip(frames + lag + 1, low, high) - low,
            screened,
            rows[start:stop],
            columns[low:high],
            low,
            radius,
            k,
        )
        yield map_threads(near, even_slices(stop - start))


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
    """The neighbours of some rows of a block: screened by estimate, measured, the k nearest."""
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
    indptr = np.concatenate([[0], np.cumsum(counts)])
    mask = _kernels.nearest_mask(indptr, distances, k)
    return np.minimum(counts, k), indices[mask], distances[mask]


def _block_shape(n_rows: int, n_columns: int, lag: int) -> tuple[int, int]:
    """Rows per block and the columns they can reach, within BLOCK_ENTRIES."""
    height = max(1, BLOCK_ENTRIES // n_columns)
    if 2 * lag < n_columns:
        height = max(height, min(2 * lag, int(BLOCK_ENTRIES**0.5)))
    height = min(height, n_rows)
    return height, min(n_columns, height + 2 * lag)
