"""The self-similarity matrix of a recording, as tiles at every zoom.

A cell of level 0 says how alike two moments look: ``exp(-d²)`` of the distance
of their features, from 0 (nothing in common, or not seen) to 1. The features
are those of the ``kineme`` method, the ends of the body in its own frame with
what they do 0.2 s before and after; ``d`` is 1 at a fifth of a body. Motions
without a known body are compared by the distances between their points, signals
by their channels, each divided by its deviation.

A cell of level L merges 2^L moments on either side. It compares how their poses
are distributed, mean and deviation of each feature (the Fréchet distance of
normal distributions with independent features), so that from afar an activity
is a plain block, whatever the phase of its moments.

Nothing of cells × cells is held: a tile is made from two stretches of features,
each time anew, in a few milliseconds. It is a PNG of 16 shades, white for 1.
"""

from __future__ import annotations

import struct
import zlib
from dataclasses import dataclass
from itertools import product
from math import ceil

import numpy as np
from numpy.typing import ArrayLike, NDArray

from kineme.errors import MotionError, ParameterError
from kineme.features import Names, body_size, distance_features, end_effectors, pose_features
from kineme.features.distances import SIZE
from kineme.recordings import Motion
from kineme.recordings.operations import resample
from kineme.web.messages import MatrixHead

Floats = NDArray[np.float64]

TILE = 256
RATE = 10.0  # cells per second: what can still be told apart on a screen
MOST_CELLS = 36_000  # an hour; longer recordings get fewer cells per second
OFFSETS = (-0.2, -0.1, 0.0, 0.1, 0.2)  # seconds, as in the preset kineme
BODY_SCALE = 0.2  # body sizes; where the activities of subject 86 stand out
SIGNAL_SCALE = 0.5  # of the distance of two moments taken at random
MOST_CHANNELS = 16
MOST_BYTES = 9_000_000  # of the tiles in a report, see display.MOST_BYTES
WHOLE = 24  # tiles a side up to which a report holds all of a level


@dataclass(frozen=True, eq=False)
class Matrix:
    """A recording's self-similarity: ``levels[L]`` holds the features of each cell of level L.

    Parameters
    ----------
    fps : cells of level 0 per second
    levels : (cells, dims) each, in units of the scale; rows of nan where nothing was seen
    """

    fps: float
    levels: tuple[NDArray[np.float32], ...]

    def head(self, band: int | None = None) -> MatrixHead:
        """What a page needs to know; ``band`` as in the message."""
        sizes = [len(level) for level in self.levels]
        return {"fps": self.fps, "tile": TILE, "sizes": sizes, "band": band}

    def tile(self, level: int, row: int, column: int) -> bytes | None:
        """The PNG of a tile; None where there is none."""
        if not 0 <= level < len(self.levels) or min(row, column) < 0:
            return None
        features = self.levels[level]
        if max(row, column) * TILE >= len(features):
            return None
        down, across = (features[TILE * i : TILE * (i + 1)] for i in (row, column))
        return _png(_similarity(down, across))

    def kept(self, most_bytes: int = MOST_BYTES) -> tuple[dict[str, bytes], int | None]:
        """Tiles for a report, by "level/row/column", and the band that they fill.

        Those on and below the diagonal: all of the coarse levels; of the fine
        ones those at the diagonal, then those next to it, as long as there is
        room. The band is None if none had to be left out.
        """
        sides = [ceil(len(features) / TILE) for features in self.levels]
        coarse = [level for level, side in enumerate(sides) if side <= WHOLE]
        places = [
            (level, row, column)
            for level in reversed(coarse)
            for row in range(sides[level])
            for column in range(row + 1)
        ]
        first = len(places)
        fine = [level for level in reversed(range(len(sides))) if level not in coarse]
        for away, level in product((0, 1), fine):
            places += [(level, row, row - away) for row in range(away, sides[level])]
        tiles: dict[str, bytes] = {}
        left = most_bytes
        for place in places:
            tile = self.tile(*place) or b""
            left -= len(tile)
            if left < 0:
                break
            tiles["/".join(map(str, place))] = tile
        if len(tiles) == len(places):
            return tiles, TILE if fine else None
        return tiles, 0 if len(tiles) >= first else None


def matrix_of_motion(motion: Motion, *, effectors: Names | None = None) -> Matrix:
    """The matrix of a motion; of the distances between its points where it has no known body."""
    try:
        found = end_effectors(motion, names=effectors)
        values = pose_features(motion, effectors=found)
        values /= BODY_SCALE * body_size(motion, found)
    except MotionError:
        motion = resample(motion, min(motion.fps, 3 * RATE))  # distances are many
        values = _distances(motion)
    for start, stop in motion.gaps:
        values[start:stop] = np.nan
    return _pyramid(values, motion.fps, motion.duration)


