"""Windows of matching features in a few numbers, whose distances foretell those of a search.

A search compares samples along a warping. The mean of a window, and how its second half differs
from the first (the first two terms of a cosine transform), are near where all samples are. Features
are ordered by how much they tell, so the first of them do. Each number takes a byte: those of unit
vectors lie between -1 and 1, and rounding errs less than the numbers that are left out.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from kineme._util.arrays import Float32s, Ints, interpolate_frames

Bytes = NDArray[np.int8]

LENGTHS = (15, 30, 60)
"""Samples of a window: 1, 2 and 4 s of a body. Each begins half a window after the last one."""
SPEEDS = (0.7, 1.0, 1.4)
"""Of an example, as it is compared with windows: others may be slower or faster."""
MEANS, SLOPES = 16, 16
NUMBERS = MEANS + SLOPES
LARGEST = 127
"""What 1 becomes in a window."""
FINER = 16
"""As many times finer is an example."""


def compute_step(length: int) -> int:
    """Samples from one window to the next."""
    return length // 2


def count_windows(samples: Ints, length: int) -> Ints:
    """Return how many windows of a length there are in recordings of so many samples.

    A recording that is shorter is one window.
    """
    windows = np.maximum(samples - length, 0) // compute_step(length) + 1
    return np.where(samples > 0, windows, 0)


def describe_windows(features: Float32s, length: int) -> Bytes:
    """The windows of a recording in 32 numbers each: means, and what tells of the two halves."""
    if len(features) == 0:
        return np.empty((0, NUMBERS), np.int8)
    if len(features) < length:
        features = _resample_to(features, length)
    windows = np.lib.stride_tricks.sliding_window_view(features, length, axis=0)[
        :: compute_step(length)
    ]
    return np.clip(np.rint(LARGEST * _compute_numbers(windows)), -LARGEST, LARGEST).astype(np.int8)


def describe_all_windows(features: Float32s) -> Bytes:
    """Return the windows of all `LENGTHS`, one length after the other."""
    return np.concatenate([describe_windows(features, length) for length in LENGTHS])


def group_by_length(windows: Bytes, samples: int) -> Iterator[tuple[int, Bytes]]:
    """Yield each of `LENGTHS` and its part of `describe_all_windows`."""
    first = 0
    for length in LENGTHS:
        n = int(count_windows(np.array(samples), length))
        yield length, windows[first : first + n]
        first += n


def choose_length(example: Float32s) -> int:
    """Return the length of windows that is nearest to that of an example."""
    return min(LENGTHS, key=lambda length: abs(np.log(length / max(len(example), 1))))


def describe_at_speeds(example: Float32s) -> NDArray[np.int32]:
    """The middle of an example at each of `SPEEDS`, (speeds, 32), to compare windows with."""
    length = choose_length(example)
    parts = []
    for speed in SPEEDS:
        n = min(round(length * speed), len(example))
        first = (len(example) - n) // 2
        parts.append(_resample_to(example[first : first + n], length).T)
    most = FINER * LARGEST
    return np.clip(np.rint(most * _compute_numbers(np.array(parts))), -most, most).astype(np.int32)


def _compute_numbers(windows: Float32s) -> Float32s:
    """Means and slopes (windows, 32) of windows (windows, dims, length)."""
    length = windows.shape[2]
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
