"""Curves of an FBX file, and their values at the frames of a recording.

A curve is keys with a time, a value and flags, which tell how it goes on to the next key:
constant, linear or cubic. Cubic ones are Bezier curves whose inner points lie a third of the
interval away from the keys, or another share (the weight), along a slope. The slopes are in the
file, unless the key's tangent is automatic or of the kind of Kochanek and Bartels (TCB): then
they follow from the keys around it. Before its first and after its last key a curve is constant.

Times are counts of 1/46186158000 s.

Source: Autodesk, FBX SDK, `FbxAnimCurveDef` for the flags; D. Kochanek and R. Bartels,
"Interpolating splines with local tension, continuity, and bias control", SIGGRAPH 1984. How
automatic tangents are made is not published: what ufbx (S. Raivio) found is followed.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from kineme._util.arrays import Floats
from kineme.formats.files import FileContent
from kineme.formats.scenes.fbx_nodes import FBXNode
from kineme.formats.scenes.sampling import find_keys

TICKS = 46_186_158_000
"""In a second."""

RATES = {
    1: 120.0, 2: 100.0, 3: 60.0, 4: 50.0, 5: 48.0, 6: 30.0, 7: 30.0, 8: 30 / 1.001, 9: 30 / 1.001,
    10: 25.0, 11: 24.0, 12: 1000.0, 13: 24 / 1.001, 15: 96.0, 16: 72.0, 17: 60 / 1.001,
    18: 120 / 1.001,
}  # fmt: skip
"""Frames per second of a ``TimeMode``."""

CUSTOM = 14
"""``TimeMode`` whose rate is in ``CustomFrameRate``."""

SLACK = 2.0
"""Ticks by which a key may miss the frame that it was made for."""

CONSTANT, LINEAR, CUBIC = 0x2, 0x4, 0x8
NEXT = 0x100  # of a constant key: it has the value of the next one
TCB, USER = 0x200, 0x400  # of a cubic one: made from its details, or as given; else automatic
CLAMPED, TIMELESS, PROGRESSIVE = 0x1000, 0x2000, 0x4000  # of an automatic one
RIGHT_WEIGHT, LEFT_WEIGHT = 0x1000000, 0x2000000  # of the key, and of the next one

THIRD = 1 / 3
_WEIGHT_UNIT = 1e-4
_NEAR = 0.001  # values nearer than this are one, where tangents are clamped
_STEPS = 40


@dataclass(frozen=True)
class Curve:
    """Keys in the order of time.

    Parameters
    ----------
    times : ndarray of shape (keys,)
        Ticks.
    values : ndarray of shape (keys,)
    flags : ndarray of shape (keys,)
        How it goes on after each key.
    details : ndarray of shape (keys, 4)
        Slope after the key and before the next one, per second; weights of both, packed.
    kinds : int
        All flags that a key of it has.
    """

    times: Floats
    values: Floats
    flags: NDArray[np.int64]
    details: NDArray[np.float32]
    kinds: int


class CurveReader:
    """Reads the curves of a file; most have the same times, which are unpacked once."""

    def __init__(self, content: FileContent) -> None:
        self.content = content
        self._packed = b""
        self._times = np.empty(0)
        self._ordered = True

    def read(self, node: FBXNode) -> Curve | None:
        """Return the curve of an ``AnimationCurve``; None where it has no key."""
        times, values = self._read_times(node), node.array(self.content, "KeyValueFloat")
        if values is None or len(times) == 0:
            return None
        if len(times) != len(values):
            reason = f"a curve has {len(times)} times for {len(values)} values: damaged"
            raise self.content.error(reason)
        if not np.isfinite(values).all():
            raise self.content.error("a curve has values that are not finite: damaged")
        flags, details = _read_attributes(self.content, node, len(times))
        kinds = int(np.bitwise_or.reduce(flags))
        # Sorted, and of keys at one time only one.
        if not self._ordered:  # as editors leave keys that were moved
            times, order = np.unique(times, return_index=True)
            values, flags, details = values[order], flags[order], details[order]
        return Curve(times, values.astype(np.float64), flags, details, kinds)

    def _read_times(self, node: FBXNode) -> Floats:
        stored = node.stored("KeyTime")
        if stored is None:
            return np.empty(0)
        packed = stored.raw(self.content)
        # Most curves have the same times, byte for byte.
        if packed != self._packed or not packed:
            self._packed, self._times = packed, stored.read(self.content).astype(np.float64)
            self._ordered = bool((np.diff(self._times) > 0).all())
        return self._times


def _read_attributes(
    content: FileContent, node: FBXNode, n_keys: int
) -> tuple[NDArray[np.int64], NDArray[np.float32]]:
    """Flags and details of each key: they are stored once for successive keys that share them."""
    flags = node.array(content, "KeyAttrFlags")
    details = node.array(content, "KeyAttrDataFloat")
    counts = node.array(content, "KeyAttrRefCount")
    if flags is None or counts is None or len(flags) != len(counts) or len(flags) == 0:
        flags, counts, details = np.array([LINEAR]), np.array([n_keys]), None
    with np.errstate(invalid="ignore"):
        wide = flags.astype(np.int64)
        # Where each run of equal attributes ends.
        ends = np.cumsum(np.clip(counts, 0, n_keys).astype(np.int64))
    if details is None or len(details) != 4 * len(flags):
        table = np.zeros((len(flags), 4), np.float32)
    elif details.dtype.itemsize == 8:
        table = _from_text(details)
    else:
        table = details.astype("<f4").reshape(-1, 4)
    if len(flags) == 1:
        return np.broadcast_to(wide, n_keys), np.broadcast_to(table, (n_keys, 4))
    # The run that each key is in.
    rows = np.minimum(np.searchsorted(ends, np.arange(n_keys), "right"), len(flags) - 1)
    return wide[rows], table[rows]


def _from_text(details: Floats) -> NDArray[np.float32]:
    """Texts have the bits of the packed weights as a whole number."""
    table = details.reshape(-1, 4).astype(np.float32)
    third = details.reshape(-1, 4)[:, 2]
    # Whole numbers are bits of two packed weights; others are weights as they are.
    packed = (third >= 1) & (third < 2**32) & (third == np.floor(third))
    bits = np.where(packed, third, 0).astype(np.uint32).view(np.float32)
    table[:, 2] = np.where(packed, bits, table[:, 2])
    return table


class Sampler:
    """Values of curves at the frames of a recording, in ticks.

    Most curves of a file have keys at the same times, so that what was found for the last one is
    kept.
    """

    def __init__(self, at: Floats) -> None:
        self.at = at
        self._frame_times = at  # times that are those of the frames, or nearly so
        self._times = np.empty(0)
        self._index: NDArray[np.intp] = np.empty(0, np.intp)
        self._share = np.empty(0)

    def values(self, curve: Curve) -> Floats:
        """(frames,), or () where the curve is constant."""
        times, values = curve.times, curve.values
        # A constant cubic curve may still bulge between keys, by its tangents.
        still = bool((values == values[0]).all())
        if still and not curve.kinds & CUBIC:
            return values[:1].reshape(())
        if self._are_frames(times):
            # A key in every frame: nothing to interpolate.
            return values[:1].reshape(()) if still else values
        if len(times) == 1:
            return values.reshape(())
        self._find(times)
        i, share = self._index, self._share
        sampled = values[i] + share * (values[i + 1] - values[i])
        flags = curve.flags[i]
        if curve.kinds & CONSTANT:
            # Held until the next key; with NEXT already the next value.
            constant = (flags & CONSTANT) > 0
            after = (share >= 1) | ((flags & NEXT > 0) & (share > 0))
            sampled[constant] = np.where(after, values[i + 1], values[i])[constant]
        if curve.kinds & CUBIC:
            cubic = ((flags & CUBIC) > 0) & (share > 0) & (share < 1)
            sampled[cubic] = _evaluate_bezier(curve, i[cubic], share[cubic])
        return sampled

    def _are_frames(self, times: Floats) -> bool:
        """Return whether there is a key at each frame."""
        if times is self._frame_times:
            return True
        if len(times) != len(self.at) or np.abs(times - self.at).max() > SLACK:
            return False
        self._frame_times = times
        return True

    def _find(self, times: Floats) -> None:
        """Return the key before each frame, and the share of the interval that has passed."""
        if len(times) == len(self._times) and np.array_equal(times, self._times):
            return
        self._times = times
        self._index, self._share = find_keys(times, self.at, SLACK)


def _evaluate_bezier(curve: Curve, i: NDArray[np.intp], share: Floats) -> Floats:
    """Values between the keys i and i + 1, of which so large a share has passed."""
    right, left, right_weight, left_weight = _compute_tangents(curve)
    # Seconds of each interval.
    step = np.diff(curve.times)[i] / TICKS
    start, stop = curve.values[i], curve.values[i + 1]
    first, last = right_weight[i], left_weight[i]
    # Time is a Bézier curve of its own, if the inner points are not at the thirds.
    share_after = _solve_parameter(share, first, 1 - last)
    rest = 1 - share_after
    # Inner points of the Bézier curve: along the slopes, weight times the interval away.
    out, into = start + right[i] * first * step, stop - left[i] * last * step
    value = rest**3 * start + 3 * rest**2 * share_after * out + 3 * rest * share_after**2 * into
    return np.asarray(value + share_after**3 * stop, np.float64)


def _solve_parameter(share: Floats, first: Floats, second: Floats) -> Floats:
    """Where on the curve so large a share of the time has passed: halving, as it only grows."""
    # At the thirds time is even.
    if (np.abs(first - THIRD) < 1e-3).all() and (np.abs(second - 2 * THIRD) < 1e-3).all():
        return share
    # Bisection: time grows along the curve.
    low, high = np.zeros_like(share), np.ones_like(share)
    for _ in range(_STEPS):
        middle = (low + high) / 2
        rest = 1 - middle
        time = 3 * rest**2 * middle * first + 3 * rest * middle**2 * second + middle**3
        low, high = np.where(time < share, middle, low), np.where(time < share, high, middle)
    return (low + high) / 2


def _compute_tangents(curve: Curve) -> tuple[Floats, Floats, Floats, Floats]:
    """(keys - 1,) each: slopes at the start and end of each interval, and their weights."""
    times, values = curve.times / TICKS, curve.values
    step = np.diff(times)
    secant = np.diff(values) / step
    # Slopes of damaged files may be nan.
    with np.errstate(invalid="ignore", over="ignore"):
        slopes = np.nan_to_num(curve.details[:, :2].astype(np.float64))
    # Two weights of 16 bits share the bits of one float.
    packed = np.ascontiguousarray(curve.details[:, 2]).view(np.uint32)
    flags = curve.flags
    weighted = (flags & RIGHT_WEIGHT) > 0
    right_weight = np.where(weighted, (packed & 0xFFFF) * _WEIGHT_UNIT, THIRD)[:-1]
    weighted = (flags & LEFT_WEIGHT) > 0
    left_weight = np.where(weighted, (packed >> 16) * _WEIGHT_UNIT, THIRD)[:-1]
    right_weight, left_weight = np.clip(right_weight, 0, 1), np.clip(left_weight, 0, 1)
    # Slope after each key and before the next one: both are stored with the first key.
    right, left = slopes[:-1, 0], slopes[:-1, 1]
    cubic = (flags & (CONSTANT | CUBIC)) == CUBIC
    tcb = cubic & ((flags & TCB) > 0)
    automatic = cubic & ((flags & (TCB | USER)) == 0)
    left = np.where(tcb[:-1], 0.0, left)  # its details are no slopes
    if automatic.any():
        # Slopes of automatic keys hold for both sides.
        made = _compute_automatic_slopes(times, values, flags, right_weight, left_weight)
        right = np.where(automatic[:-1], made[:-1], right)
        left = np.where(automatic[1:], made[1:], left)
    if tcb.any():
        after, before = _compute_tcb_slopes(curve, secant)
        right = np.where(tcb[:-1], after[:-1], right)
        left = np.where(tcb[1:], before[1:], left)
    return right, left, right_weight, left_weight


def _compute_automatic_slopes(
    times: Floats, values: Floats, flags: NDArray[np.int64], right: Floats, left: Floats
) -> Floats:
    """(keys,): slopes of automatic tangents, which overshoot no neighbour if they are clamped."""
    step, rise = np.diff(times), np.diff(values)
    secant = rise / step
    near = np.abs(rise) <= _NEAR
    clamped, progressive = (flags & CLAMPED) > 0, (flags & PROGRESSIVE) > 0
    slope = np.zeros(len(times))
    # At the ends the slope is that of the only interval.
    ends = [0, -1]
    flat = progressive[ends] | (clamped[ends] & near[ends])
    slope[ends] = np.where(flat, 0.0, secant[ends])
    if len(times) < 3:
        return slope
    across = (values[2:] - values[:-2]) / (times[2:] - times[:-2])
    # Secants count more, the shorter their interval is.
    share = step[:-1] / (step[:-1] + step[1:])
    blended = (across + secant[:-1] * (1 - share) + secant[1:] * share) / 2
    inner = np.where(flags[1:-1] & TIMELESS, across, blended)
    # Towards each neighbour the tangent's end must not lie beyond the neighbour's value.
    sign = np.where(inner < 0, -1.0, 1.0)
    limit = np.full(len(inner), np.inf)
    for weight, side in ((left[:-1], slice(None, -1)), (right[1:], slice(1, None))):
        reach = weight * step[side]
        most = sign * rise[side] / np.where(reach > 0, reach, np.inf)
        limit = np.minimum(limit, np.maximum(most, 0.0))
    inner = np.where(progressive[1:-1], sign * np.minimum(np.abs(inner), limit), inner)
    # Next to a nearly equal value a clamped tangent is flat.
    slope[1:-1] = np.where(clamped[1:-1] & (near[:-1] | near[1:]), 0.0, inner)
    return slope


def _compute_tcb_slopes(curve: Curve, secant: Floats) -> tuple[Floats, Floats]:
    """(keys,) each: slopes after and before the keys, from tension, continuity and bias."""
    with np.errstate(invalid="ignore", over="ignore"):
        tension, continuity, bias = np.nan_to_num(curve.details[:, :3].astype(np.float64)).T
    # Slope of the interval before each key, and of the one after it.
    before, after = np.r_[0.0, secant], np.r_[secant, 0.0]
    tight = (1 - tension) / 2
    tight[[0, -1]] *= 2  # there is one neighbour only
    forward = tight * (
        (1 + continuity) * (1 + bias) * before + (1 - continuity) * (1 - bias) * after
    )
    backward = tight * (
        (1 - continuity) * (1 + bias) * before + (1 + continuity) * (1 - bias) * after
    )
    return forward, backward
