"""Where to look first in a large library: windows of its recordings in 32 numbers each.

`kineme.library.windows` tells what these numbers are, `kineme.library.storage.index` holds those of
a whole library. The few windows that are like an example are found first, and only the parts of
recordings around these are searched sample by sample: here, or wherever an executor works.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from threadpoolctl import threadpool_limits

from kineme._util.arrays import Float32s, Ints
from kineme._util.parallel import map_threads
from kineme.errors import KinemeError
from kineme.library._kernels import least_squares
from kineme.library.executors import Executor
from kineme.library.searching import spans_like
from kineme.library.storage.analyses import read_parts
from kineme.library.storage.index import Windows
from kineme.library.windows import FINER, parts_at_speeds, step
from kineme.transfer.subsequences import Matches

SHARE = 0.01
"""Of the windows, that are searched sample by sample."""
MORE = 20
"""Windows for each hit that is wanted, at least."""
BLOCK = 1 << 16
"""Windows that are compared at a time."""


AT_ONCE = 1 << 15
"""Samples that are searched in one go."""
APART = 1e3
"""Value of each feature between two parts: no match crosses it."""


class Parts(NamedTuple):
    """Parts [start, stop) of recordings, in samples, in the order of the recordings."""

    rows: Ints
    starts: Ints
    stops: Ints


@dataclass(frozen=True, eq=False)
class Sought:
    """What is searched for.

    Attributes
    ----------
    examples, counterexamples : sequence of (samples, dims) array
    threshold : float
    top : int, optional
        Matches at most, in all parts of a task together.
    """

    examples: Sequence[Float32s]
    counterexamples: Sequence[Float32s]
    threshold: float
    top: int | None


@dataclass(frozen=True, eq=False)
class Task:
    """Parts to be searched in one go, and the analyses that hold their recordings, by row."""

    folder: Path
    analyses: dict[int, str]
    parts: Parts
    sought: Sought


def parts_like(windows: Windows, example: Float32s, top: int) -> Parts:
    """Return the parts of recordings around the windows that are nearest to an example."""
    near = _nearest(windows, parts_at_speeds(example), top)
    rows = np.searchsorted(windows.firsts, near, side="right") - 1
    middles = (near - windows.firsts[rows]) * step(windows.length) + windows.length // 2
    reach = step(windows.length) + len(example)  # a match may last twice as long
    lasts = windows.samples[rows]
    return merge_overlapping(
        Parts(rows, np.clip(middles - reach, 0, lasts), np.clip(middles + reach, 0, lasts))
    )


def merge_overlapping(parts: Parts) -> Parts:
    """Parts that overlap as one."""
    order = np.lexsort((parts.starts, parts.rows))
    rows, starts, stops = (column[order] for column in parts)
    far = int(stops.max(initial=0)) + 1
    reached = np.maximum.accumulate(stops + rows * far)  # beyond the end of recordings before
    new = np.ones(len(rows), np.bool_)
    new[1:] = starts[1:] + rows[1:] * far > reached[:-1]
    first = np.flatnonzero(new)
    last = np.append(first[1:], len(rows)) - 1 if len(rows) else first
    return Parts(rows[first], starts[first], reached[last] - rows[first] * far)


def matches_in(
    folder: Path,
    analyses: Sequence[str],
    parts: Parts,
    sought: Sought,
    executor: Executor | None,
) -> dict[int, Matches]:
    """Return the matches in parts of recordings by row, the best of each first."""
    tasks = [
        Task(folder, {row: analyses[row] for row in set(batch.rows.tolist())}, batch, sought)
        for batch in _batches(parts)
    ]
    if executor is None:
        with threadpool_limits(1):  # tasks are searched side by side
            found = map_threads(search_parts, tasks)
    else:
        found = [_matches(outcome) for _, outcome in executor.completed(search_parts, tasks)]
    by_row: dict[int, list[Matches]] = {}
    for each in found:
        for row, matches in each.items():
            by_row.setdefault(row, []).append(matches)
    return {row: _order_matches(several) for row, several in sorted(by_row.items())}


def search_parts(task: Task) -> dict[int, Matches]:
    """Return the matches in the parts of a task by row, the best of each first."""
    parts, sought = task.parts, task.sought
    lasts = parts.stops - parts.starts
    firsts = np.concatenate([[0], np.cumsum(lasts + 1)])
    features = np.full((firsts[-1], sought.examples[0].shape[1]), APART, np.float32)
    for row, key in sorted(task.analyses.items()):
        at = np.flatnonzero(parts.rows == row)
        spans = zip(firsts[at].tolist(), (firsts[at] + lasts[at]).tolist(), strict=True)
        read_parts(task.folder, key, parts.starts[at].tolist(), [features[a:b] for a, b in spans])
    matches = spans_like(
        features,
        sought.examples,
        sought.counterexamples,
        threshold=sought.threshold,
        top=sought.top,
    )
    owners = np.searchsorted(firsts, matches.starts, side="right") - 1
    offsets = parts.starts[owners] - firsts[owners]
    moved = Matches(matches.starts + offsets, matches.stops + offsets, matches.distances)
    rows = parts.rows[owners]
    return {row: Matches(*(column[rows == row] for column in moved)) for row in set(rows.tolist())}


def _nearest(windows: Windows, parts: NDArray[np.int32], top: int) -> Ints:
    """Return the windows that are nearest to any part of an example, in their order."""
    n = len(windows.embedded)
    least = np.empty(n, np.int32)

    def compare(first: int) -> None:
        block = slice(first, first + BLOCK)
        least_squares(np.asarray(windows.embedded[block]), parts, np.int32(FINER), least[block])

    map_threads(compare, range(0, n, BLOCK))
    most = min(max(round(SHARE * n), MORE * top), n)
    chosen: NDArray[np.int64] = np.sort(np.argpartition(least, most - 1)[:most])
    return chosen


def _batches(parts: Parts) -> Iterator[Parts]:
    """Parts of about `AT_ONCE` samples together; one that is longer is alone."""
    reached = np.cumsum(parts.stops - parts.starts)
    batches = (reached - (parts.stops - parts.starts)) // AT_ONCE
    edges = np.flatnonzero(np.diff(batches, prepend=-1, append=-1))
    for first, stop in pairwise(edges.tolist()):
        yield Parts(*(column[first:stop] for column in parts))


def _matches(outcome: dict[int, Matches] | None) -> dict[int, Matches]:
    if outcome is None:
        raise KinemeError("the processes that searched died: they may need more memory")
    return outcome


def _order_matches(several: Sequence[Matches]) -> Matches:
    """Matches of one recording as one, the best first."""
    if len(several) == 1:
        return several[0]
    starts, stops, distances = (np.concatenate(column) for column in zip(*several, strict=True))
    order = np.lexsort((starts, distances))
    return Matches(starts[order], stops[order], distances[order])
