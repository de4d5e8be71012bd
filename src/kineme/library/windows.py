"""Summarise windows of matching features in a few numbers, to preselect matches.

A search compares samples with warping. If all samples of two windows are near, so are their means
and slopes (the first two terms of a cosine transform). Features are sorted by importance, so the
first ones suffice. Each number takes one byte: components of unit vectors lie between -1 and 1, and
the rounding error is smaller than the effect of the omitted numbers.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from kineme._util.arrays import Float32s, Ints, interpolate_frames

Bytes = NDArray[np.int8]
LENGTHS = (15, 30, 60)
"""Lengths of windows in samples: 1, 2 and 4 s of a body. Windows overlap by half."""
SPEEDS = (0.7, 1.0, 1.4)
"""Relative speeds at which an example is compared, since matches may be slower or faster."""
MEANS, SLOPES = 16, 16
NUMBERS = MEANS + SLOPES
LARGEST = 127
"""Value of 1.0 in a window, the largest of int8."""
FINER = 16
"""Factor by which examples have a finer resolution than windows."""


def compute_step(length: int) -> int:
    """Return the number of samples from one window to the next."""
    return length // 2


def count_windows(samples: Ints, length: int) -> Ints:
    """Return the number of windows of a length in recordings with ``samples`` samples.

    A shorter recording has one window.
    """
    windows = np.maximum(samples - length, 0) // compute_step(length) + 1
    return np.where(samples > 0, windows, 0)


def describe_windows(features: Float32s, length: int) -> Bytes:
    """Return the windows of a recording, (windows, 32): means and slopes."""
    if len(features) == 0:
        return np.empty((0, NUMBERS), np.int8)
    if len(features) < length:
        features = _resample_to(features, length)
    windows = np.lib.stride_tricks.sliding_window_view(features, length, axis=0)[
        :: compute_step(length)
    ]
    return np.clip(np.rint(LARGEST * _compute_numbers(windows)), -LARGEST, LARGEST).astype(np.int8)


def describe_all_windows(features: Float32s) -> Bytes:
    """Return the windows of all `LENGTHS`, concatenated."""
    return np.concatenate([describe_windows(features, length) for length in LENGTHS])


def group_by_length(windows: Bytes, samples: int) -> Iterator[tuple[int, Bytes]]:
    """Yield each of `LENGTHS` with its part of the result of `describe_all_windows`."""
    first = 0
    for length in LENGTHS:
        n = int(count_windows(np.array(samples), length))
        yield length, windows[first : first + n]
        first += n


def choose_length(example: Float32s) -> int:
    """Return the window length nearest to that of an example, on a logarithmic scale."""
    return min(LENGTHS, key=lambda length: abs(np.log(length / max(len(example), 1))))


def describe_at_speeds(example: Float32s) -> NDArray[np.int32]:
    """Return the middle of an example at each of `SPEEDS`, (speeds, 32), in finer resolution."""
    length = choose_length(example)
    parts = []
    for speed in SPEEDS:
        n = min(round(length * speed), len(example))
        first = (len(example) - n) // 2
        parts.append(_resample_to(example[first : first + n], length).T)
    most = FINER * LARGEST
    return np.clip(np.rint(most * _compute_numbers(np.array(parts))), -most, most).astype(np.int32)


def _compute_numbers(windows: Float32s) -> Float32s:
    """Return means and slopes (windows, 32) of windows (windows, dims, length)."""
    length = windows.shape[2]
    # The first cosine of a discrete cosine transform, orthonormal relative to the mean.
    slope = np.cos(np.pi / length * (np.arange(length) + 0.5)).astype(np.float32)
    slope *= np.float32(np.sqrt(2) / length)
    numbers = np.zeros((len(windows), NUMBERS), np.float32)
    means, slopes = windows[:, :MEANS].mean(axis=2), windows[:, :SLOPES] @ slope
    numbers[:, : means.shape[1]] = means
    numbers[:, MEANS : MEANS + slopes.shape[1]] = slopes
    return numbers


def _resample_to(features: Float32s, length: int) -> Float32s:
    at = np.linspace(0, len(features) - 1, length)
    return interpolate_frames(features.astype(np.float64), at).astype(np.float32)
