"""Write a database for motion matching with the published features of each frame, and poses.

Data is at 60 Hz, in metres with y up. A root bone is added above the skeleton, with the smoothed
floor position and heading of the hips. Relative to it, a frame has 27 features: position and
velocity of both ankles, velocity of the hips, and position and direction of the root bone in 20, 40
and 60 frames. These may lie after the end of the clip in its recording. To compare frames, subtract
``features_offset`` and divide by ``features_scale``, which includes the published weights.

``.npz`` holds features, poses, foot contacts and the named ranges of clips. ``.bin`` holds poses,
ranges and contacts in the format of the public example, which expects the bones of LAFAN1.

Source: Holden, Kanoun, Perepichka, Popa, "Learned Motion Matching", SIGGRAPH 2020, section 3;
``database.bin`` of https://github.com/orangeduck/Motion-Matching.
"""

from __future__ import annotations

import struct
from collections.abc import Iterable, Sequence
from os import PathLike
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from kineme._util import rotations as rot
from kineme._util.arrays import Floats
from kineme._util.files import atomic_write
from kineme.clips.shaping import find_planted_feet
from kineme.errors import EndEffectorError, MotionError, ParameterError
from kineme.features import compute_heading, end_effectors
from kineme.recordings import Motion
from kineme.recordings.arrays import to_samples
from kineme.recordings.kinematics import compute_local_translations
from kineme.recordings.operations import resample
from kineme.segments.table import Segment

RATE = 60.0
"""Frames per second."""
AHEAD = (20, 40, 60)
"""Frames ahead at which the trajectory is sampled."""
SMOOTH_PLACE, SMOOTH_FACING = 31, 61
"""Window lengths in frames for smoothing the root bone by cubic polynomials."""
GROUPS = (
    *((f"{side}_foot_position", 3, 0.75) for side in ("left", "right")),
    *((f"{side}_foot_velocity", 3, 1.0) for side in ("left", "right")),
    ("hips_velocity", 3, 1.0),
    ("trajectory_position", 6, 1.0),
    ("trajectory_direction", 6, 1.5),
)
"""Name, size and weight of each group of features."""
SUFFIXES = (".npz", ".bin")
Range = tuple[str, Segment, Sequence[str]]
"""Name of a clip, its segment, and its tags."""
LAYOUT = (
    *("bone_positions", "bone_velocities", "bone_rotations", "bone_angular_velocities"),
    *("bone_parents", "range_starts", "range_stops", "contact_states"),
)
"""Order of the little-endian arrays in a ``.bin``."""


class Database:
    """Collects clips of recordings with one skeleton; `write` saves them."""

    def __init__(self) -> None:
        self.skeleton: tuple[Any, ...] = ()
        self.parts: list[dict[str, NDArray[Any]]] = []
        self.ranges: list[tuple[str, Sequence[str], int, int]] = []

    def add(self, motion: Motion, ranges: Iterable[Range]) -> None:
        """Add clips of a recording.

        Raises
        ------
        ParameterError
            The recording has no rotations or feet, or other bones than the first one.
        """
        # End sites are dropped, and bone 0 is the root, so joints are renumbered.
        bones = [j for j in range(motion.skeleton.n_joints) if j not in motion.skeleton.end_sites]
        numbers = {joint: bone for bone, joint in enumerate(bones, 1)}
        parents = tuple(numbers.get(motion.skeleton.parents[joint], 0) for joint in bones)
        skeleton = ("root", *(motion.skeleton.names[j] for j in bones)), (-1, *parents)
        if motion.rotations is None or (self.skeleton or skeleton) != skeleton:
            lacks = (
                "other bones than the previous motion" if motion.rotations is not None else "points"
            )
            raise ParameterError(
                f"motion_matching needs rotations of one skeleton, {motion.provenance.path} has "
                f"{lacks}"
            )
        self.skeleton = skeleton
        described = _describe_motion(resample(motion, RATE), bones)
        ratio, n = RATE / motion.fps, len(described["features"])
        at = self.ranges[-1][3] if self.ranges else 0
        for name, row, tags in ranges:
            start, stop = to_samples((row.start_frame, row.stop_frame), ratio, n)
            self.parts.append({key: part[start:stop] for key, part in described.items()})
            self.ranges.append((name, tags, at, at + stop - start))
            at += stop - start

    def write(self, path: str | PathLike[str]) -> None:
        """Write all clips; raise ParameterError if there are none."""
        if not self.parts:
            raise ParameterError("there is no clip for motion_matching")
        arrays = {key: np.concatenate([part[key] for part in self.parts]) for key in self.parts[0]}
        names, tags, starts, stops = zip(*self.ranges, strict=True)
        bone_names, parents = self.skeleton
        arrays |= {
            "bone_parents": np.array(parents, np.int32),
            "range_starts": np.array(starts, np.int32),
            "range_stops": np.array(stops, np.int32),
        }
        with atomic_write(path) as draft, draft.open("wb") as file:
            if Path(path).suffix.lower() == ".bin":
                for key in LAYOUT:
                    # The shape precedes each array, without the dimension of vector components.
                    shape = arrays[key].shape[:2]
                    file.write(struct.pack(f"<{len(shape)}I", *shape) + arrays[key].tobytes())
                return
            offset, scale = _compute_normalization(arrays["features"])
            feature_names = [f"{name}_{i}" for name, size, _ in GROUPS for i in range(size)]
            arrays |= {
                "features_offset": offset,
                "features_scale": scale,
                "feature_names": np.array(feature_names),
                "bone_names": np.array(bone_names),
                "range_names": np.array(names),
                "range_tags": np.array([", ".join(each) for each in tags]),
                "fps": np.array(RATE),
            }
            np.savez_compressed(file, allow_pickle=False, **arrays)


