"""Primitive cuts: symmetry, slope, and the choice between close cuts."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import naive
from graphs import as_lists, flatten_paths, sparse_graphs, staircases
from kineme.methods.region_growing import _kernels
from kineme.methods.region_growing.activities import _choose_cuts, find_primitive_cuts
from kineme.methods.region_growing.neighbors import neighbor_graph
from kineme.methods.region_growing.warping import BASIC_STEPS, WarpingPaths, warping_paths

seconds = settings(max_examples=60)
CONSTANTS = {"steps": BASIC_STEPS, "skip_penalty": 0.0, "zero_cost": 1e-6, "separation": None}


@given(st.lists(staircases(), max_size=5), st.sampled_from([0.1, 0.5, 1.0]))
@seconds
def test_symmetry_is_that_of_the_naive_version(paths, share) -> None:
    coherent = _kernels.mark_coherent_paths(*flatten_paths(paths), share)
    assert coherent.tolist() == naive.mark_coherent_paths(paths, share)


@given(
    sparse_graphs(),
    st.data(),
    st.sampled_from([0.5, 1.0]),
    st.sampled_from([1.0, 2.0]),
    st.sampled_from([1, 2.5, 4]),
)
@seconds
def test_cuts_are_those_of_the_naive_rules(graph, data, symmetry, max_slope, min_length) -> None:
    first = data.draw(st.integers(0, len(graph) - 1))
    last = data.draw(st.integers(first, len(graph) - 1))
    found = find_primitive_cuts(
        graph,
        (first, last),
        min_nodes=2,
        max_slope=max_slope,
        symmetry=symmetry,
        min_length=min_length,
        **CONSTANTS,
    )
    box = (first, last + 1)
    paths = as_lists(warping_paths(graph, box, box, min_nodes=2, **CONSTANTS))
    symmetric = naive.mark_coherent_paths(paths, symmetry)
    valid = [
        path
        for path, holds in zip(paths, symmetric, strict=True)
        if holds and 1 / max_slope <= slope(path) <= max_slope
    ]
    assert as_lists(found.paths) == valid
    assert found.cuts.tolist() == naive.choose_cuts(valid, (first, last), min_length=min_length)
    assert [valid[source][0][1] for source in found.sources] == found.cuts.tolist()


@given(st.lists(staircases(), max_size=6), st.sampled_from([0, 1, 2.5, 4]))
@seconds
def test_of_two_close_cuts_the_one_with_the_longer_path_stays(paths, min_length) -> None:
    ptr, rows, columns = flatten_paths(paths)
    found = _choose_cuts(WarpingPaths(ptr, rows, columns, np.zeros(len(paths))), 2, 8, min_length)
    kept = naive.choose_cuts(paths, (2 - min_length, 8 + min_length), min_length=min_length)
    assert found.cuts.tolist() == kept


def slope(path: list[tuple[int, int]]) -> float:
    return (path[-1][1] - path[0][1]) / (path[-1][0] - path[0][0])


@pytest.mark.parametrize("period", [20, 33])
@pytest.mark.parametrize("repetitions", [2, 3, 7])
def test_each_repetition_of_a_cycle_is_cut(period: int, repetitions: int) -> None:
    turns = 2 * np.pi * np.arange(period * repetitions) / period
    graph = neighbor_graph(np.stack([np.cos(turns), np.sin(turns)], axis=1), radius=0.01)
    found = find_primitive_cuts(
        graph,
        (0, len(turns) - 1),
        min_nodes=15,
        max_slope=2.0,
        symmetry=0.5,
        min_length=7.5,
        **CONSTANTS,
    )
    assert found.cuts.tolist() == list(range(period, period * repetitions, period))
