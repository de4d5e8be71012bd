"""Curves in step: the same share of the cycle is the same part of the movement.

Cycles of one group are each of 0 to 100 %, evenly in time. Where their parts last differently, a
mean over them is flatter than any of them. Two ways of mending that:

*Landmarks.* The largest and the smallest value of the first channel come at one time in all cycles,
the mean of theirs; time between landmarks and the ends is stretched evenly (Kneip and Gasser 1992,
"Statistical tools to analyze data representing a sample of curves").

*Warping.* Each cycle is warped to the mean of all, in all channels, each in units of its own
deviation (dynamic time warping; Sakoe and Chiba 1978), several times. What all have in common in
these warps is taken off, so that the mean keeps its times.

What is measured, such as when a channel is largest, is that of the cycle as it was.
"""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from kineme._util.arrays import Floats

LINEAR, LANDMARKS, WARP = "linear", "landmarks", "warp"
ALIGNMENTS = (LINEAR, LANDMARKS, WARP)
GRID = 101
"""Points of a cycle on which it is warped."""
NEAR = 0.15
"""Of a cycle: a landmark is looked for so far from where the mean has it."""
INSIDE = 0.05
"""Of a cycle: landmarks are so far from its ends and from each other, at least."""
BAND = 0.15
"""Of a cycle, by which it is warped at most."""
STEP = 0.2
"""What a step of a warp costs that leaves one of the two cycles where it is."""
ROUNDS = 3
SMOOTH = 7
"""Points over which a warp is smoothed."""
BLOCK = 256
"""Cycles that are warped at a time."""


def align_curves(curves: Floats, alignment: str) -> Floats:
    """Curves (cycles, channels, points) of one group, in step; those with gaps as they were."""
    complete = np.isfinite(curves).all(axis=(1, 2))
    if alignment == LINEAR or complete.sum() < 2:
        return curves
    # Positions of the points in a cycle, 0 to 1.
    shares = np.linspace(0, 1, curves.shape[2])
    grid = np.linspace(0, 1, GRID)
    sampled = _sample_curves(
        curves[complete], shares, np.broadcast_to(grid, (int(complete.sum()), GRID))
    )
    phases = _align_landmarks(sampled[:, 0]) if alignment == LANDMARKS else _warp_to_mean(sampled)
    # Warps are found on GRID points; curves may have any other number of points.
    phases = np.array([np.interp(shares, grid, each) for each in phases])
    moved = curves.copy()
    moved[complete] = _sample_curves(curves[complete], shares, phases)
    return moved


def _sample_curves(curves: Floats, shares: Floats, phases: Floats) -> Floats:
    """Return the curves, known at shares of the cycle, at a phase of each for each point."""
    return np.array(
        [[np.interp(phase, shares, channel) for channel in curve]
         for curve, phase in zip(curves, phases, strict=True)]
    )  # fmt: skip


def _align_landmarks(curves: Floats) -> Floats:
    """(cycles, GRID): the phase of each cycle at each time of the common one."""
    mean, grid = curves.mean(axis=0), np.linspace(0, 1, GRID)
    # In points of the grid.
    reach, margin = round(NEAR * GRID), round(INSIDE * GRID)
    found = []
    for sign in (1.0, -1.0):
        # The largest value for sign 1, the smallest for sign -1.
        at = int((sign * mean).argmax())
        # An extreme at an end of the cycle is a border value, not a landmark.
        if margin <= at < GRID - margin:
            first, last = max(margin, at - reach), min(GRID - margin, at + reach + 1)
            found.append(grid[first + (sign * curves[:, first:last]).argmax(axis=1)])
    # (cycles, landmarks); the reshape keeps the shape where no landmark was found.
    extremes = np.array(found).reshape(len(found), len(curves)).T
    # Knots of an interpolation must increase, so landmarks are put in the order of time.
    extremes = extremes[:, np.argsort(extremes.mean(axis=0))]
    common = [0.0, *extremes.mean(axis=0).tolist(), 1.0]
    phases = np.tile(grid, (len(curves), 1))
    for row, each in enumerate(extremes.tolist()):
        places = [0.0, *each, 1.0]
        # A cycle whose landmarks are too close or swapped would be stretched too much: it stays as
        # it is.
        if all(b - a >= INSIDE for a, b in [*pairwise(places), *pairwise(common)]):
            phases[row] = np.interp(grid, common, places)
    return phases


