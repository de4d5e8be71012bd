"""Recurrence: how similar any two samples of a recording are, whatever the phase.

A sample is one in ``step`` frames of the working rate. Two samples of the same
activity seldom show the same pose, but each finds its own pose again close to
the other. The distance of two samples is therefore the larger of two smallest
distances: from the one to anything within the phase window around the other,
and back. Activities then are plain squares along the diagonal, without the
stripes of a self-similarity matrix. A wide window spans slow repetitions, a
narrow one keeps short activities apart: similarity is the mean over several.

How near is near depends on the movement: distances are measured against the
scale at which each sample recurs, so that small movements count as large ones
do (local scaling, after Zelnik-Manor and Perona 2004).

Everything is held as a band along the diagonal, at the rate of ``step``, so
that memory and time grow with the length of the recording.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from kineme._threads import even_slices, map_threads
from kineme.methods.recurrence import _recurrence_kernels as kernels

Band = NDArray[np.float32]

SHORT = 1000
"""Rows of a band that are read or written sooner than threads have shared them."""
BLOCK = 4
"""Times as many rows as the band has lags that are compared at a time."""


@dataclass(frozen=True, eq=False)
class Recurrence:
    """How similar the samples of a recording are, in a band along the diagonal.

    Attributes
    ----------
    near : (samples, 2 width + 1) array
        ``near[i, j - i + width]`` is the distance from sample i to the nearest
        frame between sample j and the next.
    similarity : (samples, width + 1) array
        ``similarity[i, j - i]`` from 0 to 1, phase windows and local scale applied.
    scales : (samples,) array
        The distance at which each sample recurs.
    features : (frames, dims) array
        As measured.
    step : int
        Frames per sample.
    phases : tuple of int
        Samples on either side within which a sample may find its like, the widest
        window first.
    softness : float
        Scales at which similarity has fallen to 1/e.
    """

    near: Band
    similarity: Band
    scales: NDArray[np.float32]
    features: Band
    step: int
    phases: tuple[int, ...]
    softness: float

    @property
    def phase(self) -> int:
        """The widest window; nearer samples do not count as recurrence."""
        return self.phases[0]

    def __len__(self) -> int:
        return len(self.scales)


def recurrence(
    features: ArrayLike,
    *,
    step: int,
    width: int,
    phases: tuple[int, ...],
    rank: int,
    low: float,
    high: float,
    softness: float,
) -> Recurrence:
    """Distances and similarities of all samples no more than ``width`` apart.

    Parameters
    ----------
    features : (frames, dims) array
    step : int
        Every step-th frame is a sample.
    width : int
        Samples on either side of the diagonal.
    phases : tuple of int
        Samples on either side within which a sample may find its like, the widest first;
        similarity is the mean over these windows.
    rank : int
        The scale of a sample is the distance to its rank-th nearest beyond the widest window.
    low, high : float
        Least and greatest scale, in the unit of the features.
    softness : float
        Scales at which similarity has fallen to 1/e.

    Returns
    -------
    Recurrence
    """
    rows = np.ascontiguousarray(features, np.float32)
    n = (len(rows) + step - 1) // step
    width = min(width, n - 1)
    near = np.empty((n, 2 * width + 1), np.float32)

    def measure(part: slice) -> None:
        kernels.nearest_frames(rows, step, width, part.start, part.stop, near)

    map_threads(measure, even_slices(n))
    return _similar(near, rows, step, phases, rank, low, high, softness)


def narrower(
    wide: Recurrence, *, phases: tuple[int, ...], rank: int, low: float, high: float
) -> Recurrence:
    """The same samples with other windows; parameters are those of `recurrence`.

    Returns
    -------
    Recurrence
    """
    return _similar(wide.near, wide.features, wide.step, phases, rank, low, high, wide.softness)


def _similar(
    near: Band,
    rows: Band,
    step: int,
    phases: tuple[int, ...],
    rank: int,
    low: float,
    high: float,
    softness: float,
) -> Recurrence:
    """Similarities of samples from their distances.

    Blurred distances are held for a block of rows at a time, and for those in reach of it.
    """
    n, lags = near.shape
    scales = np.empty(n, np.float32)
    similarity = np.zeros((n, lags // 2 + 1), np.float32)
    blurred = np.empty((min(n, BLOCK * lags + 2 * (lags // 2 + phases[0])), lags), np.float32)
    held: tuple[slice, int] | None = None  # which rows are blurred, and by which window

    def blur(around: slice, window: int) -> None:
        nonlocal held
        if held == (around, window):
            return
        held, rows_around = (around, window), near[around]

        def fill(part: slice) -> None:
            kernels.blur_rows(rows_around, window, part.start, part.stop, blurred)

        map_threads(fill, even_slices(len(rows_around), SHORT))

    def block(first: int) -> tuple[slice, list[slice]]:
        """Rows around those of a block, and slices of its own, counted from there."""
        last, reach = min(first + BLOCK * lags, n), lags // 2 + phases[0]
        around = slice(max(first - reach, 0), min(last + reach, n))
        begin = first - around.start
        own = even_slices(last - first, SHORT)
        return around, [slice(begin + each.start, begin + each.stop) for each in own]

    blocks = [block(first) for first in range(0, n, BLOCK * lags)]
    for around, parts in blocks:  # the scale is that of the widest window, which is the first
        blur(around, phases[0])

        def scale(part: slice, around: slice = around) -> None:
            rows_of, found = blurred[: around.stop - around.start], scales[around]
            kernels.local_scales(rows_of, phases[0], rank, part.start, part.stop, low, high, found)

        map_threads(scale, parts)
    for window in phases:
        for around, parts in blocks:
            blur(around, window)

            def compare(part: slice, around: slice = around) -> None:
                kernels.add_similarities(
                    blurred[: around.stop - around.start], scales[around], softness,
                    1 / len(phases), part.start, part.stop, similarity[around],
                )  # fmt: skip

            map_threads(compare, parts)
    return Recurrence(near, similarity, scales, rows, step, phases, softness)


def phase_windows(widest: int, shares: tuple[float, ...]) -> tuple[int, ...]:
    """The windows that similarity is measured with, samples on either side, the widest first."""
    return tuple(sorted({round(share * widest) for share in shares}, reverse=True))
