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
from kineme.segments.table import Level, Segment

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
        return [self.others.get(_place(row), _identity(self.origin, row)) for row in table]

    def after(
        self, before: Segmentation, now: Segmentation, edit: str, *, replaced: bool = False
    ) -> Identities:
        """Those of the table that an edit makes of another.

        In one that is ``replaced``, who has the same frames is the same. Else it is who starts
        where it did, and of the others who started nearest by.
        """
        edit = edit[:LONGEST_ORIGIN]
        identities = dict(zip(map(_key, before), self.of(before), strict=True))
        if replaced:
            spans = {span_of(row) for row in before}
            same = {_key(row): _key(row) for row in now if span_of(row) in spans}
        else:
            same = {}
            for level in get_args(Level):
                starts = (table.level(level).start_frame.tolist() for table in (before, now))
                same |= {(level, n): (level, was) for n, was in descent(*starts).items()}
        origin = edit if replaced else self.origin
        others = {}
        for row in now:
            former = same.get(_key(row))
            identity = _identity(edit, row) if former is None else identities[former]
            if identity != _identity(origin, row):
                others[_place(row)] = identity
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


def _key(row: Segment) -> tuple[Level, int]:
    return row.level, row.start_frame


def _place(row: Segment) -> str:
    return f"{row.level[0]}{row.start_frame}"


def _identity(origin: str, row: Segment) -> str:
    return f"{row.level[0]}{origin}:{row.start_frame}"
