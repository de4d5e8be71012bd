"""Activities, primitive cuts and clusters against naive rules."""

from __future__ import annotations

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

import naive
from graphs import PRESET, STEPS, as_lists, as_pairs, block_graphs, sparse_graphs
from kineme.methods.region_growing.activities import (
    cluster_segments,
    find_activity_cuts,
    find_primitive_cuts,
)
from kineme.methods.region_growing.warping import warping_paths

seconds = settings(max_examples=60)
GAPS = st.integers(1, 6)
COUNTS = st.integers(0, 30)


@given(block_graphs(), GAPS, COUNTS, st.integers(0, 12))
@seconds
def test_squares_are_those_of_the_naive_version(graph, gap, count, distance) -> None:
    preset = PRESET.replace(
        growth="squares", growth_gap=gap, growth_count=count, growth_distance=distance
    )
    cuts = find_activity_cuts(graph, preset)
    forward, backward = naive.find_square_cuts(
        as_pairs(graph), len(graph), min_gap=gap, min_count=count, min_distance=distance
    )
    assert cuts.forward.tolist() == forward
    assert sorted(set(cuts.backward.tolist())) == sorted(set(backward))


@given(block_graphs() | sparse_graphs(max_frames=30), GAPS, COUNTS)
@seconds
def test_scan_lines_are_those_of_the_naive_version(graph, gap, count) -> None:
    cuts = find_activity_cuts(graph, PRESET.replace(growth_gap=gap, growth_count=count))
    expected = naive.find_scan_line_cuts(as_pairs(graph), len(graph), min_gap=gap, min_count=count)
    assert (cuts.forward.tolist(), cuts.backward.tolist()) == expected


@given(
    sparse_graphs(),
    STEPS,
    st.data(),
    st.sampled_from([0.1, 0.5, 1.0]),
    st.sampled_from([1.0, 2.0]),
    st.sampled_from([1, 2.5, 4]),
)
@seconds
def test_cuts_are_those_of_the_naive_rules(
    graph, steps, data, symmetry, max_slope, min_length
) -> None:
    first = data.draw(st.integers(0, len(graph) - 1))
    last = data.draw(st.integers(first, len(graph) - 1))
    preset = PRESET.replace(
        steps=steps, symmetry=symmetry, max_slope=max_slope, min_primitive=min_length
    )
    found = find_primitive_cuts(graph, (first, last), preset)
    box = (first, last + 1)
    paths = as_lists(warping_paths(graph, box, box, steps=steps))
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


@given(
    sparse_graphs(),
    STEPS,
    st.data(),
    st.sampled_from([0.1, 0.5, 0.66, 1.0]),
    st.booleans(),
    st.sampled_from(["weak", "strong"]),
)
@seconds
def test_clusters_are_those_of_the_naive_rules(
    graph, steps, data, coverage, interpolate, connection
) -> None:
    n = len(graph)
    inner = data.draw(st.sets(st.integers(1, n - 2), max_size=4)) if n > 2 else set()
    borders = [0, *sorted(inner), n - 1]
    preset = PRESET.replace(
        steps=steps, coverage=coverage, interpolate=interpolate, connection=connection
    )
    found = cluster_segments(graph, np.array(borders, np.int64), preset)
    links = []
    for g in range(len(borders) - 1):
        rows = (borders[g], borders[g + 1] + 1)
        paths = as_lists(warping_paths(graph, rows, (0, n), steps=steps, max_slope=2.0))
        linked = naive.find_linked_segments(
            paths, borders, g, coverage=coverage, interpolate=interpolate
        )
        links.append(dict(sorted(linked, key=lambda link: link[1])))
    labels = naive.cluster_segments(links, connection)
    assert found.labels.tolist() == labels
    scores = [0.0] * len(labels)
    for g, targets in enumerate(links):
        for h, share in targets.items():
            if h != g and labels[g] == labels[h]:
                scores[g], scores[h] = max(scores[g], share), max(scores[h], share)
    np.testing.assert_allclose(found.scores, scores)
