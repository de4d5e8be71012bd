"""Link more local clusters than are compared pairwise."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import kineme
from kineme.transfer import clusters as transfer_clusters
from kineme.transfer.clusters import (
    CONSTANTS,
    Assignment,
    ClusterSet,
    Features,
    LocalCluster,
    link_clusters,
)
from kineme.transfer.sharing import share_clusters

KINDS, RECORDINGS = 6, 30
RARE = 3
"""Recordings that contain the last kind of movement."""


def make_cluster_set() -> tuple[ClusterSet, np.ndarray]:
    """Local clusters of some kinds of movement, one of each in a recording, and their kinds.

    Each kind is an arc in a plane of its own: nothing in one is like anything in another.
    """
    rng = np.random.default_rng(1)
    angle = np.linspace(0, np.pi, 24)
    shapes = np.zeros((KINDS, 24, 2 * KINDS))
    for kind in range(KINDS):
        shapes[kind, :, 2 * kind : 2 * kind + 2] = np.column_stack([np.cos(angle), np.sin(angle)])
    features: dict[tuple[int, int], Features] = {}
    for recording in range(RECORDINGS):
        for kind in range(KINDS - (recording >= RARE)):
            values = shapes[kind] + 0.1 * rng.normal(size=shapes[kind].shape)
            values /= np.linalg.norm(values, axis=1, keepdims=True)
            context = values.astype(np.float32)
            features[recording, kind] = context[4:20], context
    local = [
        LocalCluster(recording, kind, 0, 0.0, 1.0, np.array([[0.0, 1.0 + kind]]), (0, 1), (0, 1))
        for recording, kind in features
    ]
    embeddings = np.array([example.mean(axis=0) for example, _ in features.values()])
    clusters = ClusterSet(local, embeddings, lambda each: features[each.recording, each.cluster])
    return clusters, np.array([kind for _, kind in features])


def link(clusters: ClusterSet, progress: Any = None, **constants: Any) -> Assignment:
    """Link local clusters by other constants."""
    keys = [str(recording) for recording in range(RECORDINGS)]
    told = progress or (lambda _: None)
    return link_clusters(clusters, keys, replace(CONSTANTS, **constants), progress=told)


def test_rounds_find_the_clusters_that_comparing_all_pairwise_finds() -> None:
    clusters, kinds = make_cluster_set()
    told: list[str] = []
    whole = link(clusters)
    in_rounds = link(clusters, progress=told.append, most=20)
    assert len({*zip(whole.cluster.tolist(), kinds.tolist(), strict=True)}) == KINDS
    assert in_rounds.cluster.tolist() == whole.cluster.tolist()
    common = kinds < KINDS - 1  # of what is rare, the next cluster may be of an earlier round
    assert (in_rounds.confidence[common] > 0.3).all()
    assert (in_rounds.next_cluster != in_rounds.cluster).all()
    assert told[0] == "clusters in common: 20 of 153"
    assert told[-1] == "clusters in common: 153 of 153"


def test_neither_threads_nor_blocks_nor_order_change_clusters(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    clusters, kinds = make_cluster_set()
    here = link(clusters, most=20)
    monkeypatch.setattr(transfer_clusters, "map_threads", lambda work, items: [*map(work, items)])
    alone = link(clusters, most=20)
    assert [column.tobytes() for column in alone] == [column.tobytes() for column in here]
    monkeypatch.setattr(transfer_clusters, "BLOCK", 8)
    order = np.random.default_rng(2).permutation(len(kinds))
    shuffled = link(clusters.select(order), most=20)
    assert shuffled.cluster.tolist() == here.cluster[order].tolist()
    assert np.allclose(shuffled.spread, here.spread[order], atol=1e-5)


def test_one_local_cluster_or_none_is_linked_to_nothing() -> None:
    clusters, _ = make_cluster_set()
    one = link(clusters.select(np.array([3])))
    assert (one.cluster.tolist(), one.next_cluster.tolist()) == ([0], [-1])
    assert np.isnan(one.confidence).all()
    assert link(clusters.select(np.empty(0, np.int64))).cluster.tolist() == []


def test_walking_and_running_of_many_takes_are_two_clusters(data_dir: Path) -> None:
    paths = sorted((data_dir / "rigs" / "bandai_namco").glob("dataset-2_*_00[14].bvh"))
    paths = [path for path in paths if path.name.split("_")[1] in ("walk", "run")]
    if not paths:
        pytest.skip("no rigs/bandai_namco")
    motions = [kineme.read(path) for path in paths]
    shared = share_clusters(motions, [kineme.segment(motion) for motion in motions])
    clusters: dict[str, set[int]] = {"walk": set(), "run": set()}
    for path, found in zip(paths, shared, strict=True):
        clusters[path.name.split("_")[1]] |= {row.cluster for row in found.activities} - {-1}
    assert clusters["walk"].isdisjoint(clusters["run"])
