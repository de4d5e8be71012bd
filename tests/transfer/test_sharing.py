"""Clusters of several recordings: equal numbers are equal movements, also of many recordings."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import kineme
from kineme.datasets import Action, bundled_recording, synthesize
from kineme.errors import ParameterError
from kineme.features.canonical import matching_poses, mirror_poses
from kineme.recordings.operations import cut, scale, turn
from kineme.transfer import clusters as transfer_clusters
from kineme.transfer import share_clusters
from kineme.transfer.clusters import (
    CONSTANTS,
    Assignment,
    ClusterSet,
    Features,
    LocalCluster,
    link_clusters,
)
from kineme.transfer.embeddings import compute_channel_samples, embedding
from kineme.transfer.sharing import share_by_samples


def reverse_clusters(found: kineme.Segmentation) -> kineme.Segmentation:
    """Reverse the cluster numbers."""
    clusters = found.table.cluster
    turned = np.where(clusters >= 0, clusters.max() - clusters, -1)
    return replace(found, table=replace(found.table, cluster=turned), hierarchy=None)


def test_the_same_movements_get_the_same_numbers_again() -> None:
    motion = kineme.read(bundled_recording(), unit="cm")
    found = kineme.segment(motion)
    other = scale(turn(motion, 1.0), 1.1)
    first, second, third = share_clusters(
        [motion, other, motion],
        [found, reverse_clusters(kineme.segment(other)), reverse_clusters(found)],
    )
    assert first.table == found.table
    assert (second.activities.cluster == found.activities.cluster).all()
    assert third.table == found.table


def test_what_was_not_there_before_is_numbered_on() -> None:
    motion = kineme.read(bundled_recording(), unit="cm")
    half = motion.n_frames // 2
    parts = [cut(motion, 0, half), cut(motion, half, motion.n_frames)]
    found = [kineme.segment(part) for part in parts]
    first, second = share_clusters(parts, found)
    known = set(first.table.cluster.tolist()) - {-1}
    new = set(second.table.cluster.tolist()) - {-1} - known
    assert new
    assert min(new) == max(known) + 1
    assert len(set(second.table.cluster.tolist())) == len(set(found[1].table.cluster.tolist()))
    assert (second.table.action == second.activities.cluster[second.table.activity]).all()


def test_walking_is_one_cluster_in_all_takes_of_a_subject(data_dir: Path) -> None:
    motions = [kineme.read(data_dir / "cmu86" / f"{trial}.amc") for trial in ("86_01", "86_11")]
    first, second = share_clusters(motions, [kineme.segment(motion) for motion in motions])
    both = set(first.table.cluster.tolist()) & set(second.table.cluster.tolist()) - {-1}
    assert both == {0}
    walked = second.activities.cluster == 0
    assert walked[0] or walked[1]
    assert walked.sum() == 2


def test_segments_of_another_recording_are_refused() -> None:
    motion = kineme.read(bundled_recording(), unit="cm")
    found = kineme.segment(motion)
    with pytest.raises(ParameterError, match="do not match"):
        share_clusters([cut(motion, 0, 100)], [found])


def make_still_and_shaken(turns: list[bool], unit: float = 1.0) -> tuple:
    """Make ten seconds of rest and of shaking, with one segment and cluster each."""
    rng = np.random.default_rng(len(turns))
    rows = [[5.0, 0.0] + (3.0 if on else 0.1) * rng.standard_normal((200, 2)) for on in turns]
    edges = 200 * np.arange(len(turns) + 1)
    columns = {
        "level": ["activity"] * len(turns) + ["primitive"] * len(turns),
        "kind": ["activity"] * 2 * len(turns),
        "start_frame": np.tile(edges[:-1], 2),
        "stop_frame": np.tile(edges[1:], 2),
        "cluster": np.tile(np.arange(len(turns)), 2),
    }
    found = kineme.Segmentation.from_columns(columns, n_frames=int(edges[-1]), fps=20.0)
    return kineme.Signals(unit * np.concatenate(rows), 20.0), found


@pytest.mark.parametrize("told", [None, 2])
def test_clusters_of_signals_are_alike_in_all_recordings(told: int | None) -> None:
    turns = ([True, False], [False, True, False], [False, False])
    signals, found = zip(*map(make_still_and_shaken, turns), strict=True)
    shared = share_clusters(signals, found, n_clusters=told)
    still = int(shared[2].activities.cluster[0])
    for one, own, before in zip(shared, turns, found, strict=True):
        assert (one.activities.cluster != still).tolist() == own
        assert one.primitives.cluster.tolist() == one.activities.cluster.tolist()
        assert one.cuts().tolist() == before.cuts().tolist()
    assert shared[0] == share_clusters(signals, found, n_clusters=told)[0]


def test_a_still_recording_is_not_stretched_to_a_moving_one() -> None:
    signals, found = zip(
        make_still_and_shaken([True, True]), make_still_and_shaken([True, True], 0.01), strict=True
    )
    moved, still = share_clusters(signals, found, n_clusters=2)
    assert set(moved.table.cluster.tolist()).isdisjoint(still.table.cluster.tolist())


def test_signals_of_other_channels_share_nothing() -> None:
    one, found = make_still_and_shaken([True, False])
    other = kineme.Signals(one.values, one.fps, ["a", "b"])
    with pytest.raises(ParameterError, match="with the same channels, not 1, 2 and of a, b"):
        share_clusters([one, other], [found, found])


def test_clusters_of_signals_do_not_depend_on_the_order_of_recordings() -> None:
    random = np.random.default_rng(4)
    recordings = []
    for _ in range(6):
        kinds = random.uniform(0.02, 1.5, (4, 6))
        wave = np.sin(2 * np.pi * np.outer(np.arange(300) / 30, random.uniform(0.4, 3, 4)))
        values = np.concatenate([size * wave[:, [k]] for k, size in enumerate(kinds)])
        recordings.append(kineme.Signals(values + 0.05 * random.normal(size=values.shape), 30.0))
    found = [kineme.segment(recording, preset="uniform") for recording in recordings]
    samples = [compute_channel_samples(recording) for recording in recordings]
    shared = share_by_samples(samples, found)
    for order in ([5, 4, 3, 2, 1, 0], [3, 0, 4, 1, 5, 2]):
        again = share_by_samples([samples[i] for i in order], [found[i] for i in order])
        assert [shared[i] for i in order] == again


def perform(name: str, **how: float) -> np.ndarray:
    return matching_poses(synthesize([Action(name, 3, **how)], fps=60).motion)


def measure_distance(one: np.ndarray, other: np.ndarray) -> float:
    return float(np.linalg.norm(embedding(one) - embedding(other)))


def test_speed_and_side_change_little_and_another_movement_much() -> None:
    walk, kick = perform("walk"), perform("kick")
    assert measure_distance(walk, perform("walk", speed=1.4)) < 0.3
    assert measure_distance(kick, mirror_poses(kick)) < measure_distance(kick, walk)
    for other in ("squat", "jump", "arm circles"):
        assert measure_distance(walk, perform(other)) > 0.8


def test_a_single_pose_is_a_segment() -> None:
    assert np.isfinite(embedding(perform("walk")[:1])).all()


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
