"""What can be measured in a recording: angles, positions and speeds of a body, channels of signals.

Left and right stand at the end of a name, as in ``knee_l``. Angles of a body:

=============== ===============================================================================
``knee_l``      by how much thigh and shank are bent against each other, of markers about the axis
                of the knee; ``elbow_l`` between both limbs
``hip_l``       thigh forward: against the pelvis where rotations tell it, else against the trunk
``ankle_l``     toes up: 90 degrees less the angle between shank and foot
``shoulder_l``  between upper arm and trunk: 0 where the arm hangs
``trunk_lean``  trunk forward against the vertical; ``trunk_side`` to the right
=============== ===============================================================================

``stance_l`` is 100 while the left foot stands and 0 while it swings, so that its mean over a cycle
is the share of stance, in per cent; sensors at the feet have it, too. ``heading`` is where the body
faces, about the vertical, without jumps. Of each joint there are ``NAME.rx``, ``.rz``, ``.ry`` (its
rotation, see `kineme.cycles.cardan`), ``NAME.x``, ``.y``, ``.z`` (metres, y up), ``NAME.left``,
``.up``, ``.ahead`` (metres, seen from the pelvis, as the body faces) and ``NAME.speed``.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from fnmatch import fnmatchcase
from functools import partial

import numpy as np

from kineme._util import rotations as rot
from kineme._util.arrays import Floats
from kineme._util.checks import as_texts
from kineme.cycles.events import find_foot, mark_stance
from kineme.cycles.joints import (
    add_joint_centres,
    bend,
    cardan,
    find_hinge_axis,
    landmarks,
    measure_angle,
    measure_turn,
    normalize,
    remove_along,
)
from kineme.errors import EndEffectorError, MotionError, ParameterError
from kineme.features import compute_body_frame, compute_heading
from kineme.features.feet import measure_speed
from kineme.recordings import Motion, Signals
from kineme.recordings.joint_names import SIDES
from kineme.recordings.kinematics import compute_world_rotations, place_at_rest

Compute = Callable[[], Floats]
Add = Callable[[str, str, str, Sequence[str | int], Compute], None]
"""Name, unit, group, joints or words that tell the source, and what computes the channel."""

DEGREES = "°"
CONTACT = "contact"
ANGLE, CHANNEL = "angle", "channel"
"""Groups that are measured where nobody says which."""
ALIKE = 0.7
"""Cosine between the axis of a knee and that of the hips, at least: 45 degrees."""
_SHOWN = 8


@dataclass(frozen=True)
class Channel:
    """One number for each frame of a recording.

    Attributes
    ----------
    name, unit : str
        The unit is empty where nobody says it, as of most signals.
    group : str
        What kind of number it is: ``angle``, ``direction``, ``contact``, ``rotation``,
        ``position``, ``from the pelvis``, ``speed`` or ``channel``.
    source : str
        From which joints it is, for the provenance.
    fps : float
        Frames per second.

    Examples
    --------
    >>> import kineme
    >>> from kineme.cycles import channels_of
    >>> knee = channels_of(kineme.read(kineme.bundled_recording()), ["knee_l"])[0]
    >>> knee.unit, knee.source, knee.values().shape
    ('°', 'LeftUpLeg, LeftLeg, LeftFoot', (2898,))
    """

    name: str
    unit: str
    group: str
    source: str
    fps: float
    compute: Compute
    gaps: Sequence[tuple[int, int]] = ()

    def values(self) -> Floats:
        """Return the numbers, nan where nothing was recorded."""
        values = np.array(self.compute(), np.float64)
        for start, stop in self.gaps:
            values[start:stop] = np.nan
        return values


def channels_of(
    recording: Motion | Signals,
    names: Iterable[str] | None = None,
    *,
    beside: Sequence[Signals] = (),
) -> list[Channel]:
    """Channels of a recording, by their names.

    Parameters
    ----------
    recording : Motion or Signals
    names : iterable of str, optional
        In the order wanted; ``*`` and ``?`` stand for any characters. By default the angles of a
        body, or the speeds of its points where no joint is found by name; all channels of signals.
    beside : sequence of Signals
        Recorded at the same time, such as force plates: their channels are measured as well, each
        at its rate.

    Returns
    -------
    list of Channel

    Raises
    ------
    ParameterError
        There is no channel of a name.

    Examples
    --------
    >>> import kineme
    >>> from kineme.cycles import channels_of
    >>> motion = kineme.read(kineme.bundled_recording())
    >>> [channel.name for channel in channels_of(motion, ["knee_*", "Head.up"])]
    ['knee_l', 'knee_r', 'Head.up']
    """
    if isinstance(recording, Motion):
        every = make_motion_channels(recording)
    else:
        every = _make_signal_channels(recording)
    # Contacts follow, unless a channel of this name is there already.
    every += [
        each
        for each in make_contact_channels(recording)
        if each.name not in {c.name for c in every}
    ]
    for signals in beside:
        every += _make_signal_channels(signals)
    usual = [channel for channel in every if channel.group in (ANGLE, CHANNEL)]
    if names is None:
        return usual or [channel for channel in every if channel.group == "speed"]
    chosen: dict[str, Channel] = {}
    for pattern in as_texts(names, "names of channels"):
        matching = [each for each in every if fnmatchcase(each.name, pattern)]
        if not matching:
            choices = [each.name for each in usual or every]
            more = ", …" if len(choices) > _SHOWN else ""
            raise ParameterError(
                f"no channel {pattern!r}; there are {', '.join(choices[:_SHOWN])}{more} "
                "(kineme info --channels lists them)"
            )
        chosen |= {each.name: each for each in matching}
    return list(chosen.values())


def _make_signal_channels(signals: Signals) -> list[Channel]:
    columns = signals.values.T
    return [
        Channel(name, "", CHANNEL, name, signals.fps, partial(np.array, column), signals.gaps)
        for name, column in zip(signals.names, columns, strict=True)
    ]


def make_contact_channels(recording: Motion | Signals) -> list[Channel]:
    """When each foot stands, of the feet that are there."""
    return [
        Channel(f"stance_{side[0]}", "%", CONTACT, ", ".join(foot), recording.fps,
                partial(mark_stance, recording, side), recording.gaps)
        for side in SIDES
        if (foot := find_foot(recording, side))
    ]  # fmt: skip


def make_motion_channels(motion: Motion) -> list[Channel]:
    """Return every channel of a body: its angles first, after them rotations, positions, speeds."""
    channels: list[Channel] = []
    fps, gaps = motion.fps, motion.gaps
    extended, parts = add_joint_centres(motion, landmarks(motion))
    names = extended.skeleton.names

    def add(name: str, unit: str, group: str, of: Sequence[str | int], compute: Compute) -> None:
        source = ", ".join(each if isinstance(each, str) else names[each] for each in of)
        channels.append(Channel(name, unit, group, source, fps, compute, gaps))

    try:
        # Without jumps by 360 degrees.
        facing = np.degrees(np.unwrap(compute_heading(motion)[1]))
    except (EndEffectorError, MotionError):
        facing = None  # nothing tells where the body faces
    _add_bends(extended.positions, parts, add)
    _add_angles(extended, parts, add)
    if facing is not None:
        source = ["the line of the hips"]
        add("heading", DEGREES, "direction", source, partial(np.asarray, facing))
    _add_joints(motion, facing is not None, add)
    return channels


def _add_joints(motion: Motion, faces: bool, add: Add) -> None:
    """Rotation, position and speed of each joint."""
    places, rotations = motion.positions, motion.rotations
    joints = [*enumerate(motion.skeleton.names)]

    def add_axes(name: str, axes: Iterable[str], unit: str, group: str, joint: int,
                 compute: Compute) -> None:  # fmt: skip
        for place, axis in enumerate(axes):
            add(f"{name}.{axis}", unit, group, [joint], partial(_get_component, compute, place))

    for joint, name in joints:
        if rotations is not None and joint not in motion.skeleton.end_sites:
            compute = partial(cardan, rotations[:, joint])
            add_axes(name, ("rx", "rz", "ry"), DEGREES, "rotation", joint, compute)
    for joint, name in joints:
        add_axes(name, "xyz", "m", "position", joint, partial(np.asarray, places[:, joint]))
    for joint, name in joints if faces else []:
        compute = partial(compute_body_frame, motion, (joint,))
        add_axes(name, ("left", "up", "ahead"), "m", "from the pelvis", joint, compute)
    for joint, name in joints:
        compute = partial(measure_speed, places[:, joint], motion.fps)
        add(f"{name}.speed", "m/s", "speed", [joint], compute)


def _get_component(compute: Compute, place: int) -> Floats:
    """Return one number of each frame, of the several that a function gives."""
    return np.asarray(compute()[..., place]).ravel()


def _add_bends(places: Floats, joints: Mapping[str, int], add: Add) -> None:
    """Knees, elbows and ankles, as far as their joints are there."""
    bent = (
        ("knee", ("hip", "knee", "ankle"), 0.0),
        ("elbow", ("shoulder", "elbow", "wrist"), 0.0),
        # 90 degrees less, so that an ankle is 0 with the foot at right angles to the shank.
        ("ankle", ("knee", "ankle", "toe"), -90.0),
    )
    for name, parts, less in bent:
        for side in SIDES:
            # Joints that were not found are -1.
            chain = [joints.get(f"{side}_{part}", -1) for part in parts]
            thigh = joints.get(f"{side}_thigh")
            compute = partial(_measure_bend, places, chain, less)
            if name == "knee" and thigh is not None:
                hips = [joints[f"{each}_hip"] for each in SIDES]
                compute = partial(_measure_flexion, places, chain, thigh, hips)
            if min(chain) >= 0:
                add(f"{name}_{side[0]}", DEGREES, ANGLE, chain, compute)


def _add_angles(motion: Motion, joints: Mapping[str, int], add: Add) -> None:
    """Hips, shoulders and the trunk."""
    places = motion.positions
    hips = [joints.get(f"{side}_hip", -1) for side in SIDES]
    shoulders = [joints.get(f"{side}_shoulder", -1) for side in SIDES]
    if min(hips) < 0:
        return
    for side, hip in zip(SIDES, hips, strict=True):
        if f"{side}_knee" in joints:
            thigh = hip, joints[f"{side}_knee"]
            pelvis = motion.skeleton.parents[hip]
            if motion.rotations is not None and pelvis >= 0:
                against = f"against {motion.skeleton.names[pelvis]}"
                compute = partial(_measure_against_pelvis, motion, *thigh, hips)
            elif min(shoulders) >= 0:
                against = "against the trunk"
                compute = partial(_measure_against_trunk, places, *thigh, hips, shoulders)
            else:
                continue
            add(f"hip_{side[0]}", DEGREES, ANGLE, [against, *thigh], compute)
    if min(shoulders) < 0:
        return
    for side, shoulder in zip(SIDES, shoulders, strict=True):
        elbow = joints.get(f"{side}_elbow")
        if elbow is not None:
            compute = partial(_measure_arm_raise, places, shoulder, elbow, hips, shoulders)
            add(f"shoulder_{side[0]}", DEGREES, ANGLE, ["against the trunk", shoulder, elbow],
                compute)  # fmt: skip
    for name, sideways in (("trunk_lean", False), ("trunk_side", True)):
        compute = partial(_measure_lean, places, hips, shoulders, sideways=sideways)
        add(name, DEGREES, ANGLE, [*hips, *shoulders], compute)


def _measure_bend(places: Floats, chain: Sequence[int], less: float) -> Floats:
    return bend(*(places[:, joint] for joint in chain)) + less


def _measure_flexion(
    places: Floats, chain: Sequence[int], thigh: int, hips: Sequence[int]
) -> Floats:
    """By how much a knee is bent about its axis, or that of the hips if it hardly moves."""
    hip, knee, ankle = (places[:, joint] for joint in chain)
    # Without what lies along the leg: an axis at right angles to it.
    to_left = normalize(remove_along(places[:, hips[0]] - places[:, hips[1]], ankle - hip))
    axis = find_hinge_axis(hip, knee, ankle, places[:, thigh])
    # Cosine of the fitted axis with the line of the hips, in each frame.
    alike = np.zeros(1) if axis is None else (axis * to_left).sum(axis=1)
    if axis is None or np.median(np.abs(alike)) < ALIKE:
        return measure_turn(to_left, knee - hip, ankle - knee)
    axis = axis * np.sign(alike)[:, None]  # in each frame: a thigh marker may be mistaken in some
    return measure_turn(axis, knee - hip, ankle - knee)


def _measure_against_pelvis(motion: Motion, hip: int, knee: int, hips: Sequence[int]) -> Floats:
    """Return how far the thigh is turned forward from the pose of rest, in the pelvis's frame."""
    skeleton = motion.skeleton
    turned = compute_world_rotations(skeleton, motion.rotations)[:, skeleton.parents[hip]]
    # The thigh as the pelvis sees it: rotated by the inverse of its rotation.
    thigh = rot.rotate(rot.conjugate(turned), motion.positions[:, knee] - motion.positions[:, hip])
    places = place_at_rest(skeleton)
    rest, to_left = places[knee] - places[hip], places[hips[0]] - places[hips[1]]
    # A right-handed turn about the axis to the left swings a hanging thigh back, hence the minus.
    return -measure_turn(to_left[None], np.broadcast_to(rest, thigh.shape), thigh)


