"""Knees without markers are where thigh and shank turn about each other."""

from __future__ import annotations

from itertools import product
from pathlib import Path

import numpy as np
import pytest
from posed_figures import pose_figure

import kineme
from kineme._util import rotations as rot
from kineme.cycles import channels_of
from kineme.datasets import Action, synthesize
from kineme.formats.files import load
from kineme.formats.markers.c3d_file import parse_c3d
from kineme.recordings import Motion, Skeleton
from kineme.recordings.kinematics import compute_world_rotations

CLUSTER = np.array([[0.08, -0.1, 0.02], [0.06, -0.2, -0.05], [0.09, -0.3, 0.04]])


def place_markers(motion: Motion, noise: float = 0.0) -> Motion:
    """Hips, ankles, toes and shoulders of a figure, and three markers on each thigh and shank."""
    turned = compute_world_rotations(motion.skeleton, motion.rotations)
    places: dict[str, np.ndarray] = {"pelvis": motion.positions[:, 0]}
    for side in ("Left", "Right"):
        for name, joint in (("hip", "UpLeg"), ("ankle", "Foot"), ("toe", "ToeBase"),
                            ("shoulder", "Arm")):  # fmt: skip
            joint = motion.skeleton.joint(f"{side}{joint}")
            places[f"{side.lower()}_{name}"] = motion.positions[:, joint]
        for body, joint in (("Thigh", "UpLeg"), ("Shank", "Leg")):
            j = motion.skeleton.joint(f"{side}{joint}")
            for n, offset in enumerate(CLUSTER * [1 if side == "Left" else -1, 1, 1]):
                at = rot.rotate(turned[:, j], np.broadcast_to(offset, (motion.n_frames, 3)))
                places[f"{side}{body}{n}"] = motion.positions[:, j] + at
    positions = np.stack([*places.values()], axis=1)
    positions = positions + noise * np.random.default_rng(1).normal(size=positions.shape)
    parents = [-1, *[0] * (len(places) - 1)]
    skeleton = Skeleton(tuple(places), parents, np.zeros((len(places), 3)))
    return Motion(skeleton, positions, motion.fps)


@pytest.mark.parametrize(("noise", "most"), [(0.0, 2.0), (0.003, 3.0)])
@pytest.mark.parametrize("name", ["walk", "squat"])
def test_angles_are_those_of_the_figure(name: str, noise: float, most: float) -> None:
    motion = synthesize([Action(name, 4)], fps=60, seed=2).motion
    for channel in ("knee_l", "knee_r", "ankle_l"):
        true = channels_of(motion, [channel])[0].values()
        found = channels_of(place_markers(motion, noise), [channel])[0]
        assert "centre of" in found.source
        assert np.sqrt(np.mean((found.values() - true) ** 2)) < most


def test_a_knee_that_is_not_bent_has_no_centre() -> None:
    motion = synthesize([Action("walk", 4)], fps=60, seed=2).motion
    still = place_markers(motion)[:5]
    assert not any(channel.name.startswith("knee") for channel in channels_of(still))


def place_skin_markers(motion: Motion) -> Motion:
    """Centres of hips of a figure, and markers beside thighs, knees and ankles, on its skin."""
    turned = compute_world_rotations(motion.skeleton, motion.rotations)
    places: dict[str, np.ndarray] = {"pelvis": motion.positions[:, 0]}
    for side, outwards in (("Left", 1), ("Right", -1)):
        for name, joint, offset in (
            ("HJC", "UpLeg", (0, 0, 0)),
            ("THI", "UpLeg", (0.1, -0.2, -0.03)),
            ("KNE", "Leg", (0.06, 0, 0)),
            ("ANK", "Leg", (0.05, -0.4, 0)),
        ):
            j = motion.skeleton.joint(f"{side}{joint}")
            local = np.broadcast_to(np.array(offset) * [outwards, 1, 1], (motion.n_frames, 3))
            places[f"{side[0]}{name}"] = motion.positions[:, j] + rot.rotate(turned[:, j], local)
    skeleton = Skeleton(tuple(places), [-1, *[0] * (len(places) - 1)], np.zeros((len(places), 3)))
    return Motion(skeleton, np.stack([*places.values()], axis=1), motion.fps)


