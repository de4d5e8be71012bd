"""Tiles of the self-similarity matrix at every zoom level.

A tile is a PNG with 16 grey levels; white is similarity 1. It is rendered on request, within
milliseconds.
"""

from __future__ import annotations

import struct
import zlib
from math import ceil

import numpy as np

from kineme._util.arrays import Float32s
from kineme.features.similarity import COARSEST, SimilarityMatrix
from kineme.web.messages import MatrixHead

TILE = COARSEST
MAX_BYTES = 9_000_000  # size of all tiles in a report
MAX_TILES = 24  # largest level, in tiles per side, that a report holds completely


def make_head(matrix: SimilarityMatrix) -> MatrixHead:
    """Return the layout of the tiles."""
    sizes = [len(level) for level in matrix.levels]
    return MatrixHead(fps=matrix.fps, tile=TILE, sizes=sizes)


def make_tile(matrix: SimilarityMatrix, level: int, row: int, column: int) -> bytes | None:
    """Return the PNG of a tile; None if there is no such tile."""
    if not 0 <= level < len(matrix.levels) or min(row, column) < 0:
        return None
    if max(row, column) * TILE >= len(matrix.levels[level]):
        return None
    rows, columns = (slice(TILE * i, TILE * (i + 1)) for i in (row, column))
    return _encode_png(matrix.cells(level, rows, columns))


def make_report_tiles(matrix: SimilarityMatrix, max_bytes: int = MAX_BYTES) -> dict[str, bytes]:
    """Return the tiles for a report by "level/row/column", within ``max_bytes``.

    The matrix is symmetric, so tiles on and below the diagonal are enough. All tiles of coarse
    levels come first, the coarsest first. Of fine levels only tiles on the diagonal follow, then
    those next to it. A page shows a coarser tile if one is missing.
    """
    sides = [ceil(len(features) / TILE) for features in matrix.levels]
    coarse_first = list(reversed(range(len(sides))))
    coarse = [level for level in coarse_first if sides[level] <= MAX_TILES]
    fine = [level for level in coarse_first if sides[level] > MAX_TILES]
    indices = [
        (level, row, column)
        for level in coarse
        for row in range(sides[level])
        for column in range(row + 1)
    ]
    for distance in (0, 1):  # in tiles, from the diagonal
        indices += [
            (level, row, row - distance) for level in fine for row in range(distance, sides[level])
        ]
    tiles: dict[str, bytes] = {}
    bytes_left = max_bytes
    for index in indices:
        tile = make_tile(matrix, *index) or b""
        bytes_left -= len(tile)
        if bytes_left < 0:
            break
        tiles["/".join(map(str, index))] = tile
    return tiles


def _encode_png(shares: Float32s) -> bytes:
    """Return shares of white (rows, columns) as a PNG with 4 bits per pixel."""
    height, width = shares.shape
    # Two pixels share a byte, so rows of odd width are padded.
    shades = np.zeros((height, width + width % 2), np.uint8)
    shades[:, :width] = np.rint(15 * shares)
    # The first byte of a row is the filter: none.
    rows = np.zeros((height, 1 + shades.shape[1] // 2), np.uint8)
    # The left pixel is in the high bits.
    rows[:, 1:] = shades[:, ::2] << 4 | shades[:, 1::2]
    # Width, height, 4 bits a pixel, grey; default compression, filter and no interlacing.
    header = struct.pack(">IIBBBBB", width, height, 4, 0, 0, 0, 0)
    chunks = [(b"IHDR", header), (b"IDAT", zlib.compress(rows.tobytes(), 6)), (b"IEND", b"")]
    return b"\x89PNG\r\n\x1a\n" + b"".join(
        # A chunk consists of length, name, data, and a checksum of name and data.
        struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))
        for name, data in chunks
    )
