"""Convert tables with columns of joint coordinates to motions.

A joint has two or three columns whose names differ in the last letter: ``hip_x hip_y hip_z``,
``hip.x``, ``hip x`` or ``hipX``, in any order, or ``hip_pos_x`` if all names have this form. A name
may state the unit, as in ``hip_x [mm]`` or ``hip_x_mm``; columns may have different units.
Velocities, rotations and similar columns of joints are ignored. Other columns that are read:

- the time: ``time``, ``t``, ``timestamp``, ``datetime``, ``elapsed`` or ``seconds``, with or
  without a unit as in ``time_ms``, ``Time (s)`` or ``epoch_ns``. Values are numbers or dates, see
  `kineme.recordings.times`;
- the frame rate, repeated in every row: ``fps`` or ``rate``;
- a pose estimator's confidence: ``hip_confidence``, ``_likelihood``, ``_score``, ``_visibility``,
  ``_presence`` or ``_c``. Below 0.5 the joint counts as not seen.

Two-dimensional joints get z = 0. They are positions in an image with y down; the larger side of
the body is scaled to a person's height.
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
"""Columns of each joint, by axis."""

LIMIT = 0.5
"""Confidence at and above which a keypoint counts as seen."""

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
    """Return the motion of the joints in a table's columns, which hold one number per row.

    ``name`` is the name of the format, ``limit`` the confidence at which a keypoint counts as seen.
    Raise ReadError if there are no joints, columns differ in length, or the rate is unknown.
    """
    joints = _find_joints(content, columns)
    use_visibility = options.confidence is not None
    names, positions, confidence = _read_positions(
        content, columns, joints, visibility=use_visibility
    )
    limit = limit if options.confidence is None else options.confidence
    positions[confidence < limit] = np.nan  # these become gaps
    is_flat = all(len(axes) == 2 for axes in joints.values())
    n_unsure = int((confidence < limit).sum())
    timing = find_table_timing(content, columns, options.fps, positions.reshape(len(positions), -1))
    positions, gaps = place_points(timing, positions)
    notes = list(timing.notes)
    if n_unsure:
        notes.append(f"{format_count(n_unsure, 'position')} below confidence {limit:g} not used")
    unit, stated_unit, up = options.unit, None, options.up
    if unit is None:
        stated_unit, unit_notes = _find_common_unit(content, joints, positions)
        notes += unit_notes
    if is_flat:
        notes.append("two-dimensional: z is 0, and image rows count downwards")
        unit, up = unit or stated_unit or "pixel", up or "-y"
    points = Points(
        names, positions, timing.fps, unit, up, stated_unit=stated_unit, person=options.person
    )
    provenance = content.provenance(name, notes).timed(timing.clock, timing.row_seconds)
    return split_at(to_motion(points, provenance), gaps)


def is_used(column: str) -> bool:
    """Return whether a column of this name holds positions, times, a rate or confidences."""
    return is_timing(column) or any(
        pattern.fullmatch(column.strip()) for pattern in (COORDINATE, _CONFIDENCE)
    )


def list_joints(columns: Iterable[str]) -> list[str]:
    """Return the joints whose coordinates are in columns of these names, in order."""
    return list(group_axes(columns))


def _find_joints(content: FileContent, columns: Iterable[str]) -> Joints:
    """Return the coordinate columns of each joint, without those of velocities or rotations."""
    points = group_axes(columns)
    if not points:
        shown = ", ".join(list(columns)[:8])
        raise content.error(
            "no columns JOINT_x, JOINT_y and JOINT_z found, so there are no positions "
            f"(columns: {shown or 'none'}); channels are named with columns= (--columns)"
        )
    position_matches = {name: _POSITION.fullmatch(name) for name in points if is_body(name)}
    joint_names = {name: match[1] if match else name for name, match in position_matches.items()}
    known_names, has_only_positions = set(joint_names.values()), all(position_matches.values())
    joints: dict[str, Mapping[str, str]] = {}
    for name, axes in points.items():
        # Without "pos" in all names, "hip_pos" and "hip" are two joints.
        if name in joint_names:
            joints[joint_names[name] if has_only_positions else name] = axes
        # "hip_velocity" begins with the name of a joint: it is not a joint itself.
        elif known_names.isdisjoint(list_beginnings(name)):
            joints[name] = axes
    return joints


def _find_common_unit(
    content: FileContent, joints: Joints, positions: Floats
) -> tuple[str | None, list[str | Note]]:
    """Return the unit stated in the columns' names, or None, and notes.

    If names state several units, ``positions`` are converted to metres in place.
    """
    by_joint = {joint: _parse_units(axes) for joint, axes in joints.items()}
    units = sorted({unit for axes in by_joint.values() for unit in axes.values() if unit})
    unstated = [joint for joint, axes in by_joint.items() if None in axes.values()]
    if len(units) < 2:
        if not (units and unstated):
            return (units[0] if units else None), []
        unit = _match_unit(positions, [joint in unstated for joint in joints], units[0])
        remark = f"columns of {format_count(len(unstated), 'point')} state no unit; read in"
        if unit == units[0]:
            return unit, [Note(f"{remark} the unit of the others, {unit}", "warning")]
        stated_joints = [j for j, joint in enumerate(joints) if joint not in unstated]
        # Convert the other joints to the unit of those without one.
        positions[:, stated_joints] *= to_metres(units[0]) / to_metres(unit)
        return unit, [
            Note(f"{remark} {unit}, which fits their size; others in {units[0]}", "warning")
        ]
    listed = " and ".join(units)
    if "pixel" in units:
        raise content.error(
            f"columns are in {listed}, which cannot be converted: keep columns of one unit"
        )
    if unstated:
        column = next(iter(joints[unstated[0]].values()))
        raise content.error(
            f"columns are in {listed}, and {column!r} states no unit: add it to the name, "
            f"as in '{column} [{units[0]}]', or give unit= (--unit) for all of them"
        )
    for j, axes in enumerate(by_joint.values()):
        for axis, stated in axes.items():
            positions[:, j, "xyz".index(axis)] *= to_metres(stated or "m")
    return "m", [f"columns are in {listed}, each read in its own unit"]


def _match_unit(positions: Floats, is_unstated: list[bool], stated: str) -> str:
    """Return the unit in which joints without one are as far from the origin as the others."""
    if stated not in METRIC:
        return stated
    distance = np.linalg.norm(positions, axis=2)
    unstated = np.array(is_unstated)
    known, unknown = (np.nanmedian(distance[:, part]) for part in (~unstated, unstated))
    if not (known > 0 and unknown > 0):
        return stated
    # Metric units differ by a factor of 10 or more; 0.7 in log10 is a factor of 5.
    errors = {
        unit: abs(np.log10(unknown * to_metres(unit) / (known * to_metres(stated))))
        for unit in METRIC
    }
    return stated if errors[stated] < 0.7 else min(errors, key=lambda unit: errors[unit])


def _parse_units(axes: Mapping[str, str]) -> dict[str, str | None]:
    """Return the unit of each axis of a point.

    An axis without a unit gets that of the other axes if they agree.
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

    ``visibility`` counts as a confidence only if requested: it states whether a point is occluded.
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
    positions[np.isinf(positions)] = np.nan  # infinite values count as missing
    return list(joints), positions, confidence
