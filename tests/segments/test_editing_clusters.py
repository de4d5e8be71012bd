"""Clusters divided and numbered anew."""

from __future__ import annotations

import pytest

import kineme
from kineme.errors import ParameterError
from kineme.segments import editing


def table() -> kineme.Segmentation:
    spans = [(0, 10), (10, 20), (20, 30), (30, 40)]
    columns = {
        "level": ["activity", "activity"] + ["primitive"] * 4,
        "kind": ["activity"] * 6,
        "start_frame": [0, 20] + [a for a, _ in spans],
        "stop_frame": [20, 40] + [b for _, b in spans],
        "cluster": [0] * 6,
        "label": [""] * 6,
    }
    made = kineme.Segmentation.from_columns(columns, n_frames=40, fps=10)
    return editing.name_cluster(made, 0, "walk")


def test_a_part_of_a_cluster_is_one_of_its_own() -> None:
    parted = editing.split_cluster(table(), 0, [20, 30])
    assert parted.primitives.cluster.tolist() == [0, 0, 1, 1]
    assert parted.activities.cluster.tolist() == [0, 1]
    assert editing.cluster_names(parted) == {0: "walk"}
    assert editing.split_cluster(table(), 0, [30]).activities.cluster.tolist() == [0, 0]
    with pytest.raises(ParameterError, match="not all"):
        editing.split_cluster(table(), 0, [0, 10, 20, 30])


def test_clusters_in_another_order_keep_their_names() -> None:
    parted = editing.split_cluster(table(), 0, [20, 30])
    turned = editing.order_clusters(parted, [1, 0])
    assert turned.primitives.cluster.tolist() == [1, 1, 0, 0]
    assert editing.cluster_names(turned) == {1: "walk"}
    assert editing.order_clusters(turned, [1, 0]) == parted
    with pytest.raises(ParameterError, match="each cluster once"):
        editing.order_clusters(parted, [0])
