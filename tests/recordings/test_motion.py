from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from kineme._util import rotations as rot
from kineme.errors import MotionError, ParameterError
from kineme.recordings import Motion, Skeleton
from kineme.recordings.kinematics import compute_local_translations

ARM = Skeleton(
    ("shoulder", "elbow", "hand"), (-1, 0, 1), np.array([[0, 0, 0], [1, 0, 0], [1, 0, 0]]), {2}
)
QUARTER = [0.5**0.5, 0.0, 0.0, 0.5**0.5]  # about z
STILL = [1.0, 0.0, 0.0, 0.0]

seeds = st.integers(0, 2**32)


def make_quaternions(seed: int, *shape: int) -> np.ndarray:
    q = np.random.default_rng(seed).normal(size=(*shape, 4))
    return q / np.linalg.norm(q, axis=-1, keepdims=True)


def test_forward_kinematics_of_a_bent_arm() -> None:
    motion = Motion.from_rotations(ARM, [[STILL, QUARTER, STILL]], 30, [[0, 1, 0]])
    np.testing.assert_allclose(motion.positions[0], [[0, 1, 0], [1, 1, 0], [1, 2, 0]], atol=1e-15)
    lifted = Motion.from_rotations(ARM, [[QUARTER, STILL, STILL]], 30)
    np.testing.assert_allclose(lifted.positions[0], [[0, 0, 0], [0, 1, 0], [0, 2, 0]], atol=1e-15)


@given(seeds)
def test_translations_are_recovered(seed: int) -> None:
    rng = np.random.default_rng(seed)
    skeleton = Skeleton(tuple("abcd"), (-1, 0, 0, 2), rng.normal(size=(4, 3)))
    moves = rng.normal(size=(5, 4, 3))
    motion = Motion.from_rotations(skeleton, make_quaternions(seed, 5, 4), 30, translations=moves)
    np.testing.assert_allclose(
        compute_local_translations(motion.skeleton, motion.positions, motion.rotations),
        moves,
        atol=1e-12,
    )
    rigid = Motion.from_rotations(skeleton, make_quaternions(seed, 5, 4), 30)
    offsets = np.broadcast_to(skeleton.offsets, (5, 4, 3))
    np.testing.assert_allclose(
        compute_local_translations(rigid.skeleton, rigid.positions, rigid.rotations),
        offsets,
        atol=1e-12,
    )


def test_joints_by_name() -> None:
    motion = Motion(ARM, np.zeros((1, 3, 3)), 30)
    assert motion.joint("hand") == 2
    assert ARM.children == ((1,), (2,), ())
    with pytest.raises(ParameterError, match="no joint is called 'elbw'; did you mean 'elbow'"):
        motion.joint("elbw")


def test_arrays_are_read_only_and_the_callers_stay_writable() -> None:
    positions = np.zeros((1, 3, 3))
    motion = Motion(ARM, positions, 30)
    with pytest.raises(ValueError, match="read-only"):
        motion.positions[0, 0, 0] = 1
    positions[0, 0, 0] = 1


@pytest.mark.parametrize(
    ("names", "parents", "offsets", "ends", "reason"),
    [
        ((), (), np.zeros((0, 3)), set(), "at least one joint"),
        (("a", "b"), (-1,), np.zeros((2, 3)), set(), "do not describe one skeleton"),
        (("a", "b"), (-1, 0), np.zeros((2, 2)), set(), "do not describe one skeleton"),
        (("a", "a"), (-1, 0), np.zeros((2, 3)), set(), "two joints are called 'a'"),
        (("a", "b"), (1, 0), np.zeros((2, 3)), set(), "'a' .* has parent 1: parents come before"),
        (("a", "b"), (-1, 1), np.zeros((2, 3)), set(), "'b' .* has parent 1"),
        (("a", "b"), (-1, -2), np.zeros((2, 3)), set(), "'b' .* has parent -2"),
        (("a", "b"), (-1, 0), np.full((2, 3), np.nan), set(), "offsets hold values that are not"),
        (("a", "b"), (-1, 0), np.zeros((2, 3)), {0}, "end site 0 is not a leaf"),
        (("a", "b"), (-1, 0), np.zeros((2, 3)), {2}, "end site 2 is not a leaf"),
    ],
)
def test_skeletons_that_contradict_themselves(
    names: tuple[str, ...],
    parents: tuple[int, ...],
    offsets: np.ndarray,
    ends: set[int],
    reason: str,
) -> None:
    with pytest.raises(MotionError, match=reason):
        Skeleton(names, parents, offsets, frozenset(ends))


