"""Make clips loop seamlessly by blending the end into the beginning, and rank possible loops.

When a loop repeats, the first frame follows the last one, moved on and turned. A `Carry` describes
this motion: a turn about the vertical and a shift on the floor, as in a player with root motion.
The seam lies half a frame after the last frame, which is half a frame before the first.

1. Position, speed and acceleration on both sides of the seam come from parabolas fitted to the last
   and the first 0.035 s (at least four frames).
2. The carry is the rigid motion on the floor that brings the pose after the seam closest to the one
   before it: Kovar, Gleicher, Pighin, Motion Graphs, SIGGRAPH 2002, section 3.1, with equal weights
   of all joints.
3. The remaining step of the pose is spread linearly over the clip, half of it on either side. This
   moves the ends least and changes speeds by a constant only.
4. The steps of speed and acceleration are spread over 0.4 s on either side, by curves that are zero
   at the seam. So position, speed and acceleration become continuous.
5. Rotations are corrected along the shorter arc, those of roots after applying the carry;
   translations, and positions without rotations, linearly.

Frame rate and number of frames do not change.

The candidates of a cluster are ranked by these measures:

1. The step of pose and of speed at the seam, which blending has to remove.
2. The remaining step from the last frame to the first, and its change, both relative to steps
   within the recording.
3. The sliding of planted feet in the loop.
4. The turn and rise of the body in one round.
5. The distance of poses from the typical poses of the cluster, by phase.

Each measure is divided by its unit in `COSTS`. The sum is the cost of a loop; the candidate with
the lowest cost ranks first. Seam and feet have the greatest weights, since they are most visible.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import asdict, dataclass, replace
from math import atan2, cos, sin

import numpy as np
from numpy.typing import NDArray

from kineme._util import rotations as rot
from kineme._util.arrays import Floats, Masks, interpolate_frames
from kineme.recordings import Motion
from kineme.recordings.carriers import (
    find_carriers,
    find_still_joints,
    place_frames,
    to_parent_axes,
    to_world_axes,
)
from kineme.recordings.kinematics import forward_kinematics
from kineme.recordings.operations import cut

NEAR_S = 0.035
"""Seconds at either end of a clip used to fit the parabolas."""
FEWEST = 4
"""Least number of frames for a parabola; a line is fitted to fewer."""
BLEND_S = 0.4
"""Seconds on either side of a seam over which steps of speed and acceleration are spread."""
USUAL = 95.0
"""Percentile that defines the usual large steps of a recording."""
PHASES = 24
"""Number of phases of a round at which poses are compared."""
COSTS = {
    "pose_m": 0.03,
    "speed_m_s": 0.3,
    "step": 1.0,
    "speed_step": 1.0,
    "slide_m_s": 0.1,
    "turn_deg": 180.0,
    "rise_m": 0.2,
    "unlike_m": 1.0,
}
"""Amount of each measure that costs 1."""


@dataclass(frozen=True)
class Carry:
    """Motion on the floor from one round of a loop to the next: a turn, then a shift.

    ``turn`` in radians, ``x`` and ``z`` in metres, as `kineme.recordings.operations.turn`
    and `kineme.recordings.operations.move` take them.
    """

    turn: float
    x: float
    z: float

    @property
    def rotation(self) -> Floats:
        """Return the turn as a quaternion."""
        return rot.rotate_about_y(self.turn)

    @property
    def shift(self) -> Floats:
        return np.array([self.x, 0.0, self.z])

    def apply(self, positions: Floats) -> Floats:
        """Return positions one round later."""
        return rot.rotate(self.rotation, positions) + self.shift


def make_loop(motion: Motion) -> tuple[Motion, Carry]:
    """Return the motion as a seamless loop, and its carry.

    A motion of fewer than two frames is returned unchanged.
    """
    if motion.n_frames < 2:
        return motion, Carry(0.0, 0.0, 0.0)
    carry, fps = find_carry(motion), motion.fps
    provenance = motion.provenance.noted("ends blended into a loop")
    if motion.rotations is None:
        # Without rotations no joint depends on another: the carry applies to all.
        free = np.ones(motion.positions.shape[1], bool)
        positions = _close_translations(motion.positions, fps, carry, free)
        return replace(motion, positions=positions, provenance=provenance), carry
    skeleton, still = motion.skeleton, find_still_joints(motion)
    # Joints in world axes, to which the carry applies.
    free = find_carriers(skeleton, still)
    rotations, translations = to_world_axes(motion, still)
    rotations, translations = to_parent_axes(
        skeleton,
        _close_rotations(rotations, fps, carry, free),
        _close_translations(translations, fps, carry, free),
        still,
    )
    positions = forward_kinematics(skeleton, rotations, translations=translations)
    return Motion(skeleton, positions, fps, rotations, provenance), carry


def repeat_first_frame(motion: Motion, carry: Carry) -> Motion:
    """Append the first frame of a loop, moved by the carry, as game engines expect."""
    still, rotations = find_still_joints(motion), motion.rotations
    turn = np.array([carry.turn])
    again = place_frames(cut(motion, 0, 1), turn, np.zeros(3), carry.shift, still)
    if rotations is not None and again.rotations is not None:
        rotations = np.concatenate([rotations, again.rotations])
    positions = np.concatenate([motion.positions, again.positions])
    provenance = motion.provenance.noted("first frame repeated at the end")
    return replace(motion, positions=positions, rotations=rotations, provenance=provenance)


def find_carry(motion: Motion) -> Carry:
    """Return the carry that best aligns the pose after the seam with the one before it."""
    if motion.n_frames < 2:
        return Carry(0.0, 0.0, 0.0)
    before, after = compute_seam_sides(motion.positions[:, motion.skeleton.body], motion.fps)
    # The values at the seam; speed and acceleration are not needed here.
    first, last = after[0], before[0]
    # Means of both poses on the floor.
    (x, _, z), (u, _, w) = (pose.mean(axis=0) for pose in (first, last))
    a, b = first - first.mean(axis=0), last - last.mean(axis=0)
    # Best turn about y in closed form (Kovar et al. 2002, section 3.1, equal weights).
    across = float(a[:, 2] @ b[:, 0] - a[:, 0] @ b[:, 2])
    turn = atan2(across, float(a[:, 0] @ b[:, 0] + a[:, 2] @ b[:, 2]))
    # The shift brings the turned mean of the first pose onto the mean of the last.
    to_x = float(u - x * cos(turn) - z * sin(turn))
    return Carry(turn, to_x, float(w + x * sin(turn) - z * cos(turn)))


def compute_seam_sides(values: Floats, fps: float) -> tuple[Floats, Floats]:
    """Return value, speed and acceleration (3, ...) before and after the seam, per frame.

    ``values`` (frames, ...) needs at least two frames.
    """
    n_fit = min(len(values), max(FEWEST, round(NEAR_S * fps)))
    # The seam is at 0: half a frame after the last frame and half a frame before the first.
    return _extrapolate_seam(values[-n_fit:], 0.5 - n_fit), _extrapolate_seam(values[:n_fit], 0.5)


def _extrapolate_seam(values: Floats, first: float) -> Floats:
    """Fit a parabola to values at frames from ``first`` on; return its derivatives at 0."""
    frames = first + np.arange(len(values))
    degree = 2 if len(frames) >= FEWEST else 1
    # Least-squares fit: the columns of the Vandermonde matrix are 1, t, t².
    fit = np.linalg.pinv(np.vander(frames, degree + 1, increasing=True))
    derivatives = np.zeros((3, *values.shape[1:]))
    derivatives[: degree + 1] = np.tensordot(fit, values, axes=1)
    # The second derivative of a parabola is twice its coefficient.
    derivatives[2] *= 2
    return derivatives


def _close_rotations(
    rotations: Floats, fps: float, carry: Carry, roots: NDArray[np.bool_]
) -> Floats:
    """Return rotations corrected so that they are continuous over the seam."""
    first, last = rotations[0], rotations[-1]
    # Rotation vectors relative to the nearest frame are small, so they add up like vectors.
    before, _ = compute_seam_sides(
        rot.to_rotation_vectors(rot.multiply(rot.conjugate(last), rotations)), fps
    )
    _, after = compute_seam_sides(
        rot.to_rotation_vectors(rot.multiply(rot.conjugate(first), rotations)), fps
    )
    ahead = np.array(first)
    # The first frame as it is one round later.
    ahead[roots] = rot.multiply(carry.rotation, ahead[roots])
    # Rotations on both sides of the seam.
    left = rot.multiply(last, rot.from_rotation_vectors(before[0]))
    right = rot.multiply(ahead, rot.from_rotation_vectors(after[0]))
    gaps = after - before
    # The step of pose along the shorter arc; the steps of speed are differences of vectors.
    gaps[0] = rot.to_rotation_vectors(rot.multiply(rot.conjugate(left), right))
    # (frames, 3) times (3, joints, 3): correction of each joint in each frame.
    added = np.tensordot(_compute_shares(len(rotations), fps), gaps, axes=1)
    return rot.normalize(rot.multiply(rotations, rot.from_rotation_vectors(added)))


def _close_translations(
    places: Floats, fps: float, carry: Carry, free: NDArray[np.bool_]
) -> Floats:
    """Return translations corrected so that they are continuous over the seam.

    The carry applies to ``free`` joints; the others are relative to a parent. Corrections of free
    joints turn along with the carry, so that they fit at both ends.
    """
    before, after = compute_seam_sides(places, fps)
    # Value, speed and acceleration are turned, and only the value is shifted as well.
    after[:, free] = rot.rotate(carry.rotation, after[:, free])
    after[0, free] += carry.shift
    shares = _compute_shares(len(places), fps)
    added = np.tensordot(shares, after - before, axes=1)
    turns = np.zeros((len(places), 1, 3))
    # Steps are in the axes of the last frame; earlier frames have turned less by their share.
    turns[:, 0, 1] = carry.turn * (shares[:, 0] - 0.5)
    added[:, free] = rot.rotate(rot.from_rotation_vectors(turns), added[:, free])
    closed: Floats = places + added
    return closed


def _compute_shares(n: int, fps: float) -> Floats:
    """Return corrections (frames, 3) for unit steps of pose, speed and acceleration.

    With t frames from the seam, negative before it, and k = (1 - |t| / width)^3: the share of the
    step of speed is -|t| k / 2, that of the step of acceleration -t |t| k / 4.
    """
    # Frames lie half a frame off the seam on either side.
    frames = np.arange(n) + 0.5
    # At most half of the clip, so that both blends do not overlap.
    width = min(n / 2, BLEND_S * fps)
    ahead, back = np.maximum(1 - frames / width, 0), np.maximum(1 - (n - frames) / width, 0)
    # Smooth weights which reach 0, with no slope, at the end of the blend.
    rise, fall = frames * ahead**3, (n - frames) * back**3
    return np.stack(
        [
            # From -1/2 at the first frame to 1/2 at the last: half of the step on either side.
            frames / n - 0.5,
            -(rise + fall) / 2,
            (fall * (n - frames) - rise * frames) / 4,
        ],
        axis=1,
    )


@dataclass(frozen=True)
class LoopQuality:
    """Quality measures of a loop; lower is better.

    Parameters
    ----------
    pose_m, speed_m_s : float
        RMS step of pose and speed of all joints at the seam before blending: metres, metres per
        second.
    step, speed_step : float
        Step over the seam after blending, and its change, relative to the 95 % quantiles in the
        recording.
    slide_m_s : float
        Speed of planted feet in the loop, metres per second; nan if none is planted.
    turn_deg, rise_m : float
        Turn and change of height per round, before blending.
    unlike_m : float
        Distance from the typical poses of the cluster; nan without other candidates.
    """

    pose_m: float
    speed_m_s: float
    step: float
    speed_step: float
    slide_m_s: float
    turn_deg: float
    rise_m: float
    unlike_m: float

    @property
    def cost(self) -> float:
        """Return the sum of all measures divided by `COSTS`; unknown ones cost nothing."""
        parts = {name: abs(value) / COSTS[name] for name, value in asdict(self).items()}
        return math.fsum(part for part in parts.values() if not math.isnan(part))


def measure_loop(
    before: Floats,
    after: Floats,
    carry: Carry,
    fps: float,
    *,
    usual: tuple[float, float],
    feet: Sequence[tuple[Sequence[int], Masks]] = (),
    unlike: float = math.nan,
) -> LoopQuality:
    """Return the quality of a loop from positions (frames, joints, 3) in metres with y up.

    ``before`` is the clip, ``after`` the closed loop; ``carry`` takes one round to the next.
    ``usual`` comes from `measure_usual_steps`, ``unlike`` from `measure_distances`. ``feet`` holds
    the joints of each foot and the frames in which it is planted.
    """
    end, start = compute_seam_sides(before, fps)
    step, speed_step = _measure_seam_steps(after, carry)
    # A recording without movement has no usual step.
    large, changed = (max(each, 1e-12) for each in usual)
    return LoopQuality(
        pose_m=_compute_rms(carry.apply(start[0]) - end[0]),
        # Speeds turn with the carry and are not shifted.
        speed_m_s=_compute_rms(rot.rotate(carry.rotation, start[1]) - end[1]) * fps,
        step=step / large,
        speed_step=speed_step / changed,
        slide_m_s=_measure_sliding(after, carry, fps, feet),
        turn_deg=math.degrees(carry.turn),
        # Change of height, averaged over the joints.
        rise_m=float((end[0] - start[0])[:, 1].mean()),
        unlike_m=unlike,
    )


def measure_usual_steps(positions: Floats) -> tuple[float, float]:
    """Return the 95 % quantiles of a recording's frame-to-frame steps, and of their changes.

    Both are RMS over the joints, in metres.
    """
    steps = np.diff(positions, axis=0)
    changes = np.diff(steps, axis=0)
    return _compute_quantile(steps), _compute_quantile(changes)


def measure_distances(shapes: Sequence[Floats]) -> list[float]:
    """Return the RMS distance of each in-place motion from the median motion, metres.

    Motions (frames, joints, 3) are compared at `PHASES` of the round. nan if there is only one.
    """
    if len(shapes) < 2:
        return [math.nan] * len(shapes)
    sampled = np.stack(
        [interpolate_frames(each, np.linspace(0, len(each) - 1, PHASES)) for each in shapes]
    )
    typical = np.median(sampled, axis=0)
    return [_compute_rms(each - typical) for each in sampled]


def _measure_seam_steps(after: Floats, carry: Carry) -> tuple[float, float]:
    """Return the RMS step over the seam of a loop, and the larger of its changes to either side."""
    step = carry.apply(after[0]) - after[-1]
    # The steps before and after the seam, both in the axes of the last frame.
    before, behind = after[-1] - after[-2], rot.rotate(carry.rotation, after[1] - after[0])
    return _compute_rms(step), max(_compute_rms(step - before), _compute_rms(behind - step))


def _measure_sliding(
    after: Floats, carry: Carry, fps: float, feet: Sequence[tuple[Sequence[int], Masks]]
) -> float:
    """Return the mean horizontal speed of each planted foot's slowest point, over the seam, too."""
    speeds: list[float] = []
    for joints, planted in feet:
        path = after[:, list(joints)]
        # The first frame one round later closes the path, so the last step leads over the seam.
        steps = np.diff(np.concatenate([path, carry.apply(path[:1])]), axis=0)
        # A rolling foot has one point at rest, so sliding is the speed of its slowest point.
        slowest = np.hypot(steps[..., 0], steps[..., 2]).min(axis=1) * fps
        # Planted in both frames of a step; the roll pairs the last frame with the first.
        speeds += slowest[planted & np.roll(planted, -1)].tolist()
    return float(np.mean(speeds)) if speeds else math.nan


def _compute_quantile(steps: Floats) -> float:
    sizes = np.sqrt((steps**2).sum(axis=-1).mean(axis=-1))
    return float(np.percentile(sizes, USUAL)) if len(sizes) else 0.0


def _compute_rms(differences: Floats) -> float:
    """Return the RMS length of vectors (..., 3)."""
    return float(np.sqrt((differences**2).sum(axis=-1).mean()))
