"""Datasets in the layout of the package movement, with xarray, and with movement where it is."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as arrays

import kineme
from kineme import Motion, Skeleton
from kineme.datasets import bundled_recording
from kineme.errors import KinemeWarning, ParameterError, ReadError
from kineme.recordings.operations import cut
from segmentations import segmentations

xr = pytest.importorskip("xarray", reason="not installed: pip install 'kineme[xarray]'")

from kineme.interop.movement_dataset import from_movement, to_movement  # noqa: E402


@pytest.fixture(scope="module")
def motion() -> Motion:
    return cut(kineme.read(bundled_recording()), 0, 300)


def test_the_layout_is_movements(motion) -> None:
    dataset = to_movement(motion, individual="anna")
    assert dataset["position"].dims == ("time", "space", "keypoints", "individuals")
    assert dataset["confidence"].dims == ("time", "keypoints", "individuals")
    assert dataset.attrs["ds_type"] == "poses"
    assert dataset.attrs["time_unit"] == "seconds"
    hand = motion.skeleton.names[5]
    chosen = dataset["position"].sel(keypoints=hand, individuals="anna", time=2.0, space="y")
    frame = round(2.0 * motion.fps)
    assert float(chosen) == motion.positions[frame, 5, 1]


def test_without_rotations_the_borders_are_the_same() -> None:
    motion = kineme.read(bundled_recording())
    ours = kineme.segment(motion).cuts()
    theirs = kineme.segment(from_movement(to_movement(motion))).cuts()
    assert len(theirs) == len(ours)
    assert np.abs(theirs - ours).max() <= 0.2 * motion.fps


@given(
    arrays.arrays(
        np.float64,
        st.tuples(st.integers(2, 9), st.just(3), st.just(3)),
        elements=st.floats(0.1, 0.3),
    ),
    st.sampled_from([25.0, 29.97, 60.0, 119.88]),
)
@settings(max_examples=30)
def test_any_points_come_back(moves, fps) -> None:
    positions = np.array([[0, 0, 0], [5, 0, 0], [0, 5, 5]]) + moves  # none jumps
    skeleton = Skeleton(("a", "b", "c"), (-1, -1, -1), np.zeros((3, 3)))
    back = from_movement(to_movement(Motion(skeleton, positions, fps)))
    order = [back.joint(name) for name in "abc"]
    assert np.array_equal(back.positions[:, order], positions)
    assert back.fps == fps


@given(segmentations())
@settings(max_examples=30)
def test_segments_go_with_their_frames(result) -> None:
    skeleton = Skeleton(("a",), (-1,), np.zeros((1, 3)))
    motion = Motion(skeleton, np.zeros((result.n_frames, 1, 3)), result.fps)
    dataset = to_movement(motion, result)
    level = "primitive" if len(result.primitives) else "activity"
    assert dataset["cluster"].to_numpy().tolist() == result.per_frame(level=level).tolist()
    rows = result.level(level)
    for number, row in enumerate(rows):
        inside = dataset["primitive"].to_numpy() == number
        assert inside.sum() == row.stop_frame - row.start_frame
        assert inside[row.start_frame : row.stop_frame].all()


def test_gaps_were_not_seen(motion) -> None:
    skeleton = motion.skeleton
    gappy = Motion(skeleton, motion.positions, motion.fps, gaps=((100, 150),))
    dataset = to_movement(gappy)
    assert float(dataset["confidence"].isel(time=slice(100, 150)).sum()) == 0
    assert bool(np.isnan(dataset["position"].isel(time=120)).all())
    with pytest.warns(KinemeWarning, match="the recording is split there"):
        again = from_movement(dataset)
    assert again.gaps == ((100, 150),)
    assert set(skeleton.names) <= set(again.skeleton.names)


def test_one_of_several_and_only_what_is_sure(motion) -> None:
    anna, ben = to_movement(motion, individual="anna"), to_movement(motion, individual="ben")
    ben["position"] = ben["position"] + 1
    both = xr.concat([anna, ben], "individuals")
    with pytest.raises(ParameterError, match="name one of anna, ben"):
        from_movement(both)
    with pytest.raises(ParameterError, match="no individual 'carl'; there are anna, ben"):
        from_movement(both, individual="carl")
    back = from_movement(both, individual="ben")
    name = motion.skeleton.names[0]
    assert np.allclose(back.positions[:, back.joint(name)], motion.positions[:, 0] + 1)
    both["confidence"][50:53] = 0.1
    assert any("filled" in note for note in from_movement(both, individual="ben").provenance.notes)


def test_two_dimensions_and_frame_numbers(motion) -> None:
    flat = to_movement(motion).sel(space=["x", "y"])
    flat = flat.assign_attrs(length_unit=None, up=None)
    back = from_movement(flat)
    assert "two-dimensional: z is 0, and image rows count downwards" in back.provenance.notes
    frames = to_movement(motion).assign_attrs(fps=None, time_unit="frames")
    with pytest.raises(ReadError, match="has times in frames but no fps: give fps="):
        from_movement(frames)
    assert from_movement(frames, fps=50).fps == 50
    seconds = to_movement(motion).assign_attrs(fps=None)
    assert from_movement(seconds).fps == pytest.approx(motion.fps)


def test_other_layouts_are_refused(motion) -> None:
    with pytest.raises(ParameterError, match="has no position"):
        from_movement(xr.Dataset({"speed": ("time", [1.0, 2.0])}))
    boxes = to_movement(motion).assign_coords(space=["u", "v", "w"])
    with pytest.raises(ParameterError, match="space must be x, y and optionally z, not u, v, w"):
        from_movement(boxes)
    with pytest.raises(ParameterError, match="the segments have 2898 frames"):
        to_movement(motion, kineme.read_segments(bundled_recording().with_suffix(".json")))


def test_movement_takes_our_datasets_and_we_take_its_own(motion) -> None:
    pytest.importorskip("movement", reason="not installed: pip install movement")
    from movement.io import load_poses
    from movement.kinematics import compute_velocity
    from movement.validators.datasets import ValidPosesInputs

    dataset = to_movement(motion)
    ValidPosesInputs.validate(dataset)
    speed = compute_velocity(dataset["position"])
    assert speed.shape == dataset["position"].shape
    theirs = load_poses.from_numpy(
        motion.positions.transpose(0, 2, 1)[..., None],
        np.ones((motion.n_frames, motion.skeleton.n_joints, 1)),
        keypoint_names=list(motion.skeleton.names),
        fps=motion.fps,
        source_software="test",
    )
    back = from_movement(theirs, unit="m", up="y")
    name = motion.skeleton.names[3]
    assert np.array_equal(back.positions[:, back.joint(name)], motion.positions[:, 3])
    assert theirs["position"].equals(dataset["position"])
