"""Convert named points over time (markers, keypoints, columns of a table) to a motion.

The motion has no rotations. Its skeleton is the small tree of `kineme.recordings.joint_names`
(pelvis, hips, ankles, head, wrists), as far as the points define these joints. All points are
children of the pelvis; without a pelvis and hips each point is a root. Offsets are those of the
frame in which the body is highest.

`kineme.formats.plausibility` fills short gaps. A point with a longer gap is left out, with a
warning. If a joint of the body needs the point, the gap splits the motion instead. Points that are
missing only in such gaps are kept.

In a table, a joint has two or three columns whose names differ in the last letter: ``hip_x hip_y``,
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
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from kineme._util.arrays import Floats
from kineme._util.checks import format_count, join_names, make_unique
from kineme.errors import ReadError
from kineme.formats.files import FileContent
from kineme.formats.options import ReadOptions, choose_person
from kineme.formats.plausibility import (
    Gaps,
    bridge_gaps,
    check_rigid_points,
    drop_implausible,
    fill_gaps,
    split_at,
)
from kineme.formats.sniffing import find_table_timing, place_points, read_column
from kineme.formats.units import METRIC, infer_scale, infer_up_axis, to_metres, turn_upright
from kineme.recordings import Motion, Note, Provenance, Skeleton
from kineme.recordings.arrays import mark_spans
from kineme.recordings.column_names import COORDINATE, group_axes, is_body, list_beginnings
from kineme.recordings.joint_names import PARENTS, find_body
from kineme.recordings.regular import LONGEST_S
from kineme.recordings.times import is_timing

Body = dict[str, tuple[int, ...]]
Spans = tuple[tuple[int, int], ...]
Joints = Mapping[str, Mapping[str, str]]
"""Columns of each joint, by axis."""

RIGID = ("pelvis", "head")
"""Joints of the body whose points are all on one bone."""
BODY = "joints of the body"
"""Start of the note that lists the points of each joint."""
LIMIT = 0.5
"""Confidence at and above which a keypoint counts as seen."""

_CONFIDENCE = re.compile(
    r"(.*[^\s_.:/-])[\s_.:/-]+(confidence|likelihood|score|visibility|presence|c)", re.IGNORECASE
)
_POSITION = re.compile(
    r"(.*[^\s_.:/-])(?:[\s_.:/-]+pos(?:ition)?|(?-i:Pos(?:ition)?))", re.IGNORECASE
)


@dataclass(frozen=True)
class Points:
    """Named points in a file's own units and axes.

    Parameters
    ----------
    names : sequence of str
        One per point.
    positions : array_like of shape (frames, points, 3)
        NaN where not seen.
    fps : float
        Frames per second.
    unit : str or float, optional
        A name in `UNITS`, metres in one unit, "pixel", or None if unknown.
    up : str, optional
        The axis that points up, or None if unknown.
    stated_unit : str, optional
        The unit stated in the file, used if `unit` is None and the body then has human size.
    usual_up : str, optional
        The up axis used if it cannot be inferred from the body.
    is_up_stated : bool
        True if the file states the usual axis.
    person : str, optional
        Which of several subjects is the body; the first by default.
    """

    names: Sequence[str]
    positions: ArrayLike
    fps: float
    unit: str | float | None = None
    up: str | None = None
    stated_unit: str | None = None
    usual_up: str = "y"
    is_up_stated: bool = False
    person: str | None = None


def to_motion(points: Points, provenance: Provenance) -> Motion:
    """Return the motion in metres with y up.

    Raise ReadError if no point was seen throughout, the body is complete in no frame, or the
    person does not exist.
    """
    path = provenance.path or "recording"
    full_names = [name.strip() or "point" for name in points.names]
    own_points, subject, subjects = select_subject(full_names, points.person, path)
    names = make_unique([*own_points.values()])
    if len(subjects) > 1:
        remark: Note | str = f"person {subject} of {len(subjects)}"
        if points.person is None:
            sentence = f"{len(subjects)} subjects: the body used is that of {subject!r}"
            remark = Note(f"{sentence}; choose another with person= (--person)", "warning")
        provenance = provenance.noted(remark)
    if any(subjects):
        provenance = provenance.of_person(subject, subjects)
    positions = np.array(points.positions, np.float64)
    if left_out := len(full_names) - len(names):
        provenance = provenance.noted(f"{format_count(left_out, 'point')} of other bodies left out")
        positions = positions[:, [*own_points]]
    # Implausible positions must become NaN before gaps are filled.
    doubts = drop_implausible(positions, names, points.fps)
    gaps = fill_gaps(positions, points.fps)
    body = _choose_body(names, gaps, len(positions))
    body_points = _list_body_points(body)
    # Points with open gaps are kept only if the body needs them.
    kept_points = [i for i in range(len(names)) if i not in gaps.open or i in body_points]
    missing = bridge_gaps(positions, gaps, body_points, points.fps)
    is_visible = ~mark_spans(missing, len(positions))
    if not kept_points:
        raise ReadError(path, f"every marker has a gap above {LONGEST_S} s")
    if not is_visible.any():
        hidden_names = join_names([names[i] for i in sorted(body_points & gaps.open.keys())])
        raise ReadError(path, f"the body is never complete: {hidden_names} are never seen together")
    kept_points += _find_missing_with_body(positions, gaps, body_points, is_visible, points.fps)
    kept_points.sort()
    notes = [*doubts, *_describe_gaps(names, gaps, kept_points, len(positions))]
    notes += _describe_splits(names, gaps, body_points, missing, points.fps)
    visible = positions if is_visible.all() else positions[is_visible]
    # Avoid copies: a recording may be a large part of the memory.
    seen = visible if len(kept_points) == len(names) else visible[:, kept_points]
    is_body = {"pelvis", "head", "left_ankle"} <= body.keys()
    scale, note = infer_scale(points.unit, seen, stated=points.stated_unit, is_body=is_body)
    notes += note
    del seen
    up = points.up
    if up is None:
        up, note = infer_up_axis(points.usual_up, visible, body, is_stated=points.is_up_stated)
        notes += note
    for joint in RIGID:
        notes += check_rigid_points(visible, names, body.get(joint, ()))
    del visible
    positions *= scale
    skeleton, positions = _build_skeleton(
        names, turn_upright(positions, up), body, kept_points, is_visible
    )
    if "pelvis" in body:
        used = (
            f"{joint.replace('_', ' ')} from {' '.join(names[i] for i in joint_points)}"
            for joint, joint_points in body.items()
        )
        notes.append(f"{BODY}: {', '.join(used)}")
    return Motion(
        skeleton, positions, points.fps, provenance=provenance.noted(*notes), gaps=missing
    )


def select_subject(
    names: Sequence[str], person: str | None = None, path: str = "recording"
) -> tuple[dict[int, str], str, list[str]]:
    """Return the names of the points to read by index, their subject, and all subjects.

    Subjects are those whose points form a pelvis; the first one is the default. ``Ann:LANK``
    becomes ``LANK`` for the selected subject, or if all names have the same prefix. Points of other
    bodies are left out, since their joints have the same names. Props keep their full names. Raise
    SeveralPeopleError if there are several subjects, but not this person.
    """
    points: dict[str, list[int]] = {}
    for i, name in enumerate(names):
        points.setdefault(name.rpartition(":")[0], []).append(i)
    short = [name.rpartition(":")[2] for name in names]
    bodies = {subject: find_body(short, members) for subject, members in points.items()}
    subjects = [subject for subject, body in bodies.items() if "pelvis" in body]
    left_out: set[str] = set()
    if subjects:
        is_chosen = person is not None and any(subjects)
        chosen = choose_person(path, subjects, person) if is_chosen else subjects[0]
        # Keep markers without a prefix, and props, of which one point may be named like a joint.
        left_out = {each for each, body in bodies.items() if each and len(body) > 1}
        left_out = (left_out | {*subjects}) - {chosen}
    else:
        # Without a body, a prefix common to all names is still removed.
        chosen = next(iter(points)) if len(points) == 1 else ""
    own_points = {
        i: short[i] if subject == chosen else names[i]
        for subject, members in points.items()
        if subject not in left_out
        for i in members
    }
    return dict(sorted(own_points.items())), chosen, subjects


def _choose_body(names: list[str], gaps: Gaps, n_frames: int) -> Body:
    """Return the joints that the points form, from the points with the shortest gaps.

    Points with open gaps are used if a joint cannot be formed without them.
    """
    masks = {point: mark_spans(spans.tolist(), n_frames) for point, spans in gaps.open.items()}
    usable = {i for i in range(len(names)) if i not in masks or not masks[i].all()}
    body = find_body(names, usable)
    if "pelvis" not in body:
        # No motion can be built on points with gaps: use complete points only.
        return find_body(names, usable - masks.keys())
    # Try to do without each point, the one with most missing frames first.
    tried: set[int] = set()
    while incomplete := (_list_body_points(body) & masks.keys()) - tried:
        worst = max(incomplete, key=lambda point: (masks[point].sum(), -point))
        without = find_body(names, usable - {worst})
        tried.add(worst)
        is_better = _count_missing(without, masks) < _count_missing(body, masks)
        if is_better and without.keys() == body.keys():
            usable, body = usable - {worst}, without
    return body


def _find_missing_with_body(
    positions: Floats, gaps: Gaps, used: set[int], is_visible: NDArray[np.bool_], fps: float
) -> list[int]:
    """Return points with long gaps only in frames without the body, and fill these gaps."""
    points = [
        point
        for point, spans in gaps.open.items()
        if point not in used and not is_visible[mark_spans(spans.tolist(), len(positions))].any()
    ]
    bridge_gaps(positions, gaps, points, fps)
    return points


def _list_body_points(body: Body) -> set[int]:
    return {point for joint_points in body.values() for point in joint_points}


def _count_missing(body: Body, hidden: dict[int, NDArray[np.bool_]]) -> int:
    """Return the number of frames in which one of the body's points was not seen."""
    masks = [hidden[point] for point in _list_body_points(body) & hidden.keys()]
    return int(np.logical_or.reduce(masks).sum()) if masks else 0


