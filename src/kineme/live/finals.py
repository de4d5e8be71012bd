"""What is final of a stream, and how it grows.

Each look at the recent past gives rows for it. Those before the horizon become final: activities up
to the frontier, and the repetitions of the open activity as they end. A row that contradicts what
is final already begins at the frontier. A border must be found by two looks, or wait for the next.
An activity that does not repeat yet has no primitives yet: they become final when they are found.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np

from kineme._util.arrays import Ints
from kineme.live.events import ActivityEnded, ActivityStarted, Event, Repetition, State

MOST_SLIP = 0.5
"""Share of a repetition by which the phase may change in an activity."""
SHORTEST_S = 0.7
"""Seconds below which what is left of a row that contradicts the open activity is ignored."""
AGREEING_S = 0.5
"""Seconds by which two looks may differ in where an activity starts."""
SAME_END = 0.25
"""Share of a repetition by which two looks may differ in where it ends."""


class Row(NamedTuple):
    """Frames [start, stop) of the stream in a cluster; -1 for transitions."""

    start: int
    stop: int
    cluster: int


class Look(NamedTuple):
    """What one look at the recent past found: rows of both levels that tile it."""

    activities: list[Row]
    primitives: list[Row]

    def has_activity(self, row: Row, near: float) -> bool:
        """Return whether an activity of this cluster starts within so many frames of a row."""
        return any(
            each.cluster == row.cluster and abs(each.start - row.start) <= near
            for each in self.activities
        )

    def has_repetition(self, row: Row) -> bool:
        """Return whether a repetition ends where a row does, give or take a share of it."""
        near = SAME_END * (row.stop - row.start)
        return any(
            each.cluster >= 0 and abs(each.stop - row.stop) <= near for each in self.primitives
        )


class Looks(NamedTuple):
    """What one look found, and when.

    Attributes
    ----------
    look, before : Look
        The present one, and the one before, which must agree; None if none must.
    horizon : int
        The frame before which rows become final.
    patience : int
        Frames by which a row may be older than that, and is then final although looks disagree.
    now : int
        Frame at which the look was taken.
    """

    look: Look
    before: Look | None
    horizon: int
    patience: int
    now: int


@dataclass
class Finals:
    """Rows that do not change any more, and the activity that is open.

    Attributes
    ----------
    fps : float
        Frames per second.
    activities, primitives : list of Row
        Of activities that are over.
    start, cluster : int
        Of the open activity; a cluster of -1 is a transition.
    counted : int
        The frame up to which the primitives of the open activity are known.
    n_repetitions : int
        Its repetitions so far.
    slip : float
        Share of a repetition by which their phase has changed.
    frontier : int
        The frame up to which activities are final.
    highest : int
        The largest cluster so far.
    labels : dict of int to str
        Names of known clusters.
    """

    fps: float
    activities: list[Row] = field(default_factory=list)
    primitives: list[Row] = field(default_factory=list)
    start: int = 0
    cluster: int = -1
    counted: int = 0
    n_repetitions: int = 0
    slip: float = 0.0
    frontier: int = 0
    highest: int = -1
    labels: dict[int, str] = field(default_factory=dict)

    def advance(self, looks: Looks) -> list[Event]:
        """Make final what lies before the horizon; return the events."""
        events: list[Event] = []
        at_s = looks.now / self.fps
        for row in looks.look.activities:
            begin = max(row.start, self.frontier)
            if row.stop <= begin:
                continue
            if begin >= looks.horizon:
                break
            if row.cluster != self.cluster or not self.frontier:
                is_late = row.start < self.frontier
                left = row.stop - begin
                if is_late and left < SHORTEST_S * self.fps and row.stop < looks.now:
                    self.frontier = min(row.stop, looks.horizon)
                    continue
                if self.frontier and not self._agree(row, looks):
                    self.frontier = begin
                    break
                events += self.close(begin, at_s)
                self._open(begin, row.cluster, at_s, events)
            self.frontier = min(row.stop, looks.horizon)
            self._count(row.start, looks, events)
        return events

    def _agree(self, row: Row, looks: Looks) -> bool:
        """Return whether two looks have an activity, and it does not contradict what is final."""
        if looks.before is None or max(row.start, self.frontier) <= looks.horizon - looks.patience:
            return True
        near = AGREEING_S * self.fps
        return row.start >= self.frontier - near and looks.before.has_activity(row, near)

    def close(self, stop: int, at_s: float) -> list[Event]:
        """End the open activity at a frame."""
        self.frontier = max(self.frontier, stop)
        if stop <= self.start:
            return []
        if self.counted < stop:
            self.primitives.append(Row(self.counted, stop, -1))
        self.activities.append(Row(self.start, stop, self.cluster))
        start, cluster = self.start, self.cluster
        n_repetitions = self.n_repetitions
        self.start = self.counted = stop
        self.cluster, self.n_repetitions, self.slip = -1, 0, 0.0
        if cluster < 0:
            return []
        return [
            ActivityEnded(
                at_s=at_s,
                start_s=start / self.fps,
                stop_s=stop / self.fps,
                cluster=cluster,
                repetitions=n_repetitions,
                label=self.labels.get(cluster, ""),
            )
        ]

    def _open(self, start: int, cluster: int, at_s: float, events: list[Event]) -> None:
        self.start = self.counted = start
        self.cluster, self.n_repetitions, self.slip = cluster, 0, 0.0
        self.highest = max(self.highest, cluster)
        if cluster >= 0:
            label = self.labels.get(cluster, "")
            events.append(
                ActivityStarted(at_s=at_s, start_s=start / self.fps, cluster=cluster, label=label)
            )

    def _count(self, first: int, looks: Looks, events: list[Event]) -> None:
        """Make final the repetitions of the open activity that end before the frontier."""
        rows, slip = self.uncounted(looks.look.primitives, first)
        for row in rows:
            is_old = looks.before is None or row.stop <= looks.horizon - looks.patience
            agreed = is_old or (looks.before and looks.before.has_repetition(row))
            if row.stop > self.frontier or not agreed:
                break
            self.slip, slip = self.slip + slip, 0.0
            if self.counted < row.start:
                self.primitives.append(Row(self.counted, row.start, -1))
            self.primitives.append(row)
            self.counted = row.stop
            self.highest = max(self.highest, row.cluster)
            self.n_repetitions += 1
            events.append(self.repetition(row, self.n_repetitions, looks.now / self.fps))

    def uncounted(self, primitives: Sequence[Row], first: int) -> tuple[list[Row], float]:
        """Return the repetitions of an activity that are not final, and the change of phase.

        Looks may cut at different phases. Then the first repetition is shorter or longer, as long
        as all such changes do not add up to half a repetition: else they would be counted. Beyond
        that the repetitions that touch each other are moved to where the last one ended.

        Parameters
        ----------
        primitives : sequence of Row
            Of a look.
        first : int
            The frame at which the activity begins there.

        Returns
        -------
        rows : list of Row
        slip : float
            Share of a repetition by which the first one is shorter, below 0 if it is longer.
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
        if 2 * over > length:  # it is counted: the second one begins earlier or late
            over -= length
            rows = rows[1:]
        if not rows or rows[0].start > self.counted - min(over, 0):
            return rows, 0.0
        slip = over / length
        if abs(self.slip + slip) < MOST_SLIP:
            return [rows[0]._replace(start=self.counted), *rows[1:]], slip
        apart = (i for i in range(1, len(rows)) if rows[i].start != rows[i - 1].stop)
        n = next(apart, len(rows))
        end = rows[n - 1].stop  # which stays, be the last one ever so short
        moved = [Row(row.start + over, min(row.stop + over, end), row.cluster) for row in rows[:n]]
        moved[-1] = moved[-1]._replace(stop=end)
        return [row for row in moved if row.start < row.stop] + rows[n:], 0.0

    def repetition(self, row: Row, number: int, at_s: float, state: State = "final") -> Repetition:
        """Return the event of a repetition."""
        return Repetition(
            at_s=at_s,
            state=state,
            number=number,
            start_s=row.start / self.fps,
            stop_s=row.stop / self.fps,
            cluster=row.cluster,
        )

    def last_activities(self, frame: int) -> list[Row]:
        """Return the activities that reach beyond a frame, the open one up to the frontier."""
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
