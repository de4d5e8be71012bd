"""New motion: what was asked for, smooth where spans meet, with feet that stand."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pybvh
import pytest

import kineme
from kineme._util import rotations as rot
from kineme.errors import ParameterError
from kineme.features import end_effectors
from kineme.recordings import Motion
from kineme.recordings.kinematics import (
    compute_local_translations,
    compute_world_rotations,
    forward_kinematics,
)
from kineme.recordings.operations import cut
from kineme.segments.segmentation import Segmentation
from kineme.synthesis import (
    MotionGraph,
    Placement,
    action_route,
    find_foot_contacts,
    motion_graph,
    parse_actions,
    plant_feet,
    random_route,
    synthesize,
)


def count_repetitions(found: Segmentation, activity: int) -> int:
    rows = found.primitives
    return int(((rows.activity == activity) & (rows.kind == "primitive")).sum())


def measure_largest_step(motion: Motion) -> float:
    """Metres that a joint moves from frame to frame at most."""
    return float(np.linalg.norm(np.diff(motion.positions, axis=0), axis=2).max())


def measure_largest_turn(motion: Motion) -> float:
    """Degrees that a joint turns from frame to frame at most."""
    q = motion.rotations
    assert q is not None
    half = np.arccos(np.clip(np.abs((q[1:] * q[:-1]).sum(axis=2)), 0, 1))
    return float(np.degrees(2 * half).max())


def measure_ankle_slides(motion: Motion) -> np.ndarray:
    found = end_effectors(motion)
    paths = [motion.positions[:, ankle] for ankle in found.indices[:2]]
    return np.array([
        np.linalg.norm((path[a:b] - path[a])[:, [0, 2]], axis=1).max()
        for path in paths
        for a, b in find_foot_contacts(path, motion.fps)
    ])  # fmt: skip


@pytest.mark.parametrize(
    "actions", ["walk*6,jump*4,run*7", "squat*3,jump*5,kick*4", "jump*3,squat*4,jump*4"]
)
def test_segmenting_finds_the_actions_and_counts_asked_for(
    exercises: Motion, graph: MotionGraph, actions: str
) -> None:
    wanted = parse_actions(actions)
    motion = synthesize(graph, [exercises], action_route(graph, wanted))
    found = kineme.segment(motion)
    runs = [row for row in found.activities if row.kind == "activity"]
    inside = [count_repetitions(found, row.activity) for row in runs]
    assert inside == [count for _, count in wanted]
    first = {name: i for i, (name, _) in reversed([*enumerate(wanted)])}
    assert [row.cluster for row in runs] == [runs[first[name]].cluster for name, _ in wanted]
    assert len({row.cluster for row in runs}) == len(first)


@pytest.mark.parametrize("seed", range(3))
def test_a_random_walk_is_as_smooth_as_the_recording_and_stands(
    exercises: Motion, graph: MotionGraph, seed: int
) -> None:
    route = random_route(graph, 60, seed)
    motion = synthesize(graph, [exercises], route)
    assert motion.duration >= 60
    assert measure_largest_step(motion) <= 1.5 * measure_largest_step(exercises)
    assert measure_largest_turn(motion) <= 1.5 * measure_largest_turn(exercises)
    assert measure_ankle_slides(motion).mean() < 0.01
    sliding = synthesize(graph, [exercises], route, plant=False)
    assert measure_ankle_slides(motion).mean() < 0.5 * measure_ankle_slides(sliding).mean()


def test_the_recording_itself_comes_out_as_it_went_in(exercises: Motion) -> None:
    graph = motion_graph([exercises], prune=False)
    motion = synthesize(graph, [exercises], range(len(graph.nodes)), plant=False)
    assert np.abs(motion.positions - exercises.positions).max() < 1e-9


def test_where_it_starts_is_where_it_was_laid(exercises: Motion, graph: MotionGraph) -> None:
    route = random_route(graph, 10, 0)
    here = synthesize(graph, [exercises], route, plant=False)
    there = synthesize(graph, [exercises], route, start=Placement(0.5, 3 - 2j), plant=False)
    expected = kineme.recordings.operations.move(
        kineme.recordings.operations.turn(here, 0.5), [3, 0, -2]
    )
    assert np.abs(there.positions - expected.positions).max() < 1e-9


def test_planting_keeps_bones_heights_and_the_direction_of_feet(
    exercises: Motion, graph: MotionGraph
) -> None:
    before = synthesize(graph, [exercises], random_route(graph, 30, 3), plant=False)
    after = plant_feet(before)
    assert after.rotations is not None
    assert (
        np.abs(
            compute_local_translations(after.skeleton, after.positions, after.rotations)
            - compute_local_translations(before.skeleton, before.positions, before.rotations)
        ).max()
        < 1e-9
    )
    again = forward_kinematics(
        after.skeleton,
        after.rotations,
        translations=compute_local_translations(
            before.skeleton, before.positions, before.rotations
        ),
    )
    assert np.abs(again - after.positions).max() < 1e-9
    feet = list(end_effectors(before).indices[:2])
    raised = after.positions[:, feet, 1] - before.positions[:, feet, 1]
    assert np.percentile(np.abs(raised), 99) < 0.005  # where the leg is long enough
    turns = rot.multiply(
        rot.conjugate(compute_world_rotations(before.skeleton, before.rotations)[:, feet]),
        compute_world_rotations(after.skeleton, after.rotations)[:, feet],
    )
    assert np.abs(np.abs(turns[..., 0]) - 1).max() < 1e-9
    assert np.abs(after.positions[:, 0] - before.positions[:, 0]).max() == 0


def test_a_still_foot_is_left_alone(exercises: Motion) -> None:
    still = cut(exercises, 0, 1)
    frames = np.zeros(60, int)
    frozen = Motion(still.skeleton, still.positions[frames], 60, still.rotations[frames])
    assert np.abs(plant_feet(frozen).positions - frozen.positions).max() < 1e-9
    assert plant_feet(still) is still or np.array_equal(
        plant_feet(still).positions, still.positions
    )


def test_a_route_without_edges_or_of_other_motions_is_refused(
    exercises: Motion, graph: MotionGraph
) -> None:
    with pytest.raises(ParameterError, match="no edge leads from node 0 to node 30"):
        synthesize(graph, [exercises], [0, 30])
    with pytest.raises(ParameterError, match="at least one node"):
        synthesize(graph, [exercises], [])
    with pytest.raises(ParameterError, match="the graph was built from other motions"):
        synthesize(graph, [cut(exercises, 0, 100)], [0])


def test_another_program_reads_the_same_motion(
    exercises: Motion, graph: MotionGraph, tmp_path: Path
) -> None:
    motion = synthesize(graph, [exercises], action_route(graph, [("walk", 2), ("jump", 1)]))
    kineme.write(motion, tmp_path / "new.bvh")
    other = pybvh.read_bvh_file(tmp_path / "new.bvh")
    assert other.fps == pytest.approx(motion.fps, rel=1e-4)
    order = [other.node_index[name] for name in motion.skeleton.names if name in other.joint_names]
    own = [i for i, name in enumerate(motion.skeleton.names) if name in other.joint_names]
    apart = other.node_positions()[:, order] / 100 - motion.positions[:, own]
    assert len(own) > 15
    assert np.abs(apart).max() < 1e-4
