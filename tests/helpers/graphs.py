"""Neighbour graphs and features of all shapes, for hypothesis."""

from __future__ import annotations

import numpy as np
from hypothesis import strategies as st
from numpy.typing import NDArray

from kineme.methods.region_growing.neighbors import NeighborGraph
from kineme.methods.region_growing.warping import BASIC_STEPS, WarpingPaths

Pairs = dict[tuple[int, int], np.float32]


def as_pairs(graph: NeighborGraph) -> Pairs:
    """``{(i, j): distance}`` of the stored pairs."""
    rows = np.repeat(np.arange(len(graph)), graph.counts)
    return dict(
        zip(zip(rows.tolist(), graph.indices.tolist(), strict=True), graph.distances, strict=True)
    )


def as_graph(pairs: Pairs, n: int, n_columns: int | None = None) -> NeighborGraph:
    ordered = sorted(pairs)
    counts = np.bincount([i for i, _ in ordered], minlength=n) if ordered else np.zeros(n, int)
    return NeighborGraph(
        np.concatenate([[0], np.cumsum(counts)]).astype(np.int64),
        np.array([j for _, j in ordered], np.int32),
        np.array([pairs[pair] for pair in ordered], np.float32),
        n if n_columns is None else n_columns,
        float(max(pairs.values(), default=1.0)),
    )


def as_lists(paths: WarpingPaths) -> list[list[tuple[int, int]]]:
    """Each path as a list of pairs."""
    return [list(zip(rows.tolist(), cols.tolist(), strict=True)) for rows, cols in paths]


@st.composite
def features(draw: st.DrawFn, *, max_frames: int = 40, min_frames: int = 1) -> NDArray[np.float64]:
    """Points on a small grid, where equal frames and equal distances are the rule.

    The grid lies anywhere and has any size, but its points are exact floats.
    """
    n = draw(st.integers(min_frames, max_frames))
    dims = draw(st.integers(1, 4))
    rng = np.random.default_rng(draw(st.integers(0, 2**32)))
    grid = rng.integers(0, draw(st.integers(1, 5)), (n, dims))
    offset = draw(st.sampled_from([0, 1, 1_000_000, -123_456_789]))
    return (grid + offset) * 2.0 ** draw(st.sampled_from([0, -20, 12]))


@st.composite
def sparse_graphs(
    draw: st.DrawFn, *, max_frames: int = 16, min_lag: int = 0, distinct: bool = False
) -> NeighborGraph:
    """Any pairs at all, some at distance zero; or all distances ``distinct`` and none zero."""
    n = draw(st.integers(1, max_frames))
    rng = np.random.default_rng(draw(st.integers(0, 2**32)))
    filled = rng.random((n, n)) < draw(st.sampled_from([0.0, 0.1, 0.3, 0.6, 1.0]))
    lags = np.abs(np.subtract.outer(np.arange(n), np.arange(n)))
    distances = rng.random((n, n)) if distinct else rng.integers(0, 4, (n, n)) / 4
    pairs = {
        (int(i), int(j)): np.float32(distances[i, j])
        for i, j in zip(*np.nonzero(filled & (lags >= min_lag)), strict=True)
    }
    return as_graph(pairs, n)


@st.composite
def block_graphs(draw: st.DrawFn, *, max_frames: int = 60, min_lag: int = 2) -> NeighborGraph:
    """Blocks of repeating frames with gaps between them, off the main diagonal."""
    lengths = draw(st.lists(st.integers(1, 14), min_size=1, max_size=7))
    n = min(sum(lengths), max_frames)
    block = np.repeat(np.arange(len(lengths)), lengths)[:n]
    full = np.array(draw(st.lists(st.booleans(), min_size=len(lengths), max_size=len(lengths))))
    rng = np.random.default_rng(draw(st.integers(0, 2**32)))
    filled = (block[:, None] == block) & full[block] | (rng.random((n, n)) < 0.01)
    filled &= rng.random((n, n)) < draw(st.sampled_from([0.3, 1.0]))
    lags = np.abs(np.subtract.outer(np.arange(n), np.arange(n)))
    pairs = {
        (int(i), int(j)): np.float32(1)
        for i, j in zip(*np.nonzero(filled & (lags >= min_lag)), strict=True)
    }
    return as_graph(pairs, n)


@st.composite
def staircases(draw: st.DrawFn) -> list[tuple[int, int]]:
    """A path of neighbouring pairs, both frames never falling, over two rows at least."""
    at = (draw(st.integers(0, 8)), draw(st.integers(0, 8)))
    path = [at, at := (at[0] + 1, at[1])]
    steps = draw(st.lists(st.sampled_from([*BASIC_STEPS, (2, 1), (1, 2), (3, 3)]), max_size=10))
    return path + [at := (at[0] + a, at[1] + b) for a, b in steps]


def flatten_paths(
    paths: list[list[tuple[int, int]]],
) -> tuple[NDArray[np.signedinteger], NDArray[np.signedinteger], NDArray[np.signedinteger]]:
    """Pointers, rows and columns, as kernels take them."""
    nodes = np.array([node for path in paths for node in path], np.int32).reshape(-1, 2)
    ptr = np.cumsum([0, *map(len, paths)]).astype(np.int64)
    return ptr, np.ascontiguousarray(nodes[:, 0]), np.ascontiguousarray(nodes[:, 1])
