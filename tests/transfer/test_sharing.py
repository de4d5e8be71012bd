"""Clusters of several recordings: equal numbers are equal movements."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import kineme
from kineme.datasets import Action, bundled_recording, synthesize
from kineme.errors import ParameterError
from kineme.features.canonical import matching_poses, mirror_poses
from kineme.recordings.operations import cut, scale, turn
from kineme.transfer import share_clusters
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
