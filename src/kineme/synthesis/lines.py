"""Lines on the floor: as people type them, and as points that are equally far from each other."""

from __future__ import annotations

from collections.abc import Sequence
from math import isfinite

import numpy as np
from numpy.typing import NDArray

from kineme.errors import ParameterError

Complex = NDArray[np.complex128]

SPACING = 0.05
"""Metres between the points that stand for the line."""
FAR = 0.25
"""Metres of the line that count as equally far; no line is shorter."""


def parse_line(text: str) -> list[tuple[float, float]]:
    """Points (x, z) on the floor in metres, as people type them.

    Parameters
    ----------
    text : str

    Returns
    -------
    list of (float, float)

    Raises
    ------
    ParameterError
        It is something else.

    Examples
    --------
    >>> from kineme.synthesis import parse_line
    >>> parse_line("0,0;2,0;2,3")
    [(0.0, 0.0), (2.0, 0.0), (2.0, 3.0)]
    """
    try:
        points = [tuple(float(number) for number in point.split(",")) for point in text.split(";")]
    except ValueError:
        points = []
    if len(points) < 2 or any(len(p) != 2 or not all(map(isfinite, p)) for p in points):
        raise ParameterError(
            f"{text!r} is not a line on the floor: give two or more points x,z in metres, "
            "as in 0,0;2,0;2,3"
        )
    return [(x, z) for x, z in points]


def space_evenly(line: Sequence[tuple[float, float]]) -> Complex:
    """Points of the line, equally far from each other."""
    corners = np.array([complex(x, z) for x, z in line])
    lengths = np.abs(np.diff(corners))
    total = lengths.sum()
    if len(corners) < 2 or not FAR < total < 1e4:
        raise ParameterError(
            f"the line is {total:g} m long: it must have a length from {FAR} m to 10 km"
        )
    # Length of the line up to each corner.
    at = np.concatenate([[0], np.cumsum(lengths)])
    places = np.linspace(0, total, round(total / SPACING) + 1)
    x, z = (np.interp(places, at, part) for part in (corners.real, corners.imag))
    return np.asarray(x + 1j * z, np.complex128)
