"""Channels that can be measured: angles, positions and speeds of a body, channels of signals.

Names end with the side, as in ``knee_l``. Angles of a body:

=============== ===============================================================================
``knee_l``      angle between thigh and shank, for markers about the axis of the knee;
                ``elbow_l`` between both limbs
``hip_l``       thigh forward: relative to the pelvis if its rotation is known or it has markers,
                else to the trunk
``ankle_l``     toes up: 90 degrees less the angle between shank and foot
``shoulder_l``  between upper arm and trunk: 0 if the arm hangs down
``trunk_lean``  trunk forward from the vertical; ``trunk_side`` to the right
=============== ===============================================================================

``stance_l`` is 100 while the left foot stands and 0 while it swings, so that its mean over a cycle
is the stance phase in per cent; sensors at the feet have it, too. ``heading`` is the direction that
the body faces, about the vertical, unwrapped. Each joint has ``NAME.rx``, ``.rz``, ``.ry`` (its
rotation, see `kineme.cycles.cardan`), ``NAME.x``, ``.y``, ``.z`` (metres, y up), ``NAME.left``,
``.up``, ``.ahead`` (metres, relative to pelvis and heading) and ``NAME.speed``.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from fnmatch import fnmatchcase
from functools import partial

import numpy as np

from kineme._util import rotations as rot
from kineme._util.arrays import Floats, normalize_vectors
from kineme._util.checks import as_texts
from kineme.cycles.events import find_foot, mark_stance
from kineme.cycles.joints import (
    add_joint_centres,
    bend,
    cardan,
    find_hinge_axis,
    find_pelvis_axes,
    landmarks,
    measure_angle,
    measure_turn,
    remove_along,
)
from kineme.errors import EndEffectorError, MotionError, ParameterError
from kineme.features import compute_body_frame, compute_heading
from kineme.features.effectors import measure_speed
from kineme.recordings import Motion, Signals
from kineme.recordings.joint_names import SIDES
from kineme.recordings.kinematics import compute_world_rotations, place_at_rest

Compute = Callable[[], Floats]
Add = Callable[[str, str, str, Sequence[str | int], Compute], None]
"""Arguments: name, unit, group, source (joints or words), and function that computes values."""

DEGREES = "°"
CONTACT = "contact"
ANGLE, CHANNEL = "angle", "channel"
"""Groups that are measured by default."""
ALIKE = 0.7
"""Least cosine between the axis of a knee and that of the hips: 45 degrees."""
STANDING = 60.0
"""Largest angle between a thigh and the downward trunk in a rest pose that stands, in degrees."""
_SHOWN = 8


@dataclass(frozen=True)
class Channel:
    """One number for each frame of a recording.

    Attributes
    ----------
    name, unit : str
        The unit is empty if unknown, as for most signals.
    group : str
        Kind of quantity: ``angle``, ``direction``, ``contact``, ``rotation``,
        ``position``, ``from the pelvis``, ``speed`` or ``channel``.
    source : str
        Joints that it is computed from, for the provenance.
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
        """Return the values, nan in gaps."""
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
    """Return channels of a recording, selected by name.

    Parameters
    ----------
    recording : Motion or Signals
    names : iterable of str, optional
        Names in the wanted order; ``*`` and ``?`` are wildcards. By default the angles of a body,
        or the speeds of its points if no joint is recognised; for signals all channels.
    beside : sequence of Signals
        Signals recorded at the same time, such as force plates. Their channels are added, each at
        its own rate.

    Raises
    ------
    ParameterError
        No channel matches a name.

    Examples
    --------
    >>> import kineme
    >>> from kineme.cycles import channels_of
    >>> motion = kineme.read(kineme.bundled_recording())
    >>> [channel.name for channel in channels_of(motion, ["knee_*", "Head.up"])]
    ['knee_l', 'knee_r', 'Head.up']
    """
    if isinstance(recording, Motion):
        available = make_motion_channels(recording)
    else:
        available = _make_signal_channels(recording)
    # Contacts follow, unless a channel with this name exists already.
    available += [
        each
        for each in make_contact_channels(recording)
        if each.name not in {c.name for c in available}
    ]
    for signals in beside:
        available += _make_signal_channels(signals)
    usual = [channel for channel in available if channel.group in (ANGLE, CHANNEL)]
    if names is None:
        return usual or [channel for channel in available if channel.group == "speed"]
    chosen: dict[str, Channel] = {}
    for pattern in as_texts(names, "names of channels"):
        matching = [each for each in available if fnmatchcase(each.name, pattern)]
        if not matching:
            choices = [each.name for each in usual or available]
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
        Channel(
            name,
            "",
            group=CHANNEL,
            source=name,
            fps=signals.fps,
            compute=partial(np.array, column),
            gaps=signals.gaps,
        )
        for name, column in zip(signals.names, columns, strict=True)
    ]


def make_contact_channels(recording: Motion | Signals) -> list[Channel]:
    """Return a stance channel for each foot that is found."""
    return [
        Channel(f"stance_{side[0]}", "%", group=CONTACT, source=", ".join(foot), fps=recording.fps,
                compute=partial(mark_stance, recording, foot), gaps=recording.gaps)
        for side in SIDES
        if (foot := find_foot(recording, side))
    ]  # fmt: skip


