"""Growing regions against naive versions, and simple cases."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

import naive
from graphs import as_pairs, block_graphs, sparse_graphs
from kineme.methods.region_growing import _kernels
from kineme.methods.region_growing.activities import (
    _find_peaks,
    find_scan_line_cuts,
    find_square_cuts,
)

seconds = settings(max_examples=60)
GAPS = st.integers(1, 6)
COUNTS = st.integers(0, 30)


@given(block_graphs(), GAPS, COUNTS, st.integers(0, 12))
@seconds
def test_squares_are_those_of_the_naive_version(graph, min_gap, min_count, min_distance) -> None:
    options = {"min_gap": min_gap, "min_count": min_count, "min_distance": min_distance}
    cuts = find_square_cuts(graph, **options)
    expected = naive.find_square_cuts(as_pairs(graph), len(graph), **options)
    assert (cuts.forward.tolist(), sorted(set(cuts.backward.tolist()))) == (
        expected[0],
        sorted(set(expected[1])),
    )


@given(block_graphs() | sparse_graphs(max_frames=30), GAPS, COUNTS)
@seconds
def test_scan_lines_are_those_of_the_naive_version(graph, min_gap, min_count) -> None:
    cuts = find_scan_line_cuts(graph, min_gap=min_gap, min_count=min_count)
    expected = naive.find_scan_line_cuts(
        as_pairs(graph), len(graph), min_gap=min_gap, min_count=min_count
    )
    assert (cuts.forward.tolist(), cuts.backward.tolist()) == expected


@given(st.lists(st.integers(0, 6), min_size=1, max_size=40), st.integers(0, 5), st.integers(0, 9))
@seconds
def test_peaks_are_those_of_the_naive_version(heights, min_height, min_distance) -> None:
    found = _find_peaks(np.array(heights, np.int64), min_height, min_distance)
    assert found.tolist() == naive.find_peaks(dict(enumerate(heights)), min_height, min_distance)


@given(sparse_graphs(), st.booleans())
@seconds
def test_grouped_pairs_hold_every_pair_once(graph, by_later) -> None:
    indptr, others = _kernels.group_pairs(graph.indptr, graph.indices, by_later)
    groups = [sorted(others[a:b].tolist()) for a, b in pairwise(indptr)]
    key, other = (max, min) if by_later else (min, max)
    pairs = as_pairs(graph)
    assert groups == [
        sorted(other(pair) for pair in pairs if key(pair) == i) for i in range(len(graph))
    ]


@given(sparse_graphs(), st.data())
@seconds
def test_inner_neighbors_are_those_of_the_naive_version(graph, data) -> None:
    n = len(graph)
    inner = data.draw(st.sets(st.integers(1, n - 1))) if n > 1 else set()
    borders = [0, *sorted(inner), n]
    counts = _kernels.count_inner_neighbors(
        graph.indptr, graph.indices, np.array(borders, np.int64)
    )
    assert counts.tolist() == naive.count_inner_neighbors(as_pairs(graph), borders)
