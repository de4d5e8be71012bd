"""Convert named arrays, as in npz archives and MAT files, to a motion.

These arrays are read:

- ``poses`` and ``trans``, see `kineme.formats.arrays.amass`;
- ``positions`` (frames, joints, 3) with ``names`` and ``fps``. With ``parents`` they are in metres
  with y up, and may have ``offsets``, ``end_sites``, ``rotations`` (w, x, y, z) and ``gaps``, as
  written by kineme;
- an array (frames, 3) for each joint, named after the joint, and ``fps`` or ``time``;
- an array for each column of a table, see `kineme.formats.columns`.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping

import numpy as np

from kineme._util.arrays import Array
from kineme._util.checks import make_unique
from kineme.formats.arrays.amass import find_rate, poses_to_motion
from kineme.formats.columns import columns_to_motion
from kineme.formats.files import FileContent
from kineme.formats.options import ReadOptions
from kineme.formats.points import Points, to_motion
from kineme.recordings import Motion, Skeleton

Arrays = Mapping[str, Array]

_RATES = ("fps", "framerate", "frame_rate", "FrameRate", "rate")


def arrays_to_motion(
    content: FileContent, name: str, arrays: Arrays, options: ReadOptions
) -> Motion:
    """Return the motion described by named arrays; ``name`` is the name of the format."""
    if "poses" in arrays:
        return poses_to_motion(content, arrays, options)
    if "positions" in arrays:
        return positions_to_motion(content, name, arrays, options)
    columns = {key: array for key, array in arrays.items() if array.ndim == 1}
    columns |= {key: array[None] for key, array in arrays.items() if array.ndim == 0}
    for joint, track in _find_tracks(arrays).items():
        columns |= {f"{joint}_{axis}": track[:, i] for i, axis in enumerate("xyz")}
    return columns_to_motion(content, name, columns, options)


def positions_to_motion(
    content: FileContent, name: str, arrays: Arrays, options: ReadOptions
) -> Motion:
    """Return the motion described by ``positions`` and the arrays that belong to it."""
    positions = _read_numbers(content, arrays, "positions")
    if positions.ndim != 3 or positions.shape[2] != 3 or 0 in positions.shape:
        raise content.error(f"positions have shape {positions.shape}, not (frames, joints, 3)")
    fps = options.fps or find_rate(content, arrays, _RATES)
    is_from_kineme = "parents" in arrays and "names" in arrays  # in metres, y up
    if is_from_kineme and options.unit in (None, "m", 1) and options.up in (None, "y"):
        return _restore_motion(content, name, arrays, positions, fps)
    default_names = [f"joint{i}" for i in range(positions.shape[1])]
    names = list(map(str, arrays["names"].ravel())) if "names" in arrays else default_names
    if len(names) != len(default_names):
        raise content.error(f"{len(names)} names for {len(default_names)} joints")
    positions = np.where(np.isfinite(positions), positions, np.nan)
    unit = options.unit or ("m" if is_from_kineme else None)
    up = options.up or ("y" if is_from_kineme else None)
    points = Points(names, positions, fps, unit, up, person=options.person)
    return to_motion(points, content.provenance(name, []))


def _find_tracks(arrays: Arrays) -> Arrays:
    """Return the arrays (frames, 3) whose number of frames is the most frequent."""
    tracks = {key: a for key, a in arrays.items() if a.ndim == 2 and a.shape[1] == 3}
    lengths = Counter(len(track) for track in tracks.values())
    # The most frequent length; on a tie the longest.
    length = max(lengths, key=lambda n: (lengths[n], n), default=0)
    return {key: track for key, track in tracks.items() if len(track) == length}


def _restore_motion(
    content: FileContent, name: str, arrays: Arrays, positions: Array, fps: float
) -> Motion:
    """Return a motion written by kineme, unchanged."""
    n = positions.shape[1]
    offsets = _read_numbers(content, arrays, "offsets") if "offsets" in arrays else np.zeros((n, 3))
    parents = _read_integers(content, arrays, "parents")
    ends = _read_integers(content, arrays, "end_sites") if "end_sites" in arrays else []
    gaps = _read_integers(content, arrays, "gaps") if "gaps" in arrays else []
    names = tuple(make_unique(map(str, arrays["names"].ravel())))
    skeleton = Skeleton(names, tuple(parents), offsets, frozenset(ends))
    rotations = _read_numbers(content, arrays, "rotations") if "rotations" in arrays else None
    # Start and stop alternate.
    spans = tuple(zip(gaps[::2], gaps[1::2], strict=False))
    return Motion(skeleton, positions, fps, rotations, content.provenance(name, []), spans)


def _read_integers(content: FileContent, arrays: Arrays, name: str) -> list[int]:
    values = _read_numbers(content, arrays, name).ravel()
    if not np.isfinite(values).all() or np.abs(values).max(initial=0) > 2**53:
        raise content.error(f"{name} are not whole numbers")
    return list(map(int, values.tolist()))


def _read_numbers(content: FileContent, arrays: Arrays, name: str) -> Array:
    if arrays[name].dtype.kind not in "iufb":
        raise content.error(f"{name} hold {arrays[name].dtype}, not numbers")
    return np.asarray(arrays[name], np.float64)
