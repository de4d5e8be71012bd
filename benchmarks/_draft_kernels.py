"""Compiled loops of the draft of one method."""

from __future__ import annotations

import numpy as np
from numba import njit

COMPARED = 32
"""Samples at most that tell how far a segment spreads."""


@njit(cache=True)
def explained(poses, path, visits, places):
    """The share of repetitions' variance that the mean of the others explains, in time.

    Each about its own mean, and the mean of the others as large as fits it best.
    """
    count, number, dims = places.shape
    for k in range(count):
        for d in range(dims):
            places[k, :, d] -= places[k, :, d].mean()
    total = places.sum(axis=0)
    left = frames = 0.0
    for k in range(count):
        mean = (total - places[k]) / (count - 1)
        size = max((places[k] * mean).sum(), 0.0) / max((mean**2).sum(), 1e-12)
        first, last = visits[k], visits[k + 1]
        center = np.zeros(dims)
        middle = np.zeros(dims)
        length = max(path[last] - path[first], 1e-12)
        for d in range(dims):
            center[d] = poses[first:last, d].mean()
        residual, variance = 0.0, 1e-12
        for part in range(2):  # the mean pose along the path first, then what is left about it
            for f in range(first, last):
                phase = (path[f] - path[first]) / length * number - 0.5
                low = min(max(int(np.floor(phase)), 0), number - 1)
                high = min(low + 1, number - 1)
                share = min(max(phase - low, 0.0), 1.0)
                for d in range(dims):
                    expected = size * (mean[low, d] * (1 - share) + mean[high, d] * share)
                    if part == 0:
                        middle[d] += (poses[f, d] - expected) / (last - first)
                    else:
                        residual += (poses[f, d] - expected - middle[d]) ** 2
                        variance += (poses[f, d] - center[d]) ** 2
        noise = (count - 1) / count  # the mean of few others has noise of its own
        left += min(residual * noise / variance, 1.0) * (last - first)
        frames += last - first
    return 1 - left / frames


@njit(cache=True)
def spread(view, start, stop):
    """Half the summed distances of samples to the mean others of the span, by a few of them."""
    stop = min(stop, len(view))
    count = min(COMPARED, stop - start)
    total = 0.0
    for i in range(count):
        for j in range(i):
            a, b = start + i * (stop - start) // count, start + j * (stop - start) // count
            square = 0.0
            for d in range(view.shape[1]):
                square += (view[a, d] - view[b, d]) ** 2
            total += np.sqrt(square)
    return (stop - start) * total / max(count * count, 1)