def _describe_motion(motion: Motion, bones: Sequence[int]) -> dict[str, NDArray[Any]]:
    """Return features, poses and contacts of each frame; float32 except for contacts."""
    try:
        ends = end_effectors(motion)
        pelvis, angles = compute_heading(motion, effectors=ends)
    except (EndEffectorError, MotionError) as error:
        raise ParameterError(f"motion_matching needs a body: {error}") from error
    place = _smooth(motion.positions[:, pelvis] * [1.0, 0.0, 1.0], SMOOTH_PLACE)
    facing = _smooth(np.stack([np.sin(angles), np.cos(angles)], axis=1), SMOOTH_FACING)
    turn = rot.rotate_about_y(np.arctan2(facing[:, 0], facing[:, 1]))
    back = rot.conjugate(turn)
    skeleton, rotations = motion.skeleton, np.array(motion.rotations)
    places = compute_local_translations(skeleton, motion.positions, motion.rotations)
    # Former roots become children of the new root bone.
    for joint in (j for j, parent in enumerate(skeleton.parents) if parent < 0):
        places[:, joint] = rot.rotate(back, motion.positions[:, joint] - place)
        rotations[:, joint] = rot.multiply(back, rotations[:, joint])
    places = np.concatenate([place[:, None], places[:, bones]], axis=1)
    rotations = np.concatenate([turn[:, None], rotations[:, bones]], axis=1)
    feet = find_planted_feet(motion)
    contacts = [feet[side][1] if side in feet else np.zeros(len(turn), bool) for side in
                ("left", "right")]  # fmt: skip
    arrays = {
        "features": _compute_features(
            motion, (ends.left_ankle, ends.right_ankle), pelvis, place, turn
        ),
        "bone_positions": places,
        "bone_velocities": _compute_velocities(places),
        "bone_rotations": rotations,
        "bone_angular_velocities": _compute_angular_velocities(rotations),
    }
    described: dict[str, NDArray[Any]] = {key: part.astype("<f4") for key, part in arrays.items()}
    return described | {"contact_states": np.stack(contacts, axis=1).astype(np.uint8)}


def _compute_features(
    motion: Motion, feet: tuple[int, int], pelvis: int, place: Floats, turn: Floats
) -> Floats:
    """Return the features (frames, 27), in the order of `GROUPS`."""
    back, n = rot.conjugate(turn), motion.n_frames
    velocities = _compute_velocities(motion.positions)
    parts = [rot.rotate(back, motion.positions[:, foot] - place) for foot in feet]
    parts += [rot.rotate(back, velocities[:, joint]) for joint in (*feet, pelvis)]
    # Frames ahead of each frame, clamped to the last one.
    then = [np.minimum(np.arange(n) + ahead, n - 1) for ahead in AHEAD]
    forward = rot.rotate(turn, np.array([0.0, 0.0, 1.0]))
    parts += [rot.rotate(back, place[at] - place)[:, [0, 2]] for at in then]
    parts += [rot.rotate(back, forward[at])[:, [0, 2]] for at in then]
    return np.concatenate(parts, axis=1)


def _compute_normalization(features: NDArray[Any]) -> tuple[NDArray[Any], NDArray[Any]]:
    """Return means, and the mean deviation of each group divided by its weight, (27,) each."""
    deviations, scale, at = features.std(axis=0), np.empty(features.shape[1], np.float32), 0
    for _, size, weight in GROUPS:
        # A constant group has no deviation; any scale will do.
        scale[at : at + size] = (float(deviations[at : at + size].mean()) or 1.0) / weight
        at += size
    return features.mean(axis=0), scale


def _smooth(values: Floats, window: int) -> Floats:
    """Smooth values (frames, dims) with a Savitzky-Golay filter of degree 3."""
    from scipy.signal import savgol_filter  # heavy, and seldom needed

    # The longest odd window that fits; cubic polynomials need at least 5 frames.
    window = min(window, len(values) - 1 + len(values) % 2)
    smoothed: Floats = values if window < 5 else savgol_filter(values, window, 3, axis=0)
    return smoothed


def _compute_velocities(places: Floats) -> Floats:
    """Return central differences per second."""
    return np.gradient(places, axis=0) * RATE if len(places) > 1 else np.zeros_like(places)


def _compute_angular_velocities(rotations: Floats) -> Floats:
    """Return rotation vectors per second, in the axes of the parent, (frames, bones, 3)."""
    if len(rotations) < 2:
        return np.zeros((*rotations.shape[:2], 3))
    steps = (
        rot.to_rotation_vectors(rot.multiply(rotations[1:], rot.conjugate(rotations[:-1]))) * RATE
    )
    # Average the steps before and after a frame; the ends have only one.
    before, after = np.concatenate([steps[:1], steps]), np.concatenate([steps, steps[-1:]])
    mean: Floats = (before + after) / 2
    return mean