def _describe_splits(
    names: list[str], gaps: Gaps, used: set[int], missing: Spans, fps: float
) -> list[str]:
    """Return a note on the gaps of the recording and the points that cause them."""
    if not missing:
        return []
    spans = [f"frames {a} to {b - 1} ({(b - a) / fps:.2f} s)" for a, b in missing]
    hidden = [names[point] for point in sorted(used & gaps.open.keys())]
    note = (
        f"the body is incomplete in {join_names(spans)}, for gaps above {LONGEST_S} s in "
        f"{join_names(hidden)}: the recording is split there"
    )
    return [Note(note, "warning")]


def _describe_gaps(
    names: list[str], gaps: Gaps, kept_points: list[int], n_frames: int
) -> list[str]:
    """Return notes on points that were filled or left out."""
    notes: list[str] = []
    if gaps.filled:
        most = max(gaps.filled, key=lambda point: gaps.filled[point])
        notes.append(
            f"gaps up to {LONGEST_S} s filled in {format_count(len(gaps.filled), 'point')}, "
            f"{format_count(sum(gaps.filled.values()), 'position')} in all, most in {names[most]} "
            f"({gaps.filled[most]} of {format_count(n_frames, 'frame')})"
        )
    never = [p for p, spans in gaps.open.items() if np.diff(spans).sum() == n_frames]
    if never:
        unseen = join_names([names[p] for p in never])
        notes.append(f"left out, since they are never seen: {unseen}")
    broken = [
        f"{names[p]} (frames {spans[0, 0]} to {spans[-1, 1] - 1})"
        for p, spans in gaps.open.items()
        if p not in never and p not in kept_points
    ]
    if broken:
        left_out = f"left out for gaps above {LONGEST_S} s: {join_names(broken)}"
        notes.append(Note(left_out, "warning"))
    return notes


