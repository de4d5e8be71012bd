"""Compute pose features, and stack them with neighbouring frames.

A pose is 15 numbers: x, y, z of the left ankle, right ankle, head, left wrist
and right wrist in the body's own frame, in metres. Stacked with the poses some frames
before and after it, it also shows the direction of movement.

The body's own frame has its origin at the pelvis, y up, and faces +z with left at +x. Each
frame is turned about the vertical, so that the body always faces the same way. Height
differences, pitch and roll are kept; limbs are not scaled. The heading follows from the axis of
the pelvis that points from the right hip to the left at rest. In the authors' program this is the
root's +x, as in CMU's files. Other exporters rotate the root frame, so the axis is found in the
skeleton: the nearest of +-x, +-y, +-z. For a motion without rotations it is the line through the
hips. If this axis is vertical (a body on its side, as in a cartwheel), the frame has no heading and
takes that of the nearest frame with one; at a tie the earlier frame. A motion without any heading
is not turned.

Presets whose features are rotations use those of 14 joints without the root, chosen by Barbič et
al. (2004) and Zhou et al. (2013). Their program maps the raw Euler angles of AMC files.
``Motion.rotations`` are the same rotations in other axes, constant per joint. This rotates each log
map as a whole and does not change distances.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike

from kineme._util import rotations as rot
from kineme._util.arrays import Floats
from kineme._util.checks import as_floats, as_indices
from kineme.errors import MotionError, ParameterError
from kineme.features.effectors import EndEffectors, Names, end_effectors
from kineme.recordings import Motion, Skeleton
from kineme.recordings.motion import check_motion

_UPRIGHT = 1e-6
"""Length of the horizontal part of the unit axis below which there is no heading."""
JOINTS = (
    *("lowerback", "upperback", "thorax", "lowerneck", "upperneck", "head"),
    *("rhumerus", "rradius", "lhumerus", "lradius"),
    *("rfemur", "rtibia", "lfemur", "ltibia"),
)


def compute_body_frame(
    motion: Motion, joints: tuple[int, ...] | None = None, *, effectors: EndEffectors | None = None
) -> Floats:
    """Return positions (frames, joints, 3) relative to the pelvis, without heading, in metres.

    x points to the body's left, y up, z ahead.

    Parameters
    ----------
    motion : Motion
    joints : tuple of int, optional
        Indices of the joints to return; by default all.
    effectors : EndEffectors, optional
        The ends of the legs, from which pelvis and hips follow; by default found by name or
        shape.

    Raises
    ------
    EndEffectorError
        The legs were not found.
    MotionError
        The legs have no hips, so left and right are unknown.

    References
    ----------
    Voegele et al. 2014, section 3.1; heading as in the authors' program.

    Examples
    --------
    >>> import kineme
    >>> from kineme.features import compute_body_frame
    >>> motion = kineme.read(kineme.bundled_recording())
    >>> compute_body_frame(motion).shape == motion.positions.shape
    True
    """
    pelvis, cos, sin = _compute_turns(motion, effectors or end_effectors(motion))
    positions = motion.positions if joints is None else motion.positions[:, joints]
    relative = positions - motion.positions[:, pelvis, None]
    # Copy x, as its column is overwritten before it is used for z.
    x, z = relative[:, :, 0].copy(), relative[:, :, 2]
    relative[:, :, 0] = cos * x + sin * z
    relative[:, :, 2] = cos * z - sin * x
    return relative


def compute_heading(motion: Motion, *, effectors: EndEffectors | None = None) -> tuple[int, Floats]:
    """Return the pelvis joint, and the heading (frames,): the angle between facing and +z.

    Radians about the vertical, positive towards +x. ``compute_body_frame`` removes this
    angle; its arguments and errors are the same.

    Examples
    --------
    >>> import kineme
    >>> from kineme.features import compute_heading
    >>> motion = kineme.read(kineme.bundled_recording())
    >>> pelvis, angles = compute_heading(motion)
    >>> motion.skeleton.names[pelvis], angles.shape
    ('Hips', (2898,))
    """
    pelvis, cos, sin = _compute_turns(motion, effectors or end_effectors(motion))
    # `_compute_turns` returns the turn back to +z: the negative heading.
    return pelvis, np.arctan2(-sin, cos)[:, 0]


def _compute_turns(motion: Motion, effectors: EndEffectors) -> tuple[int, Floats, Floats]:
    """Return the pelvis, and cosine and sine (frames, 1) of the turns that remove the heading."""
    ankles = effectors.left_ankle, effectors.right_ankle
    pelvis, left_hip, right_hip = find_parting(motion.skeleton, *ankles)
    if motion.rotations is None:
        to_left = motion.positions[:, left_hip] - motion.positions[:, right_hip]
        # A line shorter than the threshold does not become a unit vector and counts as vertical.
        to_left /= np.maximum(np.linalg.norm(to_left, axis=1, keepdims=True), _UPRIGHT)
    else:
        rest = _measure_hip_axis(motion.skeleton, pelvis, left_hip, right_hip)
        to_left = np.zeros(3)
        # Coordinate axis nearest to the line of the hips, with its sign.
        to_left[np.argmax(np.abs(rest))] = np.sign(rest[np.argmax(np.abs(rest))])
        # Local rotations from the pelvis up to the root transform the axis to the world.
        for joint in reversed(motion.skeleton.ancestry(pelvis)):
            to_left = rot.rotate(motion.rotations[:, joint], to_left)
    return pelvis, *find_facing(to_left, _UPRIGHT)


def find_parting(
    skeleton: Skeleton, left_end: int, right_end: int, limbs: str = "legs"
) -> tuple[int, int, int]:
    """Return the joint at which two limbs branch, and the first separate left and right joint.

    Legs branch at the pelvis, arms at the chest. Raise MotionError if they are not connected.
    """
    left, right = skeleton.ancestry(left_end), skeleton.ancestry(right_end)
    # Both chains begin at the root and are equal down to the joint where the limbs branch.
    shared = sum(1 for a, b in zip(left, right, strict=False) if a == b)
    if shared == 0:
        raise MotionError(f"the {limbs} belong to different roots, so no joint connects them")
    pelvis = left[shared - 1]
    # Some skeletons have several joints at the same place below it.
    for left_hip, right_hip in zip(left[shared:], right[shared:], strict=False):
        if np.linalg.norm(_measure_hip_axis(skeleton, pelvis, left_hip, right_hip)) > 0:
            return pelvis, left_hip, right_hip
    raise MotionError(
        f"left and right {limbs} coincide below {skeleton.names[pelvis]!r}, so the facing "
        "direction is unknown"
    )


def _measure_hip_axis(skeleton: Skeleton, pelvis: int, left_hip: int, right_hip: int) -> Floats:
    """Return the vector from the right hip to the left, in the pelvis's own frame, at rest."""
    chains = [skeleton.ancestry(hip) for hip in (left_hip, right_hip)]
    # Offsets below the pelvis only: at rest they are in the pelvis's own axes.
    left, right = (
        skeleton.offsets[chain[chain.index(pelvis) + 1 :]].sum(axis=0) for chain in chains
    )
    return np.asarray(left - right, np.float64)


