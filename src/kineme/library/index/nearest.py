"""The parts of recordings that may be like an example, as its windows tell."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from kineme._threads import map_threads
from kineme.library.index._kernels import least_squares
from kineme.library.index.kept import Windows
from kineme.library.index.parts import Parts
from kineme.library.index.windows import FINER, Float32s, Ints, step, wanted

SHARE = 0.01
"""Of the windows, that are searched sample by sample."""
MORE = 20
"""Windows for each hit that is wanted, at least."""
BLOCK = 1 << 16
"""Windows that are compared at a time."""


def parts_like(windows: Windows, example: Float32s, top: int) -> Parts:
    """The parts of recordings around the windows that are nearest to an example.

    Parameters
    ----------
    windows : Windows
        Of the length that `length_for` gives.
    example : (samples, dims) array
    top : int
        Hits that are wanted.
    """
    near = _nearest(windows, wanted(example), top)
    rows = np.searchsorted(windows.firsts, near, side="right") - 1
    middles = (near - windows.firsts[rows]) * step(windows.length) + windows.length // 2
    reach = step(windows.length) + len(example)  # a match may last twice as long
    lasts = windows.samples[rows]
    return joined(
        Parts(rows, np.clip(middles - reach, 0, lasts), np.clip(middles + reach, 0, lasts))
    )


def joined(parts: Parts) -> Parts:
    """Parts that overlap as one."""
    order = np.lexsort((parts.starts, parts.rows))
    rows, starts, stops = (column[order] for column in parts)
    far = int(stops.max(initial=0)) + 1
    reached = np.maximum.accumulate(stops + rows * far)  # beyond the end of recordings before
    new = np.ones(len(rows), np.bool_)
    new[1:] = starts[1:] + rows[1:] * far > reached[:-1]
    first = np.flatnonzero(new)
    last = np.append(first[1:], len(rows)) - 1 if len(rows) else first
    return Parts(rows[first], starts[first], reached[last] - rows[first] * far)


def _nearest(windows: Windows, wanted: NDArray[np.int32], top: int) -> Ints:
    """The windows that are nearest to any of what is wanted, in their order."""
    n = len(windows.embedded)
    least = np.empty(n, np.int32)

    def compare(first: int) -> None:
        block = slice(first, first + BLOCK)
        least_squares(np.asarray(windows.embedded[block]), wanted, np.int32(FINER), least[block])

    map_threads(compare, range(0, n, BLOCK))
    most = min(max(round(SHARE * n), MORE * top), n)
    chosen: NDArray[np.int64] = np.sort(np.argpartition(least, most - 1)[:most])
    return chosen