def _warp_to_mean(curves: Floats) -> Floats:
    """Return the same, warped to the mean."""
    grid = np.linspace(0, 1, GRID)
    # One deviation for each channel, over all cycles and points: channels have different units.
    deviation = curves.std(axis=(0, 2), keepdims=True)
    scaled = curves / np.where(deviation > 0, deviation, 1.0)
    phases = np.tile(grid, (len(curves), 1))
    for _ in range(ROUNDS):
        mean = _sample_curves(scaled, grid, phases).mean(axis=0)
        blocks = range(0, len(scaled), BLOCK)
        phases = np.concatenate([_warp_cycle(mean, scaled[at : at + BLOCK]) for at in blocks])
        # Compose each warp with the inverse of the mean warp, so that warps are the identity on
        # average.
        usual = phases.mean(axis=0)
        phases = np.array([np.interp(grid, usual, each) for each in phases])
    return phases


def _warp_cycle(mean: Floats, curves: Floats) -> Floats:
    """Return phase of each cycle at each time of the mean, on the cheapest path within a band."""
    n, band = len(curves), round(BAND * GRID)
    # One more row and column than points: index 0 is the state before the first pair.
    cost = np.full((n, GRID + 1, GRID + 1), np.inf)
    # All paths start here; the rest of row and column 0 stays infinite.
    cost[:, 0, 0] = 0
    for i in range(GRID):
        # Only pairs near the diagonal (Sakoe-Chiba band); others keep an infinite cost.
        first, last = max(0, i - band), min(GRID, i + band + 1)
        # (cycles, band): squared distance of point i of the mean to each point of the band.
        apart = np.square(curves[:, :, first:last] - mean[:, i, None]).sum(axis=1)
        # All cycles at once: the loops run over the points only.
        for j in range(first, last):
            before = np.minimum(cost[:, i, j + 1], cost[:, i + 1, j]) + STEP
            cost[:, i + 1, j + 1] = apart[:, j - first] + np.minimum(cost[:, i, j], before)
    # A point of the mean may be paired with several points of a cycle: their mean is taken.
    total, count = np.zeros((n, GRID)), np.zeros((n, GRID))
    rows, at, of = np.arange(n), np.full(n, GRID), np.full(n, GRID)  # back from the end
    while (inside := (at > 0) & (of > 0)).any():
        # `add.at` counts repeated index pairs; indices are one less than in `cost`, which has a
        # margin.
        np.add.at(total, (rows[inside], at[inside] - 1), of[inside] - 1)
        np.add.at(count, (rows[inside], at[inside] - 1), 1)
        # Both points back, only the mean's, only the cycle's. At index 0 the -1 wraps round: not
        # used.
        costs = [cost[rows, at - 1, of - 1], cost[rows, at - 1, of] + STEP,
                 cost[rows, at, of - 1] + STEP]  # fmt: skip
        chosen = np.argmin(costs, axis=0)
        # Finished cycles stay where they are.
        at, of = at - (inside & (chosen != 2)), of - (inside & (chosen != 1))
    # From point numbers to shares of the cycle.
    phases = total / np.maximum(count, 1) / (GRID - 1)
    # Smooth the deviation from an even course. It is 0 at both ends, so zeros continue it.
    kernel, half = np.ones(SMOOTH) / SMOOTH, SMOOTH // 2
    late = np.pad(phases - np.linspace(0, 1, GRID), ((0, 0), (half, half)))
    smooth = np.array([np.convolve(each, kernel, "valid") for each in late])
    # A phase must neither leave the cycle nor go back in time.
    smooth = np.maximum.accumulate(np.clip(smooth + np.linspace(0, 1, GRID), 0, 1), axis=1)
    smooth[:, 0], smooth[:, -1] = 0, 1
    return np.asarray(smooth)
