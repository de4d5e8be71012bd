"""Joints of a body: which they are, where their centres lie, and the angles between them.

Found are hip, knee, ankle, heel, toe, shoulder, elbow and wrist of each side. Arms and legs are
those of `kineme.features.canonical`. Heels and toes are found by their names (see
`kineme.recordings.joint_names`); a toe may also be the end of a foot.

Bodies that are markers on the skin get the centres of hips and knees as well (`add_joint_centres`).

*Hip.* From the depth and the width of the pelvis, by the regression of Harrington et al. 2007,
"Prediction of the hip joint centre in adults, children, and patients with cerebral palsy based on
magnetic resonance imaging"; or where the file has it (``LHJC``).

*Knee.* A marker on it is beside its centre, which does not matter to an angle about the axis of the
knee (`find_hinge_axis`), as long as the ankle is a marker at the same side. Without one, thigh and
shank are rigid bodies, each fitted to its markers. Both have one point in common, about which they
turn (Ehrig et al. 2006, "A survey of formal methods for determining the centre of rotation of ball
joints", section 2.2.2). A knee turns about an axis, so that this point may lie anywhere on it: that
one is taken which is in line with hip and ankle, as seen from the front. A knee that is not bent in
the recording has no such point.

*Angles* are in degrees. From positions of joints an angle is the one between two limbs, by which a
straight limb is bent: a knee is 0 degrees when thigh and shank are in line, whatever plane it bends
in. Markers on the skin are beside the joints, so that a straight leg has an angle between its
limbs, too. There a knee is bent about its axis, and below 0 degrees if it is bent the other way.
From rotations it is how far a joint is turned from the pose of rest, as the skeleton has it.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from kineme._util import rotations as rot
from kineme._util.arrays import Floats
from kineme.errors import EndEffectorError
from kineme.features import PARTS, end_effectors
from kineme.features.canonical.joints import find_limbs
from kineme.recordings import Motion, Skeleton
from kineme.recordings.joint_names import SIDES, find_joints, simplify_name

OTHER_SIDE = dict(zip(SIDES, reversed(SIDES), strict=True))


def landmarks(motion: Motion) -> dict[str, int]:
    """Joints by part and side, such as ``left_knee``; those that are not found are left out.

    Parameters
    ----------
    motion : Motion

    Returns
    -------
    dict of str to int

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
    """Return for each foot the joints that tell whether it stands: heel or ankle, and toe."""
    joints = landmarks(motion)
    heels = {side: joints.get(f"{side}_heel", joints.get(f"{side}_ankle")) for side in SIDES}
    # The keys of a dict are unique: a foot without a toe has its heel only once.
    return {
        side: tuple(dict.fromkeys((heel, joints.get(f"{side}_toe", heel))))
        for side, heel in heels.items()
        if heel is not None
    }


LEAST = 3
"""Markers of a rigid body."""
MARKERS = (
    *(("*_hip_centre",), ("*_outer_ankle",)),
    *(("*_waist_front",), ("*_waist_back",), ("sacrum",)),
)
"""Markers and centres from which those of hips and knees are made, as in `joint_names`."""
DEPTH, WIDTH_DOWN, WIDTH_OUT = (-0.24, -0.0099), (-0.30, -0.0109), (0.33, 0.0073)
"""How far ahead, up and to its side a hip is of the middle of the front: factor, and metres."""
PULL = 0.05
"""How strongly the common point is drawn to between both bodies, against how well it fits them."""
BENT = 0.1
"""How much a knee bends and stretches in the recording, about 8 degrees of deviation, at least."""
MOST = 4000
"""Frames that the common point is found from, at most."""


