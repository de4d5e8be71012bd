"""Primitive cuts: symmetry, slope, and the choice between close cuts."""

from __future__ import annotations

from hypothesis import given, settings
from hypothesis import strategies as st

import naive
from graphs import as_lists, flatten_paths, sparse_graphs, staircases
from kineme.methods.region_growing import _kernels
from kineme.methods.region_growing.activities import find_primitive_cuts
from kineme.methods.region_growing.warping import BASIC_STEPS, warping_paths

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


def slope(path: list[tuple[int, int]]) -> float:
    return (path[-1][1] - path[0][1]) / (path[-1][0] - path[0][0])