def make_motion_channels(motion: Motion) -> list[Channel]:
    """Return all channels of a body: angles first, then rotations, positions, speeds."""
    channels: list[Channel] = []
    fps, gaps = motion.fps, motion.gaps
    extended, parts = add_joint_centres(motion, landmarks(motion))
    names = extended.skeleton.names

    def add(name: str, unit: str, group: str, of: Sequence[str | int], compute: Compute) -> None:
        source = ", ".join(each if isinstance(each, str) else names[each] for each in of)
        channels.append(
            Channel(name, unit, group=group, source=source, fps=fps, compute=compute, gaps=gaps)
        )

    try:
        # Unwrapped: no jumps by 360 degrees.
        facing = np.degrees(np.unwrap(compute_heading(motion)[1]))
    except (EndEffectorError, MotionError):
        facing = None  # unknown heading
    _add_bends(extended.positions, parts, add)
    _add_angles(extended, parts, add)
    if facing is not None:
        source = ["the line of the hips"]
        add("heading", DEGREES, "direction", source, partial(np.asarray, facing))
    _add_joints(motion, facing is not None, add)
    return channels


def _add_joints(motion: Motion, faces: bool, add: Add) -> None:
    """Add rotation, position and speed of each joint."""
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
    """Return one component of the values of a function, (frames,)."""
    return np.asarray(compute()[..., place]).ravel()


def _add_bends(places: Floats, joints: Mapping[str, int], add: Add) -> None:
    """Add angles of knees, elbows and ankles whose joints are found."""
    bent = (
        ("knee", ("hip", "knee", "ankle"), 0.0),
        ("elbow", ("shoulder", "elbow", "wrist"), 0.0),
        # Minus 90 degrees: an ankle is 0 if the foot is at right angles to the shank.
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
    """Add angles of hips, shoulders and the trunk."""
    places = motion.positions
    hips = [joints.get(f"{side}_hip", -1) for side in SIDES]
    shoulders = [joints.get(f"{side}_shoulder", -1) for side in SIDES]
    if min(hips) < 0:
        return
    axes = find_pelvis_axes(motion)
    for side, hip in zip(SIDES, hips, strict=True):
        if f"{side}_knee" in joints:
            thigh = hip, joints[f"{side}_knee"]
            pelvis = motion.skeleton.parents[hip]
            if motion.rotations is not None and pelvis >= 0:
                against = f"against {motion.skeleton.names[pelvis]}"
                compute = partial(_measure_against_pelvis, motion, side, joints)
            elif axes is not None:
                against = "against the pelvis"
                compute = partial(_measure_against_axes, places, *thigh, axes)
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
    """Return the flexion of a knee about its axis, or that of the hips if it hardly moves."""
    hip, knee, ankle = (places[:, joint] for joint in chain)
    # Remove the component along the leg to get an axis at right angles to it.
    to_left = normalize_vectors(remove_along(places[:, hips[0]] - places[:, hips[1]], ankle - hip))
    axis = find_hinge_axis(hip, knee, ankle, places[:, thigh])
    # Cosine of the fitted axis with the line of the hips, in each frame.
    alike = np.zeros(1) if axis is None else (axis * to_left).sum(axis=1)
    if axis is None or np.median(np.abs(alike)) < ALIKE:
        return measure_turn(to_left, knee - hip, ankle - knee)
    axis = axis * np.sign(alike)[:, None]  # per frame, since a thigh marker may be wrong in some
    return measure_turn(axis, knee - hip, ankle - knee)


def _measure_against_pelvis(motion: Motion, side: str, joints: Mapping[str, int]) -> Floats:
    """Return the thigh's forward rotation from standing upright, relative to the pelvis."""
    skeleton, places = motion.skeleton, motion.positions
    hips, shoulders = ([joints.get(f"{each}_{part}", -1) for each in SIDES]
                       for part in ("hip", "shoulder"))  # fmt: skip
    hip, knee = joints[f"{side}_hip"], joints[f"{side}_knee"]
    turned = compute_world_rotations(skeleton, motion.rotations)[:, skeleton.parents[hip]]
    # Transform vectors into the frame of the pelvis.
    transform = partial(rot.rotate, rot.conjugate(turned))
    thigh = transform(places[:, knee] - places[:, hip])
    rest = place_at_rest(skeleton)
    down, to_left = rest[knee] - rest[hip], rest[hips[0]] - rest[hips[1]]
    if min(shoulders) >= 0:
        up = transform(_find_trunk(places, hips, shoulders)).mean(axis=0)
        thighs = [rest[joints[f"{each}_knee"]] - rest[joints[f"{each}_hip"]]
                  for each in SIDES if f"{each}_knee" in joints]  # fmt: skip
        # In rigs with bones along their own axes, thighs may point anywhere without rotations.
        # Then the pelvis's own axis nearest to the trunk is up, in all recordings of the rig.
        if not (measure_angle(np.array(thighs), -up) < STANDING).all():
            nearest = np.argmax(np.abs(up))
            down = -np.sign(up[nearest]) * np.eye(3)[nearest]
            to_left = transform(places[:, hips[0]] - places[:, hips[1]]).mean(axis=0)
    # A right-handed turn about the axis to the left swings a hanging thigh back, hence the minus.
    return -measure_turn(to_left[None], np.broadcast_to(down, thigh.shape), thigh)


def _measure_against_axes(
    places: Floats, hip: int, knee: int, axes: tuple[Floats, Floats, Floats]
) -> Floats:
    """Return the thigh's forward rotation in the sagittal plane of the pelvis."""
    left, _, up = axes
    return -measure_turn(left, -up, places[:, knee] - places[:, hip])


def _find_trunk(places: Floats, hips: Sequence[int], shoulders: Sequence[int]) -> Floats:
    """Return the vector from the middle of the hips to that of the shoulders."""
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
    # The line of the hips without its vertical component.
    to_left = (places[:, hips[0]] - places[:, hips[1]]) * [1, 0, 1]
    up = np.broadcast_to([0.0, 1.0, 0.0], trunk.shape)
    # Left x up is ahead: turning up about it leads to the right; about left, it leads forward.
    return measure_turn(np.cross(to_left, up) if sideways else to_left, up, trunk)