def add_joint_centres(motion: Motion, joints: Mapping[str, int]) -> tuple[Motion, dict[str, int]]:
    """Return motion with centres of hips and knees as more joints, and the joints by part and side.

    Both are as they were (joints as `landmarks` has them) where nothing tells where centres are. Of
    markers on the skin, ``left_thigh`` is the point that tells with hip and knee how a thigh is
    turned: the marker of the thigh that is farthest from their line, else the other hip.
    """
    names = [simplify_name(name.rpartition(":")[2]) for name in motion.skeleton.names]
    found = find_joints(motion.skeleton.names, MARKERS, exact=True, single=True)
    marker = {joint: points[0] for joint, points in found.items()}
    places = motion.positions
    made: dict[str, Floats] = {}
    # A skeleton with rotations has its joints at their centres; only markers need this.
    if motion.rotations is not None:
        return motion, dict(joints)
    centres = _find_hips(places, marker)
    # Without pelvis markers, joints that are named hips serve.
    hips = centres or {
        side: places[:, joints[f"{side}_hip"]] for side in SIDES if f"{side}_hip" in joints
    }
    if len(hips) < len(SIDES):
        return motion, dict(joints)
    to_left = hips["left"] - hips["right"]
    chosen = dict(joints)
    # From here per side: which ankle marker and which knee belong together.
    for side in SIDES:
        ankle = joints.get(f"{side}_ankle")
        letter = side[0].upper()
        bodies = [[j for j, name in enumerate(names) if name.startswith(letter + word)]
                  for word in ("THIGH", "SHANK")]  # fmt: skip
        if f"{side}_knee" in joints:
            # Only with markers on the skin: knee and ankle are then both at the outer side.
            outer = marker.get(f"{side}_outer_ankle") if centres else None
            chosen |= {} if outer is None else {f"{side}_ankle": outer}
        elif ankle is not None and min(map(len, bodies)) >= LEAST:
            ends = hips[side], places[:, ankle]
            knee = _find_knee(places[:, bodies[0]], places[:, bodies[1]], ends, to_left)
            made |= {} if knee is None else {f"{side}_knee": knee}
    if not made and not centres:
        return motion, chosen
    # Computed hips are added after the knees; `n + place` below relies on this order.
    made |= {f"{side}_hip": hip for side, hip in hips.items()}
    skeleton, n = motion.skeleton, motion.skeleton.n_joints
    extended = Skeleton(
        (*skeleton.names, *(f"centre of {part.replace('_', ' ')}" for part in made)),
        # New joints hang on joint 0 with no offset: only their positions are used.
        (*skeleton.parents, *[0] * len(made)),
        np.concatenate([skeleton.offsets, np.zeros((len(made), 3))]),
        skeleton.end_sites,
    )
    positions = np.concatenate([places, np.stack([*made.values()], axis=1)], axis=1)
    chosen |= {part: n + place for place, part in enumerate(made)}
    for side in SIDES:
        if f"{side}_knee" in chosen:
            hip, knee = (positions[:, chosen[f"{side}_{part}"]] for part in ("hip", "knee"))
            markers = [j for j, name in enumerate(names) if name[:1] == side[0].upper()
                       and "THI" in name[1:] and j not in chosen.values()]  # fmt: skip
            # Vectors from the line through hip and knee to each marker.
            aside = [remove_along(places[:, j] - knee, knee - hip) for j in markers]
            far = [float(np.median(np.linalg.norm(each, axis=1))) for each in aside]
            other = chosen[f"{OTHER_SIDE[side]}_hip"]
            chosen[f"{side}_thigh"] = markers[int(np.argmax(far))] if markers else other
    return replace(motion, skeleton=extended, positions=positions), chosen


def _find_hips(places: Floats, marker: Mapping[str, int]) -> dict[str, Floats]:
    """Both centres, from the file or the markers of the pelvis; none where these are not there."""
    given, fronts, backs = (
        [marker.get(f"{side}_{part}", -1) for side in SIDES]
        for part in ("hip_centre", "waist_front", "waist_back")
    )
    if min(given) >= 0:
        return {side: places[:, j] for side, j in zip(SIDES, given, strict=True)}
    # A marker on the sacrum replaces the two at the back.
    if min(backs) < 0:
        backs = [marker.get("sacrum", -1)]
    if min(fronts + backs) < 0:
        return {}
    front, back = places[:, fronts].mean(axis=1), places[:, backs].mean(axis=1)
    across, ahead = places[:, fronts[0]] - places[:, fronts[1]], front - back
    width, depth = (float(np.median(np.linalg.norm(each, axis=1))) for each in (across, ahead))
    # Axes of the pelvis: left, ahead without its share of left, and up.
    left = normalize(across)
    forward = normalize(remove_along(ahead, left))
    up = np.cross(forward, left)
    # Regression of Harrington et al.: factor times depth or width, plus a constant, in metres.
    middle = front + (DEPTH[0] * depth + DEPTH[1]) * forward
    middle = middle + (WIDTH_DOWN[0] * width + WIDTH_DOWN[1]) * up
    aside = (WIDTH_OUT[0] * width + WIDTH_OUT[1]) * left
    return {"left": middle + aside, "right": middle - aside}


def _find_knee(
    thigh: Floats, shank: Floats, ends: tuple[Floats, Floats], to_left: Floats
) -> Floats | None:
    """(frames, 3): the point about which two bodies turn, in line with hip and ankle."""
    upper, lower = _find_poses(thigh), _find_poses(shank)
    chosen = np.unique(np.linspace(0, len(thigh) - 1, min(len(thigh), MOST)).astype(np.intp))
    # Evenly spread frames; both rotations and both centres of these only.
    (turned, centre), (other, below) = ((r[chosen], c[chosen]) for r, c in (upper, lower))
    # (3 frames, 6): R1 c1 - R2 c2 = t2 - t1, linear in the local places c1 and c2 (Ehrig, SCoRE).
    both = np.concatenate([turned, -other], axis=2).reshape(-1, 6)
    # A hinge leaves one singular value near 0, the axis. A second small one: the knee does not
    # bend.
    if np.linalg.svd(both, compute_uv=False)[4] < BENT * np.sqrt(len(chosen)):
        return None
    # Weak extra equations: c1 near the middle of both bodies, which fixes the place on the axis.
    pulled = np.concatenate([turned, 0 * other], axis=2).reshape(-1, 6)
    apart = (below - centre).reshape(-1)
    found = np.linalg.lstsq(
        np.concatenate([both, PULL * pulled]), np.concatenate([apart, PULL * apart / 2])
    )[0]
    # The same point as each body sees it, averaged.
    at = (upper[0] @ found[:3] + upper[1] + lower[0] @ found[3:] + lower[1]) / 2
    # Leftward axis in the frame of the thigh, averaged over time, then turned back with the thigh.
    axis = normalize(
        np.einsum("fji,fj->fi", upper[0], normalize(to_left)).mean(axis=0, keepdims=True)
    )[0]
    axis = upper[0] @ axis
    # How far the middle of hip and ankle lies beside the point, along the axis.
    aside = (((ends[0] + ends[1]) / 2 - at) * axis).sum(axis=1)
    return np.asarray(at + float(np.median(aside)) * axis)


