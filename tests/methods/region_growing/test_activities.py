"""Growing regions against naive versions, and simple cases."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import naive
from graphs import as_graph, as_pairs, block_graphs, sparse_graphs
from kineme.methods.region_growing import _kernels
from kineme.methods.region_growing.activities import (
    ActivityCuts,
    _find_peaks,
    find_scan_line_cuts,
    find_square_cuts,
)

seconds = settings(max_examples=60)
GAPS = st.integers(1, 6)
COUNTS = st.integers(0, 30)


def blocks(*lengths: int, gap: int = 20):
    """Make square blocks of mutual neighbours with gaps between them, without the diagonal."""
    pairs, start = {}, 0
    for length in lengths:
        frames = range(start, start + length)
        pairs |= {(i, j): np.float32(1) for i in frames for j in frames if abs(i - j) >= 3}
        start += length + gap
    return as_graph(pairs, start - gap)


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


@pytest.mark.parametrize("form", ["squares", "scan_lines"])
def test_blocks_end_and_begin_at_their_borders(form: str) -> None:
    graph = blocks(40, 30, 50)
    if form == "squares":
        cuts = find_square_cuts(graph, min_gap=10, min_count=128, min_distance=30)
    else:
        cuts = find_scan_line_cuts(graph, min_gap=5, min_count=120)
    # a block's last frame is the last to bring neighbours; its first, seen from the end,
    # the first: both within the band taken off the diagonal
    assert len(cuts.forward) == len(cuts.backward) == 2
    np.testing.assert_allclose(cuts.forward, [39, 89], atol=1)
    np.testing.assert_allclose(cuts.backward, [60, 110], atol=1)


@given(block_graphs(), GAPS, COUNTS)
@seconds
def test_backward_lines_are_forward_lines_of_the_mirrored_graph(graph, min_gap, min_count) -> None:
    n = len(graph)
    mirrored = as_graph({(n - 1 - i, n - 1 - j): d for (i, j), d in as_pairs(graph).items()}, n)
    forward = _kernels.scan_lines_forward(graph.indptr, graph.indices, min_gap, min_count)
    backward = _kernels.scan_lines_backward(
        mirrored.indptr, mirrored.indices, np.zeros(n, np.bool_), min_gap, min_count
    )
    assert sorted(n - 1 - backward) == forward.tolist()


@given(block_graphs(), GAPS, COUNTS)
@seconds
def test_backward_squares_are_forward_squares_of_the_mirrored_graph(
    graph, min_gap, min_count
) -> None:
    n = len(graph)
    mirrored = as_graph({(n - 1 - i, n - 1 - j): d for (i, j), d in as_pairs(graph).items()}, n)
    forward = _kernels.grow_squares_forward(
        *_kernels.group_pairs(graph.indptr, graph.indices, True), min_gap, min_count
    )
    pairs = _kernels.group_pairs(mirrored.indptr, mirrored.indices, False)
    first = _kernels.grow_squares_backward(*pairs, np.zeros(n, np.bool_), min_gap, min_count)
    # exact up to the first end of a region: forward it begins its search for a full region
    # where the last began to stand still, backward where the region was given up
    given_up = np.flatnonzero(np.diff(forward[1:]) < 0)
    until = given_up[0] + 2 if given_up.size else n
    np.testing.assert_array_equal(first[::-1][:until], forward[:until])


def test_every_cut_once() -> None:
    cuts = ActivityCuts(np.array([3, 9]), np.array([4, 9]))
    assert cuts.all.tolist() == [3, 4, 9]
