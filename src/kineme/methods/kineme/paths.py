"""Warping paths along which a recording matches itself, wherever they are.

A path is found with its ends, and then followed from the one to the other. A long one
is followed in legs, from each of the pairs that it passed on the way to the next, so that
the work grows with its length and not with the square of it.
"""

from __future__ import annotations

from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from kineme.methods.kineme import _event_kernels as kernels

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
Paths = tuple[Ints, Ints, Floats, Floats, Ints, Ints]

# What a pair of samples scores at least, however far they are apart.
WORST = -2.0


def matching_paths(
    columns: Floats,
    costs: Floats,
    begins: NDArray[np.bool_],
    *,
    gap: int,
    width: int,
    leg: int,
    scale: float,
    least: float,
) -> Paths:
    """Paths seen from either side: first samples, partners, sums, and the paths of each sample.

    Parameters
    ----------
    columns : (dims, samples) array
    costs : (samples,) array
        What stillness costs.
    begins : (samples,) array of bool
        Samples into which no path steps.
    gap, width : int
        Samples that pairs are apart, at least and at most.
    leg : int
        Samples that a path is followed at a time.
    scale : float
        Distance from which two samples are not similar.
    least : float
        Score of a path at least.

    Returns
    -------
    starts : (paths,) array
        First sample of each; a path and the same seen from the other side are neighbours.
    ptr : (paths + 1,) array
        Where the samples of each begin in the next two.
    partners, sums : arrays
        Of each sample of each path: its partner, and the score up to there.
    row_ptr : (samples + 1,) array
        Where the paths of each sample begin in the last.
    row_paths : array of int
    """
    ends, _, passed = kernels.local_paths(
        columns, costs, begins, gap, width, leg, scale, WORST, least
    )
    starts, partners, sums = [], [np.empty(0)], [np.empty(0)]
    for each in ends:
        forth, forth_sums, back, back_sums = followed(columns, costs, each, passed, scale)
        starts += [each[0], each[1]]
        partners += [forth, back]
        sums += [forth_sums, back_sums]
    sizes = np.array([len(each) for each in partners[1:]], np.int64)
    ptr = np.append(0, np.cumsum(sizes))
    first = np.array(starts, np.int64)
    rows = np.repeat(first - ptr[:-1], sizes) + np.arange(ptr[-1])
    row_paths = np.repeat(np.arange(len(sizes)), sizes)[np.argsort(rows, kind="stable")]
    row_ptr = np.append(0, np.cumsum(np.bincount(rows, minlength=len(costs))))
    return first, ptr, np.concatenate(partners), np.concatenate(sums), row_ptr, row_paths


def followed(
    columns: Floats, costs: Floats, ends: Ints, passed: Ints, scale: float
) -> tuple[Floats, Floats, Floats, Floats]:
    """Partners and sums of a path, from its first side and from the second.

    Parameters
    ----------
    columns, costs, scale
        See `matching_paths`.
    ends : (5,) array
        First and last pair, and the latest of the pairs passed.
    passed : (pairs, 3) array
        Pairs, and the one passed before each; see `_event_kernels.local_paths`.
    """
    pairs, latest = [ends[2:4]], int(ends[4])
    while latest >= 0:
        pairs.append(passed[latest, :2])
        latest = int(passed[latest, 2])
    pairs.append(ends[:2])
    legs = [
        kernels.follow(columns, costs, np.append(start, stop), scale, WORST)
        for stop, start in pairwise(pairs)
    ]
    forth, forth_sums, back, back_sums = map(_joined, zip(*legs[::-1], strict=True))
    return forth, forth_sums, back, back_sums


def _joined(legs: tuple[Floats, ...]) -> Floats:
    """Values of legs one after the other, each going on from the last value of the one before."""
    shifts = np.cumsum([before[-1] - after[0] for before, after in pairwise(legs)])
    rest = [leg[1:] + shift for leg, shift in zip(legs[1:], shifts, strict=True)]
    return np.concatenate([legs[0], *rest])
