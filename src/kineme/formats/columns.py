"""Tables whose columns are coordinates of joints: from named columns to a motion.

A joint is two or three columns that differ in their last letter: ``hip_x hip_y
hip_z``, ``hip.x``, ``hip x`` or ``hipX``, in any order; ``hip_pos_x`` where all are called so,
and ``hip_x [mm]``, which tells the unit; columns in several units are each taken in their own.
Velocities, rotations and the like of joints are passed
over. Besides these there may be

- the time: ``time``, ``t``, ``timestamp``, ``datetime``, ``elapsed`` or ``seconds``,
  with or without a unit as in ``time_ms``, ``Time (s)`` or ``epoch_ns``: numbers or dates, see
  `kineme.formats.timing`;
- a rate in every row: ``fps`` or ``rate``;
- how sure a pose estimator is: ``hip_confidence``, ``_likelihood``, ``_score``,
  ``_visibility``, ``_presence`` or ``_c``. Below 0.5 the joint counts as not seen.

Two-dimensional joints get z = 0. They are positions in an image, whose rows
count downwards; the body's larger side is taken as a person's height.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping, Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from kineme._counts import counted
from kineme.formats.files import FileContent
from kineme.formats.gaps import split_at
from kineme.formats.options import ReadOptions
from kineme.formats.points import Points, to_motion
from kineme.formats.timing import UNITS_OF_TIME, Timing, is_date, seconds, timing_of
from kineme.formats.units import metres
from kineme.recordings import Motion, Note
from kineme.recordings.coordinates import COORDINATE, axes_by_point, beginnings, is_body

Floats = NDArray[np.float64]
Joints = Mapping[str, Mapping[str, str]]
"""For each joint the columns of its axes."""

RATE = "fps"
"""A column that tells a rate, as it is written."""

SURE = 0.5
"""Confidence from which a keypoint counts as seen."""

_SLOWEST = 1.0  # frames per second: at or below, a column of times is hardly in seconds

_FINER = {"milliseconds": 1e3, "microseconds": 1e6, "nanoseconds": 1e9}

_CONFIDENCE = re.compile(
    r"(.*[^\s_.:/-])[\s_.:/-]+(confidence|likelihood|score|visibility|presence|c)", re.IGNORECASE
)
_TIME = re.compile(
    r"((?:unix|epoch|utc|sensor|elapsed)?[\s_]*time(?:[\s_]*stamp)?|t|date[\s_]*time|elapsed|"
    rf"seconds?(?:[\s_]*elapsed)?|epoch?(?=[\s_]*[\[(]?[mun]?s\b))[\s_]*(?:[\[(]?({'|'.join(UNITS_OF_TIME)})?[\])]?|"
    r"[\[(]?(?:utc|iso|[+-]\d{2}:?\d{2})[\])]?)",
    re.IGNORECASE,
)
_POSITION = re.compile(
    r"(.*[^\s_.:/-])(?:[\s_.:/-]+pos(?:ition)?|(?-i:Pos(?:ition)?))", re.IGNORECASE
)
_RATE = re.compile(r"fps|rate|frame[\s_]?rate", re.IGNORECASE)


def columns_to_motion(
    content: FileContent,
    name: str,
    columns: Mapping[str, ArrayLike],
    options: ReadOptions,
    *,
    limit: float = SURE,
) -> Motion:
    """The motion of the joints in a table's columns.

    Parameters
    ----------
    name : str
        Of the format.
    columns : mapping of str to array_like
        (rows,) each, numbers, by their names.
    limit : float, optional
        Confidence from which a keypoint counts as seen.

    Raises
    ------
    ReadError
        No joints are found, columns differ in length, or nothing tells the rate.
    """
    joints = _joints(content, columns)
    names, positions, sure = _positions(content, columns, joints)
    limit = limit if options.confidence is None else options.confidence
    positions[sure < limit] = np.nan
    flat = all(len(axes) == 2 for axes in joints.values())
    timing = timed(content, columns, options.fps)
    notes = list(timing.notes)
    if (sure < limit).any():
        notes.append(
            f"{counted(int((sure < limit).sum()), 'position')} less sure than {limit:g} not used"
        )
    unit, up = options.unit, options.up
    if unit is None:
        unit, said = _in_one_unit(content, joints, positions)
        notes += said
    if flat:
        notes.append("two-dimensional: z is 0, and image rows count downwards")
        unit, up = unit or "pixel", up or "-y"
    points = Points(names, positions, timing.fps, unit, up, person=options.person)
    provenance = content.provenance(name, notes).timed(timing.clock)
    return split_at(to_motion(points, provenance), timing.gaps)


def is_used(column: str) -> bool:
    """Whether a column of this name tells a position, a time, a rate or a confidence."""
    patterns = (COORDINATE, _CONFIDENCE, _TIME, _RATE)
    return any(pattern.fullmatch(column.strip()) for pattern in patterns)


def joint_names(columns: Iterable[str]) -> list[str]:
    """The joints that columns of these names are the coordinates of, in order."""
    return list(axes_by_point(columns))


def is_timing(column: str) -> bool:
    """Whether a column of this name tells a time or a rate."""
    return any(pattern.fullmatch(column.strip()) for pattern in (_TIME, _RATE))


def is_rate(column: str) -> bool:
    """Whether a column of this name tells a rate."""
    return _RATE.fullmatch(column.strip()) is not None


def dated(names: Sequence[str], cells: Sequence[str]) -> list[int]:
    """Which columns of a text table tell the time by dates, as their first cells do."""
    pairs = enumerate(zip(names, cells, strict=False))
    return [i for i, (name, cell) in pairs if _TIME.fullmatch(name.strip()) and is_date(cell)]


def timed(content: FileContent, columns: Mapping[str, ArrayLike], fps: float | None) -> Timing:
    """Frames per second, pauses, and what was seen of the times.

    Parameters
    ----------
    columns : mapping of str to array_like
        (rows,) each, by their names; one of them tells the time or the rate.
    fps : float or None
        In place of what the columns tell.

    Raises
    ------
    ReadError
        Nothing tells the rate, or what does contradicts itself.
    """
    if fps:
        return Timing(fps)
    for column in columns:
        if _RATE.fullmatch(column.strip()):
            return Timing(_one_rate(content, _column(content, columns, column)))
    for column in columns:
        match = _TIME.fullmatch(column.strip())
        if match:
            return _in_seconds(
                content, timing_of(content, _times(content, columns, column, match[2]))
            )
    raise content.error("no column 'time' or 'fps' found: give fps= (--fps)")


def _joints(content: FileContent, columns: Iterable[str]) -> Joints:
    """For each joint the columns of its axes; without those of its velocity, rotation and such."""
    points = axes_by_point(columns)
    if not points:
        shown = ", ".join(list(columns)[:8])
        raise content.error(
            "no columns JOINT_x, JOINT_y and JOINT_z found, so there are no positions "
            f"(columns: {shown or 'none'}); channels are named with columns= (--columns)"
        )
    called = {name: _POSITION.fullmatch(name) for name in points if is_body(name)}
    plain = {name: match[1] if match else name for name, match in called.items()}
    known, all_so = set(plain.values()), all(called.values())
    joints: dict[str, Mapping[str, str]] = {}
    for name, axes in points.items():
        if name in plain:
            joints[plain[name] if all_so else name] = axes
        elif known.isdisjoint(beginnings(name)):
            joints[name] = axes
    return joints


def _in_one_unit(
    content: FileContent, joints: Joints, positions: Floats
) -> tuple[str | None, list[str | Note]]:
    """The unit that the columns' names tell, and notes; None where none does.

    Where they tell several, ``positions`` are brought to metres in place, and the unit is that.
    """
    told = {joint: _told(axes) for joint, axes in joints.items()}
    units = sorted({unit for axes in told.values() for unit in axes.values() if unit})
    silent = [joint for joint, axes in told.items() if None in axes.values()]
    if len(units) < 2:
        said = f"columns of {counted(len(silent), 'point')} tell no unit, and are taken in that of"
        notes = [Note(f"{said} the others, {units[0]}", "warning")] if units and silent else []
        return (units[0] if units else None), [*notes]
    listed = " and ".join(units)
    if silent:
        column = next(iter(joints[silent[0]].values()))
        raise content.error(
            f"columns are in {listed}, and {column!r} tells no unit: add it to the name, as in "
            f"'{column} [{units[0]}]', or give unit= (--unit) for all of them"
        )
    for j, axes in enumerate(told.values()):
        for axis, unit in axes.items():
            positions[:, j, "xyz".index(axis)] *= metres(unit or "m")
    return "m", [f"columns are in {listed}, each taken in its own"]


def _told(axes: Mapping[str, str]) -> dict[str, str | None]:
    """The unit of each axis of a point; where one tells none, that of the others if it is one."""
    matches = {axis: COORDINATE.fullmatch(column.strip()) for axis, column in axes.items()}
    told = {axis: match[5] if match else None for axis, match in matches.items()}
    known = {unit for unit in told.values() if unit}
    return {axis: unit or (min(known) if len(known) == 1 else None) for axis, unit in told.items()}


def _positions(
    content: FileContent, columns: Mapping[str, ArrayLike], joints: Joints
) -> tuple[list[str], Floats, Floats]:
    """Names, positions (rows, joints, 3) and confidences (rows, joints)."""
    sureness = {
        match[1]: column for column in columns if (match := _CONFIDENCE.fullmatch(column.strip()))
    }
    rows = len(_column(content, columns, next(iter(next(iter(joints.values())).values()))))
    positions = np.zeros((rows, len(joints), 3))
    sure = np.ones((rows, len(joints)))
    for j, (joint, axes) in enumerate(joints.items()):
        for axis, column in axes.items():
            positions[:, j, "xyz".index(axis)] = _column(content, columns, column, rows)
        if joint in sureness:
            sure[:, j] = _column(content, columns, sureness[joint], rows)
    positions[np.isinf(positions)] = np.nan
    return list(joints), positions, sure


def _column(
    content: FileContent, columns: Mapping[str, ArrayLike], name: str, rows: int | None = None
) -> Floats:
    try:
        values = np.asarray(columns[name], np.float64)
    except (ValueError, TypeError):
        raise content.error(f"column {name!r} does not hold numbers") from None
    if values.ndim != 1 or len(values) == 0 or len(values) != (rows or len(values)):
        raise content.error(f"column {name!r} has shape {values.shape}, not one value per row")
    return values


def _times(
    content: FileContent, columns: Mapping[str, ArrayLike], name: str, unit: str | None
) -> Floats:
    """(rows,): a column of times in seconds."""
    try:
        times = seconds(columns[name], unit and unit.lower())
    except (ValueError, TypeError) as error:
        raise content.error(f"column {name!r} does not tell times: {error}") from None
    return _column(content, {name: times}, name)


def _in_seconds(content: FileContent, timing: Timing) -> Timing:
    """What the times tell, refused where they are so far apart that they are hardly seconds."""
    rate = timing.fps
    if rate <= _SLOWEST:
        unit = next((unit for unit in _FINER if rate * _FINER[unit] > _SLOWEST), "milliseconds")
        raise content.error(
            f"its times are {1 / rate:g} apart; if these are not seconds, give fps "
            f"(--fps; {rate * _FINER[unit]:g} for {unit})"
        )
    return timing


def _one_rate(content: FileContent, rates: Sequence[float] | Floats) -> float:
    rate = float(rates[0])
    if not (np.isfinite(rate) and rate > 0) or np.ptp(rates) > 0:
        raise content.error(
            f"the frame rate is not one positive number ({rate:g} first): give fps= (--fps)"
        )
    return rate
