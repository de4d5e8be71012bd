"""Knees without markers are where thigh and shank turn about each other."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import kineme
from kineme import _rotations as rot
from kineme.cycles import channels_of, landmarks
from kineme.cycles.centres import with_centres
from kineme.datasets import Action, synthesize
from kineme.recordings import Motion, Skeleton
from kineme.recordings.kinematics import world_rotations

CLUSTER = np.array([[0.08, -0.1, 0.02], [0.06, -0.2, -0.05], [0.09, -0.3, 0.04]])


def markers(motion: Motion, noise: float = 0.0) -> Motion:
    """Hips, ankles, toes and shoulders of a figure, and three markers on each thigh and shank."""
    turned = world_rotations(motion.skeleton, motion.rotations)
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
        found = channels_of(markers(motion, noise), [channel])[0]
        assert "centre of" in found.source
        assert np.sqrt(np.mean((found.values() - true) ** 2)) < most


def test_a_knee_that_is_not_bent_has_no_centre() -> None:
    motion = synthesize([Action("walk", 4)], fps=60, seed=2).motion
    still = markers(motion)[:5]
    assert not any(channel.name.startswith("knee") for channel in channels_of(still))


def test_a_body_that_has_knees_stays_as_it_is() -> None:
    motion = synthesize([Action("walk", 2)], fps=60, seed=2).motion
    assert with_centres(motion, landmarks(motion))[0] is motion


def test_a_walk_agrees_with_opensim(data_dir: Path) -> None:
    """All angles, and by how much: a benchmark."""
    walk = data_dir / "formats" / "subject01_walk.trc"
    angles = kineme.read(walk.with_name("subject01_walk_IK.mot"))
    for side in "lr":
        found = channels_of(kineme.read(walk), [f"knee_{side}"])[0].values()
        apart = found + angles.values[:, angles.names.index(f"knee_angle_{side}")]
        assert np.sqrt(np.mean(apart**2)) < 4.5
