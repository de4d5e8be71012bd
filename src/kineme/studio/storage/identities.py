"""Who a segment is, whatever becomes of its borders.

A page takes edits while others are still on their way. What they were made on is then said by the
identity of a segment, not by a frame that has moved meanwhile; a border is the start of the segment
after it.

An identity is a letter for the level, what the table or the segment came from, and where it
started then: ``p:120`` of the first table, ``p3f2a9c01:150`` made by the edit of that name.
Tables mostly have segments that never moved, so only the others are written down.
"""

from __future__ import annotations

import math
from bisect import bisect, bisect_left
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import get_args

from kineme.segments.editing.annotating import span_of
from kineme.segments.segmentation import Segmentation
from kineme.segments.table import Level

LONGEST_ORIGIN = 8
"""Characters of an edit's name that are part of the identities of what it made."""


@dataclass(frozen=True)
class Identities:
    """Identities of the segments of one table.

    ``origin`` is the edit that made it, empty for one that was found; ``others`` has, by level and
    first frame (``p150``), identities of segments that came from or started elsewhere.
    """

    origin: str = ""
    others: dict[str, str] = field(default_factory=dict)

    def of(self, table: Segmentation) -> list[str]:
        """Return the identity of each row of the table.

        Examples
        --------
        >>> import kineme
        >>> from kineme.datasets import bundled_truth
        >>> Identities().of(kineme.read_segments(bundled_truth(), fps=60))[:2]
        ['a:0', 'a:326']
        """
        found: list[str] = []
        for level in get_args(Level):
            starts, first = table.level(level).start_frame.tolist(), len(found)
            made = _identity(self.origin, level[0])
            found += [f"{made}{start}" for start in starts]
            for place, identity in self.others.items():
                # Starts ascend, so a place is found by bisection.
                row = bisect_left(starts, int(place[1:]))
                if place[0] == level[0] and row < len(starts) and starts[row] == int(place[1:]):
                    found[first + row] = identity
        return found

    def after(
        self, before: Segmentation, now: Segmentation, edit: str, *, replaced: bool = False
    ) -> Identities:
        """Those of the table that an edit makes of another.

        In one that is ``replaced``, who has the same frames is the same. Else it is who starts
        where it did, and of the others who started nearest by.
        """
        edit = edit[:LONGEST_ORIGIN]
        if replaced:
            spans = {span_of(row) for row in before}
            same = {at: self._at(at) for row, at in zip(now, _places(now), strict=True)
                    if span_of(row) in spans}  # fmt: skip
            return Identities(edit, same)
        others = dict(self.others)
        for level in get_args(Level):
            was, starts = (table.level(level).start_frame.tolist() for table in (before, now))
            moves = descent(was, starts)
            # Segments that are gone take their identities along.
            for start in {*was}.difference(starts):
                others.pop(f"{level[0]}{start}", None)
            for start in {*starts}.difference(was):
                at, former = f"{level[0]}{start}", moves.get(start)
                moved = None if former is None else self._at(f"{level[0]}{former}")
                identity = moved or _identity(edit, at)
                # Identities that follow from the place need not be written down.
                if identity != _identity(self.origin, at):
                    others[at] = identity
        return Identities(self.origin, others)

    def _at(self, place: str) -> str:
        """Who is at a place."""
        return self.others.get(place) or _identity(self.origin, place)


def descent(before: Sequence[int], now: Sequence[int]) -> dict[int, int]:
    """Where the segments of a level that start at ``now`` started before; new ones are left out.

    Both ascend.

    Examples
    --------
    >>> descent([0, 30, 60], [0, 40, 60, 80])
    {0: 0, 40: 30, 60: 60}
    """
    staying = sorted({*before}.intersection(now))
    found = {start: start for start in staying}
    moved = [start for start in before if start not in found]
    for start in [each for each in now if each not in found]:
        place = bisect(staying, start)
        # Between its neighbours that stayed; it cannot have come from beyond them.
        low = staying[place - 1] if place else -1
        high = staying[place] if place < len(staying) else math.inf
        near = [each for each in moved if low < each < high]
        if near:
            found[start] = min(near, key=lambda each: abs(each - start))
            # In order: the next one comes from further on.
            moved = [each for each in moved if each > found[start]]
    return dict(sorted(found.items()))


def _places(table: Segmentation) -> list[str]:
    """Level and first frame of each row: ``p150``."""
    of_level = {level: level[0] for level in get_args(Level)}
    rows = zip(table.table.level.tolist(), table.table.start_frame.tolist(), strict=True)
    return [f"{of_level[level]}{start}" for level, start in rows]


def _identity(origin: str, place: str) -> str:
    return f"{place[0]}{origin}:{place[1:]}"
