"""Find joints of a body and their centres, and measure angles between them.

The joints are hip, knee, ankle, heel, toe, shoulder, elbow and wrist of each side. Arms and legs
come from `kineme.features.canonical`. Heels and toes are found by name (see
`kineme.recordings.joint_names`); a toe may also be the end of a foot.

For markers on the skin, centres of hips and knees are estimated (`add_joint_centres`).

*Hip.* Taken from the file (``LHJC``), or from depth and width of the pelvis by the regression of
Harrington et al. 2007, "Prediction of the hip joint centre in adults, children, and patients with
cerebral palsy based on magnetic resonance imaging".

*Knee.* A marker on the knee lies beside its centre. This does not affect the angle about the knee's
axis (`find_hinge_axis`) if the ankle marker is on the same side. Without a knee marker, thigh and
shank are fitted as rigid bodies, which rotate about a common point (Ehrig et al. 2006, "A survey of
formal methods for determining the centre of rotation of ball joints", section 2.2.2). Since a knee
is a hinge, any point on its axis will do: the one in line with hip and ankle in the frontal plane
is taken. It does not exist for a knee that is not bent in the recording.

*Angles* are in degrees. From joint positions, the angle is that between two limbs: a knee is at 0
degrees if thigh and shank are in line, whatever plane it bends in. Skin markers lie beside the
joints, so that a straight leg has an angle, too. Therefore a knee with markers is measured about
its axis, with hyperextension below 0. From rotations, the angle is relative to the rest pose,
or to the pelvis's own axis along the trunk if the body does not stand in the rest pose.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from kineme._util import rotations as rot
from kineme._util.arrays import Floats, normalize_vectors
from kineme.errors import EndEffectorError
from kineme.features import PARTS, end_effectors
from kineme.features.canonical import find_limbs
from kineme.recordings import Motion, Skeleton
from kineme.recordings.joint_names import SIDES, find_joints, simplify_name

OTHER_SIDE = dict(zip(SIDES, reversed(SIDES), strict=True))
LEAST = 3
"""Least number of markers of a rigid body."""
MARKERS = (
    *(("*_hip_centre",), ("*_outer_ankle",)),
    *(("*_waist_front",), ("*_waist_back",), ("sacrum",)),
)
"""Parts in `joint_names` from which centres of hips and knees are computed."""
DEPTH, WIDTH_DOWN, WIDTH_OUT = (-0.24, -0.0099), (-0.30, -0.0109), (0.33, 0.0073)
"""Regression of a hip's offset (ahead, up, outwards) from the front middle: factor and metres."""
PULL = 0.05
"""Weight that pulls the common point to between both bodies, relative to the fit."""
BENT = 0.1
"""Least motion of a knee in the recording, about 8 degrees standard deviation."""
MOST = 4000
"""Largest number of frames used to find the common point."""
MOVES = 0.1
"""Least standard deviation of a hinge's angle, in radians, to determine its axis."""


def landmarks(motion: Motion) -> dict[str, int]:
    """Return the indices of joints by part and side, such as ``left_knee``, if found.

    Examples
    --------
    >>> import kineme
    >>> from kineme.cycles import landmarks
    >>> motion = kineme.read(kineme.bundled_recording())
    >>> motion.skeleton.names[landmarks(motion)["left_knee"]]
    'LeftLeg'
    """
    skeleton = motion.skeleton
    try:
        ends = dict(zip(PARTS, end_effectors(motion).indices, strict=True))
    except EndEffectorError:
        ends = {}
    limbs = find_limbs(skeleton, ends, single=True)
    joints = {joint: points[0] for joint, points in limbs.items()}
    ankles = {side: joints[f"{side}_ankle"] for side in SIDES if f"{side}_ankle" in joints}
    # Some rigs call the ankle a foot, others the ball of the foot.
    others = {*range(skeleton.n_joints)} - {*ankles.values()}
    named = find_joints(
        skeleton.names, [("*_heel",), ("*_toe", "*_foot")], usable=others, single=True
    )
    joints |= {joint: points[0] for joint, points in named.items()}
    lengths = np.linalg.norm(skeleton.offsets, axis=1)
    for side, ankle in ankles.items():
        below = [j for j in skeleton.children[ankle] if lengths[j] > 0]
        if below:
            joints.setdefault(f"{side}_toe", max(below, key=lambda j: float(lengths[j])))
    return joints


