"""A human figure posed by joint angles.

It has 22 joints and five end sites with names that are common in BVH files, and a T-pose at rest.
Segment lengths follow the proportions in D. A. Winter, Biomechanics and Motor Control of Human
Movement (fig. 4.1).

Angles are in degrees; if all are zero, the figure stands upright with hanging arms:

========== =====================================================================
tilt       pelvis forward; ``list`` to the right, ``yaw`` to the left
bend       spine forward; ``lean`` to the right, ``twist`` to the left
nod        head forward; ``look`` to the left
hip        thigh forward; ``spread`` sideways
knee       shin back
foot       toes up, against the floor, whatever the leg does; ``toe`` the toes alone
swing      arm forward and up; ``raise`` sideways; ``roll`` inwards about itself
elbow      forearm forward
========== =====================================================================

The rows from ``hip`` on exist for each side: "left hip", "right hip".
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from kineme._util import rotations as rot
from kineme._util.arrays import Floats
from kineme.recordings import Skeleton

MIDDLE = ("tilt", "list", "yaw", "bend", "lean", "twist", "nod", "look")
LIMBS = ("hip", "spread", "knee", "foot", "toe", "swing", "raise", "roll", "elbow")
SIDES = ("left", "right")
ANGLES = MIDDLE + tuple(f"{side} {limb}" for side in SIDES for limb in LIMBS)

# Joint, parent, offset in metres for a body height of 1.75 m (left side).
_HEIGHT = 1.75
_TOES_OUT = np.radians(7.0)
_TRUNK = (
    ("Hips", None, (0.0, 0.98, 0.0)),
    ("Spine", "Hips", (0.0, 0.10, 0.0)),
    ("Spine1", "Spine", (0.0, 0.14, 0.0)),
    ("Neck", "Spine1", (0.0, 0.24, 0.0)),
    ("Head", "Neck", (0.0, 0.10, 0.01)),
    ("Head_end", "Head", (0.0, 0.19, 0.0)),
)
_LIMBS = (
    ("Shoulder", "Spine1", (0.03, 0.18, 0.0)),
    ("Arm", "Shoulder", (0.15, 0.02, 0.0)),
    ("ForeArm", "Arm", (0.30, 0.0, 0.0)),
    ("Hand", "ForeArm", (0.26, 0.0, 0.0)),
    ("Hand_end", "Hand", (0.17, 0.0, 0.0)),
    ("UpLeg", "Hips", (0.09, -0.05, 0.0)),
    ("Leg", "UpLeg", (0.0, -0.43, 0.0)),
    ("Foot", "Leg", (0.0, -0.42, 0.0)),
    ("ToeBase", "Foot", (0.0, -0.06, 0.13)),
    ("ToeBase_end", "ToeBase", (0.0, 0.0, 0.07)),
)


def make_figure(size: float = _HEIGHT) -> Skeleton:
    """Return the skeleton of a person ``size`` metres tall."""
    rows: list[tuple[str, str | None, tuple[float, float, float]]] = list(_TRUNK)
    for side, sign in zip(SIDES, (1.0, -1.0), strict=True):
        name = side.capitalize()
        for joint, parent, (x, y, z) in _LIMBS:
            parent_name = parent if parent in {"Hips", "Spine1"} else name + parent
            rows.append((name + joint, parent_name, (sign * x, y, z)))
    names = [name for name, _, _ in rows]
    return Skeleton(
        tuple(names),
        tuple(-1 if parent is None else names.index(parent) for _, parent, _ in rows),
        np.array([offset for _, _, offset in rows]) * size / _HEIGHT,
        frozenset(i for i, name in enumerate(names) if name.endswith("_end")),
    )


def compute_joint_rotations(
    skeleton: Skeleton, angles: Mapping[str, Floats], heading: Floats
) -> Floats:
    """Return joint rotations (frames, joints, 4) from degrees (frames,) for each of ``ANGLES``.

    ``heading`` is the direction of the figure in degrees: 0 is +z, 90 is +x.
    """
    a = {name: np.radians(values) for name, values in angles.items()}
    facing = np.radians(heading)
    rotations = np.tile(rot.IDENTITY, (len(facing), skeleton.n_joints, 1))
    local: dict[str, Floats] = {
        "Hips": _from_euler("yxz", facing + a["yaw"], a["tilt"], a["list"]),
        "Spine": _from_euler("yxz", 0.5 * a["twist"], 0.5 * a["bend"], 0.5 * a["lean"]),
        "Spine1": _from_euler("yxz", 0.5 * a["twist"], 0.5 * a["bend"], 0.5 * a["lean"]),
        "Neck": _from_euler("yx", 0.4 * a["look"], 0.4 * a["nod"]),
        "Head": _from_euler("yx", 0.6 * a["look"], 0.6 * a["nod"]),
    }
    for side, sign in zip(SIDES, (1.0, -1.0), strict=True):
        hip, spread, knee, foot, toe, swing, lift, roll, elbow = (a[f"{side} {x}"] for x in LIMBS)
        thigh = _from_euler("xz", -hip, sign * spread)
        # Local rotations of hip and knee follow from plain angles.
        shin = _from_euler("x", knee)
        # The foot's angle is relative to the floor, so the leg's rotation is removed.
        leg = rot.multiply(rot.multiply(local["Hips"], thigh), shin)
        sole = _from_euler("yx", facing + sign * _TOES_OUT, -foot)
        of_side = {
            "Arm": _from_euler("xzx", -swing, sign * (lift - np.pi / 2), roll),
            "ForeArm": _from_euler("y", -sign * elbow),
            "UpLeg": thigh,
            "Leg": shin,
            "Foot": rot.multiply(rot.conjugate(leg), sole),
            "ToeBase": _from_euler("x", -toe),
        }
        local |= {side.capitalize() + joint: turned for joint, turned in of_side.items()}
    for joint, turned in local.items():
        rotations[:, skeleton.joint(joint)] = turned
    return rotations


def _from_euler(axes: str, *radians: Floats) -> Floats:
    return rot.from_euler(np.stack(radians, axis=1), axes)