def find_facing(to_left: Floats, least: float | Floats) -> tuple[Floats, Floats]:
    """Return cosine and sine (frames, 1) of the turn about y that brings a left axis to +x.

    Frames in which the horizontal part of the axis is at most ``least`` long take the turn of the
    nearest other frame. If there is none, nothing is turned.
    """
    length = np.hypot(to_left[:, 0], to_left[:, 2])
    with_heading = np.flatnonzero(length > least)
    if len(with_heading) == 0:
        return np.ones((len(length), 1)), np.zeros((len(length), 1))
    # `searchsorted` among midpoints finds the nearest frame; at a tie the earlier one.
    middles = (with_heading[:-1] + with_heading[1:]) / 2
    nearest = with_heading[np.searchsorted(middles, np.arange(len(length)))]
    to_left, length = to_left[nearest], length[nearest]
    return (to_left[:, 0] / length)[:, None], (to_left[:, 2] / length)[:, None]


def pose_features(motion: Motion, *, effectors: EndEffectors | Names | None = None) -> Floats:
    """Return the positions (frames, 15) of the end effectors in the body's own frame, in metres.

    Parameters
    ----------
    motion : Motion
    effectors : EndEffectors or mapping of str to str or sequence of str, optional
        The end effectors or their names (see ``end_effectors``); by default they are searched.

    Raises
    ------
    EndEffectorError
        Head, hands or feet were not found.

    References
    ----------
    Voegele et al. 2014, section 3.1 (feature set of 15 values).

    Examples
    --------
    >>> import kineme
    >>> motion = kineme.read(kineme.bundled_recording())
    >>> kineme.pose_features(motion).shape
    (2898, 15)
    """
    check_motion(motion, "pose_features")
    if not isinstance(effectors, EndEffectors):
        effectors = end_effectors(motion, names=effectors)
    local = compute_body_frame(motion, effectors.indices, effectors=effectors)
    return local.reshape(len(local), -1)


