"""A bone above the hips that stays still changes nothing of what is said of a body."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import kineme
from kineme.clips.loops import find_carry
from kineme.clips.root_motion import measure_root_motion, remove_root_motion
from kineme.clips.shaping import find_planted_feet, measure_loops
from kineme.datasets import bundled_truth
from kineme.features import measure_body_size
from kineme.recordings import Motion, Skeleton
from kineme.recordings.operations import cut


@pytest.fixture(scope="module", params=[1, 2], ids=["one bone", "two bones"])
def rooted(request, motion: Motion) -> Motion:
    return add_root_bones(motion, request.param)


def add_root_bones(motion: Motion, count: int) -> Motion:
    """The motion below so many bones that stay at the origin."""
    skeleton, n = motion.skeleton, motion.n_frames
    names = (*(f"root_{k}" for k in range(count)), *skeleton.names)
    parents = (*range(-1, count - 1), *(parent + count for parent in skeleton.parents))
    still = np.zeros((n, count, 3))
    identity = np.tile([1.0, 0, 0, 0], (n, count, 1))
    return replace(
        motion,
        skeleton=Skeleton(
            names,
            parents,
            np.concatenate([np.zeros((count, 3)), skeleton.offsets]),
            frozenset(joint + count for joint in skeleton.end_sites),
        ),
        positions=np.concatenate([still, motion.positions], axis=1),
        rotations=np.concatenate([identity, motion.rotations], axis=1),
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


def test_clips_in_place_and_their_motion_are_the_same(motion, rooted) -> None:
    for row in kineme.read_segments(bundled_truth()).primitives:
        clip, other = (cut(each, row.start_frame, row.stop_frame) for each in (motion, rooted))
        carry, with_bone = find_carry(clip), find_carry(other)
        assert (carry.turn, carry.x, carry.z) == pytest.approx(
            (with_bone.turn, with_bone.x, with_bone.z), abs=1e-9
        )
        assert measure_root_motion(clip, carry).speed == pytest.approx(
            measure_root_motion(other, carry).speed
        )
        still, still_rooted = (remove_root_motion(each, carry)[0] for each in (clip, other))
        body = still_rooted.positions[:, rooted.skeleton.body]
        np.testing.assert_allclose(body, still.positions, atol=1e-9)


def test_loops_rank_the_same(motion, rooted) -> None:
    rows = list(kineme.segment(motion).primitives)
    found, other = (measure_loops(each, rows, find_planted_feet(each)) for each in (motion, rooted))
    assert found.keys() == other.keys()
    for index, quality in found.items():
        assert quality.cost == pytest.approx(other[index].cost, rel=1e-6)


def test_the_motion_graph_is_the_same(motion, rooted) -> None:
    truth = kineme.read_segments(bundled_truth())
    graph, other = (kineme.motion_graph([each], [truth]) for each in (motion, rooted))
    assert [(e.tail, e.head, e.leave, e.enter) for e in graph.edges] == [
        (e.tail, e.head, e.leave, e.enter) for e in other.edges
    ]
