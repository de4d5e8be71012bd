"""A self-similarity matrix as tiles at every zoom.

A cell of level 0 is the similarity of two samples: ``exp(-d²)`` of the distance
of their features, from 0 (nothing in common, or not seen) to 1. The features of
`kineme.web.similarity` are taken 0.2 s before to 0.2 s after.

A cell of level L merges 2^L samples on either side. It compares how their poses
are distributed, mean and deviation of each feature (the Fréchet distance of
normal distributions with independent features), so that from afar an activity
is a plain square, whatever the phase of its samples.

Nothing of cells × cells is held: a tile is made from two spans of features,
each time anew, in a few milliseconds. It is a PNG of 16 shades, white for 1.
"""

from __future__ import annotations

import struct
import zlib
from dataclasses import dataclass
from itertools import product
from math import ceil

import numpy as np
from numpy.typing import NDArray

from kineme._util.arrays import Floats
from kineme.web.messages import MatrixHead

TILE = 256
RATE = 10.0  # cells per second: what can still be told apart on a screen
MOST_CELLS = 36_000  # an hour; longer recordings get fewer cells per second
OFFSETS = (-0.2, -0.1, 0.0, 0.1, 0.2)  # seconds, as in the preset kineme
MOST_BYTES = 9_000_000  # of the tiles in a report, see display.MOST_BYTES
MOST_TILES = 24  # tiles a side up to which a report holds all of a level


@dataclass(frozen=True, eq=False)
class Matrix:
    """A recording's self-similarity: ``levels[L]`` holds the features of each cell of level L.

    They are (cells, dims), in units of the scale, nan where nothing was seen; level 0 has ``fps``
    cells a second.
    """

    fps: float
    levels: tuple[NDArray[np.float32], ...]

    def head(self, band: int | None = None) -> MatrixHead:
        """What a page needs to know of the tiles; in a report they may fill a ``band`` only."""
        sizes = [len(level) for level in self.levels]
        return MatrixHead(fps=self.fps, tile=TILE, sizes=sizes, band=band)

    def tile(self, level: int, row: int, column: int) -> bytes | None:
        """Return the PNG of a tile; None where there is no such one."""
        if not 0 <= level < len(self.levels) or min(row, column) < 0:
            return None
        features = self.levels[level]
        if max(row, column) * TILE >= len(features):
            return None
        down, across = (features[TILE * i : TILE * (i + 1)] for i in (row, column))
        return _png(_similarity(down, across))

    def report_tiles(self, most_bytes: int = MOST_BYTES) -> tuple[dict[str, bytes], int | None]:
        """Return the tiles of a report by "level/row/column", and the band of cells that they fill.

        Those on and below the diagonal: all of the coarse levels; of the fine ones those at the
        diagonal, then those next to it, as long as there is room. The band is None if none was left
        out.
        """
        sides = [ceil(len(features) / TILE) for features in self.levels]
        coarse = [level for level, side in enumerate(sides) if side <= MOST_TILES]
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


def pyramid(values: Floats, fps: float, seconds: float) -> Matrix:
    """Return the matrix of features (samples, dims) at every zoom.

    ``seconds`` is the recording's length.

    They are so scaled that two of them are ``exp(-1)`` similar at a distance of 1; nan where
    nothing was seen.
    """
    rate = min(RATE, fps, MOST_CELLS / seconds)
    middles = np.asarray((np.arange(ceil(seconds * rate - 1e-6)) + 0.5) / rate, np.float64)
    stacked = np.concatenate(
        [_sample_at(values, middles + offset, fps) for offset in OFFSETS], axis=1
    )
    stacked /= np.sqrt(len(OFFSETS))
    visible = np.asarray(np.isfinite(stacked).all(axis=1))
    total = np.where(visible[:, None], stacked, 0.0)
    squares, counts = total**2, visible.astype(float)[:, None]
    levels = [np.where(visible[:, None], total, np.nan).astype(np.float32)]
    while len(total) > TILE:
        total, squares, counts = (_sum_pairs(sums) for sums in (total, squares, counts))
        # 0 / 0: where nothing was seen there is nothing to compare.
        with np.errstate(invalid="ignore"):
            mean = total / counts
            deviation = np.sqrt(np.maximum(squares / counts - mean**2, 0))
        levels.append(np.concatenate([mean, deviation], axis=1).astype(np.float32))
    return Matrix(rate, tuple(levels))


def _sample_at(values: Floats, times: Floats, fps: float) -> Floats:
    """Values at seconds, where frame i stands for the time around (i + 0.5) / fps."""
    at = np.clip(times * fps - 0.5, 0, len(values) - 1)
    before = np.floor(at).astype(np.intp)
    after = np.minimum(before + 1, len(values) - 1)
    share = (at - before)[:, None]
    return np.asarray((1 - share) * values[before] + share * values[after])


def _sum_pairs(sums: Floats) -> Floats:
    """Sums of two neighbouring rows; the last of an odd number stays alone."""
    return np.add.reduceat(sums, np.arange(0, len(sums), 2), axis=0)


def _similarity(down: NDArray[np.float32], across: NDArray[np.float32]) -> NDArray[np.float32]:
    squared = (down**2).sum(axis=1)[:, None] + (across**2).sum(axis=1) - 2 * (down @ across.T)
    return np.asarray(np.nan_to_num(np.exp(-np.maximum(squared, 0)), nan=0.0), np.float32)


def _png(shares: NDArray[np.float32]) -> bytes:
    """Return a grey picture of 4 bits per pixel, from shares of white."""
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
