"""Which of the people in a file: pose estimators find several, and now and then one too many.

Where the file tracks people, by a name or number, these are they. Where it does
not, detections of successive frames are joined by the smallest distance between
their keypoints, once each person has gone on as before, so that people who cross
stay who they are. They are numbered from 0 as they come into sight. Who is
seen in less than a tenth of the frames of the one seen most is passed over.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from kineme._util.arrays import Floats
from kineme.formats.files import FileContent
from kineme.formats.persons import choose_person

Rows = NDArray[np.intp]

PASSING = 0.1
"""Share of the frames of the one seen most below which somebody is passed over."""

_STRIDE = 0.5  # of the body's size that someone may be away from the frame before,
_STRAY = 0.1  # and for each frame that passed since
_REMEMBERED = 50  # people last seen, who may come back
_STEADY = 0.8  # of how fast a person moves that a frame leaves as it was


@dataclass(frozen=True)
class Detections:
    """One row for each person found in a frame, the frames ascending."""

    frames: Rows
    points: Floats  # (rows, keypoints, 3), NaN where not found
    who: Sequence[str | None]  # how the file calls this person, if it does


class PersonFound(NamedTuple):
    """Rows of a person, who that is, of which people, and what was done."""

    rows: Rows
    name: str
    people: tuple[str, ...]
    notes: list[str]


def select_person(content: FileContent, found: Detections, person: str | None) -> PersonFound:
    """Return the rows of this person, or of the only one.

    SeveralPeopleError where there are several and none was chosen, or nobody of this name.
    """
    people = _group_by_person(found)
    if not people:
        raise content.error("nobody is found in any frame")
    most = max(map(len, people.values()))
    # People seen only in passing are no choice, unless somebody asks for them.
    staying = {name: rows for name, rows in people.items() if len(rows) >= PASSING * most}
    candidates = staying if person is None else people
    shown = [
        f"{name} ({len(rows)} frames from {found.frames[rows[0]]} on)"
        for name, rows in candidates.items()
    ]
    name = choose_person(content.path, candidates, person, shown=shown)
    others = tuple(each for each in people if each in staying or each == name)
    note = f"person {name} of {len(people)}"
    if person is None:
        note = f"person {name}; {len(people) - 1} seen only in passing are left out"
    return PersonFound(people[name], name, others, [note] if len(people) > 1 else [])


def _group_by_person(found: Detections) -> dict[str, Rows]:
    """Return for each person the rows, in order of first sight."""
    if all(name is not None for name in found.who):
        numbers = [str(name) for name in found.who]
    elif len(np.unique(found.frames)) == len(found.frames):
        # Nobody is seen twice in a frame: there is only one person.
        numbers = ["0"] * len(found.frames)
    else:
        numbers = [str(number) for number in track_people(found)]
    rows: dict[str, list[int]] = {}
    for row, number in enumerate(numbers):
        rows.setdefault(number, []).append(row)
    return {
        # Of several rows of a person in one frame the first counts.
        name: np.array(places)[np.unique(found.frames[places], return_index=True)[1]]
        for name, places in rows.items()
    }


def track_people(found: Detections) -> list[int]:
    """Return a number for each row: that of the person nearest a frame before, or a new one."""
    from scipy.optimize import linear_sum_assignment

    numbers = [0] * len(found.frames)
    last: dict[int, int] = {}  # the row of each person last seen
    drifts: dict[int, Floats] = {}  # how far each goes in a frame, as a whole
    count = 0
    # First row of each frame.
    starts = np.flatnonzero(np.diff(found.frames, prepend=-1))
    for start, stop in pairwise([*starts.tolist(), len(found.frames)]):
        tracks = list(last)
        before = np.array([last[who] for who in tracks], np.intp)
        drift = np.array([drifts[who] for who in tracks]).reshape(len(tracks), 3)
        cost = np.full((len(tracks), stop - start), np.inf)
        for column, row in enumerate(range(start, stop)):
            if tracks:
                cost[:, column] = _measure_strides(found, before, drift, row)
        # The assignment needs finite costs; pairs that are too far are dropped below.
        possible = np.where(np.isfinite(cost), cost, 1e6)
        pairs = zip(*linear_sum_assignment(possible), strict=True)
        matched = {column: tracks[k] for k, column in pairs if cost[k, column] <= 1}
        for column, row in enumerate(range(start, stop)):
            if column not in matched:
                matched[column] = count
                drifts[count] = np.zeros(3)
                count += 1
            who = numbers[row] = matched[column]
            # Taken out and put in again: the order tells who was seen last.
            if (former := last.pop(who, None)) is not None:
                drifts[who] = _STEADY * drifts[who] + (1 - _STEADY) * _measure_step(
                    found, former, row
                )
            last[who] = row
        for who in list(last)[:-_REMEMBERED]:
            del last[who], drifts[who]
    return numbers


def _measure_step(found: Detections, former: int, row: int) -> Floats:
    """How far a person went in a frame between two rows, as a whole; 0 where nothing tells."""
    steps = found.points[row] - found.points[former]
    seen = np.isfinite(steps).all(axis=1)
    passed = found.frames[row] - found.frames[former]
    return steps[seen].mean(axis=0) / passed if seen.any() else np.zeros(3)


def _measure_strides(found: Detections, before: Rows, drift: Floats, row: int) -> Floats:
    """How far a person is from where others went, in the ways they could have gone; or inf."""
    now = found.points[row]
    passed = found.frames[row] - found.frames[before]
    with np.errstate(all="ignore"):
        expected = found.points[before] + (drift * passed[:, None])[:, None]
        # (people, keypoints): how far each keypoint is, nan where one was not seen.
        away = np.linalg.norm(expected - now, axis=2)
        visible = np.isfinite(away)
        mean = np.where(visible, away, 0).sum(axis=1) / visible.sum(axis=1)
        here = now[np.isfinite(now).all(axis=1)]
        size = np.ptp(here, axis=0).max() if len(here) > 1 else 0.0
        # Somebody who was out of sight for longer may be farther away.
        strides = mean / (size * (_STRIDE + _STRAY * (passed - 1)))
    return np.asarray(np.where(np.isfinite(strides), strides, np.inf))
