"""Measure the quality of loops, and rank the candidates of a cluster.

For each candidate these are measured:

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
from dataclasses import asdict, dataclass

import numpy as np

from kineme._util.arrays import Floats, Masks, interpolate_frames
from kineme.clips.loops import Carry, compute_seam_sides

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
    # Speeds and accelerations turn with the carry and are not shifted.
    turned = Carry(carry.turn, 0.0, 0.0)
    carried = np.stack([carry.apply(start[0]), turned.apply(start[1]), turned.apply(start[2])])
    step, speed_step = _measure_seam_steps(after, carry)
    # A recording without movement has no usual step.
    large, changed = (max(each, 1e-12) for each in usual)
    return LoopQuality(
        pose_m=_compute_rms(carried[0] - end[0]),
        speed_m_s=_compute_rms(carried[1] - end[1]) * fps,
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


def rank_qualities(qualities: Sequence[LoopQuality]) -> list[int]:
    """Return the rank of each candidate, 1 for the best."""
    # The stable sort keeps earlier candidates first at equal cost.
    order = sorted(range(len(qualities)), key=lambda index: qualities[index].cost)
    places = [0] * len(order)
    for place, index in enumerate(order, 1):
        places[index] = place
    return places


def _measure_seam_steps(after: Floats, carry: Carry) -> tuple[float, float]:
    """Return the RMS step over the seam of a loop, and the larger of its changes to either side."""
    turned = Carry(carry.turn, 0.0, 0.0)
    step = carry.apply(after[0]) - after[-1]
    # The steps before and after the seam, both in the axes of the last frame.
    before, behind = after[-1] - after[-2], turned.apply(after[1] - after[0])
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
