"""Neighbour graphs and features of all shapes, for hypothesis."""

from __future__ import annotations

import numpy as np
from hypothesis import strategies as st
from numpy.typing import NDArray

from kineme.methods.region_growing import BASIC_STEPS
from kineme.methods.region_growing.neighbors import NeighborGraph
from kineme.methods.region_growing.preset import KRUEGER2017
from kineme.methods.region_growing.warping import WarpingPaths

Pairs = dict[tuple[int, int], np.float32]
PRESET = KRUEGER2017.replace(working_fps=1.0, min_path=2.0, cluster_min_path=2.0)
"""Times in frames; otherwise the defaults of `kineme.warping_paths`."""
STEPS = st.sampled_from([BASIC_STEPS, ((1, 1), (2, 1), (1, 2), (3, 3))])
"""Steps to each neighbour, and steps that skip rows or columns."""


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
