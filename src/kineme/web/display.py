"""Compress the joint positions of a motion, and keypoints over a video, for a page.

Poses are sampled at 30 Hz (or the frame rate if that is lower) and interpolated linearly. Each
coordinate of each joint is a column of integers: ``position = origin + step * number``; -32768
marks a missing value. Columns are ordered by joint, then x, y, z. A column holds its first number,
then differences, as little-endian 16-bit integers that wrap around. All columns are compressed with
zlib.

``step`` is 1/10000 of the body's extent, or 1/2000 if the data would get too large. Even longer
motions are sampled at a lower rate.

Keypoints over a video are encoded like poses: x and y are pixels, y from the top, and z is the
confidence in hundredths.
"""

from __future__ import annotations

import zlib
from dataclasses import dataclass
from math import floor
from pathlib import Path

import numpy as np
from msgspec import UNSET
from numpy.typing import NDArray

from kineme._util.arrays import Floats
from kineme._util.files import find_video
from kineme.errors import MotionError
from kineme.features import PARTS, Names, compute_heading, end_effectors
from kineme.formats.keypoints.overlay import find_overlay
from kineme.recordings import Motion
from kineme.recordings.joint_names import PARENTS
from kineme.web.messages import MotionHead, Picture, Video

RATE = 30.0  # poses per second; playback looks smooth
MAX_BYTES = 11_000_000  # keeps the report of an hour under 30 MB
MISSING = -32768
BLOCK = 1000  # poses that fit into the CPU cache
FINE, COARSE = 1e-4, 5e-4  # steps relative to the largest extent of the body


def display_motion(
    motion: Motion,
    *,
    effectors: Names | None = None,
    rate: float = RATE,
    max_bytes: int = MAX_BYTES,
) -> tuple[MotionHead, bytes]:
    """Return the header and the compressed poses of a motion, as described above.

    ``effectors`` are passed to `kineme.features.end_effectors`. ``rate`` is the highest number of
    poses per second. Above ``max_bytes``, coarser numbers are sent, then fewer poses.

    Examples
    --------
    >>> import kineme
    >>> from kineme.datasets import bundled_recording
    >>> head, data = display_motion(kineme.read(bundled_recording()))
    >>> head.sample_fps
    30.0
    """
    fps = min(motion.fps, rate)
    positions = sample_poses(motion, fps)
    # Fine numbers take over a byte each, so skip them if there are more numbers than bytes.
    for share in (FINE, COARSE) if positions.size <= max_bytes else (COARSE,):
        origin, step, data = encode_positions(positions, share)
        if len(data) <= max_bytes:
            break
    # Differences grow with the interval, so half the poses need more than half the bytes.
    while len(data) > max_bytes and len(positions) > 2:
        fps *= max(0.25, 0.9 * max_bytes / len(data))
        positions = sample_poses(motion, fps)
        origin, step, data = encode_positions(positions, COARSE)
    joints, angles = _find_headings(motion, effectors, len(positions), fps)
    head = MotionHead(
        n_samples=len(positions),
        sample_fps=fps,
        joints=list(motion.skeleton.names),
        parents=list(motion.skeleton.parents),
        bones=list_bones(motion),
        origin=origin,
        step=step,
        heading=angles,
        effectors=joints,
    )
    return head, data


def sample_poses(motion: Motion, fps: float) -> Floats:
    """Return poses (samples, joints, 3) at another rate, interpolated linearly; nan in gaps."""
    ratio = motion.fps / fps
    # The small number keeps the last pose despite rounding errors.
    n = floor((motion.n_frames - 1) / ratio + 1e-9) + 1
    at = np.minimum(np.arange(n) * ratio, motion.n_frames - 1)
    # Here it keeps samples that coincide with a frame on that frame.
    before = np.floor(at + 1e-9).astype(np.intp)
    share = np.maximum(at - before, 0)[:, None, None]
    positions: Floats = motion.positions[before]
    # Nothing to interpolate if all samples coincide with frames.
    if share.max() > 1e-6:
        after = np.minimum(before + 1, motion.n_frames - 1)
        positions += share * (motion.positions[after] - positions)
    for start, stop in motion.gaps:
        # Samples between a frame and a gap are missing, too.
        positions[(at > start - 1) & (at < stop)] = np.nan
    return positions


