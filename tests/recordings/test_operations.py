from __future__ import annotations

from dataclasses import replace
from math import floor
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from kineme.errors import ParameterError
from kineme.formats import read
from kineme.recordings import Motion, Signals, Skeleton
from kineme.recordings.kinematics import compute_local_translations, forward_kinematics
from kineme.recordings.operations import cut, move, resample, scale, turn
from kineme.transfer import transfer_features

TREE = Skeleton(
    tuple("abcd"), (-1, 0, 1, 0), np.array([[0, 0, 0], [1, 0, 0], [0, 2, 0], [0, 0, 1]])
)


def make_motion(n: int = 41, fps: float = 120, *, seed: int = 0, rotations: bool = True) -> Motion:
    """Every joint turns steadily about an axis of its own, the root walks along x."""
    rng = np.random.default_rng(seed)
    axes = rng.normal(size=(4, 3))
    axes /= np.linalg.norm(axes, axis=1, keepdims=True)
    half = 0.5 * np.arange(n)[:, None] / fps * rng.uniform(1, 5, size=4)
    q = np.concatenate([np.cos(half)[..., None], np.sin(half)[..., None] * axes], axis=2)
    root = np.zeros((n, 3))
    root[:, 0] = np.arange(n) / fps
    whole = Motion.from_rotations(TREE, q, fps, root)
    return whole if rotations else Motion(TREE, whole.positions, fps)


@pytest.mark.parametrize("n", [1, 4, 5, 40, 41, 7583])
def test_a_whole_ratio_takes_frames_as_they_are(n: int) -> None:
    dense = make_motion(n)
    thin = resample(dense, 30)
    assert thin.n_frames == (n - 1) // 4 + 1
    assert thin.fps == 30
    np.testing.assert_array_equal(thin.positions, dense.positions[::4])
    assert thin.rotations is not None
    assert dense.rotations is not None
    np.testing.assert_array_equal(thin.rotations, dense.rotations[::4])
    assert thin.provenance.notes == ("resampled from 120 to 30 Hz",)


@given(st.integers(1, 50), st.sampled_from([25.0, 29.97, 30.0, 59.94, 100.0, 240.0]), st.booleans())
def test_times_of_the_new_frames(n: int, fps: float, rotations: bool) -> None:
    old = make_motion(n, 120, rotations=rotations)
    new = resample(old, fps)
    assert new.n_frames == floor((n - 1) * fps / 120 + 1e-9) + 1
    assert new.times[-1] <= old.times[-1] + 1e-9
    np.testing.assert_allclose(new.positions[:, 0, 0], new.times, atol=1e-12)
    np.testing.assert_array_equal(new.positions[0], old.positions[0])


def test_steady_turns_are_interpolated_exactly() -> None:
    new = resample(make_motion(121), 50)
    expected = make_motion(51, 50)
    np.testing.assert_allclose(new.positions, expected.positions, atol=1e-9)
    assert new.rotations is not None
    bones = np.linalg.norm(
        compute_local_translations(new.skeleton, new.positions, new.rotations)[:, 1:], axis=2
    )
    np.testing.assert_allclose(bones, np.broadcast_to([1, 2, 1], bones.shape), atol=1e-12)


def test_there_and_back_on_a_real_recording(data_dir: Path) -> None:
    walk = read(data_dir / "cmu_formats/02_01.amc")
    again = resample(resample(walk, 360), 120)
    np.testing.assert_allclose(again.positions, walk.positions, atol=1e-9)
    assert resample(walk, walk.fps) is walk
    odd = resample(resample(walk, 100), 120)
    n = odd.n_frames
    assert np.abs(odd.positions - walk.positions[:n]).max() < 0.01


@pytest.mark.parametrize("fps", [30, 50])
def test_channels_are_resampled_with_their_gaps(fps: float) -> None:
    old = Signals(np.arange(121.0), 120, ["acc"], gaps=[(40, 60)])
    new = resample(old, fps)
    assert (new.fps, new.names, new.n_frames) == (fps, ("acc",), fps + 1)
    np.testing.assert_allclose(new.values[:, 0], new.times * 120, atol=1e-9)
    assert new.gaps == resample(replace(make_motion(121), gaps=old.gaps), fps).gaps
    with pytest.raises(ParameterError, match="a Motion, not Signals: channels have no joints"):
        transfer_features(old)  # type: ignore[arg-type]


def test_cut() -> None:
    old = make_motion()
    part = cut(old, 10, 20)
    np.testing.assert_array_equal(part.positions, old.positions[10:20])
    assert part.provenance.notes == ("cut to frames 10 to 20",)
    for start, stop in ((-1, 5), (5, 5), (6, 5), (0, 42)):
        with pytest.raises(ParameterError, match=f"frames {start} to {stop}"):
            cut(old, start, stop)


@given(st.floats(-10, 10), st.floats(0.01, 100), st.tuples(*[st.floats(-5, 5)] * 3))
def test_position_and_rotation_stay_in_step(
    angle: float, factor: float, offset: tuple[float, float, float]
) -> None:
    changed = move(turn(scale(make_motion(5), factor), angle), offset)
    assert changed.rotations is not None
    positions = forward_kinematics(changed.skeleton, changed.rotations, changed.positions[:, 0])
    np.testing.assert_allclose(positions, changed.positions, atol=1e-9)


def test_turn_is_about_the_vertical_from_z_to_x() -> None:
    turned = turn(Motion(TREE, np.tile([0.0, 5.0, 1.0], (1, 4, 1)), 30), np.pi / 2)
    np.testing.assert_allclose(turned.positions[0, 0], [1, 5, 0], atol=1e-15)


@pytest.mark.parametrize(
    ("operation", "value"),
    [(resample, 0), (resample, np.nan), (scale, 0), (scale, -1), (turn, np.inf), (move, [1, 2])],
)
def test_values_are_checked(operation: object, value: object) -> None:
    with pytest.raises(ParameterError, match="give"):
        operation(make_motion(), value)  # type: ignore[operator]


def test_a_rate_beyond_all_measure_is_refused() -> None:
    motion = Motion(Skeleton(("a",), (-1,), np.zeros((1, 3))), np.zeros((10, 1, 3)), 0.001)
    with pytest.raises(
        ParameterError, match="frames 1000 s apart are too far for 30 frames per second"
    ):
        resample(motion, 30)