def stack(features: ArrayLike, offsets: Sequence[int]) -> Floats:
    """Stack frames with their neighbours: row t holds ``features[t + o]`` for ascending offsets o.

    Beyond both ends, features are extrapolated linearly from the two outermost frames; a
    single frame is repeated.

    Parameters
    ----------
    features : array_like of shape (frames, dims)
    offsets : sequence of int
        Frames relative to t; 0 is not added automatically.

    Returns
    -------
    (frames, dims * number of offsets) array

    Raises
    ------
    ParameterError
        The features are not two-dimensional or have no rows; or offsets are empty or not distinct.

    Examples
    --------
    >>> import kineme
    >>> kineme.stack([[0.0], [1.0], [2.0]], [-1, 0]).tolist()
    [[-1.0, 0.0], [0.0, 1.0], [1.0, 2.0]]
    """
    features = as_floats(features, "features")
    offsets = as_indices(offsets, "offsets")
    if features.ndim != 2 or len(features) == 0:
        raise ParameterError(f"features must be frames x dims, not of shape {features.shape}")
    if len(offsets) == 0 or len(set(offsets)) < len(offsets):
        raise ParameterError(f"offsets must be different frames, at least one, not {offsets!r}")
    # Number of frames that are needed beyond each end.
    before, after = max(0, -min(offsets)), max(0, *offsets)
    frames, dims = features.shape
    first_step = features[1] - features[0] if frames > 1 else np.zeros(dims)
    last_step = features[-1] - features[-2] if frames > 1 else first_step
    # The farthest frame is the first in time, so multiples descend.
    head = features[0] - np.arange(before, 0, -1)[:, None] * first_step
    tail = features[-1] + np.arange(1, after + 1)[:, None] * last_step
    longer = np.concatenate([head, features, tail])
    stacked = np.empty((frames, len(offsets), dims))
    for block, offset in enumerate(sorted(offsets)):
        # Frame t + offset of the features is row before + t + offset of the longer array.
        stacked[:, block] = longer[before + offset : before + offset + frames]
    return stacked.reshape(frames, -1)


def round_offsets(offsets_s: Sequence[float], fps: float) -> tuple[int, ...]:
    """Convert offsets from seconds to whole frames, ascending.

    Raises
    ------
    ParameterError
        An offset is not finite, or two fall on the same frame.

    Examples
    --------
    >>> from kineme.features import round_offsets
    >>> round_offsets([-0.1, 0.0, 0.1], 30.0)
    (-3, 0, 3)
    """
    if not (fps > 0 and np.isfinite(fps)):
        raise ParameterError(f"fps must be a positive number, not {fps!r}")
    if not np.all(np.isfinite(offsets_s)):
        raise ParameterError(f"offsets must be finite seconds, not {offsets_s!r}")
    frames = tuple(sorted(round(offset * fps) for offset in offsets_s))
    if len(set(frames)) < len(frames):
        raise ParameterError(
            f"offsets {tuple(offsets_s)} s fall on the same frame at {fps:g} Hz: choose "
            "wider offsets"
        )
    return frames


def compute_joint_quaternions(motion: Motion) -> Floats:
    """Return the local rotations of the 14 joints: unit quaternions (w, x, y, z) with w >= 0.

    The result is (frames, 14, 4). Raise MotionError if the motion has no rotations, or lacks one of
    these joints.
    """
    if motion.rotations is None:
        raise MotionError("these methods need rotations, but the motion has positions only")
    names = motion.skeleton.names
    missing = [joint for joint in JOINTS if joint not in names]
    if missing:
        raise MotionError(
            f"no joint {missing[0]!r} in the skeleton; these methods need the joints of CMU's "
            f"ASF files: {', '.join(JOINTS)}"
        )
    q = motion.rotations[:, [names.index(joint) for joint in JOINTS]]
    # q and -q are the same rotation; w >= 0 selects the shorter one.
    return np.where(q[..., :1] < 0, -q, q)


def compute_log_maps(quaternions: Floats) -> Floats:
    """Return half of the rotation vector of each quaternion (frames, joints, 4) with w >= 0.

    The result is (frames, 3 * joints).
    """
    half = np.arccos(np.clip(quaternions[..., :1], -1, 1))
    # `sinc(half / pi)` is sin(half) / half, and 1 at the identity, which avoids a division by 0.
    logs = quaternions[..., 1:] / np.sinc(half / np.pi)
    return logs.reshape(len(logs), -1)
