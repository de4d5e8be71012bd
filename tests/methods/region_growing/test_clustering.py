"""Links between segments, and clusters."""

from __future__ import annotations

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

import naive
from graphs import as_lists, flatten_paths, sparse_graphs, staircases
from kineme.methods.region_growing import _kernels
from kineme.methods.region_growing.activities import cluster_segments
from kineme.methods.region_growing.warping import BASIC_STEPS, warping_paths

seconds = settings(max_examples=60)
CONSTANTS = {"steps": BASIC_STEPS, "skip_penalty": 0.0, "zero_cost": 1e-6, "separation": None}
COVERAGES = st.sampled_from([0.1, 0.5, 0.66, 1.0])


@given(st.lists(staircases(), max_size=4), st.data(), COVERAGES, st.booleans())
@seconds
def test_links_are_those_of_the_naive_version(paths, data, coverage, interpolate) -> None:
    borders = sorted(data.draw(st.sets(st.integers(0, 25), min_size=2)))
    g = data.draw(st.integers(0, len(borders) - 2))
    linked, shares = _kernels.find_linked_segments(
        *flatten_paths(paths), np.array(borders, np.int64), g, coverage, interpolate
    )
    expected = naive.find_linked_segments(
        paths, borders, g, coverage=coverage, interpolate=interpolate
    )
    assert linked.tolist() == [h for h, _ in expected]
    np.testing.assert_allclose(shares, [share for _, share in expected])


@given(sparse_graphs(), st.data(), COVERAGES, st.booleans(), st.sampled_from(["weak", "strong"]))
@seconds
def test_clusters_are_those_of_the_naive_rules(
    graph, data, coverage, interpolate, connection
) -> None:
    n = len(graph)
    inner = data.draw(st.sets(st.integers(1, n - 2), max_size=4)) if n > 2 else set()
    borders = [0, *sorted(inner), n - 1]
    found = cluster_segments(
        graph,
        np.array(borders, np.int64),
        min_nodes=2,
        max_slope=2.0,
        coverage=coverage,
        interpolate=interpolate,
        connection=connection,
        **CONSTANTS,
    )
    links = []
    for g in range(len(borders) - 1):
        rows = (borders[g], borders[g + 1] + 1)
        paths = warping_paths(graph, rows, (0, n), min_nodes=2, max_slope=2.0, **CONSTANTS)
        links.append(
            dict(
                sorted(
                    naive.find_linked_segments(
                        as_lists(paths), borders, g, coverage=coverage, interpolate=interpolate
                    ),
                    key=lambda link: link[1],
                )
            )
        )
    labels = naive.cluster_segments(links, connection)
    assert found.labels.tolist() == labels
    scores = [0.0] * len(labels)
    for g, targets in enumerate(links):
        for h, share in targets.items():
            if h != g and labels[g] == labels[h]:
                scores[g], scores[h] = max(scores[g], share), max(scores[h], share)
    np.testing.assert_allclose(found.scores, scores)
