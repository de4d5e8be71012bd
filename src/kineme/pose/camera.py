"""Find when the camera moves, from the pictures alone.

Two pictures about half a second apart are compared in their four corners, by phase correlation
(its peak is at the displacement of most edges, and exposure does not matter). If the corners that
can be compared went somewhere else, the camera panned, tilted, rolled or zoomed. A person moves in
one or two corners only, and a corner without edges has no clear peak.

Source: C. D. Kuglin and D. C. Hines, The phase correlation image alignment method, 1975.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from kineme._util.arrays import Floats
from kineme.pose.estimators import Picture

INTERVAL_S = 0.45
"""Seconds between the pictures that are compared."""
MAX_INTERVAL_S = 1.0
"""Seconds above which two pictures are not compared, such as before and after a restart."""
COLUMNS = 128
"""Width in pixels to which pictures are reduced."""
MIN_SHIFT = 2.0
"""Pixels of these that a corner has to go: 3 % of the picture's width a second."""
MIN_PEAK = 0.5
"""Height of the peak from which a displacement is clear; 1 for pictures that are equal."""
MIN_CORNERS = 3
"""Corners that must have a clear displacement."""
BANDWIDTH = 0.12
"""Standard deviation of the weights of frequencies, in cycles per pixel: noise is above."""


class CameraWatch:
    """Compares pictures of a video in the order of time."""

    def __init__(self) -> None:
        self._time = -np.inf
        self._spectra: NDArray[np.complex128] | None = None

    def measure(self, picture: Picture, time: float) -> float:
        """Return for how many seconds before ``time`` the camera moved; 0 if it did not."""
        elapsed = time - self._time
        if elapsed < INTERVAL_S:
            return 0.0
        corners = _cut_corners(_reduce(picture))
        spectra = np.fft.rfft2(corners)
        former = self._spectra
        self._time, self._spectra = time, spectra
        if former is None or former.shape != spectra.shape or elapsed > MAX_INTERVAL_S:
            return 0.0
        shifts, peaks = _correlate(former, spectra, corners.shape[1:])
        clear = peaks >= MIN_PEAK
        is_moving = clear.sum() >= MIN_CORNERS and (shifts[clear] >= MIN_SHIFT).mean() > 0.7
        return float(elapsed) if is_moving else 0.0


def _reduce(picture: Picture) -> Floats:
    """Return the green channel as means of square blocks."""
    k = max(1, picture.shape[1] // COLUMNS)
    height, width = picture.shape[0] // k, picture.shape[1] // k
    blocks = picture[: height * k, : width * k, 1].reshape(height, k, width, k)
    return np.asarray(blocks.mean(axis=(1, 3)), np.float64)


def _cut_corners(grey: Floats) -> Floats:
    """Return the four quarters (4, height, width), without their means and faded out."""
    height, width = grey.shape[0] // 2, grey.shape[1] // 2
    corners = np.stack(
        [grey[rows, columns] for rows in (np.s_[:height], np.s_[-height:])
         for columns in (np.s_[:width], np.s_[-width:])]
    )  # fmt: skip
    corners -= corners.mean(axis=(1, 2), keepdims=True)
    return np.asarray(corners * np.hanning(height)[:, None] * np.hanning(width))


def _correlate(
    former: NDArray[np.complex128], spectra: NDArray[np.complex128], shape: tuple[int, ...]
) -> tuple[Floats, Floats]:
    """Return displacement in pixels and height of the peak for each corner."""
    cross = former.conj() * spectra
    size = np.abs(cross)
    cross /= size + 1e-6 * size.max(axis=(1, 2), keepdims=True) + 1e-12
    fy, fx = np.fft.fftfreq(shape[0])[:, None], np.fft.fftfreq(shape[1])
    weights = np.exp(-(fy**2 + fx**2) / (2 * BANDWIDTH**2))
    # rfft2 has only the first half of the columns.
    surface = np.fft.irfft2(cross * weights[:, : cross.shape[2]], shape).reshape(4, -1)
    down, right = np.unravel_index(surface.argmax(axis=1), shape)
    # Indices above half of the length are negative displacements.
    y, x = ((at + n // 2) % n - n // 2 for at, n in zip((down, right), shape, strict=True))
    return np.hypot(x, y), surface.max(axis=1) / weights.mean()
