"""Tiles of the self-similarity matrix, at every zoom, as the pages show them.

A tile is made each time anew, in a few milliseconds. It is a PNG of 16 shades, white for 1.
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
MOST_BYTES = 9_000_000  # of the tiles in a report, see display.MOST_BYTES
MOST_TILES = 24  # tiles a side up to which a report holds all of a level


def make_head(matrix: SimilarityMatrix) -> MatrixHead:
    """Return what a page needs to know of the tiles."""
    sizes = [len(level) for level in matrix.levels]
    return MatrixHead(fps=matrix.fps, tile=TILE, sizes=sizes)


def make_tile(matrix: SimilarityMatrix, level: int, row: int, column: int) -> bytes | None:
    """Return the PNG of a tile; None where there is no such one."""
    if not 0 <= level < len(matrix.levels) or min(row, column) < 0:
        return None
    if max(row, column) * TILE >= len(matrix.levels[level]):
        return None
    rows, columns = (slice(TILE * i, TILE * (i + 1)) for i in (row, column))
    return _encode_png(matrix.cells(level, rows, columns))


def make_report_tiles(matrix: SimilarityMatrix, most_bytes: int = MOST_BYTES) -> dict[str, bytes]:
    """Return the tiles that a report holds, by "level/row/column", in at most so many bytes.

    The matrix is symmetric, so tiles on and below the diagonal are enough. All tiles of the coarse
    levels come first, the coarsest level before the others; of the fine levels only the tiles on
    the diagonal and, if there is room, those beside it. A page shows a coarser tile for a missing
    one.
    """
    sides = [ceil(len(features) / TILE) for features in matrix.levels]
    coarse_first = list(reversed(range(len(sides))))
    coarse = [level for level in coarse_first if sides[level] <= MOST_TILES]
    fine = [level for level in coarse_first if sides[level] > MOST_TILES]
    places = [
        (level, row, column)
        for level in coarse
        for row in range(sides[level])
        for column in range(row + 1)
    ]
    for away in (0, 1):  # tiles from the diagonal
        places += [(level, row, row - away) for level in fine for row in range(away, sides[level])]
    tiles: dict[str, bytes] = {}
    left = most_bytes
    for place in places:
        tile = make_tile(matrix, *place) or b""
        left -= len(tile)
        if left < 0:
            break
        tiles["/".join(map(str, place))] = tile
    return tiles


def _encode_png(shares: Float32s) -> bytes:
    """Return a grey picture of 4 bits per pixel, from shares of white."""
    height, width = shares.shape
    # Two pixels share a byte, so an odd row gets one more.
    shades = np.zeros((height, width + width % 2), np.uint8)
    shades[:, :width] = np.rint(15 * shares)
    rows = np.zeros((height, 1 + shades.shape[1] // 2), np.uint8)  # each begins with its filter: 0
    # The left pixel is in the high bits.
    rows[:, 1:] = shades[:, ::2] << 4 | shades[:, 1::2]
    # Width, height, 4 bits a pixel, grey; default compression, filter and no interlacing.
    header = struct.pack(">IIBBBBB", width, height, 4, 0, 0, 0, 0)
    chunks = [(b"IHDR", header), (b"IDAT", zlib.compress(rows.tobytes(), 6)), (b"IEND", b"")]
    return b"\x89PNG\r\n\x1a\n" + b"".join(
        # A chunk is its length, name and data, and a checksum of the last two.
        struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))
        for name, data in chunks
    )
