"""Align curves so that the same percentage of the cycle is the same phase of the movement.

Each cycle runs from 0 to 100 %, linear in time. If phases take different shares of the cycle, the
mean curve is flatter than each cycle. Two methods correct this:

*Landmarks.* The maximum and the minimum of the first channel are moved to their mean times; time in
between is stretched evenly (Kneip and Gasser 1992, "Statistical tools to analyze data representing
a sample of curves").

*Warping.* Each cycle is warped to the mean several times, using all channels divided by their
standard deviations (dynamic time warping; Sakoe and Chiba 1978). The mean warp is removed, so that
the mean curve keeps its timing.

Statistics, such as the time of a maximum, refer to the original cycles.
"""

from __future__ import annotations

from collections.abc import Iterable
from itertools import pairwise

import numpy as np

from kineme._util.arrays import Floats

LINEAR, LANDMARKS, WARP = "linear", "landmarks", "warp"
ALIGNMENTS = (LINEAR, LANDMARKS, WARP)
GRID = 101
"""Number of points of a cycle that are warped."""
NEAR = 0.15
"""Largest distance of a landmark from that of the mean curve, as a fraction of the cycle."""
INSIDE = 0.05
"""Least distance of landmarks from the ends and each other, as a fraction of the cycle."""
BAND = 0.15
"""Largest warp, as a fraction of the cycle."""
STEP = 0.2
"""Cost of a warping step along one axis only."""
ROUNDS = 3
SMOOTH = 7
"""Number of points over which a warp is smoothed."""


def align_curves(curves: Floats, alignment: str) -> Floats:
    """Return aligned curves (cycles, channels, points) of one group; with gaps unchanged."""
    complete = np.isfinite(curves).all(axis=(1, 2))
    if alignment == LINEAR or complete.sum() < 2:
        return curves
    # Positions of the points in a cycle, 0 to 1.
    shares, grid = np.linspace(0, 1, curves.shape[2]), np.linspace(0, 1, GRID)
    sampled = _sample_curves(curves[complete], shares, [grid] * int(complete.sum()))
    phases = _align_landmarks(sampled[:, 0]) if alignment == LANDMARKS else _warp_to_mean(sampled)
    # Warps are found on GRID points; curves may have any other number of points.
    phases = np.array([np.interp(shares, grid, each) for each in phases])
    moved = curves.copy()
    moved[complete] = _sample_curves(curves[complete], shares, phases)
    return moved


def _sample_curves(curves: Floats, shares: Floats, phases: Iterable[Floats]) -> Floats:
    """Interpolate curves, given at ``shares`` of the cycle, at the phases of each cycle."""
    return np.array(
        [[np.interp(phase, shares, channel) for channel in curve]
         for curve, phase in zip(curves, phases, strict=True)]
    )  # fmt: skip


def _align_landmarks(curves: Floats) -> Floats:
    """Return the phase of each cycle at each time of the common cycle, (cycles, GRID)."""
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
    # (cycles, landmarks); the reshape keeps the shape if no landmark was found.
    extremes = np.array(found).reshape(len(found), len(curves)).T
    # Knots of an interpolation must increase, so landmarks are put in the order of time.
    extremes = extremes[:, np.argsort(extremes.mean(axis=0))]
    common = [0.0, *extremes.mean(axis=0).tolist(), 1.0]
    phases = np.tile(grid, (len(curves), 1))
    for row, each in enumerate(extremes.tolist()):
        places = [0.0, *each, 1.0]
        # A cycle whose landmarks are too close or swapped would be stretched too much: it stays.
        if all(b - a >= INSIDE for a, b in [*pairwise(places), *pairwise(common)]):
            phases[row] = np.interp(grid, common, places)
    return phases


def _warp_to_mean(curves: Floats) -> Floats:
    """Return the phase of each cycle, warped to the mean, (cycles, GRID)."""
    grid = np.linspace(0, 1, GRID)
    # One deviation for each channel, over all cycles and points: channels have different units.
    deviation = curves.std(axis=(0, 2), keepdims=True)
    scaled = curves / np.where(deviation > 0, deviation, 1.0)
    phases = np.tile(grid, (len(curves), 1))
    for _ in range(ROUNDS):
        mean = _sample_curves(scaled, grid, phases).mean(axis=0)
        phases = np.array([_warp_cycle(mean, each) for each in scaled])
        # Compose each warp with the inverse of the mean warp, so that warps are the identity on
        # average.
        usual = phases.mean(axis=0)
        phases = np.array([np.interp(grid, usual, each) for each in phases])
    return phases


def _warp_cycle(mean: Floats, curve: Floats) -> Floats:
    """Return the phase of a cycle at each time of the mean, by the cheapest path in a band."""
    from kineme.features._kernels import find_cheapest_path

    grid, points = np.linspace(0, 1, GRID), np.arange(GRID)
    # (GRID, GRID): squared distance of each point of the mean to each point of the cycle.
    squares = np.square(curve[:, None] - mean[:, :, None]).sum(axis=0)
    # Only pairs near the diagonal (Sakoe-Chiba band).
    squares[np.abs(points[:, None] - points) > round(BAND * GRID)] = np.inf
    _, rows, columns = find_cheapest_path(squares, STEP)
    # A point of the mean may be paired with several points of a cycle: their mean is taken.
    phases = np.bincount(rows, columns) / np.bincount(rows) / (GRID - 1)
    # Smooth the deviation from an even course. It is 0 at both ends, so zeros continue it.
    lags = np.convolve(np.pad(phases - grid, SMOOTH // 2), np.ones(SMOOTH) / SMOOTH, "valid")
    # A phase must neither leave the cycle nor go back in time.
    smooth = np.maximum.accumulate(np.clip(lags + grid, 0, 1))
    smooth[0], smooth[-1] = 0, 1
    return smooth
