"""DeepLabCut: tables of keypoints under rows of names.

Rows ``scorer``, ``individuals`` (where there are several), ``bodyparts`` and
``coords`` (x, y, perhaps z, likelihood), then a row per frame. Keypoints less
likely than 0.6, DeepLabCut's own limit for plots, count as not seen. Of several
individuals the first is read. There is no frame rate in the file: ``fps`` gives it.
"""

from __future__ import annotations

import numpy as np

from kineme.formats.columns import SURE, columns_to_motion
from kineme.formats.delimited import rows_of
from kineme.formats.files import Source, warn
from kineme.formats.registry import ReadOptions
from kineme.motion import Motion

LIKELY = 0.6


def is_deeplabcut(line: str) -> bool:
    """Whether this first line is that of DeepLabCut."""
    return line.lower().startswith("scorer,")


def read_deeplabcut(source: Source, lines: list[str], first: int, options: ReadOptions) -> Motion:
    """The motion of the keypoints in a table whose first line is ``first`` of the file."""
    heads: dict[str, list[str]] = {}
    for line in lines[:4]:
        kind, *cells = [cell.strip() for cell in line.split(",")]
        if kind.lower() in ("scorer", "individuals", "bodyparts", "coords"):
            heads[kind.lower()] = cells
    if not {"bodyparts", "coords"} <= heads.keys():
        raise source.error("rows 'bodyparts' and 'coords' expected under 'scorer'", first + 1)
    parts, coords = heads["bodyparts"], heads["coords"]
    who = heads.get("individuals", [""] * len(parts))
    if len({len(parts), len(coords), len(who)}) > 1:
        raise source.error("the rows of names differ in length", first + 1)
    if len(set(who)) > 1:
        warn(f"{source.path}: {len(set(who))} individuals: the first, {who[0]!r}, is read")
    below = first + len(heads)
    values = rows_of(source, lines[len(heads) :], below, ",", 1 + len(parts))[:, 1:]
    columns = {
        f"{part}_{coord}": _sureness(column) if coord == "likelihood" else column
        for part, coord, someone, column in zip(parts, coords, who, values.T, strict=True)
        if someone == who[0]
    }
    return columns_to_motion(source, "DeepLabCut", columns, options)


def _sureness(
    likelihood: np.ndarray[tuple[int], np.dtype[np.float64]],
) -> np.ndarray[tuple[int], np.dtype[np.float64]]:
    """Likelihoods with DeepLabCut's limit where `columns` has its own."""
    return likelihood - LIKELY + SURE
