"""Parts of recordings, searched sample by sample: here, or wherever an executor works."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from threadpoolctl import threadpool_limits

from kineme._threads import map_threads
from kineme.errors import KinemeError
from kineme.library.executors import Executor
from kineme.library.searching import spans_like
from kineme.library.storage.pieces import read_parts
from kineme.matching import Matches

Float32s = NDArray[np.float32]
Ints = NDArray[np.int64]

AT_ONCE = 1 << 15
"""Samples that are searched in one go."""
APART = 1e3
"""In each feature of a sample between two parts: no match reaches over it."""


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
    """Parts to be searched in one go, and the pieces that hold their recordings, by row."""

    folder: Path
    pieces: dict[int, str]
    parts: Parts
    sought: Sought


def matches_in(
    folder: Path,
    pieces: Sequence[str],
    parts: Parts,
    sought: Sought,
    executor: Executor | None,
) -> dict[int, Matches]:
    """The matches in parts of recordings by row, the best of each first.

    Parameters
    ----------
    folder : Path
        That holds the pieces.
    pieces : sequence of str
        Of all recordings.
    parts : Parts
    sought : Sought
    executor : Executor, optional
        Threads of this process by default.
    """
    tasks = [
        Task(folder, {row: pieces[row] for row in set(own.rows.tolist())}, own, sought)
        for own in _batches(parts)
    ]
    if executor is None:
        with threadpool_limits(1):  # tasks are searched side by side
            found = map_threads(search_parts, tasks)
    else:
        found = [_done(outcome) for _, outcome in executor.completed(search_parts, tasks)]
    joined: dict[int, list[Matches]] = {}
    for each in found:
        for row, matches in each.items():
            joined.setdefault(row, []).append(matches)
    return {row: _ordered(several) for row, several in sorted(joined.items())}


def search_parts(task: Task) -> dict[int, Matches]:
    """The matches in the parts of a task by row, the best of each first."""
    parts, sought = task.parts, task.sought
    lasts = parts.stops - parts.starts
    firsts = np.concatenate([[0], np.cumsum(lasts + 1)])
    laid = np.full((firsts[-1], sought.examples[0].shape[1]), APART, np.float32)
    for row, key in sorted(task.pieces.items()):
        own = np.flatnonzero(parts.rows == row)
        spans = zip(firsts[own].tolist(), (firsts[own] + lasts[own]).tolist(), strict=True)
        read_parts(task.folder, key, parts.starts[own].tolist(), [laid[a:b] for a, b in spans])
    matches = spans_like(
        laid,
        sought.examples,
        sought.counterexamples,
        threshold=sought.threshold,
        top=sought.top,
    )
    which = np.searchsorted(firsts, matches.starts, side="right") - 1
    back = parts.starts[which] - firsts[which]
    moved = Matches(matches.starts + back, matches.stops + back, matches.distances)
    rows = parts.rows[which]
    return {row: Matches(*(column[rows == row] for column in moved)) for row in set(rows.tolist())}


def _batches(parts: Parts) -> Iterator[Parts]:
    """Parts of about `AT_ONCE` samples together; one that is longer is alone."""
    reached = np.cumsum(parts.stops - parts.starts)
    which = (reached - (parts.stops - parts.starts)) // AT_ONCE
    edges = np.flatnonzero(np.diff(which, prepend=-1, append=-1))
    for first, stop in pairwise(edges.tolist()):
        yield Parts(*(column[first:stop] for column in parts))


def _done(outcome: dict[int, Matches] | None) -> dict[int, Matches]:
    if outcome is None:
        raise KinemeError("the processes that searched died: they may need more memory")
    return outcome


def _ordered(several: Sequence[Matches]) -> Matches:
    """Matches of one recording as one, the best first."""
    if len(several) == 1:
        return several[0]
    starts, stops, distances = (np.concatenate(column) for column in zip(*several, strict=True))
    order = np.lexsort((starts, distances))
    return Matches(starts[order], stops[order], distances[order])
