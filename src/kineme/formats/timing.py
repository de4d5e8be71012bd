"""The frame rate that a column of times tells, and frames at even times where they are not."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from kineme.formats.files import Source

Floats = NDArray[np.float64]

UNEVEN = 0.1
"""Share of a period by which times may differ from even ones."""

_MOST_FRAMES_MORE = 20  # even frames per frame given, at most; beyond that the times are wrong


def even_frames(source: Source, times: Floats, values: Floats) -> tuple[float, Floats, list[str]]:
    """Frames per second, the values at even times, and what was done.

    The rate is that of the median step; a rate that rounds to whole
    thousandths of a hertz is taken as such. Where times are uneven or rows are missing,
    values are interpolated on a straight line; more than two periods between rows
    leave a gap (NaN).

    Parameters
    ----------
    times : (rows,), seconds
    values : (rows, ...)

    Raises
    ------
    ReadError : times do not increase, or are too few to tell a rate
    """
    if len(times) < 2 or not np.isfinite(times).all():
        raise source.error("the times are too few or not numbers: give fps= (--fps)")
    steps = np.diff(times)
    if steps.min() <= 0:
        row = int(steps.argmin()) + 1
        raise source.error(f"times do not increase: row {row + 1} has {times[row]:g} s")
    period = float(np.median(steps))
    even = times[0] + period * np.arange(len(times))
    drift = np.abs(times - even - (times - even).mean()).max()
    if drift <= UNEVEN * period or np.ptp(steps) <= UNEVEN * period:
        fps = (len(times) - 1) / float(times[-1] - times[0])
        return _rounded(fps), values, []
    fps = _rounded(1 / period)
    n = int((times[-1] - times[0]) * fps + 0.5) + 1
    if n > _MOST_FRAMES_MORE * len(times):
        raise source.error(f"the times span {n} periods in {len(times)} rows: give fps= (--fps)")
    at = times[0] + np.arange(n) / fps
    return (
        fps,
        _interpolated(times, values, at, 2.5 * period),
        [f"times are uneven: positions interpolated to {fps:g} Hz"],
    )


def _interpolated(times: Floats, values: Floats, at: Floats, farthest: float) -> Floats:
    after = np.clip(np.searchsorted(times, at), 1, len(times) - 1)
    span = times[after] - times[after - 1]
    share = np.clip((at - times[after - 1]) / span, 0, 1)
    share = share.reshape(-1, *[1] * (values.ndim - 1))
    between = (1 - share) * values[after - 1] + share * values[after]
    between[(span > farthest) & (share.reshape(-1) % 1 > 0)] = np.nan
    return between


def _rounded(fps: float) -> float:
    """The rate to thousandths of a hertz where it is within a millionth of that."""
    whole = round(fps, 3)
    return whole if whole > 0 and abs(fps - whole) <= 1e-6 * fps else fps
