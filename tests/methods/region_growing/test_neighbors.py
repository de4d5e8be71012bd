"""The neighbour graph: equality with the naive version, invariances, and errors."""

from __future__ import annotations

import tracemalloc

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial import KDTree

import kineme
import naive
from graphs import as_pairs, features, sparse_graphs
from kineme.errors import ParameterError
from kineme.methods.region_growing.neighbors import NeighborGraph, neighbor_graph

pytestmark = pytest.mark.filterwarnings("error")
seconds = settings(max_examples=60)
SHARES = st.sampled_from([0.0, 0.2, 0.5, 0.9, 1.0, 2.0])
COUNTS = st.none() | st.integers(1, 12)


def spread(points: np.ndarray) -> float:
    return float(np.linalg.norm(points.max(axis=0) - points.min(axis=0)))


@given(features(), SHARES, COUNTS, COUNTS)
@seconds
def test_equal_to_the_naive_version(points, share, k, max_lag) -> None:
    radius = share * spread(points)
    graph = neighbor_graph(points, radius=radius, k=k, max_lag=max_lag)
    assert as_pairs(graph) == naive.find_neighbors(points, radius=radius, k=k, max_lag=max_lag)


@given(features(), st.data(), SHARES, COUNTS, COUNTS)
@seconds
def test_equal_to_the_naive_version_between_two_sets(points, data, share, k, max_lag) -> None:
    scale = np.abs(np.diff(points, axis=0)).max(initial=0) or 1.0
    shift = data.draw(st.integers(-2, 2)) * scale
    others = points[:: data.draw(st.sampled_from([1, -1, 3]))] + shift
    radius = share * spread(points)
    graph = neighbor_graph(points, others, radius=radius, k=k, max_lag=max_lag)
    assert as_pairs(graph) == naive.find_neighbors(
        points, others, radius=radius, k=k, max_lag=max_lag
    )
    assert graph.n_columns == len(others)


@pytest.mark.parametrize("offset", [0.0, 1e6, -3e9])
@pytest.mark.parametrize("scale", [1e-30, 1e-9, 1.0, 1e12])
def test_exact_for_any_offset_and_scale(offset: float, scale: float) -> None:
    points = scale * (np.random.default_rng(5).random((300, 6)) + offset)
    distances = np.linalg.norm(points[:, None] - points, axis=2)
    ordered = np.unique(distances)
    at = len(ordered) // 3
    at += int(np.argmax(np.diff(ordered[at : at + 50])))
    radius = (ordered[at] + ordered[at + 1]) / 2
    graph = neighbor_graph(points, radius=radius)
    i, j = np.nonzero(distances <= radius)
    np.testing.assert_array_equal(np.repeat(np.arange(300), graph.counts), i)
    np.testing.assert_array_equal(graph.indices, j)
    np.testing.assert_allclose(graph.distances, distances[i, j], rtol=1e-6)


def test_one_far_outlier_costs_no_neighbour() -> None:
    points = np.random.default_rng(0).random((200, 3))
    points[77] = 1e8
    graph = neighbor_graph(points, radius=0.25)
    expected = KDTree(points).query_ball_point(points, 0.25, return_sorted=True)
    assert [graph[i][0].size for i in range(200)] == [len(found) for found in expected]
    np.testing.assert_array_equal(graph.indices, np.concatenate(expected))


@pytest.mark.parametrize("value", [0.0, 0.1, 1e-5, 1e-300, 3e5, 1e30])
@pytest.mark.parametrize("radius", [0.0, 0.64, 1e6])
def test_constant_features_are_all_neighbours(value: float, radius: float) -> None:
    graph = neighbor_graph(np.full((33, 4), value), radius=radius)
    assert graph.n_entries == 33 * 33
    assert not graph.distances.any()


@given(features(), SHARES, st.integers(1, 10))
@seconds
def test_rows_come_nearest_first_and_ties_by_frame(points, share, k) -> None:
    graph = neighbor_graph(points, radius=share * spread(points), k=k)
    for i, (frames, distances) in enumerate(graph):
        assert len(frames) <= k
        assert [*zip(distances, frames, strict=True)] == sorted(zip(distances, frames, strict=True))
        np.testing.assert_array_equal(frames, graph[i - len(graph)][0])
    with pytest.raises(IndexError, match=f"frame {len(graph)} of"):
        graph[len(graph)]


@given(sparse_graphs(), st.integers(1, 20))
@seconds
def test_nearest_is_the_naive_version(graph: NeighborGraph, k: int) -> None:
    assert as_pairs(graph.nearest(k)) == naive.select_nearest(as_pairs(graph), k)


