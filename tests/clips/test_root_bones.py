"""A bone above the hips that stays still changes nothing of what is said of a body."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import kineme
from kineme._util import rotations as rot
from kineme.clips.loops import find_carry, make_loop, repeat_first_frame
from kineme.clips.root_motion import (
    extract_root_motion,
    measure_root_motion,
    remove_root_motion,
    straighten,
)
from kineme.clips.shaping import find_planted_feet, measure_loops
from kineme.features import measure_body_size
from kineme.recordings import Motion, Skeleton
from kineme.recordings.carriers import find_still_joints
from kineme.recordings.kinematics import compute_world_rotations
from kineme.recordings.operations import cut
from kineme.synthesis import random_route


@pytest.fixture(scope="module", params=[1, 2], ids=["one bone", "two bones"])
def rooted(request, motion: Motion) -> Motion:
    return add_root_bones(motion, request.param)


def add_root_bones(motion: Motion, count: int) -> Motion:
    """Return the motion below some bones that stay at the origin, the first one with z up."""
    skeleton, n = motion.skeleton, motion.n_frames
    names = (*(f"root_{k}" for k in range(count)), *skeleton.names)
    parents = (*range(-1, count - 1), *(parent + count for parent in skeleton.parents))
    still = np.zeros((n, count, 3))
    bones = np.tile([1.0, 0, 0, 0], (n, count, 1))
    bones[:, 0] = z_up = np.array([0.5**0.5, -(0.5**0.5), 0, 0])
    rotations, offsets = np.array(motion.rotations), np.array(skeleton.offsets)
    rotations[:, 0] = rot.multiply(rot.conjugate(z_up), rotations[:, 0])
    offsets[0] = rot.rotate(rot.conjugate(z_up), offsets[0])
    return replace(
        motion,
        skeleton=Skeleton(
            names,
            parents,
            np.concatenate([np.zeros((count, 3)), offsets]),
            frozenset(joint + count for joint in skeleton.end_sites),
        ),
        positions=np.concatenate([still, motion.positions], axis=1),
        rotations=np.concatenate([bones, rotations], axis=1),
    )


def test_the_unit_is_that_of_the_body(rooted, tmp_path) -> None:
    far = replace(rooted, positions=rooted.positions + [0, 0, 30.0] * (rooted.positions != 0))
    kineme.write(far, tmp_path / "far.bvh")
    again = kineme.read(tmp_path / "far.bvh")
    np.testing.assert_allclose(again.positions, far.positions, atol=1e-4)


def test_size_and_segments_are_the_same(motion, rooted) -> None:
    sizes = [measure_body_size(each, kineme.end_effectors(each)) for each in (motion, rooted)]
    assert sizes[0] == pytest.approx(sizes[1], abs=1e-12)
    assert kineme.segment(rooted).table == kineme.segment(motion).table


def test_clips_in_place_and_their_motion_are_the_same(motion, truth, rooted) -> None:
    for row in truth.primitives:
        clip, other = (cut(each, row.start_frame, row.stop_frame) for each in (motion, rooted))
        carry, with_bone = find_carry(clip), find_carry(other)
        assert (carry.turn, carry.x, carry.z) == pytest.approx(
            (with_bone.turn, with_bone.x, with_bone.z), abs=1e-9
        )
        assert measure_root_motion(clip, carry).speed == pytest.approx(
            measure_root_motion(other, carry).speed
        )
        still, still_rooted = (remove_root_motion(each, carry)[0] for each in (clip, other))
        check_body(still, still_rooted)


def test_straight_and_closed_clips_are_the_same(motion, truth, rooted) -> None:
    for row in truth.primitives[:4]:
        clip, other = (cut(each, row.start_frame, row.stop_frame) for each in (motion, rooted))
        carry = find_carry(clip)
        check_body(straighten(clip, carry)[0], straighten(other, carry)[0])
        check_body(*(repeat_first_frame(*make_loop(each)) for each in (clip, other)))


def test_a_root_bone_that_moves_stays_below_the_body(motion) -> None:
    clip = cut(motion, 240, 354)
    for carry in (None, find_carry(clip)):
        rooted = extract_root_motion(clip, carry)
        still, _ = remove_root_motion(rooted, carry)
        assert np.linalg.norm(still.positions[:, 0], axis=1).max() < 0.3
    closed, carry = make_loop(rooted)
    again = repeat_first_frame(closed, carry).positions
    np.testing.assert_allclose(again[-1], carry.apply(again[0]), atol=1e-9)


def test_root_bones_at_two_places_do_not_move_the_body(motion, truth, rooted) -> None:
    aside = np.array(rooted.positions)
    aside[:, find_still_joints(rooted)] += [3.0, 0, 0]
    graph = kineme.motion_graph([motion, motion], [truth, truth])
    route = random_route(graph, 20.0, seed=1)
    assert {graph.nodes[node].source for node in route} == {0, 1}
    check_body(
        kineme.synthesize(graph, [motion, motion], route, plant=False),
        kineme.synthesize(graph, [rooted, replace(rooted, positions=aside)], route, plant=False),
    )


def check_body(motion: Motion, rooted: Motion) -> None:
    """Check that both bodies have the same positions and axes, and that the root bones stay."""
    body, others = list(rooted.skeleton.body), find_still_joints(rooted)
    assert others.sum() == rooted.skeleton.n_joints - len(body)
    np.testing.assert_array_equal(rooted.positions[:, others], 0)
    np.testing.assert_allclose(rooted.positions[:, body], motion.positions, atol=1e-9)
    turns = [compute_world_rotations(each.skeleton, each.rotations) for each in (motion, rooted)]
    # The sign of a quaternion is free; end sites have no axes of their own.
    joints = [j for j in range(motion.skeleton.n_joints) if j not in motion.skeleton.end_sites]
    dots = (turns[0] * turns[1][:, body]).sum(axis=-1)[:, joints]
    np.testing.assert_allclose(np.abs(dots), 1, atol=1e-9)


def test_loops_rank_the_same(motion, rooted) -> None:
    rows = list(kineme.segment(motion).primitives)
    found, other = (measure_loops(each, rows, find_planted_feet(each)) for each in (motion, rooted))
    assert found.keys() == other.keys()
    for index, quality in found.items():
        assert quality.cost == pytest.approx(other[index].cost, rel=1e-6)


def test_the_motion_graph_is_the_same(motion, truth, rooted) -> None:
    graph, other = (kineme.motion_graph([each], [truth]) for each in (motion, rooted))
    assert [(e.tail, e.head, e.leave, e.enter) for e in graph.edges] == [
        (e.tail, e.head, e.leave, e.enter) for e in other.edges
    ]
    route = random_route(graph, 20.0, seed=1)
    check_body(*(kineme.synthesize(graph, [each], route, plant=False) for each in (motion, rooted)))
