"""What a page draws of a motion: where its joints are, small enough to be sent once.

The poses are those at 0, 1/30, 2/30, ... seconds (those of the file if it has
fewer), joined in straight lines. Each coordinate of each joint is a column of
whole numbers: ``position = origin + step * number``; -32768 stands for what was
not seen. Columns follow each other, joint by joint, x, y, z of each. A column
holds its first number, then the differences, as 16-bit integers, little end
first, which wrap around; all columns together are compressed with zlib.

``step`` is a ten-thousandth of the body, or a two-thousandth where that would
be too long; motions longer still are shown at a lower rate.
"""

from __future__ import annotations

import zlib
from math import floor

import numpy as np
from numpy.typing import NDArray

from kineme._util.arrays import Floats
from kineme.errors import MotionError
from kineme.features import PARTS, Names, compute_heading, end_effectors
from kineme.recordings import Motion
from kineme.recordings.joint_names import PARENTS
from kineme.web.messages import MotionHead

RATE = 30.0  # poses per second: what a page plays without visible steps
MOST_BYTES = 11_000_000  # so that the report of an hour, with all else in it, is under 30 MB
MISSING = -32768
BLOCK = 1000  # poses that stay in the processor's cache
FINE, COARSE = 1e-4, 5e-4  # steps, as shares of the body's largest extent


def display_motion(
    motion: Motion,
    *,
    effectors: Names | None = None,
    rate: float = RATE,
    most_bytes: int = MOST_BYTES,
) -> tuple[MotionHead, bytes]:
    """How to read the binary motion, and the binary motion, as described above.

    ``effectors`` are as `kineme.features.end_effectors` takes them, ``rate`` is how many poses a
    second are sent at most. Above ``most_bytes``, fewer digits are sent, then fewer poses.

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
    # Fine numbers take more than a byte each, so that many of them need not be tried.
    for share in (FINE, COARSE) if positions.size <= most_bytes else (COARSE,):
        origin, step, data = encode_positions(positions, share)
        if len(data) <= most_bytes:
            break
    # Poses farther apart differ more, so that half of them take more than half the length.
    while len(data) > most_bytes and len(positions) > 2:
        fps *= max(0.25, 0.9 * most_bytes / len(data))
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
    """Poses (samples, joints, 3) at another rate, on straight lines between frames; nan in gaps."""
    ratio = motion.fps / fps
    # The small number keeps a last pose that rounding would lose.
    n = floor((motion.n_frames - 1) / ratio + 1e-9) + 1
    at = np.minimum(np.arange(n) * ratio, motion.n_frames - 1)
    # It also keeps a frame that rounding puts just before itself.
    before = np.floor(at + 1e-9).astype(np.intp)
    share = np.maximum(at - before, 0)[:, None, None]
    positions: Floats = motion.positions[before]
    # Where all samples are frames there is nothing to interpolate.
    if share.max() > 1e-6:
        after = np.minimum(before + 1, motion.n_frames - 1)
        positions += share * (motion.positions[after] - positions)
    for start, stop in motion.gaps:
        # A sample between a seen frame and one in a gap is not seen either.
        positions[(at > start - 1) & (at < stop)] = np.nan
    return positions


def encode_positions(
    positions: Floats, share: float
) -> tuple[tuple[float, float, float], float, bytes]:
    """Origin and step in metres, and positions (samples, joints, 3) as whole numbers, compressed.

    The step is a share of the largest extent of the median pose. It becomes larger where 16 bits do
    not reach both ends of the recording.
    """
    visible = np.asarray(np.isfinite(positions).all(axis=2))
    everywhere = bool(visible.all())
    # All of them without a copy, which would be of hours.
    points = positions.reshape(-1, 3) if everywhere else positions[visible]
    if not len(points):
        points = np.zeros((1, 3))
    low, high = points.min(axis=0), points.max(axis=0)
    origin = (low + high) / 2
    # A step so large that 16 bits reach both ends of the recording; 1 if nothing moves.
    step = (
        max(share * _measure_extent(positions, visible), float((high - low).max()) / 65000) or 1.0
    )
    numbers = np.full(positions.shape, MISSING, np.int16)
    if everywhere:
        # In blocks that stay in the cache, without a copy of the whole.
        for first in range(0, len(positions), BLOCK):
            span = slice(first, first + BLOCK)
            numbers[span] = np.rint((positions[span] - origin) / step)
    else:
        numbers[visible] = np.rint((points[: visible.sum()] - origin) / step)
    # One row for each coordinate of each joint.
    columns = np.ascontiguousarray(numbers.reshape(len(numbers), -1).T)
    # Differences compress better; 16-bit integers wrap around, and so do their sums when decoded.
    columns[:, 1:] -= columns[:, :-1].copy()
    x, y, z = origin.tolist()
    return (x, y, z), step, zlib.compress(columns.astype("<i2").tobytes(), 6)


def list_bones(motion: Motion) -> list[tuple[int, int]]:
    """Pairs of joints (parent, child) to draw a line between.

    Of markers only the joints made from them are joined: the markers themselves hang on the pelvis
    for want of anything better.
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
    of_bodies = [(a, b) for a, b in pairs if PARENTS.get(names[b]) == names[a]]
    return of_bodies or pairs


def _measure_extent(positions: Floats, visible: NDArray[np.bool_]) -> float:
    """Largest extent of the median pose along an axis, in metres."""
    complete = np.flatnonzero(visible.all(axis=1))
    if not len(complete):
        return 0.0
    # Some thousand poses are enough for a median.
    few = positions[complete[:: max(1, len(complete) // 1000)]]
    return float(np.median(np.ptp(few, axis=1).max(axis=1)))


def _find_headings(
    motion: Motion, effectors: Names | None, n_samples: int, fps: float
) -> tuple[dict[str, int], list[float] | None]:
    """Joints of the parts and of the pelvis, and the heading of each sample, where known."""
    try:
        found = end_effectors(motion, names=effectors)
    except MotionError:
        return {}, None
    joints = dict(zip(PARTS, found.indices, strict=True))
    try:
        pelvis, angles = compute_heading(motion, effectors=found)
    except MotionError:
        return joints, None
    # Nearest frame of each sample: angles cannot be interpolated across ±180°.
    nearest = np.rint(np.arange(n_samples) * (motion.fps / fps)).astype(np.intp)
    shown = angles[np.minimum(nearest, motion.n_frames - 1)].round(3)
    return {**joints, "pelvis": pelvis}, shown.tolist()
