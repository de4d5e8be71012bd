"""What a file of points does not tell and the body in it does: the unit, and which axis is up."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from kineme.formats.units import UNITS, metres
from kineme.recordings import Note

Floats = NDArray[np.float64]
Body = Mapping[str, tuple[int, ...]]

SPREADS = (0.3, 3.0)
"""Metres over which markers on a person spread, in the middle of the recording:
a factor of ten, as between two of m, cm and mm."""

_HEIGHT = 1.7  # metres, given to a body measured in pixels


def scale_of(unit: str | float | None, positions: Floats) -> tuple[float, list[str]]:
    """Metres in one unit of the positions, and what was inferred."""
    if unit is not None and unit != "pixel":
        return metres(unit), []
    spread = float(np.median(np.ptp(positions, axis=1).max(axis=1)))
    if unit == "pixel":
        return _HEIGHT / (spread or 1.0), [
            f"no unit: {spread:.3g}, the larger side of the body, taken as {_HEIGHT} m"
        ]
    sizes = {name: UNITS[name] for name in ("m", "cm", "mm")}
    fits = [name for name, size in sizes.items() if SPREADS[0] <= spread * size < SPREADS[1]]
    if fits:
        found = fits[0]
    else:
        found = "m" if spread < 1 else "mm"
        said = (
            f"markers {spread:.3g} units apart are in no unit those of a person: "
            f"{found} assumed; give unit= (--unit)"
        )
        return sizes[found], [Note(said, "warning")]
    return sizes[found], [
        f"unit {found} inferred: the points then spread over {spread * sizes[found]:.2f} m"
    ]


def up_axis(usual: str, positions: Floats, body: Body) -> tuple[str, list[str]]:
    """The axis from the feet to the head, else the usual one; and what was inferred."""
    head = list(body.get("head", ()))
    feet = [i for joint in ("left_ankle", "right_ankle") for i in body.get(joint, ())]
    if head and feet:
        trunk = positions[:, head].mean(axis=1) - positions[:, feet].mean(axis=1)
        length = np.linalg.norm(trunk, axis=1, keepdims=True)
        along = np.median(trunk / np.where(length > 0, length, 1), axis=0)
        axis = int(np.abs(along).argmax())
        if abs(along[axis]) > 0.7:
            up = ("-" if along[axis] < 0 else "") + "xyz"[axis]
            return up, [f"up axis {up} inferred: head and feet lie along it"]
    return usual, [f"up axis {usual} assumed; give up= if it is another"]
