"""Convert a file's units and axes to metres with y up.

For formats without unit or up axis these are inferred from the body: the unit from its size, the
vertical from the line between feet and head. The motion's provenance records what was inferred.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from decimal import Decimal
from math import ceil, floor

import numpy as np

from kineme._util import rotations as rot
from kineme._util.arrays import Floats, normalize_vectors
from kineme.recordings import Note, Skeleton
from kineme.recordings.joint_names import mentions
from kineme.recordings.kinematics import place_at_rest

Body = Mapping[str, tuple[int, ...]]

INCH = 0.0254

UNITS = {"m": 1.0, "cm": 0.01, "mm": 0.001, "inch": INCH, "cmu": INCH / 0.45}
"""Metres in one unit; "cmu" is 1/0.45 inch, the unit of the CMU database."""

CERTAIN_HEIGHTS = (1.2, 2.4)
"""Heights of a body in metres for which its unit is certain: their ratio is 2, that of two units at
least 2.2.
"""

PLAUSIBLE_HEIGHTS = (0.3, 4.0)
"""Body heights in metres outside of which a given unit is doubtful."""

_TO_Y = {
    "y": (1.0, 0.0, 0.0, 0.0),
    "-y": (0.0, 1.0, 0.0, 0.0),
    "z": (0.5**0.5, -(0.5**0.5), 0.0, 0.0),
    "-z": (0.5**0.5, 0.5**0.5, 0.0, 0.0),
    "x": (0.5**0.5, 0.0, 0.0, 0.5**0.5),
    "-x": (0.5**0.5, 0.0, 0.0, -(0.5**0.5)),
}
"""Rotation that turns an axis to y, and keeps x or z fixed."""

AXES = tuple(_TO_Y)

BLOCK = 2048
"""Number of frames processed at once."""

MARKER_EXTENTS = (0.3, 3.0)
"""Extent in metres of the markers on a person. The ratio of ten is the smallest ratio of two of
m, cm and mm.
"""

POINT_EXTENTS = (0.02, 50.0)
"""Metres: the stated unit is wrong for smaller bodies and for points farther apart."""

METRIC = ("m", "cm", "mm")
"""Units of markers and of most files."""

_METRES = re.compile("(centi|milli)?met(?:er|re)s?")
_HEIGHT = 1.7  # metres of a usual body, assumed for one measured in pixels


def to_metres(unit: str | float) -> float:
    """Return the metres in one ``unit``, a name in `UNITS` or already a length."""
    return UNITS[unit] if isinstance(unit, str) else float(unit)


def parse_unit(word: str) -> str | None:
    """Return the unit called ``word`` ("mm", "Millimeters", "in") in a file, or None."""
    word = word.strip().lower()
    if metric := _METRES.fullmatch(word):
        return {"centi": "cm", "milli": "mm"}.get(metric[1], "m")
    return "inch" if word in ("in", "inch", "inches") else word if word in METRIC else None


def infer_unit(skeleton: Skeleton, means: Floats) -> tuple[str, Note]:
    """Return the unit in which the body has human size, and a note.

    The height is estimated as three quarters of the longest path along the bones, hand to foot. In
    nine skeletons (CMU, HDM05, PyMO, aitviewer) this is within 7 % of the path along the bones from
    head to toes. If no unit fits, the nearest is used and the note is a warning.
    """
    height = estimate_height(skeleton, means)
    low, high = CERTAIN_HEIGHTS
    for unit, size in UNITS.items():
        if low <= height * size <= high:
            remark = f"the skeleton is then about {height * size:.2f} m tall"
            return unit, Note(f"unit {unit} inferred: {remark}")
    # Compare ratios to the usual height on a logarithmic scale.
    errors = np.log([max(height, 1e-9) * size / _HEIGHT for size in UNITS.values()])
    unit = list(UNITS)[int(np.abs(errors).argmin())]
    remark = (
        f"this skeleton, about {height:.3g} units tall, is not of human size in any unit: "
        f"{unit} assumed; give unit= (--unit)"
    )
    return unit, Note(remark, "warning")


def estimate_height(skeleton: Skeleton, means: Floats) -> float:
    """Return three quarters of the longest path along the bones, in file units.

    ``means`` (joints, 3) are the mean positions of joints relative to their parents. Bones above
    the hips are ignored: their length is the distance walked.
    """
    lengths = np.linalg.norm(means, axis=1).tolist()
    body = set(skeleton.body) - {skeleton.carrier}
    reach = [0.0] * skeleton.n_joints
    longest = 0.0
    # Process children before parents: `reach` is the longest path down from each joint.
    for joint in range(skeleton.n_joints - 1, -1, -1):
        parent = skeleton.parents[joint]
        if parent >= 0 and joint in body:
            branch = reach[joint] + lengths[joint]
            longest = max(longest, reach[parent] + branch)
            reach[parent] = max(reach[parent], branch)
    return 0.75 * longest


def infer_scale(
    unit: str | float | None, positions: Floats, *, stated: str | None = None, is_body: bool = False
) -> tuple[float, list[str]]:
    """Return the metres in one unit of the positions, and notes on what was inferred.

    ``stated`` is the file's unit, used if ``unit`` is None. It is rejected if the points are then
    more than 50 m apart, or if a whole body is smaller than 2 cm.
    """
    if unit is not None and unit != "pixel":
        return to_metres(unit), []
    # Median over frames of the largest extent along an axis.
    spread = float(np.median(np.ptp(positions, axis=1).max(axis=1)))
    if unit == "pixel":
        return _HEIGHT / (spread or 1.0), [
            f"no unit: {spread:.3g}, the larger side of the body, scaled to {_HEIGHT} m"
        ]
    if stated:
        return _check_scale(stated, spread, is_body=is_body)
    unit = _find_human_unit(spread)
    if unit is not None:
        note = f"unit {unit} inferred: the points then spread over {spread * UNITS[unit]:.2f} m"
        return UNITS[unit], [note]
    # No unit fits: small numbers are more likely metres, large ones millimetres.
    name = "m" if spread < 1 else "mm"
    remark = (
        f"markers {spread:.3g} units apart do not fit a person in any unit: {name} assumed; "
        "give unit= (--unit)"
    )
    return UNITS[name], [Note(remark, "warning")]


def _check_scale(stated: str, spread: float, *, is_body: bool) -> tuple[float, list[str]]:
    """Return the metres in the stated unit, or in one that gives human size, and a note."""
    size, other = spread * to_metres(stated), _find_human_unit(spread)
    if other is None or (size <= POINT_EXTENTS[1] and (size >= POINT_EXTENTS[0] or not is_body)):
        return to_metres(stated), []
    remark = (
        f"in the file's unit {stated}, the points spread over {size:.4g} m: {other} assumed "
        f"({spread * UNITS[other]:.2f} m); unit= (--unit) overrides"
    )
    return UNITS[other], [Note(remark, "warning")]


def _find_human_unit(spread: float) -> str | None:
    """Return the unit in which points are spread like those on a person, or None."""
    fits = (
        name for name in METRIC if MARKER_EXTENTS[0] <= spread * UNITS[name] < MARKER_EXTENTS[1]
    )
    return next(fits, None)


def infer_up(skeleton: Skeleton, positions: Floats) -> str:
    """Return the axis along which the body stands at rest and most of the time, else "y"."""
    feet, head = find_feet_and_head(skeleton)
    axis = _find_body_axis(place_at_rest(skeleton)[None], feet, head, 0.9)
    return axis if axis and axis == _find_body_axis(positions, feet, head, 0.7) else "y"


def infer_up_axis(
    default: str, positions: Floats, body: Body, *, is_stated: bool = False
) -> tuple[str, list[str]]:
    """Return the axis along which the body stands, else the usual one, and notes.

    ``is_stated`` means that the file states the usual axis; another one is then a warning.
    """
    upper = list(body.get("head", ()) or body.get("pelvis", ()))
    feet = [i for joint in ("left_ankle", "right_ankle") for i in body.get(joint, ())]
    up = _find_body_axis(positions, feet, upper, 0.7)
    if is_stated and up in (None, default):
        return default, []
    if up is None:
        return default, [f"up axis {default} assumed; give up= (--up) if it is another"]
    part = "head" if body.get("head") else "pelvis"
    note = f"up axis {up} inferred: {part} and feet lie along it"
    if not is_stated:
        return up, [note]
    return up, [Note(f"{note}, though the file names {default}; up= (--up) overrides", "warning")]


def find_lying_axis(skeleton: Skeleton, positions: Floats) -> str | None:
    """Return the axis along which a body lies most of the time, or None if it does not lie."""
    axis = _find_body_axis(positions, *find_feet_and_head(skeleton), 0.7)
    return None if axis == "y" else axis


def find_feet_and_head(skeleton: Skeleton) -> tuple[list[int], list[int]]:
    """Return the joints of feet and head, by their names."""
    feet, head = (
        [i for i, name in enumerate(skeleton.names) if mentions(name, *parts)]
        for parts in (("*_ankle", "*_foot", "*_toe"), ("head",))
    )
    return feet, head


def _find_body_axis(
    positions: Floats, feet: list[int], head: list[int], least: float
) -> str | None:
    """Return the axis from feet to head, which may be negative (``-z``), or None.

    ``least`` is the minimum component of the median direction along that axis.
    """
    if not feet or not head:
        return None
    vectors = positions[:, head].mean(axis=1) - positions[:, feet].mean(axis=1)
    # The median is robust to frames in which the body bends or lies.
    direction = np.median(normalize_vectors(vectors), axis=0)
    axis = int(np.abs(direction).argmax())
    if abs(direction[axis]) < least:
        return None
    return ("-" if direction[axis] < 0 else "") + "xyz"[axis]


def turn_upright(points: Floats, up: str) -> Floats:
    """Turn points (frames, points, 3) in place so that their axis ``up`` becomes y; return them."""
    if up != "y":
        for span in iterate_blocks(len(points)):
            points[span] = rot.rotate(make_up_rotation(up), points[span])
    return points


def make_up_rotation(up: str) -> Floats:
    """Return the rotation that turns the axis ``up`` to y."""
    return np.array(_TO_Y[up])


def iterate_blocks(n_frames: int) -> Iterator[slice]:
    """Yield slices of frames, in blocks that fit into the processor's cache."""
    for start in range(0, n_frames, BLOCK):
        yield slice(start, min(start + BLOCK, n_frames))


def infer_rate(word: str) -> tuple[float, str | None]:
    """Return frames per second for a written frame time, and a note if it was rounded.

    ``.0083333`` stands for anything from 0.00833325 to 0.00833335 s. If exactly one integer rate
    lies in that range, here 120 Hz, it is used.
    """
    period = Decimal(word)
    exponent = period.as_tuple().exponent
    # Half a unit of the last written digit is the largest rounding error.
    half = Decimal(5).scaleb(int(exponent) - 1)
    if half >= period:
        return float(1 / period), None
    lowest, highest = ceil(1 / (period + half)), floor(1 / (period - half))
    if lowest == highest and float(1 / period) != lowest:
        note = f"frame rate {lowest} Hz: the frame time {word} s is a rounded 1/{lowest}"
        return float(lowest), note
    return float(1 / period), None