def matrix_of_signal(values: ArrayLike, fps: float) -> Matrix:
    """The matrix of any signal (frames, channels); nan for what was not seen.

    Raises
    ------
    ParameterError : no frames, no channels, no numbers, or a frame rate that is not positive
    """
    try:
        signal = np.asarray(values, np.float64)
    except (ValueError, TypeError):
        raise ParameterError(
            "a signal is frames x channels of numbers: columns of texts?"
        ) from None
    signal = signal[:, None] if signal.ndim == 1 else signal
    if signal.ndim != 2 or 0 in signal.shape:
        raise ParameterError(f"a signal is frames x channels, not of shape {signal.shape}")
    if not (np.isfinite(fps) and fps > 0):
        raise ParameterError(f"the frame rate must be a positive number, not {fps}")
    block = max(1, int(fps / (2 * RATE)))  # frames whose mean is compared: 0.05 s
    starts = np.arange(0, len(signal), block)
    lengths = np.diff(starts, append=len(signal))
    means = np.add.reduceat(signal, starts, axis=0) / lengths[:, None]
    return _pyramid(_standardised(means), fps / block, len(signal) / fps)


def _distances(motion: Motion) -> Floats:
    """The features of a motion without a body, in units of the scale; any where it has a gap."""
    seen = np.ones(motion.n_frames, np.bool_)
    for start, stop in motion.gaps:
        seen[start:stop] = False
    if motion.skeleton.n_joints < 2 or not seen.any():
        return np.zeros((motion.n_frames, 1))
    features, _ = distance_features(motion.positions[seen])
    values = np.zeros((motion.n_frames, features.shape[1]))
    values[seen] = features / (BODY_SCALE * SIZE)
    return values


def _standardised(values: Floats) -> Floats:
    """The channels over their deviation, the main ones of many, 1 apart where ``d`` is to be 1."""
    seen = np.asarray(np.isfinite(values).all(axis=1))
    if not seen.any():
        return np.full((len(values), 1), np.nan)
    out = np.where(seen[:, None], values, np.nan) - values[seen].mean(axis=0)
    deviation = out[seen].std(axis=0)
    out = out[:, deviation > 0] / deviation[deviation > 0]
    if out.shape[1] == 0:
        return np.where(seen[:, None], 0.0, np.nan)
    if out.shape[1] > MOST_CHANNELS:
        from scipy.linalg import eigh

        n = out.shape[1]
        axes = eigh(np.cov(out[seen].T), subset_by_index=(n - MOST_CHANNELS, n - 1))[1]
        out = out @ axes
    return np.asarray(out / (SIGNAL_SCALE * np.sqrt(2 * out[seen].var(axis=0).sum())))


def _pyramid(values: Floats, fps: float, seconds: float) -> Matrix:
    rate = min(RATE, fps, MOST_CELLS / seconds)
    middles = np.asarray((np.arange(ceil(seconds * rate - 1e-6)) + 0.5) / rate, np.float64)
    stacked = np.concatenate([_at(values, middles + offset, fps) for offset in OFFSETS], axis=1)
    stacked /= np.sqrt(len(OFFSETS))
    seen = np.asarray(np.isfinite(stacked).all(axis=1))
    total = np.where(seen[:, None], stacked, 0.0)
    squares, counts = total**2, seen.astype(float)[:, None]
    levels = [np.where(seen[:, None], total, np.nan).astype(np.float32)]
    while len(total) > TILE:
        total, squares, counts = (_in_pairs(sums) for sums in (total, squares, counts))
        # 0 / 0: where nothing was seen there is nothing to compare.
        with np.errstate(invalid="ignore"):
            mean = total / counts
            deviation = np.sqrt(np.maximum(squares / counts - mean**2, 0))
        levels.append(np.concatenate([mean, deviation], axis=1).astype(np.float32))
    return Matrix(rate, tuple(levels))


def _at(values: Floats, times: Floats, fps: float) -> Floats:
    """Values at seconds, where frame i stands for the time around (i + 0.5) / fps."""
    at = np.clip(times * fps - 0.5, 0, len(values) - 1)
    before = np.floor(at).astype(np.intp)
    after = np.minimum(before + 1, len(values) - 1)
    share = (at - before)[:, None]
    return np.asarray((1 - share) * values[before] + share * values[after])


def _in_pairs(sums: Floats) -> Floats:
    """Sums of two neighbouring rows; the last of an odd number stays alone."""
    return np.add.reduceat(sums, np.arange(0, len(sums), 2), axis=0)


def _similarity(down: NDArray[np.float32], across: NDArray[np.float32]) -> NDArray[np.float32]:
    squared = (down**2).sum(axis=1)[:, None] + (across**2).sum(axis=1) - 2 * (down @ across.T)
    return np.asarray(np.nan_to_num(np.exp(-np.maximum(squared, 0)), nan=0.0), np.float32)


def _png(shares: NDArray[np.float32]) -> bytes:
    """A grey picture of 4 bits per pixel, from shares of white."""
    height, width = shares.shape
    shades = np.zeros((height, width + width % 2), np.uint8)
    shades[:, :width] = np.rint(15 * shares)
    rows = np.zeros((height, 1 + shades.shape[1] // 2), np.uint8)  # each begins with its filter: 0
    rows[:, 1:] = shades[:, ::2] << 4 | shades[:, 1::2]
    header = struct.pack(">IIBBBBB", width, height, 4, 0, 0, 0, 0)
    chunks = [(b"IHDR", header), (b"IDAT", zlib.compress(rows.tobytes(), 6)), (b"IEND", b"")]
    return b"\x89PNG\r\n\x1a\n" + b"".join(
        struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))
        for name, data in chunks
    )