def _build_skeleton(
    names: list[str],
    positions: Floats,
    body: Body,
    kept_points: list[int],
    is_visible: NDArray[np.bool_],
) -> tuple[Skeleton, Floats]:
    """Return the skeleton and its joints' positions: the body's joints first, then the points."""
    if not {"pelvis", "left_hip", "right_hip"} <= body.keys():
        alone = Skeleton(
            tuple(names[i] for i in kept_points),
            (-1,) * len(kept_points),
            np.zeros((len(kept_points), 3)),
        )
        return alone, positions[:, kept_points]
    joints = [joint for joint, parent in PARENTS.items() if joint in body]
    joints = [joint for joint in joints if PARENTS[joint] in (None, *joints)]
    rest = [i for i in kept_points if names[i] not in joints]
    # A joint is the mean of its points.
    middles = [positions[:, list(body[joint])].mean(axis=1) for joint in joints]
    joint_positions = np.concatenate([np.stack(middles, axis=1), positions[:, rest]], axis=1)
    parents = [joints.index(PARENTS[joint] or "") if PARENTS[joint] else -1 for joint in joints]
    parents += [0] * len(rest)
    # The frame with the largest height, among those in which the body was seen.
    upright_pose = joint_positions[(np.ptp(joint_positions[:, :, 1], axis=1) * is_visible).argmax()]
    offsets = upright_pose - upright_pose[parents]
    offsets[0] = 0
    return Skeleton((*joints, *(names[i] for i in rest)), tuple(parents), offsets), joint_positions


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
    # Columns of visibility state whether a point is occluded: they count only on request.
    names, positions, confidence = _read_positions(
        content, columns, joints, visibility=options.confidence is not None
    )
    limit = limit if options.confidence is None else options.confidence
    is_unsure = confidence < limit
    positions[is_unsure] = np.nan  # these become gaps
    is_flat = all(len(axes) == 2 for axes in joints.values())
    n_unsure = int(is_unsure.sum())
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