def encode_positions(
    positions: Floats, share: float
) -> tuple[tuple[float, float, float], float, bytes]:
    """Return origin and step in metres, and the compressed positions (samples, joints, 3).

    ``share`` is the step relative to the largest extent of the median pose. The step is larger if
    the recording would exceed the range of 16-bit integers.
    """
    visible = np.asarray(np.isfinite(positions).all(axis=2))
    all_visible = bool(visible.all())
    # Avoid a copy, which is large for hours of motion.
    points = positions.reshape(-1, 3) if all_visible else positions[visible]
    if not len(points):
        points = np.zeros((1, 3))
    low, high = points.min(axis=0), points.max(axis=0)
    origin = (low + high) / 2
    # 16 bits must reach both ends of the recording; 1 if nothing moves.
    step = (
        max(share * _measure_extent(positions, visible), float((high - low).max()) / 65000) or 1.0
    )
    numbers = np.full(positions.shape, MISSING, np.int16)
    if all_visible:
        # Convert in blocks that fit into the CPU cache.
        for first in range(0, len(positions), BLOCK):
            span = slice(first, first + BLOCK)
            numbers[span] = np.rint((positions[span] - origin) / step)
    else:
        numbers[visible] = np.rint((points[: visible.sum()] - origin) / step)
    # One row per coordinate of each joint.
    columns = np.ascontiguousarray(numbers.reshape(len(numbers), -1).T)
    # Differences compress better; overflow is undone when the page sums them with wrap-around.
    columns[:, 1:] -= columns[:, :-1].copy()
    x, y, z = origin.tolist()
    return (x, y, z), step, zlib.compress(columns.astype("<i2").tobytes(), 6)


def list_bones(motion: Motion) -> list[tuple[int, int]]:
    """Return pairs of joints (parent, child) to connect with a line.

    Markers have no bones: their parent is only formally the pelvis. Of marker data, only computed
    joints are connected.
    """
    skeleton = motion.skeleton
    lengths = np.linalg.norm(skeleton.offsets, axis=1)
    pairs = [
        (parent, joint)
        for joint, parent in enumerate(skeleton.parents)
        if parent >= 0 and lengths[joint] > 0
    ]
    if motion.rotations is not None:
        return pairs
    names = skeleton.names
    computed = [(a, b) for a, b in pairs if PARENTS.get(names[b]) == names[a]]
    return computed or pairs


def _measure_extent(positions: Floats, visible: NDArray[np.bool_]) -> float:
    """Return the largest extent of the median pose along an axis, in metres."""
    complete = np.flatnonzero(visible.all(axis=1))
    if not len(complete):
        return 0.0
    # About a thousand poses are enough for a median.
    few = positions[complete[:: max(1, len(complete) // 1000)]]
    return float(np.median(np.ptp(few, axis=1).max(axis=1)))


def _find_headings(
    motion: Motion, effectors: Names | None, n_samples: int, fps: float
) -> tuple[dict[str, int], list[float] | None]:
    """Return the joints of body parts and pelvis, and the heading of each sample, if known."""
    try:
        effector_joints = end_effectors(motion, names=effectors)
    except MotionError:
        return {}, None
    joints = dict(zip(PARTS, effector_joints.indices, strict=True))
    try:
        pelvis, angles = compute_heading(motion, effectors=effector_joints)
    except MotionError:
        return joints, None
    # Take the nearest frame, since angles cannot be interpolated across ±180°.
    nearest = np.rint(np.arange(n_samples) * (motion.fps / fps)).astype(np.intp)
    sampled_angles = angles[np.minimum(nearest, motion.n_frames - 1)].round(3)
    return {**joints, "pelvis": pelvis}, sampled_angles.tolist()


@dataclass(frozen=True, eq=False)
class DrawnPicture:
    """Keypoints of a recording in the picture of its video.

    ``picture`` tells how to read ``binary``. ``start_s`` is the time in the video at which the
    recording starts.
    """

    picture: Picture
    binary: bytes
    start_s: float


def draw_picture(recording: Path, person: str | None = None) -> DrawnPicture | None:
    """Return the keypoints over the video of a recording; None if its poses are not from one."""
    overlay = find_overlay(recording, person)
    if overlay is None or not overlay.width:
        return None
    origin, step, binary = encode_positions(overlay.points * np.array([1.0, 1.0, 100.0]), FINE)
    head = MotionHead(
        n_samples=len(overlay.points),
        sample_fps=overlay.fps,
        joints=list(overlay.names),
        parents=[-1] * len(overlay.names),
        bones=list(overlay.lines),
        origin=origin,
        step=step,
        heading=None,
        effectors={},
    )
    picture = Picture(width=overlay.width, height=overlay.height, keypoints=head)
    return DrawnPicture(picture, binary, overlay.start_s)


def describe_video(
    recording: Path, picture: DrawnPicture | None, offset_s: float | None = None
) -> Video | None:
    """Return the message about the video of a recording; None if there is none.

    ``offset_s`` is the time in the video at which the recording starts, if the user set it.
    """
    path = find_video(recording)
    if path is None:
        return None
    start = picture.start_s if picture and offset_s is None else offset_s or 0.0
    return Video(name=path.name, offset_s=start, picture=picture.picture if picture else UNSET)
