"""Events of a stream, its final segments, and how new ones are added.

A final event never changes; a provisional one is the best guess so far.

Each segmentation of the recent past (a look) gives rows. The start and the cluster of an activity
become final when two looks in a row find them before the horizon and the activity repeats. Its end
and its repetitions follow the latest look until the next activity begins, because a look at all of
it is more reliable than several looks at its parts. The repetitions of a long activity become final
before the recent past drops them. A row that contradicts final ones begins at the frontier.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, dataclass, field
from typing import Any, Literal, NamedTuple

import numpy as np

from kineme._util.arrays import Ints

State = Literal["provisional", "final"]


@dataclass(frozen=True, kw_only=True)
class Event:
    """Base class of all events.

    Attributes
    ----------
    at_s : float
        Time of the newest row when the event was sent, in seconds since the stream began.
    state : {"provisional", "final"}

    Examples
    --------
    >>> Event(at_s=2.0, state="provisional").is_final
    False
    """

    at_s: float
    state: State = "final"

    @property
    def is_final(self) -> bool:
        """Return whether the event is final."""
        return self.state == "final"

    def to_json(self) -> dict[str, Any]:
        """Return the name of the class as ``event``, and all attributes.

        Examples
        --------
        >>> Notice(at_s=2.0, text="the clock goes back").to_json()
        {'event': 'Notice', 'at_s': 2.0, 'state': 'final', 'text': 'the clock goes back'}
        """
        rounded = {
            name: round(value, 4) if isinstance(value, float) else value
            for name, value in asdict(self).items()
        }
        return {"event": type(self).__name__} | rounded


@dataclass(frozen=True, kw_only=True)
class ActivityStarted(Event):
    """An activity began at `start_s`; ``label`` is the name of a known cluster.

    Examples
    --------
    >>> ActivityStarted(at_s=14.0, start_s=9.0, cluster=2).start_s
    9.0
    """

    start_s: float
    cluster: int
    label: str = ""


@dataclass(frozen=True, kw_only=True)
class ActivityEnded(Event):
    """An activity ended, with its number of repetitions.

    Examples
    --------
    >>> ActivityEnded(at_s=30.0, start_s=9.0, stop_s=25.0, cluster=2, repetitions=8).repetitions
    8
    """

    start_s: float
    stop_s: float
    cluster: int
    repetitions: int
    label: str = ""


@dataclass(frozen=True, kw_only=True)
class Repetition(Event):
    """One repetition; ``number`` counts those of its activity from 1.

    Examples
    --------
    >>> Repetition(at_s=16.0, number=1, start_s=9.0, stop_s=11.0, cluster=2).number
    1
    """

    number: int
    start_s: float
    stop_s: float
    cluster: int


@dataclass(frozen=True, kw_only=True)
class Gap(Event):
    """Nothing was recorded for a while; a provisional gap has not ended yet.

    Examples
    --------
    >>> Gap(at_s=5.0, start_s=3.0, stop_s=5.0).stop_s
    5.0
    """

    start_s: float
    stop_s: float


@dataclass(frozen=True, kw_only=True)
class Notice(Event):
    """Something is wrong with the rows; the stream continues.

    Examples
    --------
    >>> Notice(at_s=5.0, text="the clock goes back by 3 s").text
    'the clock goes back by 3 s'
    """

    text: str


MOST_SLIP = 0.5
"""Share of a repetition by which the phase may change within an activity."""
AGREEING_S = 0.5
"""Seconds by which two looks may differ in the start of an activity."""


class Row(NamedTuple):
    """Frames [start, stop) of the stream and their cluster; -1 for transitions."""

    start: int
    stop: int
    cluster: int


class Look(NamedTuple):
    """Segments of the recent past: rows of both levels, each without holes or overlaps."""

    activities: list[Row]
    primitives: list[Row]

    def has_activity(self, row: Row, near: float) -> bool:
        """Return whether an activity of the row's cluster starts within `near` frames of it."""
        return any(
            each.cluster == row.cluster and abs(each.start - row.start) <= near
            for each in self.activities
        )


