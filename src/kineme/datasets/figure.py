"""Pose a human figure by joint angles, which actions define over a cycle.

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

A cycle of an action is one repetition: a stride, a jump, a squat, a kick, a full circle of the
arms, a punch, a wave to and fro. Angles are given at a few phases (fractions of the cycle) and
interpolated by monotone cubics. An angle without a side applies to both; in gaits the right side
lags by half a cycle. Missing angles are those of standing.

Hip, knee and foot angles of walking and running follow the curves of gait
analysis (Winter 1991; Novacheck, Gait and Posture 7, 1998), read off at every
tenth of the cycle from the strike of the left heel.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.interpolate import PchipInterpolator

from kineme._util import rotations as rot
from kineme._util.arrays import Floats
from kineme.recordings import Skeleton

MIDDLE = ("tilt", "list", "yaw", "bend", "lean", "twist", "nod", "look")
LIMBS = ("hip", "spread", "knee", "foot", "toe", "swing", "raise", "roll", "elbow")
SIDES = ("left", "right")
ANGLES = MIDDLE + tuple(f"{side} {limb}" for side in SIDES for limb in LIMBS)
_SIDEWAYS = frozenset({"list", "yaw", "lean", "twist", "look"})
STANDING = dict.fromkeys(ANGLES, 0.0) | {
    f"{side} {limb}": angle
    for side in SIDES
    for limb, angle in (("spread", 3.0), ("raise", 9.0), ("elbow", 14.0), ("roll", 15.0))
}
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
_TENTHS = [i / 10 for i in range(11)]


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


@dataclass(frozen=True)
class Cycle:
    """One repetition of an action.

    ``angles`` are degrees by name at the phases ``at``, fractions of the cycle from 0 to 1. An
    angle whose first and last values differ keeps turning from cycle to cycle.
    """

    seconds: float  # duration at speed 1
    at: Sequence[float]
    angles: Mapping[str, Sequence[float]]
    gait: bool = False  # the right side lags by half a cycle
    flights: tuple[tuple[float, float], ...] = ()  # fractions of the cycle in the air: from, to
    travels: bool = False  # the figure moves forward and may turn

    @property
    def one_sided(self) -> bool:
        """Return whether left and right move differently, other than alternating."""
        return not self.gait and any(name.startswith(SIDES) for name in self.angles)

    def angles_at(self, phase: Floats, amplitude: Floats) -> dict[str, Floats]:
        """Return all angles in degrees (frames,) at ``phase`` (frames,), a number of cycles.

        Deviations from standing are multiplied by ``amplitude`` (frames,).
        """
        result = {name: np.full(len(phase), angle) for name, angle in STANDING.items()}
        for name, values in self.angles.items():
            curve = _make_cyclic_curve(self.at, values)
            for full_name in _expand_name(name):
                lag = 0.5 if self.gait and full_name.startswith("right") else 0.0
                angle = curve(phase - lag)
                # Angles that keep turning are not scaled, since whole turns must stay whole.
                turns = values[0] != values[-1]
                rest = STANDING[full_name]
                result[full_name] = angle if turns else rest + amplitude * (angle - rest)
        return result


def mirror_posture(angles: Mapping[str, Floats]) -> dict[str, Floats]:
    """Return the posture with left and right exchanged."""
    result = {}
    for name, values in angles.items():
        side, _, limb = name.rpartition(" ")
        if side:
            result[f"{'right' if side == 'left' else 'left'} {limb}"] = values
        else:
            result[name] = -values if name in _SIDEWAYS else values
    return result


def _expand_name(name: str) -> list[str]:
    return [f"{side} {name}" for side in SIDES] if name in LIMBS else [name]


def _make_cyclic_curve(at: Sequence[float], values: Sequence[float]) -> Callable[[Floats], Floats]:
    """Return the cyclic curve through values at fractions of a cycle."""
    # Change of the angle per cycle, such as 360 degrees for arm circles.
    gain = values[-1] - values[0]
    phases, heights = np.asarray(at, float), np.asarray(values, float)
    # An extra cycle on either side makes the curve smooth across cycle borders.
    curve = PchipInterpolator(
        np.concatenate([phases[:-1] - 1, phases, phases[1:] + 1]),
        np.concatenate([heights[:-1] - gain, heights, heights[1:] + gain]),
    )

    def at_phase(phase: Floats) -> Floats:
        cycle = np.floor(phase)
        return np.asarray(curve(phase - cycle) + cycle * gain)

    return at_phase


def _make_cosine(
    middle: float, amplitude: float, *, times: int = 1, at: float = 0.0
) -> list[float]:
    """Return a cosine at the tenths of a cycle, with its maximum at the fraction ``at``."""
    tenths = np.arange(11) / 10
    return list(middle + amplitude * np.cos(2 * np.pi * times * (tenths - at)))


ACTIONS: dict[str, Cycle] = {
    "stand": Cycle(1.0, (0, 1), {}),
    "walk": Cycle(
        1.1,
        _TENTHS,
        {
            "hip": (28, 23, 13, 3, -6, -11, -5, 14, 27, 32, 28),
            "knee": (5, 14, 13, 8, 5, 11, 34, 63, 57, 24, 5),
            "foot": (20, 2, 0, 0, -4, -20, -52, -50, -20, 8, 20),
            "toe": (0, 0, 0, 0, 4, 20, 25, 5, 0, 0, 0),
            "tilt": _make_cosine(4, 1, times=2),
            "yaw": _make_cosine(0, -5),
            "list": _make_cosine(0, -3, at=0.15),
            "twist": _make_cosine(0, 9),
            "bend": _make_cosine(3, 1, times=2),
            "swing": _make_cosine(2, -20),
            "elbow": _make_cosine(24, -10),
        },
        gait=True,
        travels=True,
    ),
    "run": Cycle(
        0.74,
        _TENTHS,
        {
            "hip": (36, 28, 16, 1, -12, -9, 10, 34, 50, 48, 36),
            "knee": (20, 35, 38, 29, 24, 48, 86, 98, 78, 38, 20),
            "foot": (8, 0, 0, -25, -62, -80, -85, -62, -30, 0, 8),
            "toe": (0, 0, 2, 22, 12, 0, 0, 0, 0, 0, 0),
            "tilt": _make_cosine(9, 2, times=2),
            "yaw": _make_cosine(0, -7),
            "list": _make_cosine(0, -3, at=0.15),
            "twist": _make_cosine(0, 16),
            "bend": _make_cosine(7, 1, times=2),
            "swing": _make_cosine(4, -34),
            "raise": _make_cosine(14, 0),
            "elbow": _make_cosine(84, -14),
            "roll": _make_cosine(18, 0),
        },
        gait=True,
        flights=((0.37, 0.5), (0.87, 1.0)),
        travels=True,
    ),
    "jump": Cycle(
        1.6,
        (0, 0.12, 0.30, 0.42, 0.52, 0.66, 0.78, 0.92, 1),
        {
            "tilt": (0, 6, 28, 2, 0, 4, 16, 3, 0),
            "bend": (0, 4, 20, 0, -3, 4, 12, 2, 0),
            "hip": (0, 22, 92, 4, 12, 20, 62, 6, 0),
            "knee": (0, 24, 98, 6, 22, 24, 76, 8, 0),
            "foot": (0, 0, 0, -48, -50, -22, 0, 0, 0),
            "toe": (0, 0, 0, 35, 0, 10, 0, 0, 0),
            "swing": (0, -30, -22, 62, 124, 84, 22, 2, 0),
            "elbow": (14, 16, 20, 32, 22, 28, 30, 18, 14),
            "nod": (0, 0, -14, -6, 0, 4, -6, 0, 0),
        },
        flights=((0.42, 0.68),),
    ),
    "squat": Cycle(
        2.3,
        (0, 0.08, 0.44, 0.54, 0.92, 1),
        {
            "tilt": (0, 1, 26, 26, 1, 0),
            "bend": (0, 1, 16, 16, 1, 0),
            "hip": (0, 3, 106, 106, 3, 0),
            "knee": (0, 4, 106, 106, 4, 0),
            "spread": (3, 4, 14, 14, 4, 3),
            "swing": (0, 5, 84, 84, 5, 0),
            "nod": (0, 0, -20, -20, 0, 0),
        },
    ),
    "kick": Cycle(
        1.7,
        (0, 0.10, 0.30, 0.42, 0.54, 0.78, 0.92, 1),
        {
            "tilt": (0, 2, -8, -16, -10, 2, 0, 0),
            "bend": (0, 4, 8, 12, 8, 4, 1, 0),
            "yaw": (0, -3, 6, 14, 8, -2, 0, 0),
            "lean": (0, -3, -7, -8, -7, -3, 0, 0),
            "left hip": (0, 6, 10, 8, 10, 8, 2, 0),
            "left knee": (0, 9, 20, 18, 20, 12, 3, 0),
            "right hip": (0, -8, 78, 96, 74, 4, 1, 0),
            "right knee": (0, 22, 104, 12, 88, 22, 3, 0),
            "right foot": (0, -30, -38, 42, -34, -12, 0, 0),
            "swing": (0, 12, 30, 26, 30, 16, 3, 0),
            "elbow": (14, 40, 82, 70, 82, 44, 18, 14),
            "raise": (9, 14, 20, 26, 20, 14, 9, 9),
        },
    ),
    "arm circles": Cycle(
        1.35,
        (0, 0.25, 0.5, 0.75, 1),
        {
            "swing": (0, 95, 180, 265, 360),
            "raise": (14, 14, 14, 24, 14),
            "elbow": (8, 8, 12, 10, 8),
            "bend": (1, 0, -5, -2, 1),
            "tilt": (0, 1, -1, -1, 0),
        },
    ),
    "punch": Cycle(
        1.15,
        (0, 0.12, 0.36, 0.46, 0.78, 1),
        {
            "left hip": (16, 16, 20, 20, 16, 16),
            "right hip": (-6, -6, -10, -10, -6, -6),
            "knee": (14, 14, 18, 18, 14, 14),
            "yaw": (-12, -16, 12, 12, -10, -12),
            "twist": (-10, -18, 28, 28, -8, -10),
            "bend": (6, 6, 10, 10, 6, 6),
            "left swing": (44, 44, 34, 34, 44, 44),
            "left elbow": (108, 108, 116, 116, 108, 108),
            "right swing": (32, 22, 86, 86, 34, 32),
            "right elbow": (122, 130, 8, 8, 118, 122),
            "right raise": (12, 14, 6, 6, 12, 12),
            "roll": (30, 30, 20, 20, 30, 30),
        },
    ),
    "wave": Cycle(
        1.2,
        (0, 0.25, 0.5, 0.75, 1),
        {
            "right raise": (96, 124, 152, 124, 96),
            "right roll": (-88, -88, -88, -88, -88),
            "right elbow": (22, 22, 58, 58, 22),  # the forearm trails behind
            "lean": (3, 0, -3, 0, 3),
            "look": (-8, -8, -8, -8, -8),
        },
    ),
}
