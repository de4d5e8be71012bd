"""What a page draws is the motion, to the millimetre and within its bytes."""

from __future__ import annotations

import zlib
from dataclasses import replace

import hypothesis.extra.numpy as hnp
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import kineme
from kineme.datasets import bundled_recording
from kineme.recordings import Motion, Skeleton
from kineme.web.display import display_motion, encode_positions, list_bones, sample_poses
from kineme.web.messages import MotionHead

RECORDING = kineme.read(bundled_recording())


def decoded(head: MotionHead, data: bytes) -> np.ndarray:
    """Positions (samples, joints, 3) as a page reads them; nan where not seen."""
    joints = len(head.joints)
    columns = np.frombuffer(zlib.decompress(data), "<i2").reshape(3 * joints, head.n_samples)
    numbers = np.cumsum(columns, axis=1, dtype=np.int16).T.reshape(-1, joints, 3)
    positions = np.array(head.origin) + head.step * numbers
    positions[numbers == -32768] = np.nan
    return positions


def moving(positions: np.ndarray, fps: float = 30.0, **more: object) -> Motion:
    """A motion of joints without bones."""
    n = positions.shape[1]
    skeleton = Skeleton(tuple(f"p{i}" for i in range(n)), (-1,) * n, np.zeros((n, 3)))
    return Motion(skeleton, positions, fps, **more)


def test_every_second_frame_of_60_hz_comes_back_within_a_step() -> None:
    head, data = display_motion(RECORDING)
    assert (head.sample_fps, head.n_samples) == (30.0, (RECORDING.n_frames + 1) // 2)
    assert head.step < 0.0005
    np.testing.assert_allclose(decoded(head, data), RECORDING.positions[::2], atol=0.51 * head.step)


@pytest.mark.parametrize("fps", [29.97, 40.0, 59.94, 100.0, 119.88, 1000.0])
def test_samples_lie_on_the_line_between_frames(fps: float) -> None:
    line = np.linspace(0, 1, 500)[:, None, None] * np.array([1.0, 2.0, -3.0])
    found = sample_poses(moving(line, fps), min(fps, 30.0))
    times = np.arange(len(found)) / min(fps, 30.0)
    np.testing.assert_allclose(found[:, 0, 1], 2 * times * fps / 499, atol=1e-9)
    assert times[-1] <= 499 / fps < times[-1] + 1 / 30 + 1e-9


def test_long_recordings_get_a_coarser_step_then_fewer_poses() -> None:
    fine, data = display_motion(RECORDING)
    coarse, less = display_motion(RECORDING, max_bytes=len(data) - 1)
    assert len(less) < len(data)
    assert 3 * fine.step < coarse.step < 0.001
    assert coarse.sample_fps == 30.0
    slow, least = display_motion(RECORDING, max_bytes=len(less) // 3)
    assert len(least) <= len(less) // 3
    assert slow.sample_fps < 30.0
    at = np.arange(slow.n_samples) * RECORDING.fps / slow.sample_fps
    expected = RECORDING.positions[np.rint(at).astype(int)]
    np.testing.assert_allclose(decoded(slow, least), expected, atol=0.1)
    assert len(slow.heading) == slow.n_samples


def test_gaps_show_nothing() -> None:
    head, data = display_motion(replace(RECORDING, gaps=((100, 121),)))
    missing = np.isnan(decoded(head, data)).all(axis=(1, 2))
    np.testing.assert_array_equal(np.flatnonzero(missing), np.arange(50, 61))


@settings(max_examples=60)
@given(
    hnp.arrays(
        np.float64,
        st.tuples(st.integers(1, 9), st.integers(1, 4), st.just(3)),
        elements=st.floats(-1e4, 1e4) | st.just(np.nan),
    )
)
def test_points_come_back_and_missing_ones_stay_missing(positions: np.ndarray) -> None:
    origin, step, data = encode_positions(positions, 1e-4)
    head = MotionHead(
        n_samples=len(positions),
        sample_fps=30.0,
        joints=["p"] * positions.shape[1],
        parents=[],
        bones=[],
        origin=origin,
        step=step,
        heading=None,
        effectors={},
    )
    found = decoded(head, data)
    lost = np.isnan(positions).any(axis=2)
    np.testing.assert_array_equal(np.isnan(found).any(axis=2), lost)
    np.testing.assert_allclose(found[~lost], positions[~lost], atol=0.501 * step + 1e-9)


def test_heading_turns_with_the_motion() -> None:
    head, _ = display_motion(RECORDING)
    turned, _ = display_motion(kineme.recordings.operations.turn(RECORDING, 0.5))
    difference = np.array(turned.heading) - np.array(head.heading)
    np.testing.assert_allclose(np.angle(np.exp(1j * (difference - 0.5))), 0, atol=0.002)
    assert head.joints[head.effectors["head"]].lower().startswith("head")
    assert set(head.effectors) == {*kineme.features.PARTS, "pelvis"}


def test_what_has_no_body_is_still_drawn() -> None:
    head, data = display_motion(moving(RECORDING.positions[:20, :4]))
    assert (head.heading, head.effectors, head.bones) == (None, {}, [])
    assert decoded(head, data).shape == (20, 4, 3)


def test_bones_join_the_joints_of_a_body_and_no_markers() -> None:
    joints = [
        (RECORDING.skeleton.names[a], RECORDING.skeleton.names[b]) for a, b in list_bones(RECORDING)
    ]
    assert len(joints) == RECORDING.skeleton.n_joints - 1
    names = ("pelvis", "left_hip", "right_hip", "LBWT", "RBWT")
    skeleton = Skeleton(names, (-1, 0, 0, 0, 0), np.ones((5, 3)))
    assert list_bones(Motion(skeleton, np.ones((1, 5, 3)), 100.0)) == [(0, 1), (0, 2)]
