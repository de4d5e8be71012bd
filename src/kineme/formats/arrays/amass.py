"""Read AMASS and other npz files with SMPL poses, on a skeleton of average proportions.

``poses`` (frames, 72, 156 or 165) are rotation vectors of the joints of SMPL, SMPL-H or SMPL-X;
``trans`` (frames, 3) is the position of the body. The 22 joints common to all three are used;
hands, jaw and eyes are left out. No body model is needed: bones have average lengths for a height
of 1.70 m instead of the person's. Positions therefore differ by build, and the pelvis by about
0.2 m in height, which affects no feature.

AMASS has z up and bodies at rest along y. Its files are turned accordingly; ``up`` overrides this.

Source: joint order of N. Mahmood et al., "AMASS", ICCV 2019; bone lengths from the shares of height
in D. A. Winter, "Biomechanics and Motor Control of Human Movement", 4th ed. 2009, figure 4.1.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from kineme._util import rotations as rot
from kineme._util.arrays import Floats
from kineme.formats.files import FileContent
from kineme.formats.options import ReadOptions
from kineme.formats.units import make_up_rotation, to_metres
from kineme.recordings import Motion, Skeleton

WIDTHS = {72: "SMPL", 156: "SMPL-H", 165: "SMPL-X"}
"""Body models by the number of values per frame."""

# Name, parent, offset in metres in a T-pose: y up, facing z, the left at x.
_JOINTS: tuple[tuple[str, str | None, tuple[float, float, float]], ...] = (
    ("pelvis", None, (0, 0, 0)),
    ("left_hip", "pelvis", (0.09, -0.06, 0)),
    ("right_hip", "pelvis", (-0.09, -0.06, 0)),
    ("spine1", "pelvis", (0, 0.11, -0.02)),
    ("left_knee", "left_hip", (0, -0.417, 0)),
    ("right_knee", "right_hip", (0, -0.417, 0)),
    ("spine2", "spine1", (0, 0.13, 0)),
    ("left_ankle", "left_knee", (0, -0.418, 0)),
    ("right_ankle", "right_knee", (0, -0.418, 0)),
    ("spine3", "spine2", (0, 0.06, 0)),
    ("left_foot", "left_ankle", (0, -0.05, 0.13)),
    ("right_foot", "right_ankle", (0, -0.05, 0.13)),
    ("neck", "spine3", (0, 0.21, 0)),
    ("left_collar", "spine3", (0.07, 0.11, 0)),
    ("right_collar", "spine3", (-0.07, 0.11, 0)),
    ("head", "neck", (0, 0.09, 0.02)),
    ("left_shoulder", "left_collar", (0.12, 0.02, 0)),
    ("right_shoulder", "right_collar", (-0.12, 0.02, 0)),
    ("left_elbow", "left_shoulder", (0.316, 0, 0)),
    ("right_elbow", "right_shoulder", (-0.316, 0, 0)),
    ("left_wrist", "left_elbow", (0.248, 0, 0)),
    ("right_wrist", "right_elbow", (-0.248, 0, 0)),
    ("head_end", "head", (0, 0.18, 0)),
)
_AMASS_RATES = ("mocap_frame_rate", "mocap_framerate", "fps", "frame_rate", "framerate")
_N_TURNING = len(_JOINTS) - 1


def poses_to_motion(
    content: FileContent, arrays: Mapping[str, Any], options: ReadOptions
) -> Motion:
    """Return the motion of the body described by ``poses`` and ``trans``."""
    poses = _check_arrays(content, arrays, "poses")
    if poses.shape[1] not in WIDTHS:
        raise content.error(
            f"poses have {poses.shape[1]} values per frame, not "
            f"{', '.join(f'{n} ({name})' for n, name in WIDTHS.items())}"
        )
    path = np.zeros((len(poses), 3))
    if "trans" in arrays:
        path = _check_arrays(content, arrays, "trans")
    if path.shape != (len(poses), 3):
        raise content.error(f"trans has shape {path.shape}, not ({len(poses)}, 3)")
    vectors = poses[:, : 3 * _N_TURNING].reshape(len(poses), _N_TURNING, 3)
    rotations = np.zeros((len(poses), len(_JOINTS), 4))
    # The crown is an end site without rotation.
    rotations[:, -1] = rot.IDENTITY
    rotations[:, :-1] = rot.from_rotation_vectors(vectors)
    turn = make_up_rotation(options.up or "z")
    # Only the root is turned, since all others are relative to their parents.
    rotations[:, 0] = rot.multiply(turn, rotations[:, 0])
    path = rot.rotate(turn, path * to_metres(options.unit or "m"))
    kind = WIDTHS[poses.shape[1]]
    notes = [f"{kind} poses on a skeleton of average lengths, 1.70 m tall; hands and face left out"]
    if options.up is None:
        notes.append("up axis z, as in AMASS, assumed")
    return Motion.from_rotations(
        make_smpl_skeleton(),
        rotations,
        options.fps or find_rate(content, arrays, _AMASS_RATES),
        path,
        provenance=content.provenance("AMASS", notes),
    )


def make_smpl_skeleton() -> Skeleton:
    """Return the joints shared by SMPL, SMPL-H and SMPL-X, at average lengths, and a crown."""
    names = tuple(name for name, _, _ in _JOINTS)
    parents = tuple(-1 if parent is None else names.index(parent) for _, parent, _ in _JOINTS)
    offsets = np.array([offset for _, _, offset in _JOINTS])
    return Skeleton(names, parents, offsets, frozenset({len(names) - 1}))


def _check_arrays(content: FileContent, arrays: Mapping[str, Any], name: str) -> Floats:
    array = arrays[name]
    if array.dtype.kind not in "iuf" or array.ndim != 2 or len(array) == 0:
        raise content.error(
            f"{name} are {array.dtype} of shape {array.shape}, not (frames, values)"
        )
    values = np.asarray(array, np.float64)
    if not np.isfinite(values).all():
        raise content.error(f"{name} hold values that are not finite (NaN or infinite)")
    return values


def find_rate(content: FileContent, arrays: Mapping[str, Any], names: Sequence[str]) -> float:
    """Return the frame rate stored under the first of the names that holds one."""
    for name in names:
        if name in arrays and arrays[name].size == 1 and arrays[name].dtype.kind in "iuf":
            rate = float(arrays[name].item())
            if np.isfinite(rate) and rate > 0:
                return rate
    raise content.error(f"no {names[0]!r} in it: give fps= (--fps)")
