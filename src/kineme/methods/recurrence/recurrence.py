"""Recurrence: which moments of a recording look alike, whatever the phase.

Two moments of the same activity seldom show the same pose, but each finds its
own pose again close to the other. The distance of two moments is therefore the
larger of two smallest distances: from the one to anything within the phase
window around the other, and back. Activities then are plain blocks along the
diagonal, without the stripes of a self-similarity matrix. A wide window spans
slow repetitions, a narrow one keeps short activities apart: similarity is the
mean over several.

How near is near depends on the movement: distances are measured against the
scale at which each moment recurs, so that small movements count as large ones
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

# Similarity is the mean of those measured with phase windows of these shares of the widest.
PHASE_SHARES = (0.6, 0.8, 1.0)


@dataclass(frozen=True, eq=False)
class Recurrence:
    """How alike the moments of a recording are, in a band along the diagonal.

    Parameters
    ----------
    near : (bins, 2 width + 1)
        ``near[i, j - i + width]`` is the distance from moment i to the nearest
        frame in bin j.
    similarity : (bins, width + 1)
        ``similarity[i, j - i]`` from 0 to 1, phase windows and local scale applied.
    scales : (bins,)
        The distance at which each moment recurs.
    features : (frames, dims), as measured
    step : frames per bin
    phase : bins on either side of a moment within which it may find its like, at most; nearer
        moments do not count as recurrence
    softness : scales at which similarity has fallen to 1/e
    """

    near: Band
    similarity: Band
    scales: NDArray[np.float32]
    features: Band
    step: int
    phase: int
    softness: float

    def __len__(self) -> int:
        return len(self.scales)


def recurrence(
    features: ArrayLike,
    *,
    step: int,
    width: int,
    phase: int,
    rank: int,
    low: float,
    high: float,
    softness: float,
) -> Recurrence:
    """Distances and similarities of all moments no more than ``width`` bins apart.

    Parameters
    ----------
    features : (frames, dims)
    step : frames per bin; every step-th frame is a moment
    width : bins on either side of the diagonal
    phase : bins on either side within which a moment may find its like, at most
    rank : the scale of a moment is the distance to its rank-th nearest beyond the phase window
    low, high : least and greatest scale, in the unit of the features
    softness : scales at which similarity has fallen to 1/e
    """
    rows = np.ascontiguousarray(features, np.float32)
    bins = (len(rows) + step - 1) // step
    width = min(width, bins - 1)
    near = np.empty((bins, 2 * width + 1), np.float32)
    blurred = np.empty_like(near)
    scales = np.empty(bins, np.float32)
    similarity = np.zeros((bins, width + 1), np.float32)
    parts = even_slices(bins)
    windows = phase_windows(phase)

    def measure(part: slice) -> None:
        kernels.nearest_in_bins(rows, step, width, part.start, part.stop, near)

    def scale(part: slice) -> None:
        kernels.local_scales(blurred, phase, rank, part.start, part.stop, low, high, scales)

    def compare(part: slice) -> None:
        kernels.add_similarities(
            blurred, scales, softness, 1 / len(windows), part.start, part.stop, similarity
        )

    map_threads(measure, parts)
    for window in windows:

        def blur(part: slice, window: int = window) -> None:
            kernels.blur_rows(near, window, part.start, part.stop, blurred)

        # The scale is that of the widest window, which is the first.
        for stage in (blur, scale, compare) if window == phase else (blur, compare):
            map_threads(stage, parts)
    return Recurrence(near, similarity, scales, rows, step, phase, softness)


def phase_windows(widest: int) -> list[int]:
    """The windows that similarity is measured with, bins on either side, the widest first."""
    return sorted({round(share * widest) for share in PHASE_SHARES}, reverse=True)
