"""How good a loop is: what a seam costs, in numbers, and which candidate of a cluster is best.

Of each candidate is measured

1. what the blending has to take away: the step of pose and of speed at the seam;
2. what is left: the step from the last frame to the first, and its change, each as a
   share of the steps inside the recording;
3. how far planted feet slide in the loop;
4. how much the body turns and rises in a round;
5. how far the poses are from the typical ones of the cluster, phase by phase.

`COSTS` says how much of each counts as one; the sum is the cost of a loop, and the candidate of
least cost is the first of its cluster. Seam and feet weigh most, since both are seen at once.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import asdict, dataclass

import numpy as np

from kineme._util.arrays import Floats, Masks, interpolate_frames
from kineme.clips.loops import Carry, compute_seam_sides

USUAL = 95.0
"""Per cent of the steps of a recording that are as large as its usual large ones, at most."""
PHASES = 24
"""Of a round, in which poses are compared."""
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
"""How much of each measure counts as one."""


@dataclass(frozen=True)
class LoopQuality:
    """What tells a good loop from a bad one; less is better in each.

    Parameters
    ----------
    pose_m, speed_m_s : float
        Step of pose and of speed at the seam before blending, in the root mean square of
        all joints: metres, metres per second.
    step, speed_step : float
        Step over the seam after blending, and its change: shares of the usual large ones (95 %)
        of the recording.
    slide_m_s : float
        Metres per second by which planted feet move in the loop; nan where none is planted.
    turn_deg, rise_m : float
        Turn and change of height in a round, before blending.
    unlike_m : float
        From the typical poses of the cluster; nan where there is no other candidate.
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
        """Return the sum of all, each by its unit in `COSTS`; what is not known costs nothing."""
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
        # Mean over the joints of the change of height.
        rise_m=float((end[0] - start[0])[:, 1].mean()),
        unlike_m=unlike,
    )


def measure_usual_steps(positions: Floats) -> tuple[float, float]:
    """Return the 95 % quantiles of a recording's steps from frame to frame, and of their changes.

    Root mean squares of the joints, metres.
    """
    steps = np.diff(positions, axis=0)
    changes = np.diff(steps, axis=0)
    return _compute_quantile(steps), _compute_quantile(changes)


def measure_distances(shapes: Sequence[Floats]) -> list[float]:
    """How far each of several motions in place is from the median of all, metres; nan for one.

    Compared at `PHASES` of the round, in the root mean square of joints (frames, joints, 3).
    """
    if len(shapes) < 2:
        return [math.nan] * len(shapes)
    sampled = np.stack(
        [interpolate_frames(each, np.linspace(0, len(each) - 1, PHASES)) for each in shapes]
    )
    typical = np.median(sampled, axis=0)
    return [_compute_rms(each - typical) for each in sampled]


def rank_qualities(qualities: Sequence[LoopQuality]) -> list[int]:
    """Return the place of each candidate, 1 the best."""
    # Stable: of equal costs the earlier candidate is first.
    order = sorted(range(len(qualities)), key=lambda index: qualities[index].cost)
    places = [0] * len(order)
    for place, index in enumerate(order, 1):
        places[index] = place
    return places


def _measure_seam_steps(after: Floats, carry: Carry) -> tuple[float, float]:
    """Return the step over the seam of a loop, and the larger change of steps beside it."""
    turned = Carry(carry.turn, 0.0, 0.0)
    step = carry.apply(after[0]) - after[-1]
    # The steps before and after the seam, both in the axes of the last frame.
    before, behind = after[-1] - after[-2], turned.apply(after[1] - after[0])
    return _compute_rms(step), max(_compute_rms(step - before), _compute_rms(behind - step))


def _measure_sliding(
    after: Floats, carry: Carry, fps: float, feet: Sequence[tuple[Sequence[int], Masks]]
) -> float:
    """Mean speed over the floor of the slowest point of each planted foot, the seam included."""
    speeds: list[float] = []
    for joints, planted in feet:
        path = after[:, list(joints)]
        # The first frame one round later closes the path, so the last step leads over the seam.
        steps = np.diff(np.concatenate([path, carry.apply(path[:1])]), axis=0)
        # A foot that rolls turns about one point, which stays: the slowest point tells sliding.
        slowest = np.hypot(steps[..., 0], steps[..., 2]).min(axis=1) * fps
        # Planted in both frames of a step; the roll pairs the last frame with the first.
        speeds += slowest[planted & np.roll(planted, -1)].tolist()
    return float(np.mean(speeds)) if speeds else math.nan


def _compute_quantile(steps: Floats) -> float:
    sizes = np.sqrt((steps**2).sum(axis=-1).mean(axis=-1))
    return float(np.percentile(sizes, USUAL)) if len(sizes) else 0.0


def _compute_rms(differences: Floats) -> float:
    """Return the root mean square of the lengths of differences (..., 3)."""
    return float(np.sqrt((differences**2).sum(axis=-1).mean()))
