"""Components and cheapest warping paths against naive versions."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import naive
from graphs import as_lists, as_pairs, sparse_graphs
from kineme.errors import ParameterError
from kineme.methods.region_growing import BASIC_STEPS
from kineme.methods.region_growing.neighbors import neighbor_graph
from kineme.methods.region_growing.warping import label_components, warping_paths

seconds = settings(max_examples=60)
STEPS = st.sampled_from(
    [
        BASIC_STEPS,
        (*BASIC_STEPS, (2, 1), (1, 2), (2, 2), (5, 5)),
        ((1, 1),),
        ((0, 1), (3, 0)),
        ((2, 2), (2, 1)),
    ]
)


@st.composite
def boxes(draw: st.DrawFn, n: int) -> tuple[tuple[int, int], tuple[int, int]]:
    """Draw spans of rows and columns, sometimes all."""
    rows, columns = (
        sorted(draw(st.tuples(st.integers(0, n), st.integers(0, n)) | st.just((0, n))))
        for _ in range(2)
    )
    return (rows[0], rows[1]), (columns[0], columns[1])


@given(sparse_graphs(), STEPS)
@seconds
def test_components_are_those_of_the_naive_version(graph, steps) -> None:
    pairs = sorted(as_pairs(graph))
    firsts = naive.label_components(pairs, steps)
    labels = label_components(graph, steps=steps)
    assert [pairs[label] for label in labels] == [firsts[pair] for pair in pairs]


@given(sparse_graphs(distinct=True), STEPS, st.sampled_from([0.0, 0.3]), st.data())
@seconds
def test_paths_are_those_of_the_naive_version(graph, steps, penalty, data) -> None:
    rows, columns = data.draw(boxes(len(graph)))
    separation = data.draw(st.none() | st.integers(0, 6))
    options = {"steps": steps, "skip_penalty": penalty, "zero_cost": 1e-4, "separation": separation}
    paths = warping_paths(graph, rows, columns, min_nodes=1, **options)
    expected = naive.find_paths_in_box(as_pairs(graph), rows, columns, **options)
    assert sorted(as_lists(paths)) == sorted(path for _, path in expected)
    np.testing.assert_allclose(sorted(paths.costs), sorted(cost for cost, _ in expected))


@given(sparse_graphs(), STEPS, st.sampled_from([0.0, 0.3]), st.data())
@seconds
def test_among_equally_cheap_paths_one_is_found(graph, steps, penalty, data) -> None:
    rows, columns = data.draw(boxes(len(graph)))
    options = {"steps": steps, "skip_penalty": penalty, "zero_cost": 1e-4}
    pairs = as_pairs(graph)
    paths = warping_paths(graph, rows, columns, min_nodes=1, **options)
    expected = naive.find_paths_in_box(pairs, rows, columns, **options)
    np.testing.assert_allclose(sorted(paths.costs), sorted(cost for cost, _ in expected))
    for path, cost in zip(as_lists(paths), paths.costs, strict=True):
        moves = [(b[0] - a[0], b[1] - a[1]) for a, b in pairwise(path)]
        assert set(moves) <= set(steps)
        skipped = sum(max(0, a - 1) + max(0, b - 1) for a, b in moves)
        paid = sum(float(pairs[node]) or 1e-4 for node in path) + penalty * skipped
        assert paid == pytest.approx(cost)


@given(sparse_graphs(), st.integers(1, 8), st.sampled_from([1.0, 1.5, 2.0]))
@seconds
def test_short_and_steep_paths_are_dropped(graph, min_nodes, max_slope) -> None:
    n = len(graph)
    every = warping_paths(graph, (0, n), (0, n), min_nodes=1)
    kept = warping_paths(graph, (0, n), (0, n), min_nodes=min_nodes, max_slope=max_slope)
    wanted = [
        path
        for path in as_lists(every)
        if len(path) >= min_nodes
        and 1 / max_slope <= (path[-1][1] - path[0][1]) / (path[-1][0] - path[0][0]) <= max_slope
    ]
    assert sorted(as_lists(kept)) == sorted(wanted)
    assert (kept.n_nodes >= min_nodes).all()


@pytest.mark.parametrize("steps", [(), ((0, 0),), ((1, -1),)])
def test_refuses_steps_that_lead_nowhere(steps) -> None:
    graph = neighbor_graph(np.zeros((3, 1)), radius=0)
    with pytest.raises(ParameterError, match="warping steps"):
        warping_paths(graph, (0, 3), (0, 3), steps=steps)
