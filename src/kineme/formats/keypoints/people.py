"""Select one of the people in a file.

If the file tracks people by name or number, these are used, unless they often occur twice in a
frame. Otherwise detections of successive frames are joined by the smallest distance between their
keypoints, after moving each person on as before, so that people who cross are not swapped. Those
seen last come first. They are numbered from 0 in order of appearance.
People seen in less than a tenth of the frames of the most frequent one are ignored.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from kineme._util.arrays import Floats
from kineme.formats.options import choose_person

Rows = NDArray[np.intp]

PASSING = 0.1
"""Fraction of the frames of the most frequent person below which others are ignored."""

MOST_REPEATED = 0.1
"""Largest fraction of rows that repeat a person of their frame, where names identify people."""

_STRIDE = 0.5  # body sizes that a person may move from one frame to the next,
_STRAY = 0.1  # plus this for each frame without a detection
_REMEMBERED = 50  # most recently seen people who may reappear
_MOMENTUM = 0.8  # share of the previous velocity in the smoothed one


def select_person(
    path: Path, frames: Rows, points: Floats, detected: Sequence[str | None], person: str | None
) -> tuple[Rows, str, tuple[str, ...], list[str]]:
    """Return the rows and the name of the requested or only person, all people, and notes.

    Each row is a person in a frame, in order of ``frames``, with ``points`` (rows, keypoints, 3),
    NaN where not found, and the name or number in the file. Raise SeveralPeopleError if the person
    does not exist, or several exist and none is requested.
    """
    people = _group_by_person(frames, points, detected)
    max_frames = max(map(len, people.values()))
    # People seen only briefly are candidates only if requested.
    staying = {name: rows for name, rows in people.items() if len(rows) >= PASSING * max_frames}
    candidates = staying if person is None else people
    shown = [
        f"{name} ({len(rows)} frames from {frames[rows[0]]} on)"
        for name, rows in candidates.items()
    ]
    name = choose_person(path, candidates, person, shown=shown)
    all_people = tuple(other for other in people if other in staying or other == name)
    note = f"person {name} of {len(people)}"
    if person is None:
        note = f"person {name}; {len(people) - 1} seen only briefly are left out"
    return people[name], name, all_people, [note] if len(people) > 1 else []


def _group_by_person(
    frames: Rows, points: Floats, detected: Sequence[str | None]
) -> dict[str, Rows]:
    """Return the rows of each person, in order of appearance."""
    names = list(map(str, detected))
    # Untracked people share a number, which so occurs several times in most frames of several.
    n_unique = len({*zip(frames.tolist(), names, strict=True)})
    if None in detected or len(names) - n_unique > MOST_REPEATED * n_unique:
        # With one detection per frame there is only one person.
        is_alone = len(np.unique(frames)) == len(frames)
        numbers = [0] * len(frames) if is_alone else track_people(frames, points)
        names = list(map(str, numbers))
    rows: dict[str, list[int]] = {}
    for row, name in enumerate(names):
        rows.setdefault(name, []).append(row)
    return {
        # Use the first of several rows of a person in one frame.
        name: np.array(person_rows)[np.unique(frames[person_rows], return_index=True)[1]]
        for name, person_rows in rows.items()
    }


def track_people(frames: Rows, points: Floats) -> list[int]:
    """Return a person's number for each row: the nearest person of earlier frames, or a new one.

    ``points`` (rows, keypoints, 3) are in order of ``frames``; NaN where not found.
    """
    from scipy.optimize import linear_sum_assignment

    numbers = [0] * len(frames)
    last: dict[int, int] = {}  # last row of each person
    drifts: dict[int, Floats] = {}  # movement of each person per frame
    count = 0
    # First row of each frame.
    starts = np.flatnonzero(np.diff(frames, prepend=-1))
    for start, stop in pairwise([*starts.tolist(), len(frames)]):
        tracks = list(last)
        before = np.array([last[person] for person in tracks], np.intp)
        drift = np.array([drifts[person] for person in tracks]).reshape(len(tracks), 3)
        cost = np.zeros((len(tracks), stop - start))
        for column, row in enumerate(range(start, stop)):
            if tracks:
                cost[:, column] = _rate_pairs(frames, points, before, drift, row)
        pairs = zip(*linear_sum_assignment(cost), strict=True)
        matched = {column: tracks[k] for k, column in pairs if cost[k, column] < 0}
        for column, row in enumerate(range(start, stop)):
            if column not in matched:
                matched[column] = count
                drifts[count] = np.zeros(3)
                count += 1
            person = numbers[row] = matched[column]
            # Reinsert the person: the order of `last` is that of the last detection.
            if (former := last.pop(person, None)) is not None:
                step = _measure_step(frames, points, former, row)
                drifts[person] = _MOMENTUM * drifts[person] + (1 - _MOMENTUM) * step
            last[person] = row
        for person in list(last)[:-_REMEMBERED]:
            del last[person], drifts[person]
    return numbers


def _measure_step(frames: Rows, points: Floats, former: int, row: int) -> Floats:
    """Return the mean movement of a person per frame between two rows, 0 if unknown."""
    steps = points[row] - points[former]
    seen = np.isfinite(steps).all(axis=1)
    elapsed = frames[row] - frames[former]
    return steps[seen].mean(axis=0) / elapsed if seen.any() else np.zeros(3)


def _rate_pairs(frames: Rows, points: Floats, before: Rows, drift: Floats, row: int) -> Floats:
    """Return costs of matching a row to people: negative where allowed, lowest for the nearest."""
    now = points[row]
    elapsed = frames[row] - frames[before]
    # Sum of the geometric series: an absent person slows down, instead of leaving the picture.
    steps = (1 - _MOMENTUM**elapsed) / (1 - _MOMENTUM)
    with np.errstate(all="ignore"):
        expected = points[before] + (drift * steps[:, None])[:, None]
        # Distance of each keypoint (people, keypoints), NaN where not seen.
        distances = np.linalg.norm(expected - now, axis=2)
        visible = np.isfinite(distances)
        mean = np.where(visible, distances, 0).sum(axis=1) / visible.sum(axis=1)
        seen_now = now[np.isfinite(now).all(axis=1)]
        size = np.ptp(seen_now, axis=0).max() if len(seen_now) > 1 else 0.0
        # A person not seen for longer may be farther away, but a match with them is worth less:
        # the divisor keeps those who left from taking over one who stayed.
        allowed = _STRIDE + _STRAY * (elapsed - 1)
        cost = (mean / size / allowed - 1) / allowed
    return np.asarray(np.where(cost < 0, cost, 0))