def find_feet(motion: Motion) -> dict[str, tuple[int, ...]]:
    """Return the joints used to find contacts of each foot: heel or ankle, and toe."""
    joints = landmarks(motion)
    # Left and right are compared with each other, so both use the same points.
    for part in ("heel", "toe"):
        has_ankles = all(f"{side}_ankle" in joints for side in SIDES)
        if has_ankles and not all(f"{side}_{part}" in joints for side in SIDES):
            joints = {joint: at for joint, at in joints.items() if not joint.endswith(part)}
    heels = {side: joints.get(f"{side}_heel", joints.get(f"{side}_ankle")) for side in SIDES}
    # The keys of a dict are unique: a foot without a toe has its heel only once.
    return {
        side: tuple(dict.fromkeys((heel, joints.get(f"{side}_toe", heel))))
        for side, heel in heels.items()
        if heel is not None
    }


def add_joint_centres(motion: Motion, joints: Mapping[str, int]) -> tuple[Motion, dict[str, int]]:
    """Return the motion with centres of hips and knees added, and its joints by part and side.

    ``joints`` are those of `landmarks`. Both are returned unchanged if no centres are found. For
    markers, ``left_thigh`` defines the rotation of the thigh together with hip and knee: the thigh
    marker farthest from their line, or else the other hip.
    """
    names = [simplify_name(name.rpartition(":")[2]) for name in motion.skeleton.names]
    marker = _find_markers(motion)
    places = motion.positions
    new_joints: dict[str, Floats] = {}
    # A skeleton with rotations has its joints at their centres; only markers need this.
    if motion.rotations is not None:
        return motion, dict(joints)
    centres = _find_hips(places, marker)
    # Without pelvis markers, use joints that are named hips.
    hips = centres or {
        side: places[:, joints[f"{side}_hip"]] for side in SIDES if f"{side}_hip" in joints
    }
    if len(hips) < len(SIDES):
        return motion, dict(joints)
    to_left = hips["left"] - hips["right"]
    result = dict(joints)
    # From here per side: which ankle marker and which knee belong together.
    for side in SIDES:
        ankle = joints.get(f"{side}_ankle")
        letter = side[0].upper()
        bodies = [[j for j, name in enumerate(names) if name.startswith(letter + word)]
                  for word in ("THIGH", "SHANK")]  # fmt: skip
        if f"{side}_knee" in joints:
            # Only with markers on the skin: knee and ankle are then both at the outer side.
            outer = marker.get(f"{side}_outer_ankle") if centres else None
            result |= {} if outer is None else {f"{side}_ankle": outer}
        elif ankle is not None and min(map(len, bodies)) >= LEAST:
            ends = hips[side], places[:, ankle]
            knee = _find_knee(places[:, bodies[0]], places[:, bodies[1]], ends, to_left)
            new_joints |= {} if knee is None else {f"{side}_knee": knee}
    if not new_joints and not centres:
        return motion, result
    # Computed hips are added after the knees; `n + place` below relies on this order.
    new_joints |= {f"{side}_hip": hip for side, hip in hips.items()}
    skeleton, n = motion.skeleton, motion.skeleton.n_joints
    extended = Skeleton(
        (*skeleton.names, *(f"centre of {part.replace('_', ' ')}" for part in new_joints)),
        # New joints hang on joint 0 with no offset: only their positions are used.
        (*skeleton.parents, *[0] * len(new_joints)),
        np.concatenate([skeleton.offsets, np.zeros((len(new_joints), 3))]),
        skeleton.end_sites,
    )
    positions = np.concatenate([places, np.stack([*new_joints.values()], axis=1)], axis=1)
    result |= {part: n + place for place, part in enumerate(new_joints)}
    for side in SIDES:
        if f"{side}_knee" in result:
            hip, knee = (positions[:, result[f"{side}_{part}"]] for part in ("hip", "knee"))
            markers = [j for j, name in enumerate(names) if name[:1] == side[0].upper()
                       and "THI" in name[1:] and j not in result.values()]  # fmt: skip
            # Vectors from the line through hip and knee to each marker.
            aside = [remove_along(places[:, j] - knee, knee - hip) for j in markers]
            far = [float(np.median(np.linalg.norm(each, axis=1))) for each in aside]
            other_hip = result[f"{OTHER_SIDE[side]}_hip"]
            result[f"{side}_thigh"] = markers[int(np.argmax(far))] if markers else other_hip
    return replace(motion, skeleton=extended, positions=positions), result


def find_pelvis_axes(motion: Motion) -> tuple[Floats, Floats, Floats] | None:
    """Return the unit vectors (frames, 3) left, ahead and up of a pelvis; None without markers.

    These are the axes of Plug-in Gait: left along the markers in front, ahead in the plane of all
    markers.
    """
    pelvis = _find_pelvis(motion.positions, _find_markers(motion))
    return None if pelvis is None else _orient_pelvis(*pelvis[1:])


def _find_markers(motion: Motion) -> dict[str, int]:
    found = find_joints(motion.skeleton.names, MARKERS, exact=True, single=True)
    return {joint: points[0] for joint, points in found.items()}


