"""Who a segment is, whatever becomes of its borders.

A page makes edits while others are still on their way, or while nobody answers. What they were
made on is then said by the identity of a segment, not by a frame that has moved meanwhile; a
border is the start of the segment after it. ``editing/identities.ts`` of the pages is the same
in TypeScript, for edits that the server has not answered yet.

An identity is a letter for the level, what the table or the segment came from, and where it
started then: ``p:120`` of the first table, ``p3f2a9c01:150`` made by the edit of that name.
Tables mostly have segments that never moved, so only the others are written down.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from typing import get_args

from kineme.segments.editing.annotating import span_of
from kineme.segments.segmentation import Segmentation
from kineme.segments.table import Level

LONGEST_ORIGIN = 8
"""Characters of an edit's name that are part of the identities of what it made."""


@dataclass(frozen=True)
class Identities:
    """The identities of the segments of one table.

    ``origin`` is the edit that made it, empty for one that was found; ``others`` has, by level and
    first frame (``p150``), identities of segments that came from or started elsewhere.
    """

    origin: str = ""
    others: dict[str, str] = field(default_factory=dict)

    def of(self, table: Segmentation) -> list[str]:
        """The identity of each row of the table.

        Examples
        --------
        >>> import kineme
        >>> from kineme.datasets import bundled_truth
        >>> Identities().of(kineme.read_segments(bundled_truth(), fps=60))[:2]
        ['a:0', 'a:326']
        """
        return [self.others.get(at, _identity(self.origin, at)) for at in _places(table)]

    def after(
        self, before: Segmentation, now: Segmentation, edit: str, *, replaced: bool = False
    ) -> Identities:
        """Those of the table that an edit makes of another.

        In one that is ``replaced``, who has the same frames is the same. Else it is who starts
        where it did, and of the others who started nearest by.
        """
        edit = edit[:LONGEST_ORIGIN]
        identities = dict(zip(_places(before), self.of(before), strict=True))
        if replaced:
            spans = {span_of(row) for row in before}
            same = {at: at for row, at in zip(now, _places(now), strict=True)
                    if span_of(row) in spans}  # fmt: skip
        else:
            same = {}
            for level in get_args(Level):
                starts = (table.level(level).start_frame.tolist() for table in (before, now))
                moves = descent(*starts).items()
                same |= {f"{level[0]}{start}": f"{level[0]}{was}" for start, was in moves}
        origin = edit if replaced else self.origin
        others = {}
        for at in _places(now):
            former = same.get(at)
            identity = _identity(edit, at) if former is None else identities[former]
            if identity != _identity(origin, at):
                others[at] = identity
        return Identities(origin, others)


def descent(before: Sequence[int], now: Iterable[int]) -> dict[int, int]:
    """Where the segments of a level that start at ``now`` started before; new ones are left out.

    Examples
    --------
    >>> descent([0, 30, 60], [0, 40, 60, 80])
    {0: 0, 40: 30, 60: 60}
    """
    now = list(now)
    staying = set(before) & set(now)
    moved = [start for start in before if start not in staying]
    found = {start: start for start in staying}
    for start in (each for each in now if each not in staying):
        low = max((each for each in staying if each < start), default=-1)
        high = min((each for each in staying if each > start), default=math.inf)
        near = [each for each in moved if low < each < high]
        if near:
            found[start] = min(near, key=lambda each: abs(each - start))
            moved = [each for each in moved if each > found[start]]
    return dict(sorted(found.items()))


def _places(table: Segmentation) -> list[str]:
    """Level and first frame of each row: ``p150``."""
    of_level = {level: level[0] for level in get_args(Level)}
    rows = zip(table.table.level.tolist(), table.table.start_frame.tolist(), strict=True)
    return [f"{of_level[level]}{start}" for level, start in rows]


def _identity(origin: str, place: str) -> str:
    return f"{place[0]}{origin}:{place[1:]}"