class Looks(NamedTuple):
    """Two successive looks at the recent past."""

    look: Look
    before: Look | None  # the look before, which must agree; None if it need not
    horizon: int  # frame before which rows become final
    patience: int  # frames before the horizon from which rows become final even if looks disagree
    memory: int  # frames of the recent past
    now: int  # number of frames when the look was taken


@dataclass
class Finals:
    """Final rows, and the open activity."""

    fps: float
    activities: list[Row] = field(default_factory=list)  # those that have ended
    primitives: list[Row] = field(default_factory=list)
    # First frame and cluster of the open activity; -1 for a transition.
    start: int = 0
    cluster: int = -1
    counted: int = 0  # frame up to which the primitives of the open activity are final
    n_repetitions: int = 0  # final repetitions of the open activity
    slip: float = 0.0  # share of a repetition by which their phase has changed
    coming: list[Row] = field(default_factory=list)  # repetitions after `counted` in the last look
    coming_slip: float = 0.0  # change of phase of the first of them
    frontier: int = 0  # frame up to which activities are final
    highest: int = -1  # largest cluster number so far
    labels: dict[int, str] = field(default_factory=dict)  # names of known clusters

    def advance(self, looks: Looks) -> list[Event]:
        """Make rows before the horizon final; return the events."""
        events: list[Event] = []
        at_s = looks.now / self.fps
        near = AGREEING_S * self.fps
        first = -1  # frame at which the open activity begins in the look
        for row in looks.look.activities:
            if row.stop <= self.start + near:
                continue
            # A look that has the open activity may also change where it ends.
            begin = max(row.start, self.frontier if first < 0 else self.counted)
            if begin >= looks.horizon:
                break
            if row.cluster != self.cluster and row.stop <= begin:
                continue  # it is over before anything that may change
            if row.cluster == self.cluster:
                first = row.start if first < 0 else first
            elif self._agree(row, begin, looks):
                events += self.close(begin, at_s)
                events += self._open(begin, row.cluster, at_s)
                first = row.start
            else:
                self.frontier = max(self.frontier, begin)
                break
            self.frontier = max(self.frontier, min(row.stop, looks.horizon))
            self.coming, self.coming_slip = self.uncounted(looks.look.primitives, first)
            # Soon, the first repetitions are seen no longer: half of the recent past is decided.
            if self.counted < looks.now - looks.memory + looks.patience:
                events += self._count(min(self.frontier, looks.now - looks.memory // 2), at_s)
        return events

    def _agree(self, row: Row, begin: int, looks: Looks) -> bool:
        """Return whether both looks have the activity, it repeats and contradicts no final row."""
        if looks.before is None:
            return True
        near = AGREEING_S * self.fps
        is_in_both = looks.before.has_activity(row, near)
        if begin <= looks.horizon - looks.patience:
            return is_in_both or begin >= self.frontier
        units = [each for each in looks.look.primitives if row.start <= each.start < row.stop]
        if row.cluster >= 0 and sum(each.cluster >= 0 for each in units) < 2:
            return False  # it may be only a part of a slow repetition
        return row.start >= begin - near and is_in_both

    def close(self, stop: int, at_s: float) -> list[Event]:
        """End the open activity at a frame; return the events."""
        self.frontier = max(self.frontier, stop)
        if stop <= self.start:
            return []
        events: list[Event] = list(self._count(stop, at_s))
        if self.counted < stop:
            self.primitives.append(Row(self.counted, stop, -1))
        self.activities.append(Row(self.start, stop, self.cluster))
        if self.cluster >= 0:
            ended = ActivityEnded(
                at_s=at_s,
                start_s=self.start / self.fps,
                stop_s=stop / self.fps,
                cluster=self.cluster,
                repetitions=self.n_repetitions,
                label=self.labels.get(self.cluster, ""),
            )
            events.append(ended)
        self._open(stop, -1, at_s)
        return events

    def _open(self, start: int, cluster: int, at_s: float) -> list[Event]:
        """Begin an activity, or a transition (-1), at a frame; return the events."""
        self.start = self.counted = start
        self.cluster, self.n_repetitions, self.slip, self.coming = cluster, 0, 0.0, []
        self.highest = max(self.highest, cluster)
        if cluster < 0:
            return []
        label = self.labels.get(cluster, "")
        return [ActivityStarted(at_s=at_s, start_s=start / self.fps, cluster=cluster, label=label)]

    def _count(self, stop: int, at_s: float) -> list[Repetition]:
        """Make repetitions of the open activity final that end by a frame; return the events."""
        events = []
        while self.coming and self.coming[0].stop <= stop:
            row = self.coming.pop(0)
            self.slip, self.coming_slip = self.slip + self.coming_slip, 0.0
            if self.counted < row.start:
                self.primitives.append(Row(self.counted, row.start, -1))
            self.primitives.append(row)
            self.counted = row.stop
            self.highest = max(self.highest, row.cluster)
            self.n_repetitions += 1
            events.append(self.repetition(row, self.n_repetitions, at_s))
        return events

    def uncounted(self, primitives: Sequence[Row], first: int) -> tuple[list[Row], float]:
        """Return the repetitions of an activity that are not final, and the change of phase.

        Two looks may cut the repetitions at different phases. Then the first repetition becomes
        shorter or longer, unless all such changes add up to half a repetition, which would change
        the count. In that case the adjoining repetitions are moved to the last final one.

        ``primitives`` are those of a look, ``first`` is the frame at which the activity begins in
        it. The change is the share of a repetition by which the first one became shorter; negative:
        longer.
        """
        rows = [
            row
            for row in primitives
            if row.cluster >= 0 and row.start >= first and row.stop > self.counted
        ]
        if not rows or rows[0].start >= self.counted:
            return rows, 0.0
        length = rows[0].stop - rows[0].start
        over = self.counted - rows[0].start
        if 2 * over > length:  # most of the first one is counted already: the second is the next
            over -= length
            rows = rows[1:]
        if not rows or rows[0].start > self.counted - min(over, 0):
            return rows, 0.0
        slip = over / length
        if abs(self.slip + slip) < MOST_SLIP:
            return [rows[0]._replace(start=self.counted), *rows[1:]], slip
        breaks = (i for i in range(1, len(rows)) if rows[i].start != rows[i - 1].stop)
        n = next(breaks, len(rows))
        end = rows[n - 1].stop  # the end stays, however short the last one becomes
        moved = [Row(row.start + over, min(row.stop + over, end), row.cluster) for row in rows[:n]]
        moved[-1] = moved[-1]._replace(stop=end)
        return [row for row in moved if row.start < row.stop] + rows[n:], 0.0

    def repetition(self, row: Row, number: int, at_s: float, state: State = "final") -> Repetition:
        """Return the event for a repetition."""
        return Repetition(
            at_s=at_s,
            state=state,
            number=number,
            start_s=row.start / self.fps,
            stop_s=row.stop / self.fps,
            cluster=row.cluster,
        )

    def last_activities(self, frame: int) -> list[Row]:
        """Return the activities that end after a frame; the open one ends at the frontier."""
        found = [Row(self.start, self.frontier, self.cluster)] if self.start < self.frontier else []
        for row in reversed(self.activities):
            if row.stop <= frame:
                break
            found.append(row)
        return found

    def columns(self) -> dict[str, list[str] | Ints]:
        """Return the columns of a segment table up to the frontier."""
        activities, primitives = list(self.activities), list(self.primitives)
        if self.start < self.frontier:
            activities.append(Row(self.start, self.frontier, self.cluster))
        if self.counted < self.frontier:
            primitives.append(Row(self.counted, self.frontier, -1))
        rows = np.array([*activities, *primitives], np.int64)
        levels = ["activity"] * len(activities) + ["primitive"] * len(primitives)
        active = rows[:, 2] >= 0
        return {
            "level": levels,
            "kind": [
                level if is_active else "transition"
                for level, is_active in zip(levels, active.tolist(), strict=True)
            ],
            "start_frame": rows[:, 0],
            "stop_frame": rows[:, 1],
            "cluster": rows[:, 2],
            "label": [self.labels.get(cluster, "") for cluster in rows[:, 2].tolist()],
        }