def _find_pelvis(places: Floats, marker: Mapping[str, int]) -> tuple[Floats, Floats, Floats] | None:
    """Return the front middle of a pelvis, and its vectors from right to left and back to front.

    Return None if markers are missing.
    """
    fronts, backs = (
        [marker.get(f"{side}_{part}", -1) for side in SIDES]
        for part in ("waist_front", "waist_back")
    )
    # A marker on the sacrum replaces the two at the back.
    if min(backs) < 0:
        backs = [marker.get("sacrum", -1)]
    if min(fronts + backs) < 0:
        return None
    front, back = places[:, fronts].mean(axis=1), places[:, backs].mean(axis=1)
    return front, places[:, fronts[0]] - places[:, fronts[1]], front - back


def _orient_pelvis(across: Floats, ahead: Floats) -> tuple[Floats, Floats, Floats]:
    """Return the unit vectors left, ahead and up, from the vectors of `_find_pelvis`."""
    left = normalize_vectors(across)
    # Ahead without its share of left.
    forward = normalize_vectors(remove_along(ahead, left))
    return left, forward, np.cross(forward, left)


def _find_hips(places: Floats, marker: Mapping[str, int]) -> dict[str, Floats]:
    """Return both hip centres from the file or pelvis markers; empty without these."""
    centres = [marker.get(f"{side}_hip_centre", -1) for side in SIDES]
    if min(centres) >= 0:
        return {side: places[:, j] for side, j in zip(SIDES, centres, strict=True)}
    pelvis = _find_pelvis(places, marker)
    if pelvis is None:
        return {}
    front, across, ahead = pelvis
    width, depth = (float(np.median(np.linalg.norm(each, axis=1))) for each in (across, ahead))
    left, forward, up = _orient_pelvis(across, ahead)
    # Regression of Harrington et al.: factor times depth or width, plus a constant, in metres.
    middle = front + (DEPTH[0] * depth + DEPTH[1]) * forward
    middle = middle + (WIDTH_DOWN[0] * width + WIDTH_DOWN[1]) * up
    aside = (WIDTH_OUT[0] * width + WIDTH_OUT[1]) * left
    return {"left": middle + aside, "right": middle - aside}


def _find_knee(
    thigh: Floats, shank: Floats, ends: tuple[Floats, Floats], to_left: Floats
) -> Floats | None:
    """Return the point (frames, 3) about which two bodies rotate, in line with hip and ankle.

    Return None if the knee hardly bends.
    """
    upper, lower = _find_poses(thigh), _find_poses(shank)
    chosen = np.unique(np.linspace(0, len(thigh) - 1, min(len(thigh), MOST)).astype(np.intp))
    # Evenly spread frames; both rotations and both centres of these only.
    (upper_turns, upper_centres), (lower_turns, lower_centres) = (
        (turns[chosen], centres[chosen]) for turns, centres in (upper, lower)
    )
    # (3 frames, 6): R1 c1 - R2 c2 = t2 - t1, linear in the local places c1 and c2 (Ehrig, SCoRE).
    both = np.concatenate([upper_turns, -lower_turns], axis=2).reshape(-1, 6)
    # A hinge leaves one singular value near 0, the axis. A second small one: the knee does not
    # bend.
    if np.linalg.svd(both, compute_uv=False)[4] < BENT * np.sqrt(len(chosen)):
        return None
    # Weak extra equations: c1 near the middle of both bodies, which fixes the place on the axis.
    pulled = np.concatenate([upper_turns, 0 * lower_turns], axis=2).reshape(-1, 6)
    apart = (lower_centres - upper_centres).reshape(-1)
    found = np.linalg.lstsq(
        np.concatenate([both, PULL * pulled]), np.concatenate([apart, PULL * apart / 2])
    )[0]
    # The same point as each body sees it, averaged.
    at = (upper[0] @ found[:3] + upper[1] + lower[0] @ found[3:] + lower[1]) / 2
    # Leftward axis in the frame of the thigh, averaged over time, then turned back with the thigh.
    axis = normalize_vectors(
        np.einsum("fji,fj->fi", upper[0], normalize_vectors(to_left)).mean(axis=0, keepdims=True)
    )[0]
    axis = upper[0] @ axis
    # How far the middle of hip and ankle lies beside the point, along the axis.
    aside = (((ends[0] + ends[1]) / 2 - at) * axis).sum(axis=1)
    return np.asarray(at + float(np.median(aside)) * axis)