@pytest.mark.parametrize("unit", [1e-45, 1e-38, 1e-12, 1.0, 1e37])
def test_nearest_at_any_scale(unit: float) -> None:
    distances = np.float32(unit) * np.array([[3, 0, 2, 2, 1, 2], [5, 5, 5, 5, 5, 5]], np.float32)
    graph = NeighborGraph(
        np.array([0, 6, 12]), np.tile(np.arange(6, dtype=np.int32), 2), distances.ravel(), 6, 1.0
    )
    nearest = graph.nearest(3)
    np.testing.assert_array_equal(nearest.indices, [1, 2, 4, 0, 1, 2])


@given(sparse_graphs(), st.sampled_from([None, 0.0, 0.25, 0.6, 9.0]), st.integers(0, 5))
@seconds
def test_restricting_drops_the_far_and_the_near_diagonal(graph, radius, min_lag) -> None:
    kept = {
        (i, j): distance
        for (i, j), distance in as_pairs(graph).items()
        if abs(j - i) >= min_lag and (radius is None or distance <= radius)
    }
    assert as_pairs(graph.restrict(radius=radius, min_lag=min_lag)) == kept


@pytest.mark.parametrize("shape", [(3000, 3), (1, 5), (700, 1)])
@pytest.mark.parametrize("lag", [1, 40, 2000])
def test_blocks_of_the_search_join_without_seams(monkeypatch, shape, lag) -> None:
    monkeypatch.setattr("kineme.methods.region_growing.neighbors.BLOCK_ENTRIES", 5000)
    points = np.random.default_rng(2).random(shape)
    near = neighbor_graph(points, points[::-1][:650], radius=0.1, max_lag=lag)
    tree = KDTree(points[::-1][:650])
    expected = [
        [j for j in found if abs(j - i) <= lag]
        for i, found in enumerate(tree.query_ball_point(points, 0.1, return_sorted=True))
    ]
    np.testing.assert_array_equal(near.counts, [len(found) for found in expected])
    np.testing.assert_array_equal(near.indices, np.concatenate(expected))


@pytest.mark.parametrize("max_lag", [None, 300])
def test_memory_grows_with_the_neighbours_found(max_lag: int | None) -> None:
    points = np.random.default_rng(1).random((10_000, 15))
    neighbor_graph(points[:100], radius=0.5)
    tracemalloc.start()
    try:
        graph = neighbor_graph(points, radius=0.5, max_lag=max_lag)
        _, peak = tracemalloc.get_traced_memory()
    finally:
        tracemalloc.stop()
    assert len(graph) == 10_000
    assert graph.n_entries < 30_000
    assert peak < 32e6  # a matrix of booleans would take 100 MB


def test_a_sparse_matrix_keeps_neighbours_at_distance_zero() -> None:
    matrix = neighbor_graph([[0.0], [3.0], [0.0]], [[0.0], [2.0]], radius=1.5).to_scipy()
    assert matrix.shape == (3, 2)
    assert matrix.nnz == 3
    np.testing.assert_array_equal(matrix.toarray(), [[0, 0], [0, 1], [0, 0]])
    assert matrix.has_canonical_format


@pytest.mark.parametrize(
    ("points", "options", "message"),
    [
        (np.zeros(5), {}, r"frames x dims.*\(5,\)"),
        (np.zeros((0, 3)), {}, r"\(0, 3\)"),
        ([[0.0], [np.nan]], {}, "not finite, first in frame 1"),
        (np.zeros((2, 3)), {"others": np.zeros((2, 4))}, "3 dimensions, others 4"),
        (np.zeros((2, 3)), {"others": [[np.inf] * 3]}, "others hold"),
        (np.zeros((2, 3)), {"radius": -1}, "radius.*-1"),
        (np.zeros((2, 3)), {"radius": np.nan}, "radius.*nan"),
        (np.zeros((2, 3)), {"k": 0}, "k must be at least 1, not 0"),
        (np.zeros((2, 3)), {"max_lag": -2}, "max_lag must be at least 1, not -2"),
    ],
)
def test_refuses_what_has_no_neighbours(points, options, message) -> None:
    with pytest.raises(ParameterError, match=message):
        neighbor_graph(points, **{"radius": 1.0, **options})


def test_arrays_that_may_not_be_written_to_are_taken() -> None:
    signals = kineme.Signals(np.random.default_rng(0).normal(size=(50, 2)), 30)
    assert len(kineme.neighbor_graph(signals.values, radius=1.0)) == 50