def _find_poses(markers: Floats) -> tuple[Floats, Floats]:
    """Rotations (frames, 3, 3) against the middle frame (Kabsch), and places of the middle."""
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


MOVES = 0.1
"""Radians by which a hinge deviates from its mean, at least, for its axis to be seen."""


def bend(before: Floats, joint: Floats, after: Floats) -> Floats:
    """By how much a chain of three points is bent at the middle one: 0 where they are in line.

    Parameters
    ----------
    before, joint, after : (frames, 3) array

    Returns
    -------
    (frames,) array
        Degrees, 0 to 180: 180 less the angle between the two limbs.

    Examples
    --------
    >>> bend(np.array([[0, 2.0, 0]]), np.array([[0, 1.0, 0]]), np.array([[0, 1.0, 1]])).round(6)
    array([90.])
    """
    return measure_angle(joint - before, after - joint)


def measure_angle(first: Floats, second: Floats) -> Floats:
    """Return the angle between vectors, degrees from 0 to 180; nan where one has no length.

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
    """By how much a vector is turned about an axis to lie in the direction of another.

    Degrees, -180 to 180, right-handed. What the vectors (frames, 3) have in the direction of the
    axis does not count.
    """
    flat = [remove_along(vectors, axis) for vectors in (first, second)]
    # The triple product with the unit axis: the sine with its sign.
    sine = (np.cross(flat[0], flat[1]) * normalize(axis)).sum(axis=-1)
    cosine = (flat[0] * flat[1]).sum(axis=-1)
    return np.asarray(np.degrees(np.arctan2(sine, cosine)))


def find_hinge_axis(upper: Floats, joint: Floats, lower: Floats, beside: Floats) -> Floats | None:
    """Return the axis (frames, 3) of a hinge such as a knee, which is fixed to the upper limb.

    The lower limb moves in a plane, as seen from the upper one. The axis is what is most at right
    angles to it in all frames, so markers need not be at the centre of the joint. ``beside`` is a
    point that tells how the upper limb is turned, such as a marker of the thigh. The axis has
    either sign; None where the hinge hardly moves.
    """
    # Directions of thigh and shank.
    along, limb = normalize(joint - upper), normalize(lower - joint)
    aside = normalize(remove_along(beside - joint, along))
    # (frames, 3, 3): rows are the axes of the upper limb; the shank is then given in them.
    frame = np.stack([aside, np.cross(along, aside), along], axis=1)
    seen = np.einsum("fij,fj->fi", frame, limb)
    # Eigenvalues ascend: the axis has least of the shank in it, the second tells how it swings.
    spreads, axes = np.linalg.eigh(seen.T @ seen / len(seen))
    if spreads[1] < MOVES**2:
        return None
    # Back to the coordinates of the recording.
    return np.asarray(np.einsum("fij,i->fj", frame, axes[:, 0]))


def remove_along(vectors: Floats, direction: Floats) -> Floats:
    """Return vectors without what they have in a direction."""
    direction = normalize(direction)
    return np.asarray(vectors - (vectors * direction).sum(axis=-1, keepdims=True) * direction)


def normalize(vectors: Floats) -> Floats:
    """Return vectors of length 1; those without a length stay 0."""
    # The floor avoids a division by 0; a vector of length 0 stays 0.
    return np.asarray(vectors / np.maximum(np.linalg.norm(vectors, axis=-1, keepdims=True), 1e-12))


def cardan(rotations: Floats) -> Floats:
    """Angles (x, z, y) whose product Rx Rz Ry is the rotation, degrees.

    The first turns about the axis from side to side, as flexion does in a skeleton whose pose of
    rest faces +z; the second about the axis ahead; the third about the upright one.

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
    # Rx Rz Ry is Rz Ry Rx with the axes named anew: x for z, z for y, y for x.
    w, x, y, z = rot.split_components(rotations)
    renamed = rot.join_components(w, y, z, x)
    return np.degrees(rot.to_euler_zyx(renamed))