def _find_poses(markers: Floats) -> tuple[Floats, Floats]:
    """Return rotations (frames, 3, 3) relative to the middle frame (Kabsch), and mean positions."""
    # Centred markers (frames, markers, 3); the middle frame is the reference shape.
    centre = markers.mean(axis=1)
    shape = markers - centre[:, None]
    # (frames, 3, 3): cross-covariances with the reference, H = U S Vt.
    products = np.einsum("mi,fmj->fij", shape[len(shape) // 2], shape)
    u, _, vt = np.linalg.svd(products)
    # A negative determinant is a reflection: flip the last axis to get a rotation.
    flips = np.ones((len(u), 1, 3))
    flips[:, 0, 2] = np.sign(np.linalg.det(u @ vt))
    # The index order transposes the product: V D Ut.
    return np.einsum("fij,fjk->fki", u * flips, vt), centre


def bend(before: Floats, joint: Floats, after: Floats) -> Floats:
    """Return by how much a chain of three points bends at the middle one: 0 if it is straight.

    Parameters
    ----------
    before, joint, after : (frames, 3) array

    Returns
    -------
    (frames,) array
        Degrees, 0 to 180: 180 minus the angle between the two limbs.

    Examples
    --------
    >>> bend(np.array([[0, 2.0, 0]]), np.array([[0, 1.0, 0]]), np.array([[0, 1.0, 1]])).round(6)
    array([90.])
    """
    return measure_angle(joint - before, after - joint)


def measure_angle(first: Floats, second: Floats) -> Floats:
    """Return the angle between vectors in degrees, 0 to 180; nan if one has length 0.

    Parameters
    ----------
    first, second : (frames, 3) array

    Returns
    -------
    (frames,) array

    Examples
    --------
    >>> measure_angle(np.array([[0, 1.0, 0]]), np.array([[0, 0, 2.0]])).round(6)
    array([90.])
    """
    # The arctangent is exact near 0 and 180 degrees, where an arccosine loses precision.
    cross = np.linalg.norm(np.cross(first, second), axis=-1)
    dot = (first * second).sum(axis=-1)
    angle = np.degrees(np.arctan2(cross, dot))
    # `arctan2(0, 0)` is 0, but a vector without length has no direction.
    return np.where((cross == 0) & (dot == 0), np.nan, angle)


def measure_turn(axis: Floats, first: Floats, second: Floats) -> Floats:
    """Return the angle of rotation about an axis from one vector to another.

    Degrees, -180 to 180, right-handed. Components of the vectors (frames, 3) along the axis are
    ignored; the angle is 0 if nothing else is left of a vector.
    """
    flat = [remove_along(vectors, axis) for vectors in (first, second)]
    # The triple product with the unit axis: the sine with its sign.
    sine = (np.cross(flat[0], flat[1]) * normalize_vectors(axis)).sum(axis=-1)
    cosine = (flat[0] * flat[1]).sum(axis=-1)
    return np.asarray(np.degrees(np.arctan2(sine, cosine)))


def find_hinge_axis(upper: Floats, joint: Floats, lower: Floats, beside: Floats) -> Floats | None:
    """Return the axis (frames, 3) of a hinge such as a knee, fixed relative to the upper limb.

    Relative to the upper limb, the lower limb moves in a plane. The axis is normal to this plane,
    so markers need not be at the centre of the joint. ``beside`` is a point that defines the
    rotation of the upper limb, such as a thigh marker. The sign of the axis is arbitrary. Return
    None if the hinge hardly moves.
    """
    # Directions of thigh and shank.
    along, limb = normalize_vectors(joint - upper), normalize_vectors(lower - joint)
    aside = normalize_vectors(remove_along(beside - joint, along))
    # (frames, 3, 3): rows are the axes of the upper limb; the shank is then given in them.
    frame = np.stack([aside, np.cross(along, aside), along], axis=1)
    seen = np.einsum("fij,fj->fi", frame, limb)
    # Eigenvalues ascend: the first belongs to the axis, the second measures the swing.
    spreads, axes = np.linalg.eigh(seen.T @ seen / len(seen))
    if spreads[1] < MOVES**2:
        return None
    # Back to the coordinates of the recording.
    return np.asarray(np.einsum("fij,i->fj", frame, axes[:, 0]))


def remove_along(vectors: Floats, direction: Floats) -> Floats:
    """Return vectors without their component along a direction."""
    direction = normalize_vectors(direction)
    return np.asarray(vectors - (vectors * direction).sum(axis=-1, keepdims=True) * direction)


def cardan(rotations: Floats) -> Floats:
    """Return Cardan angles (x, z, y) in degrees with the rotation equal to Rx Rz Ry.

    The first is about the mediolateral axis, which is flexion in a skeleton that faces +z at
    rest; the second about the axis ahead; the third about the vertical axis.

    Parameters
    ----------
    rotations : (frames, 4) array
        Unit quaternions (w, x, y, z).

    Returns
    -------
    (frames, 3) array

    Examples
    --------
    >>> turned = rot.from_euler(np.radians([[40.0, 10.0, -5.0]]), "xzy")
    >>> cardan(turned).round(6)
    array([[40., 10., -5.]])
    """
    return np.degrees(rot.to_euler(rotations, "xzy"))
