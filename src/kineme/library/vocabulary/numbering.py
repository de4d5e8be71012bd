"""Numbers that stay: a cluster that is found again has the number that it had.

A new cluster takes the number of the old one whose time it shares most, seconds of activities in
recordings that both know; each number goes to one of them. All others get numbers that were never
given.

A recording that is taken out of a library and put back gets the numbers and names of its clusters
again: they are kept by its content, whatever its name is then.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Mapping
from pathlib import Path

import numpy as np

from kineme._util.arrays import Floats, Ints
from kineme._util.checks import is_number
from kineme.errors import ReadError
from kineme.library.storage.layout import MOST_CLUSTERS, read_json, write_json

Spans = tuple[Floats, Floats, Ints]
"""Starts and stops in seconds, and clusters, of the activities of a recording; apart."""
REMOVED = "left.json"
Removed = Mapping[str, Spans]
"""Starts, stops and clusters of the activities of a recording, by the name of its analysis."""


def lasting_numbers(
    old: Mapping[str, Spans], new: Mapping[str, Spans], *, following: int
) -> dict[int, int]:
    """Return the number of each new cluster.

    Examples
    --------
    >>> import numpy as np
    >>> starts, stops = np.array([0.0, 5.0]), np.array([5.0, 9.0])
    >>> old = {"a": (starts, stops, np.array([4, 2]))}
    >>> new = {"a": (starts, stops, np.array([0, 1])), "b": (starts, stops, np.array([1, 2]))}
    >>> lasting_numbers(old, new, following=7)
    {0: 4, 1: 2, 2: 7}
    """
    shared: defaultdict[tuple[int, int], float] = defaultdict(float)
    for recording in old.keys() & new.keys():
        (starts, stops, before), (begins, ends, now) = old[recording], new[recording]
        first = np.maximum(starts[:, None], begins[None])
        overlap = np.minimum(stops[:, None], ends[None]) - first
        for i, j in np.argwhere((overlap > 0) & (before[:, None] >= 0) & (now[None] >= 0)):
            shared[int(before[i]), int(now[j])] += round(float(overlap[i, j]), 6)
    numbers: dict[int, int] = {}
    for (number, cluster), _ in sorted(shared.items(), key=lambda pair: (-pair[1], pair[0])):
        if cluster not in numbers and number not in numbers.values():
            numbers[cluster] = number
    for cluster in sorted({int(c) for _, _, clusters in new.values() for c in clusters} - {-1}):
        if cluster not in numbers:
            numbers[cluster], following = following, following + 1
    return dict(sorted(numbers.items()))


def read_removed(folder: Path) -> dict[str, Spans]:
    """Return the activities of recordings that were taken out, by key."""
    path = folder / REMOVED
    return {key: _spans(columns, path) for key, columns in read_json(path).items()}


def write_removed(folder: Path, removed: Removed) -> None:
    """Keep them for the next build."""
    content = {key: [column.tolist() for column in spans] for key, spans in removed.items()}
    if content or (folder / REMOVED).exists():
        write_json(folder / REMOVED, content)


def removed_after(removed: Removed, before: Removed, present: Iterable[str]) -> dict[str, Spans]:
    """Return the activities of recordings that are not present any more, by key."""
    names = set(present)
    return {key: spans for key, spans in {**removed, **before}.items() if key not in names}


def _spans(content: object, path: Path) -> Spans:
    columns = content if isinstance(content, list) else []
    if len(columns) == 3 and all(isinstance(column, list) for column in columns):
        same = len({len(column) for column in columns}) == 1
        if same and all(is_number(number) for column in columns for number in column):
            starts, stops, clusters = columns
            if all(isinstance(c, int) and -1 <= c < MOST_CLUSTERS for c in clusters):
                return np.array(starts, float), np.array(stops, float), np.array(clusters, np.int64)
    raise ReadError(
        path, "is damaged: remove it; clusters of recordings that come back get new numbers then"
    )
