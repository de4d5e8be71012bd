"""Read curves of an FBX file, and sample them at the frames of a recording.

A curve has keys with a time, a value and flags for the interpolation up to the next key: constant,
linear or cubic. Cubic segments are Bézier curves whose inner points lie on a slope, at a third of
the interval or another fraction (the weight). The file stores the slopes, except for automatic and
Kochanek-Bartels (TCB) tangents, which depend on the surrounding keys. Before its first and after
its last key a curve is constant.

Times are multiples of 1/46186158000 s.

Source: Autodesk, FBX SDK, `FbxAnimCurveDef` for the flags; D. Kochanek and R. Bartels,
"Interpolating splines with local tension, continuity, and bias control", SIGGRAPH 1984. The
computation of automatic tangents is not published: this follows ufbx (S. Raivio).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from kineme._util.arrays import Floats
from kineme.formats.files import FileContent
from kineme.formats.scenes.assembly import evaluate_bezier, find_keys
from kineme.formats.scenes.fbx_file import FBXNode

TICKS = 46_186_158_000
"""Ticks per second."""

RATES = {
    1: 120.0, 2: 100.0, 3: 60.0, 4: 50.0, 5: 48.0, 6: 30.0, 7: 30.0, 8: 30 / 1.001, 9: 30 / 1.001,
    10: 25.0, 11: 24.0, 12: 1000.0, 13: 24 / 1.001, 15: 96.0, 16: 72.0, 17: 60 / 1.001,
    18: 120 / 1.001,
}  # fmt: skip
"""Frames per second by ``TimeMode``."""

CUSTOM = 14
"""``TimeMode`` whose rate is in ``CustomFrameRate``."""

SLACK = 2.0
"""Ticks by which a key may miss its frame."""

CONSTANT, LINEAR, CUBIC = 0x2, 0x4, 0x8
NEXT = 0x100  # constant key that has the value of the next one
TCB, USER = 0x200, 0x400  # cubic key with TCB or stored tangents; else automatic
CLAMPED, TIMELESS, PROGRESSIVE = 0x1000, 0x2000, 0x4000  # modes of automatic tangents
RIGHT_WEIGHT, LEFT_WEIGHT = 0x1000000, 0x2000000  # has weights of this key, of the next

THIRD = 1 / 3
_WEIGHT_UNIT = 1e-4
_NEAR = 0.001  # values closer than this count as equal for clamped tangents
_BISECTIONS = 40


@dataclass(frozen=True)
class Curve:
    """Keys in order of time."""

    times: Floats  # (keys,), ticks
    values: Floats  # (keys,)
    flags: NDArray[np.int64]  # (keys,): interpolation after each key
    details: NDArray[np.float32]  # (keys, 4): slopes per second after a key and before the next
    #                               one, and the weights of both, packed
    kinds: int  # union of all flags


class CurveReader:
    """Read the curves of a file; cache the times, which most curves share."""

    def __init__(self, content: FileContent) -> None:
        self.content = content
        self._packed = b""
        self._times = np.empty(0)
        self._ordered = True

    def read(self, node: FBXNode) -> Curve | None:
        """Return the curve of an ``AnimationCurve``; None if it has no key."""
        times, values = self._read_times(node), node.array("KeyValueFloat")
        if values is None or len(times) == 0:
            return None
        if len(times) != len(values):
            reason = f"a curve has {len(times)} times for {len(values)} values: damaged"
            raise self.content.error(reason)
        if not np.isfinite(values).all():
            raise self.content.error("a curve has values that are not finite: damaged")
        flags, details = _read_attributes(node, len(times))
        kinds = int(np.bitwise_or.reduce(flags))
        # Sort the keys and keep one of those at the same time.
        if not self._ordered:  # editors may leave moved keys unsorted
            times, order = np.unique(times, return_index=True)
            values, flags, details = values[order], flags[order], details[order]
        return Curve(times, values.astype(np.float64), flags, details, kinds)

    def _read_times(self, node: FBXNode) -> Floats:
        stored = node.stored("KeyTime")
        if stored is None:
            return np.empty(0)
        packed = stored.raw
        # Most curves have identical times, so compare the packed bytes.
        if packed != self._packed or not packed:
            self._packed, self._times = packed, stored.read().astype(np.float64)
            self._ordered = bool((np.diff(self._times) > 0).all())
        return self._times


def _read_attributes(node: FBXNode, n_keys: int) -> tuple[NDArray[np.int64], NDArray[np.float32]]:
    """Return flags and details of each key; the file stores them once for a run of equal ones."""
    flags = node.array("KeyAttrFlags")
    details = node.array("KeyAttrDataFloat")
    counts = node.array("KeyAttrRefCount")
    if flags is None or counts is None or len(flags) != len(counts) or len(flags) == 0:
        flags, counts, details = np.array([LINEAR]), np.array([n_keys]), None
    with np.errstate(invalid="ignore"):
        wide = flags.astype(np.int64)
        # End of each run of keys that share attributes.
        ends = np.cumsum(np.clip(counts, 0, n_keys).astype(np.int64))
    if details is None or len(details) != 4 * len(flags):
        table = np.zeros((len(flags), 4), np.float32)
    elif details.dtype.itemsize == 8:
        table = _from_text(details)
    else:
        table = details.astype("<f4").reshape(-1, 4)
    if len(flags) == 1:
        return np.broadcast_to(wide, n_keys), np.broadcast_to(table, (n_keys, 4))
    # Run of each key.
    rows = np.minimum(np.searchsorted(ends, np.arange(n_keys), "right"), len(flags) - 1)
    return wide[rows], table[rows]


def _from_text(details: Floats) -> NDArray[np.float32]:
    """Return details from a text file, which stores packed weights as a whole number."""
    table = details.reshape(-1, 4).astype(np.float32)
    third = details.reshape(-1, 4)[:, 2]
    # Whole numbers are the bits of two packed weights; other values are plain.
    packed = (third >= 1) & (third < 2**32) & (third == np.floor(third))
    bits = np.where(packed, third, 0).astype(np.uint32).view(np.float32)
    table[:, 2] = np.where(packed, bits, table[:, 2])
    return table


class Sampler:
    """Sample curves at the frames of a recording, given in ticks.

    Most curves of a file have keys at the same times, so the last result of the search is cached.
    """

    def __init__(self, frame_times: Floats) -> None:
        self.frame_times = frame_times
        self._times = np.empty(0)
        self._index: NDArray[np.intp] = np.empty(0, np.intp)
        self._share = np.empty(0)

    def sample(self, curve: Curve) -> Floats:
        """Return values (frames,), or () if the curve is constant."""
        times, values, frame_times = curve.times, curve.values, self.frame_times
        # With tangents, a cubic curve may bulge between equal values.
        is_constant = bool((values == values[0]).all())
        if is_constant and not curve.kinds & CUBIC:
            return values[:1].reshape(())
        if len(times) == len(frame_times) and np.abs(times - frame_times).max() <= SLACK:
            return values[:1].reshape(()) if is_constant else values
        if len(times) == 1:
            return values.reshape(())
        if times is not self._times:  # `CurveReader` returns one array for equal times
            self._times, (self._index, self._share) = times, find_keys(times, frame_times, SLACK)
        i, share = self._index, self._share
        sampled = values[i] + share * (values[i + 1] - values[i])
        flags = curve.flags[i]
        if curve.kinds & CONSTANT:
            # Hold the value of the key, or with NEXT that of the next one.
            constant = (flags & CONSTANT) > 0
            after = (share >= 1) | ((flags & NEXT > 0) & (share > 0))
            sampled[constant] = np.where(after, values[i + 1], values[i])[constant]
        if curve.kinds & CUBIC:
            cubic = ((flags & CUBIC) > 0) & (share > 0) & (share < 1)
            sampled[cubic] = _evaluate_bezier(curve, i[cubic], share[cubic])
        return sampled


def _evaluate_bezier(curve: Curve, i: NDArray[np.intp], share: Floats) -> Floats:
    """Return the values between keys i and i + 1 after a fraction ``share`` of the interval."""
    right, left, right_weight, left_weight = _compute_tangents(curve)
    step = np.diff(curve.times)[i] / TICKS
    start, stop = curve.values[i], curve.values[i + 1]
    first, last = right_weight[i], left_weight[i]
    # With weights other than a third, time is a Bézier curve as well.
    parameter = _solve_parameter(share, first, 1 - last)
    # Inner points of the Bézier curve lie on the slopes, weight times the interval away.
    out, into = start + right[i] * first * step, stop - left[i] * last * step
    return evaluate_bezier(start, out, into, stop, parameter)


def _solve_parameter(share: Floats, first: Floats, second: Floats) -> Floats:
    """Return the curve parameter at which this fraction of the time has passed.

    ``first`` and ``second`` are the times of the inner Bézier points.
    """
    # With weights of a third, time is linear in the parameter.
    if (np.abs(first - THIRD) < 1e-3).all() and (np.abs(second - 2 * THIRD) < 1e-3).all():
        return share
    # Bisect: time increases monotonically with the parameter.
    low, high = np.zeros_like(share), np.ones_like(share)
    for _ in range(_BISECTIONS):
        middle = (low + high) / 2
        time = evaluate_bezier(0.0, first, second, 1.0, middle)
        low, high = np.where(time < share, middle, low), np.where(time < share, high, middle)
    return (low + high) / 2


def _compute_tangents(curve: Curve) -> tuple[Floats, Floats, Floats, Floats]:
    """Return slopes at start and end of each interval and their weights, (keys - 1,) each."""
    times, values = curve.times / TICKS, curve.values
    step = np.diff(times)
    secant = np.diff(values) / step
    # Slopes of damaged files may be NaN.
    with np.errstate(invalid="ignore", over="ignore"):
        slopes = np.nan_to_num(curve.details[:, :2].astype(np.float64))
    # A float holds two weights of 16 bits.
    packed = np.ascontiguousarray(curve.details[:, 2]).view(np.uint32)
    flags = curve.flags
    right_weight, left_weight = (
        np.where(flags & flag, np.clip(stored * _WEIGHT_UNIT, 0, 1), THIRD)[:-1]
        for flag, stored in ((RIGHT_WEIGHT, packed & 0xFFFF), (LEFT_WEIGHT, packed >> 16))
    )
    # Slopes after a key and before the next one are stored with the first of the two.
    right, left = slopes[:-1, 0], slopes[:-1, 1]
    cubic = (flags & (CONSTANT | CUBIC)) == CUBIC
    is_tcb = cubic & ((flags & TCB) > 0)
    is_automatic = cubic & ((flags & (TCB | USER)) == 0)
    left = np.where(is_tcb[:-1], 0.0, left)  # TCB keys store other parameters than slopes
    if is_automatic.any():
        # Automatic keys have the same slope on both sides.
        automatic = _compute_automatic_slopes(times, values, flags, right_weight, left_weight)
        right = np.where(is_automatic[:-1], automatic[:-1], right)
        left = np.where(is_automatic[1:], automatic[1:], left)
    if is_tcb.any():
        after, before = _compute_tcb_slopes(curve, secant)
        right = np.where(is_tcb[:-1], after[:-1], right)
        left = np.where(is_tcb[1:], before[1:], left)
    return right, left, right_weight, left_weight


def _compute_automatic_slopes(
    times: Floats,
    values: Floats,
    flags: NDArray[np.int64],
    right_weight: Floats,
    left_weight: Floats,
) -> Floats:
    """Return the slopes (keys,) of automatic tangents.

    Clamped ones are flat beside equal values, progressive ones do not overshoot. The weights are
    those of the tangents on either side of each key, as shares of the interval.
    """
    step, rise = np.diff(times), np.diff(values)
    secant = rise / step
    is_near = np.abs(rise) <= _NEAR
    clamped, progressive = (flags & CLAMPED) > 0, (flags & PROGRESSIVE) > 0
    slope = np.zeros(len(times))
    # At the ends use the slope of the only interval.
    ends = [0, -1]
    is_flat = progressive[ends] | (clamped[ends] & is_near[ends])
    slope[ends] = np.where(is_flat, 0.0, secant[ends])
    if len(times) < 3:
        return slope
    across = (values[2:] - values[:-2]) / (times[2:] - times[:-2])
    # Shorter intervals have more weight.
    share = step[:-1] / (step[:-1] + step[1:])
    blended = (across + secant[:-1] * (1 - share) + secant[1:] * share) / 2
    inner_slopes = np.where(flags[1:-1] & TIMELESS, across, blended)
    # Limit the slope so that no inner Bézier point exceeds the neighbour's value.
    sign = np.where(inner_slopes < 0, -1.0, 1.0)
    limit = np.full(len(inner_slopes), np.inf)
    for weight, side in ((left_weight[:-1], slice(None, -1)), (right_weight[1:], slice(1, None))):
        reach = weight * step[side]
        most = sign * rise[side] / np.where(reach > 0, reach, np.inf)  # 0: no tangent to limit
        limit = np.minimum(limit, np.maximum(most, 0.0))
    inner_slopes = np.where(
        progressive[1:-1], sign * np.minimum(np.abs(inner_slopes), limit), inner_slopes
    )
    # A clamped tangent next to a nearly equal value is flat.
    slope[1:-1] = np.where(clamped[1:-1] & (is_near[:-1] | is_near[1:]), 0.0, inner_slopes)
    return slope


def _compute_tcb_slopes(curve: Curve, secant: Floats) -> tuple[Floats, Floats]:
    """Return slopes (keys,) after and before the keys from tension, continuity and bias."""
    with np.errstate(invalid="ignore", over="ignore"):
        tension, continuity, bias = np.nan_to_num(curve.details[:, :3].astype(np.float64)).T
    # Slopes of the intervals before and after each key.
    before, after = np.r_[0.0, secant], np.r_[secant, 0.0]
    tight = (1 - tension) / 2
    tight[[0, -1]] *= 2  # the ends have one neighbour only
    arriving, leaving = (1 + bias) * before, (1 - bias) * after
    forward = tight * ((1 + continuity) * arriving + (1 - continuity) * leaving)
    return forward, tight * ((1 - continuity) * arriving + (1 + continuity) * leaving)