@pytest.mark.parametrize(
    ("positions", "fps", "rotations", "reason"),
    [
        (np.zeros((0, 3, 3)), 30, None, "at least one frame"),
        (np.zeros((1, 2, 3)), 30, None, r"shape \(1, 2, 3\), not \(frames, 3, 3\)"),
        (np.full((1, 3, 3), np.inf), 30, None, "positions hold values that are not finite"),
        (np.zeros((1, 3, 3)), 0, None, "frame rate is 0"),
        (np.zeros((1, 3, 3)), np.nan, None, "frame rate is nan"),
        (np.zeros((1, 3, 3)), 30, np.zeros((1, 3, 3)), "rotations have shape"),
        (np.zeros((1, 3, 3)), 30, np.zeros((1, 3, 4)), "not unit quaternions"),
    ],
)
def test_motions_that_contradict_themselves(
    positions: np.ndarray, fps: float, rotations: np.ndarray | None, reason: str
) -> None:
    with pytest.raises(MotionError, match=reason):
        Motion(ARM, positions, fps, rotations)


@given(seeds)
def test_quaternions_agree_with_scipy(seed: int) -> None:
    a, b = make_quaternions(seed, 7), make_quaternions(seed + 1, 7)
    v = np.random.default_rng(seed).normal(size=(7, 3))
    ours, theirs = (
        Rotation.from_quat(a, scalar_first=True),
        Rotation.from_quat(b, scalar_first=True),
    )
    product = Rotation.from_quat(rot.multiply(a, b), scalar_first=True)
    assert ((ours * theirs).inv() * product).magnitude().max() < 1e-12
    np.testing.assert_allclose(rot.rotate(a, v), ours.apply(v), atol=1e-12)
    np.testing.assert_allclose(rot.rotate(rot.conjugate(a), v), ours.inv().apply(v), atol=1e-12)
    np.testing.assert_allclose(rot.to_rotation_vectors(a), ours.as_rotvec(), atol=1e-12)
    same = np.abs(np.einsum("fc,fc->f", rot.from_rotation_vectors(rot.to_rotation_vectors(a)), a))
    np.testing.assert_allclose(same, 1, atol=1e-12)


@given(seeds, st.sampled_from(["zyx", "xyz", "yxz", "zxz", "zyxz", "x", "zy", ""]))
def test_euler_angles_agree_with_scipy(seed: int, axes: str) -> None:
    angles = np.random.default_rng(seed).uniform(-7, 7, size=(5, len(axes)))
    expected = Rotation.identity()
    for axis, angle in zip(axes, angles[0], strict=True):
        expected = expected * Rotation.from_euler(axis, angle)
    found = Rotation.from_quat(rot.from_euler(angles, axes)[0], scalar_first=True)
    assert (expected.inv() * found).magnitude() < 1e-12


@given(
    seeds,
    st.sampled_from([0.0, 1e-9, 1e-7, 1e-4, 1.0]),
    st.sampled_from(["zyx", "zxy", "yzx", "yxz", "xyz", "xzy"]),
)
def test_euler_angles_there_and_back(seed: int, off_the_pole: float, axes: str) -> None:
    """Also at 90 degrees about the second axis, where the others are not unique."""
    angles = np.random.default_rng(seed).uniform(-3, 3, size=(5, 3))
    angles[:, 1] = np.pi / 2 - off_the_pole
    q = rot.from_euler(angles, axes)
    again = rot.from_euler(rot.unwrap_euler(rot.to_euler(q, axes)), axes)
    np.testing.assert_allclose(np.abs((q * again).sum(axis=1)), 1, atol=1e-14)
    v = np.eye(3)[[0, 1, 2, 0, 1]]
    np.testing.assert_allclose(rot.rotate(q, v), rot.rotate(again, v), atol=1e-7)


@pytest.mark.parametrize("axes", ["zyx", "xzy", "zx", "y"])
def test_euler_angles_are_continuous(axes: str) -> None:
    """Also past 90 degrees about the second of three axes, where the others would jump."""
    angles = np.linspace(np.zeros(len(axes)), [7.0, 2.5, -8.0][: len(axes)], 100)
    found = rot.unwrap_euler(rot.to_euler(rot.from_euler(angles, axes), axes))
    np.testing.assert_allclose(found, angles, atol=1e-12)
