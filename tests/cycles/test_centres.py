"""Knees without markers are where thigh and shank turn about each other."""

from __future__ import annotations

from itertools import product
from pathlib import Path

import numpy as np
import pytest
from posed_figures import find_recording, pose_figure

import kineme
from kineme._util import rotations as rot
from kineme.cycles import channels_of
from kineme.datasets import Action, synthesize
from kineme.formats.files import load
from kineme.formats.markers.c3d_file import parse_c3d
from kineme.recordings import Motion, Skeleton
from kineme.recordings.kinematics import compute_world_rotations

CLUSTER = [(0.08, -0.1, 0.02), (0.06, -0.2, -0.05), (0.09, -0.3, 0.04)]
Points = dict[str, tuple[str, tuple[float, float, float]]]
"""Joint of each marker, and its offset from that in metres."""


def place_points(motion: Motion, points: Points, noise: float = 0.0) -> Motion:
    """Return markers that are fixed to joints of a figure, without its rotations."""
    turned = compute_world_rotations(motion.skeleton, motion.rotations)
    joints = [motion.skeleton.joint(joint) for joint, _ in points.values()]
    offsets = np.array([offset for _, offset in points.values()])
    positions = motion.positions[:, joints] + rot.rotate(turned[:, joints], offsets)
    positions = positions + noise * np.random.default_rng(1).normal(size=positions.shape)
    parents = [-1, *[0] * (len(points) - 1)]
    skeleton = Skeleton(tuple(points), parents, np.zeros((len(points), 3)))
    return Motion(skeleton, positions, motion.fps)


def place_markers(motion: Motion, noise: float = 0.0) -> Motion:
    """Hips, ankles, toes and shoulders of a figure, and three markers on each thigh and shank."""
    points: Points = {"pelvis": ("Hips", (0, 0, 0))}
    for side, outwards in (("Left", 1), ("Right", -1)):
        for name, joint in (("hip", "UpLeg"), ("ankle", "Foot"), ("toe", "ToeBase"),
                            ("shoulder", "Arm")):  # fmt: skip
            points[f"{side.lower()}_{name}"] = f"{side}{joint}", (0, 0, 0)
        for body, joint in (("Thigh", "UpLeg"), ("Shank", "Leg")):
            for n, (x, y, z) in enumerate(CLUSTER):
                points[f"{side}{body}{n}"] = f"{side}{joint}", (outwards * x, y, z)
    return place_points(motion, points, noise)


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


def place_skin_markers(motion: Motion, more: Points | None = None) -> Motion:
    """Centres of hips of a figure, and markers beside thighs, knees and ankles, on its skin."""
    points: Points = {"pelvis": ("Hips", (0, 0, 0))}
    for side, outwards in (("Left", 1), ("Right", -1)):
        for name, joint, (x, y, z) in (
            ("HJC", "UpLeg", (0, 0, 0)),
            ("THI", "UpLeg", (0.1, -0.2, -0.03)),
            ("KNE", "Leg", (0.06, 0, 0)),
            ("ANK", "Leg", (0.05, -0.4, 0)),
        ):
            points[f"{side[0]}{name}"] = f"{side}{joint}", (outwards * x, y, z)
    return place_points(motion, points | (more or {}))


@pytest.mark.parametrize("spread", [0.0, 25.0])
def test_a_marker_beside_the_knee_does_not_bend_a_straight_leg(spread: float) -> None:
    true = 25 - 35 * np.cos(np.linspace(0, 4 * np.pi, 200))  # from -10, bent the other way, to 60
    motion = pose_figure(left_knee=true, right_knee=true, left_spread=np.array([spread]))
    found = channels_of(place_skin_markers(motion), ["knee_l"])[0].values()
    assert np.sqrt(np.mean((found - true) ** 2)) < 2
    assert np.ptp(found) == pytest.approx(70, abs=2)


def test_a_knee_that_hardly_moves_is_bent_about_the_line_of_the_hips() -> None:
    still = place_skin_markers(pose_figure(left_knee=np.full(50, -8.0)))
    np.testing.assert_allclose(channels_of(still, ["knee_l"])[0].values(), -8, atol=1.5)


def test_a_pelvis_with_markers_gives_hips_without_a_trunk() -> None:
    true = 20 * np.sin(np.linspace(0, 4 * np.pi, 200)) + 10
    tilt = 15 * np.cos(np.linspace(0, 2 * np.pi, 200))
    motion = pose_figure(left_hip=true, left_knee=true + 30, tilt=tilt)
    pelvis = {"LASI": (0.12, 0.05, 0.1), "RASI": (-0.12, 0.05, 0.1),
              "LPSI": (0.05, 0.05, -0.1), "RPSI": (-0.05, 0.05, -0.1)}  # fmt: skip
    skin = place_skin_markers(motion, {name: ("Hips", at) for name, at in pelvis.items()})
    found = channels_of(skin, ["hip_l"])[0]
    assert found.source.startswith("against the pelvis")
    assert np.sqrt(np.mean((found.values() - true) ** 2)) < 2


def test_knees_and_hips_of_walks_are_those_of_plug_in_gait(data_dir: Path) -> None:
    """All walks, and ankles, too: a benchmark."""
    for name in ("HC030A05", "HC038A11"):
        path = find_recording(data_dir, f"gait/overground/{name}.c3d")
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