@pytest.mark.parametrize("spread", [0.0, 25.0])
def test_a_marker_beside_the_knee_does_not_bend_a_straight_leg(spread: float) -> None:
    true = 25 - 35 * np.cos(np.linspace(0, 4 * np.pi, 200))  # from -10, bent the other way, to 60
    motion = pose_figure(left_knee=true, right_knee=true, left_spread=np.array([spread]))
    found = channels_of(place_skin_markers(motion), ["knee_l"])[0].values()
    assert np.sqrt(np.mean((found - true) ** 2)) < 2
    assert np.ptp(found) == pytest.approx(70, abs=2)


def test_a_knee_that_hardly_moves_is_bent_about_the_line_of_the_hips() -> None:
    found = channels_of(place_skin_markers(pose_figure(left_knee=np.full(50, -8.0))), ["knee_l"])[
        0
    ].values()
    np.testing.assert_allclose(found, -8, atol=1.5)


def test_a_pelvis_with_markers_gives_hips_without_a_trunk() -> None:
    true = 20 * np.sin(np.linspace(0, 4 * np.pi, 200)) + 10
    tilt = 15 * np.cos(np.linspace(0, 2 * np.pi, 200))
    motion = pose_figure(left_hip=true, left_knee=true + 30, tilt=tilt)
    skin = place_skin_markers(motion)
    turned = compute_world_rotations(motion.skeleton, motion.rotations)[:, 0]
    offsets = {"LASI": (0.12, 0.05, 0.1), "RASI": (-0.12, 0.05, 0.1),
               "LPSI": (0.05, 0.05, -0.1), "RPSI": (-0.05, 0.05, -0.1)}  # fmt: skip
    at = [motion.positions[:, 0] + rot.rotate(turned, np.broadcast_to(offset, (200, 3)))
          for offset in offsets.values()]  # fmt: skip
    names = (*skin.skeleton.names, *offsets)
    skeleton = Skeleton(names, [-1, *[0] * (len(names) - 1)], np.zeros((len(names), 3)))
    positions = np.concatenate([skin.positions, np.stack(at, axis=1)], axis=1)
    found = channels_of(Motion(skeleton, positions, skin.fps), ["hip_l"])[0]
    assert found.source.startswith("against the pelvis")
    assert np.sqrt(np.mean((found.values() - true) ** 2)) < 2


def test_knees_and_hips_of_walks_are_those_of_plug_in_gait(data_dir: Path) -> None:
    """All walks, and ankles, too: a benchmark."""
    folder = data_dir / "gait" / "overground"
    if not folder.is_dir():
        pytest.skip("no gait/overground among the recordings")
    for name in ("HC030A05", "HC038A11"):
        path = folder / f"{name}.c3d"
        file = parse_c3d(load(path))
        for side, joint in product("LR", ("Knee", "Hip")):
            true = file.points[:, file.labels.index(f"{side}{joint}Angles"), 0]
            found = channels_of(kineme.read(path), [f"{joint.lower()}_{side.lower()}"])[0].values()
            assert np.ptp(found) == pytest.approx(np.ptp(true), abs=4)
            assert np.sqrt(np.mean((found - true) ** 2)) < 4


def test_a_walk_agrees_with_opensim(data_dir: Path) -> None:
    """All angles, and by how much: a benchmark."""
    walk = data_dir / "formats" / "subject01_walk.trc"
    angles = kineme.read(walk.with_name("subject01_walk_IK.mot"))
    for side in "lr":
        found = channels_of(kineme.read(walk), [f"knee_{side}"])[0].values()
        apart = found + angles.values[:, angles.names.index(f"knee_angle_{side}")]
        assert np.sqrt(np.mean(apart**2)) < 4.5