def _find_trunk(places: Floats, hips: Sequence[int], shoulders: Sequence[int]) -> Floats:
    """From the middle of the hips to the middle of the shoulders."""
    return np.asarray(places[:, shoulders].mean(axis=1) - places[:, hips].mean(axis=1))


def _measure_against_trunk(
    places: Floats, hip: int, knee: int, hips: Sequence[int], shoulders: Sequence[int]
) -> Floats:
    to_left, thigh = places[:, hips[0]] - places[:, hips[1]], places[:, knee] - places[:, hip]
    return -measure_turn(to_left, -_find_trunk(places, hips, shoulders), thigh)


def _measure_arm_raise(
    places: Floats, shoulder: int, elbow: int, hips: Sequence[int], shoulders: Sequence[int]
) -> Floats:
    return measure_angle(
        places[:, elbow] - places[:, shoulder], -_find_trunk(places, hips, shoulders)
    )


def _measure_lean(
    places: Floats, hips: Sequence[int], shoulders: Sequence[int], *, sideways: bool
) -> Floats:
    trunk = _find_trunk(places, hips, shoulders)
    # The line of the hips, level.
    to_left = (places[:, hips[0]] - places[:, hips[1]]) * [1, 0, 1]
    up = np.broadcast_to([0.0, 1.0, 0.0], trunk.shape)
    # Left x up is ahead: turning up about it leads to the right; about left, it leads forward.
    return measure_turn(np.cross(to_left, up) if sideways else to_left, up, trunk)
