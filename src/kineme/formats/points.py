"""Convert named points over time (markers, keypoints, joint positions) to a motion.

The motion has no rotations. Its skeleton is the small tree of `kineme.recordings.joint_names`
(pelvis, hips, ankles, head, wrists), as far as the points define these joints. All points are
children of the pelvis; without a pelvis and hips each point is a root. Offsets are those of the
frame in which the body is highest.

`kineme.formats.gaps` fills short gaps. A point with a longer gap is left out with a warning. If a
joint of the body needs the point, the gap splits the motion instead. Points that are missing only
in such gaps are kept.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from kineme._util.arrays import Floats
from kineme._util.checks import format_count, join_names, make_unique
from kineme.errors import ReadError
from kineme.formats.gaps import Gaps, bridge_gaps, fill_gaps, mark_spans
from kineme.formats.persons import choose_person
from kineme.formats.plausibility import check_rigid_points, drop_implausible
from kineme.formats.units import infer_scale, infer_up_axis, turn_upright
from kineme.recordings import Motion, Note, Provenance, Skeleton
from kineme.recordings.joint_names import PARENTS, find_body
from kineme.recordings.regular import LONGEST_S

Body = dict[str, tuple[int, ...]]
Spans = tuple[tuple[int, int], ...]

RIGID = ("pelvis", "head")
"""Joints of the body whose points are all on one bone."""
BODY = "joints of the body"
"""Start of the note that lists the points of each joint."""


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
    names, subjects = split_subjects(full_names, points.person)
    names = make_unique(names)
    if len(subjects) > 1:
        subject = _describe_subject(path, subjects, points.person)
        provenance = provenance.noted(subject).of_person(points.person or subjects[0], subjects)
    positions = np.array(points.positions, np.float64)
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
    kept_points = sorted(
        [
            *kept_points,
            *_find_missing_with_body(positions, gaps, body_points, is_visible, points.fps),
        ]
    )
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
        notes.append(f"{BODY}: {describe_body(body, names)}")
    return Motion(skeleton, positions, points.fps, None, provenance.noted(*notes), missing)


def split_subjects(names: Sequence[str], person: str | None = None) -> tuple[list[str], list[str]]:
    """Return the names without the subject's, and the subjects whose points form a pelvis.

    ``Ann:LANK`` becomes ``LANK`` for the chosen subject, by default the first one, or if all names
    have the same prefix. Points of other subjects keep their full names.
    """
    points: dict[str, list[int]] = {}
    for i, name in enumerate(names):
        points.setdefault(name.rpartition(":")[0], []).append(i)
    short = [name.rpartition(":")[2] for name in names]
    subjects = [
        subject for subject, members in points.items() if "pelvis" in find_body(short, members)
    ]
    # Without a body, a prefix common to all names is still removed.
    chosen = names[0].rpartition(":")[0] if len(points) == 1 else ""
    if subjects:
        chosen = person if person in subjects else subjects[0]
    members = set(points.get(chosen, ()))
    return [short[i] if i in members else name for i, name in enumerate(names)], subjects


def describe_body(body: Body, names: Sequence[str]) -> str:
    """Return a line for users: ``left ankle from LANK, ...``."""
    return ", ".join(
        f"{joint.replace('_', ' ')} from {' '.join(names[i] for i in joint_points)}"
        for joint, joint_points in body.items()
    )


def _describe_subject(path: str, subjects: list[str], person: str | None) -> Note:
    """Return a note on the chosen subject; raise SeveralPeopleError if it does not exist."""
    if person is None:
        sentence = f"{len(subjects)} subjects: the body used is that of {subjects[0]!r}"
        return Note(f"{sentence}; choose another with person= (--person)", "warning")
    return Note(f"person {choose_person(path, subjects, person)} of {len(subjects)}")


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
        if without.keys() == body.keys() and _count_missing(without, masks) < _count_missing(
            body, masks
        ):
            usable, body = usable - {worst}, without
    return body


def _find_missing_with_body(
    positions: Floats, gaps: Gaps, used: set[int], is_visible: NDArray[np.bool_], fps: float
) -> list[int]:
    """Return points with long gaps only in frames without the body, and fill these gaps."""
    n = len(positions)
    points = [
        point
        for point, spans in gaps.open.items()
        if point not in used and not (is_visible & mark_spans(spans.tolist(), n)).any()
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
        notes.append(
            f"left out, since they are never seen: {join_names([names[p] for p in never])}"
        )
    broken = [p for p in gaps.open if p not in never and p not in kept_points]
    if broken:
        parts = [
            f"{names[p]} (frames {gaps.open[p][0, 0]} to {gaps.open[p][-1, 1] - 1})" for p in broken
        ]
        left_out = f"left out for gaps above {LONGEST_S} s: {join_names(parts)}"
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
