"""Tables whose columns are coordinates of joints: from named columns to a motion.

A joint is two or three columns that differ in their last letter: ``hip_x hip_y
hip_z``, ``hip.x``, ``hip x`` or ``hipX``, in any order; ``hip_pos_x`` where all are called so,
and ``hip_x [mm]`` or ``hip_x_mm``, which tells the unit; columns in several units are each taken in
their own. Velocities, rotations and the like of joints are passed over. Besides these there may be

- the time: ``time``, ``t``, ``timestamp``, ``datetime``, ``elapsed`` or ``seconds``,
  with or without a unit as in ``time_ms``, ``Time (s)`` or ``epoch_ns``: numbers or dates, see
  `kineme.recordings.times`;
- a rate in every row: ``fps`` or ``rate``;
- how sure a pose estimator is: ``hip_confidence``, ``_likelihood``, ``_score``,
  ``_visibility``, ``_presence`` or ``_c``. Below 0.5 the joint counts as not seen.

Two-dimensional joints get z = 0. They are positions in an image, whose rows
count downwards; the body's larger side is taken as a person's height.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping

import numpy as np
from numpy.typing import ArrayLike

from kineme._util.arrays import Floats
from kineme._util.checks import format_count
from kineme.formats.files import FileContent
from kineme.formats.gaps import split_at
from kineme.formats.options import ReadOptions
from kineme.formats.points import Points, to_motion
from kineme.formats.timing import find_table_timing, place_points, read_column
from kineme.formats.units import METRIC, to_metres
from kineme.recordings import Motion, Note
from kineme.recordings.coordinates import COORDINATE, group_axes, is_body, list_beginnings
from kineme.recordings.times import is_timing

Joints = Mapping[str, Mapping[str, str]]
"""For each joint the columns of its axes."""

LIMIT = 0.5
"""Confidence from which a keypoint counts as seen."""

_CONFIDENCE = re.compile(
    r"(.*[^\s_.:/-])[\s_.:/-]+(confidence|likelihood|score|visibility|presence|c)", re.IGNORECASE
)
_POSITION = re.compile(
    r"(.*[^\s_.:/-])(?:[\s_.:/-]+pos(?:ition)?|(?-i:Pos(?:ition)?))", re.IGNORECASE
)


def columns_to_motion(
    content: FileContent,
    name: str,
    columns: Mapping[str, ArrayLike],
    options: ReadOptions,
    *,
    limit: float = LIMIT,
) -> Motion:
    """Return the motion of the joints in a table's columns, one number per row each.

    ``name`` is that of the format, ``limit`` the confidence from which a keypoint counts as seen.
    ReadError where no joints are found, columns differ in length, or nothing tells the rate.
    """
    joints = _find_joints(content, columns)
    is_asked = options.confidence is not None
    names, positions, confidence = _read_positions(content, columns, joints, visibility=is_asked)
    limit = limit if options.confidence is None else options.confidence
    positions[confidence < limit] = np.nan
    flat = all(len(axes) == 2 for axes in joints.values())
    unsure = int((confidence < limit).sum())
    timing = find_table_timing(content, columns, options.fps, positions.reshape(len(positions), -1))
    positions, gaps = place_points(timing, positions)
    notes = list(timing.notes)
    if unsure:
        notes.append(f"{format_count(unsure, 'position')} less sure than {limit:g} not used")
    unit, stated, up = options.unit, None, options.up
    if unit is None:
        stated, remarks = _find_common_unit(content, joints, positions)
        notes += remarks
    if flat:
        notes.append("two-dimensional: z is 0, and image rows count downwards")
        unit, up = unit or stated or "pixel", up or "-y"
    points = Points(
        names, positions, timing.fps, unit, up, stated_unit=stated, person=options.person
    )
    provenance = content.provenance(name, notes).timed(timing.clock, timing.row_seconds)
    return split_at(to_motion(points, provenance), gaps)


def is_used(column: str) -> bool:
    """Return whether a column of this name tells a position, a time, a rate or a confidence."""
    return is_timing(column) or any(
        pattern.fullmatch(column.strip()) for pattern in (COORDINATE, _CONFIDENCE)
    )


def list_joints(columns: Iterable[str]) -> list[str]:
    """Return the joints that columns of these names are the coordinates of, in order."""
    return list(group_axes(columns))


def _find_joints(content: FileContent, columns: Iterable[str]) -> Joints:
    """For each joint the columns of its axes; without those of its velocity, rotation and such."""
    points = group_axes(columns)
    if not points:
        shown = ", ".join(list(columns)[:8])
        raise content.error(
            "no columns JOINT_x, JOINT_y and JOINT_z found, so there are no positions "
            f"(columns: {shown or 'none'}); channels are named with columns= (--columns)"
        )
    called = {name: _POSITION.fullmatch(name) for name in points if is_body(name)}
    plain = {name: match[1] if match else name for name, match in called.items()}
    plain_names, all_positions = set(plain.values()), all(called.values())
    joints: dict[str, Mapping[str, str]] = {}
    for name, axes in points.items():
        if name in plain:
            joints[plain[name] if all_positions else name] = axes
        elif plain_names.isdisjoint(list_beginnings(name)):
            joints[name] = axes
    return joints


def _find_common_unit(
    content: FileContent, joints: Joints, positions: Floats
) -> tuple[str | None, list[str | Note]]:
    """Return the unit that the columns' names tell, and notes; None where none does.

    Where they tell several, ``positions`` are brought to metres in place, and the unit is that.
    """
    by_joint = {joint: _parse_units(axes) for joint, axes in joints.items()}
    units = sorted({unit for axes in by_joint.values() for unit in axes.values() if unit})
    silent = [joint for joint, axes in by_joint.items() if None in axes.values()]
    if len(units) < 2:
        if not (units and silent):
            return (units[0] if units else None), []
        unit = _match_unit(positions, [joint in silent for joint in joints], units[0])
        remark = f"columns of {format_count(len(silent), 'point')} tell no unit, and are taken in"
        if unit == units[0]:
            return unit, [Note(f"{remark} that of the others, {unit}", "warning")]
        told = [j for j, joint in enumerate(joints) if joint not in silent]
        positions[:, told] *= to_metres(units[0]) / to_metres(unit)
        return unit, [
            Note(f"{remark} {unit}, as large as they are; others in {units[0]}", "warning")
        ]
    listed = " and ".join(units)
    if "pixel" in units:
        raise content.error(f"columns are in {listed}, which no scale relates: keep those of one")
    if silent:
        column = next(iter(joints[silent[0]].values()))
        raise content.error(
            f"columns are in {listed}, and {column!r} tells no unit: add it to the name, as in "
            f"'{column} [{units[0]}]', or give unit= (--unit) for all of them"
        )
    for j, axes in enumerate(by_joint.values()):
        for axis, stated in axes.items():
            positions[:, j, "xyz".index(axis)] *= to_metres(stated or "m")
    return "m", [f"columns are in {listed}, each taken in its own"]


def _match_unit(positions: Floats, is_silent: list[bool], told: str) -> str:
    """Return the unit that makes silent points about as far from the origin as the others."""
    if told not in METRIC:
        return told
    distance = np.linalg.norm(positions, axis=2)
    silent = np.array(is_silent)
    known, unknown = (np.nanmedian(distance[:, part]) for part in (~silent, silent))
    if not (known > 0 and unknown > 0):
        return told
    # a step from one metric unit to the next is a factor of 10 at least
    off = {
        unit: abs(np.log10(unknown * to_metres(unit) / (known * to_metres(told))))
        for unit in METRIC
    }
    return told if off[told] < 0.7 else min(off, key=lambda unit: off[unit])


def _parse_units(axes: Mapping[str, str]) -> dict[str, str | None]:
    """Return the unit of each axis of a point.

    Where one tells none, that of the others if it is one.
    """
    matches = {axis: COORDINATE.fullmatch(column.strip()) for axis, column in axes.items()}
    by_axis = {axis: match[5] if match else None for axis, match in matches.items()}
    by_axis = {axis: "pixel" if unit == "px" else unit for axis, unit in by_axis.items()}
    units = {unit for unit in by_axis.values() if unit}
    other = min(units) if len(units) == 1 else None
    return {axis: unit or other for axis, unit in by_axis.items()}


def _read_positions(
    content: FileContent, columns: Mapping[str, ArrayLike], joints: Joints, *, visibility: bool
) -> tuple[list[str], Floats, Floats]:
    """Return names, positions (rows, joints, 3) and confidences (rows, joints).

    ``visibility`` says that it counts as a confidence: it tells only that something is in front.
    """
    matches = {column: _CONFIDENCE.fullmatch(column.strip()) for column in columns}
    confidence_columns = {
        match[1]: column
        for column, match in matches.items()
        if match and (visibility or match[2].lower() != "visibility")
    }
    rows = len(read_column(content, columns, next(iter(next(iter(joints.values())).values()))))
    positions = np.zeros((rows, len(joints), 3))
    confidence = np.ones((rows, len(joints)))
    for j, (joint, axes) in enumerate(joints.items()):
        for axis, column in axes.items():
            positions[:, j, "xyz".index(axis)] = read_column(content, columns, column, rows)
        if joint in confidence_columns:
            confidence[:, j] = read_column(content, columns, confidence_columns[joint], rows)
    positions[np.isinf(positions)] = np.nan
    return list(joints), positions, confidence
