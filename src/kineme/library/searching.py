"""Search recordings for spans similar to examples, but not to counter-examples.

In a large library an index finds the windows nearest to an example first
(`kineme.library.windows`, `kineme.library.storage.index`). Only the parts of recordings around
these are searched sample by sample, in this process or by an executor.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise
from os import PathLike
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from threadpoolctl import threadpool_limits

from kineme._util.arrays import Float32s, Ints
from kineme._util.checks import is_number
from kineme._util.parallel import map_threads
from kineme.errors import KinemeError, ParameterError
from kineme.library._kernels import find_smallest_distances
from kineme.library.executors import Executor
from kineme.library.storage.analyses import read_parts
from kineme.library.storage.index import Windows
from kineme.library.windows import FINER, compute_step, describe_at_speeds
from kineme.recordings import Motion, Signals
from kineme.transfer.subsequences import Matches, search

REFUSED = 0.5
"""Fraction of a match that a nearer match of a counter-example must cover to reject it."""


class Named(str):
    """Name of a recording of the library, even if a file has the same name."""

    __slots__ = ()


@dataclass(frozen=True)
class Example:
    """A span of a recording to search for.

    Parameters
    ----------
    recording : path-like, Motion or Signals
        A file, the name of a recording of the library, or a loaded recording.
    start_s, stop_s : float, optional
        Seconds; the whole recording by default.

    Examples
    --------
    >>> Example("walk.bvh", 2.1, 3.4).stop_s
    3.4
    """

    recording: str | PathLike[str] | Motion | Signals
    start_s: float = 0.0
    stop_s: float | None = None

    def __post_init__(self) -> None:
        if not isinstance(self.recording, str | PathLike | Motion | Signals):
            raise ParameterError(
                f"an example is a file, a name or a recording, not {self.recording!r:.60}"
            )
        stop = np.inf if self.stop_s is None else self.stop_s
        numbers = is_number(self.start_s) and (self.stop_s is None or is_number(stop))
        if not numbers or not 0 <= self.start_s < stop:
            raise ParameterError(
                f"an example must stop after it starts, not last from {self.start_s!r:.20} "
                f"to {self.stop_s!r:.20}"
            )


class Hit(NamedTuple):
    """A span of a recording that is similar to an example.

    Attributes
    ----------
    recording : str
    start_s, stop_s : float
    distance : float
        0 for equal movements.
    cluster : int
        Cluster of the segment that covers most of it, -1 for none.
    label : str
        Name of that cluster.

    Examples
    --------
    >>> hit = Hit("walk.bvh", 2.0, 3.2, 0.4, 7, "step")
    >>> round(hit.stop_s - hit.start_s, 1), hit.label
    (1.2, 'step')
    """

    recording: str
    start_s: float
    stop_s: float
    distance: float
    cluster: int
    label: str


def find_matches(
    features: Float32s,
    examples: Sequence[Float32s],
    counterexamples: Sequence[Float32s],
    *,
    threshold: float,
    top: int | None,
) -> Matches:
    """Return disjoint spans of a recording that are similar to any example.

    Spans that are nearer to a counter-example are rejected.
    """
    matches = _merge_matches(features, examples, threshold, None if counterexamples else top)
    if counterexamples and len(matches.starts):
        others = _merge_matches(features, counterexamples, threshold, None)
        # (matches, others): samples shared by each pair of spans.
        first = np.maximum(matches.starts[:, None], others.starts[None])
        shared = np.minimum(matches.stops[:, None], others.stops[None]) - first
        covers = shared >= REFUSED * (matches.stops - matches.starts)[:, None]
        nearer = others.distances[None] < matches.distances[:, None]
        rows = np.flatnonzero(~(covers & nearer).any(axis=1))
        matches = _select_rows(matches, rows)
    return _select_rows(matches, slice(top))


def choose_best(
    found: Sequence[Matches], *, top: int | None, most: int | None
) -> list[tuple[int, tuple[int, int, float]]]:
    """Return the recording, and start, stop and distance, of the nearest spans.

    At most ``most`` spans of each recording.
    """
    spans = [
        (distance, i, start, stop)
        for i, each in enumerate(found)
        for start, stop, distance in zip(*(column[:most].tolist() for column in each), strict=True)
    ]
    return [(i, (start, stop, distance)) for distance, i, start, stop in sorted(spans)[:top]]


def _merge_matches(
    features: Float32s, examples: Sequence[Float32s], threshold: float, top: int | None
) -> Matches:
    """Return disjoint spans that are similar to any example, the best first."""
    several = [search(example, features, threshold=threshold, top=top) for example in examples]
    if len(several) == 1:
        return several[0]
    ordered = _order_matches(several)
    covered = np.zeros(len(features), np.bool_)
    chosen = []
    for i, span in enumerate(map(slice, ordered.starts.tolist(), ordered.stops.tolist())):
        if not covered[span].any():
            covered[span] = True
            chosen.append(i)
    return _select_rows(ordered, np.array(chosen, np.int64))


def _select_rows(matches: Matches, rows: slice | Ints) -> Matches:
    return Matches(matches.starts[rows], matches.stops[rows], matches.distances[rows])


SHARE = 0.01
"""Fraction of the windows around which samples are searched."""
MORE = 20
"""Least number of windows per wanted hit."""
BLOCK = 1 << 16
"""Number of windows compared at a time."""


BATCH_SAMPLES = 1 << 15
"""Samples that are searched at a time."""
BETWEEN_PARTS = 1e3
"""Value of all features between two parts, which no match can cross."""


class Parts(NamedTuple):
    """Parts [start, stop) of recordings in samples, sorted by recording."""

    rows: Ints
    starts: Ints
    stops: Ints


@dataclass(frozen=True, eq=False)
class Query:
    """Query: features (samples, dims) of examples; at most ``top`` matches per task."""

    examples: Sequence[Float32s]
    counterexamples: Sequence[Float32s]
    threshold: float
    top: int | None


@dataclass(frozen=True, eq=False)
class Task:
    """Parts to search together, and the analysis keys of their recordings by row."""

    folder: Path
    analyses: dict[int, str]
    parts: Parts
    query: Query


def find_parts(windows: Windows, example: Float32s, top: int) -> Parts:
    """Return the parts of recordings around the windows that are nearest to an example."""
    nearest = _find_nearest(windows, describe_at_speeds(example), top)
    rows = np.searchsorted(windows.firsts, nearest, side="right") - 1
    middles = (nearest - windows.firsts[rows]) * compute_step(windows.length) + windows.length // 2
    reach = compute_step(windows.length) + len(example)  # a match may be twice as long
    lasts = windows.samples[rows]
    return merge_overlapping(
        Parts(rows, np.clip(middles - reach, 0, lasts), np.clip(middles + reach, 0, lasts))
    )


def merge_overlapping(parts: Parts) -> Parts:
    """Merge parts that overlap or touch."""
    order = np.lexsort((parts.starts, parts.rows))
    rows, starts, stops = (column[order] for column in parts)
    far = int(stops.max(initial=0)) + 1
    # Offsets by row keep the parts of different recordings apart in one running maximum.
    reached = np.maximum.accumulate(stops + rows * far)
    new = np.ones(len(rows), np.bool_)
    new[1:] = starts[1:] + rows[1:] * far > reached[:-1]
    first = np.flatnonzero(new)
    last = np.append(first[1:], len(rows)) - 1 if len(rows) else first
    return Parts(rows[first], starts[first], reached[last] - rows[first] * far)


def find_matches_in_parts(
    folder: Path,
    analyses: Sequence[str],
    parts: Parts,
    query: Query,
    executor: Executor | None,
) -> dict[int, Matches]:
    """Return the matches in parts of recordings by row, the best first."""
    tasks = [
        Task(folder, {row: analyses[row] for row in set(batch.rows.tolist())}, batch, query)
        for batch in _make_batches(parts)
    ]
    if executor is None:
        with threadpool_limits(1):  # tasks use all cores already
            outcomes = map_threads(search_parts, tasks)
    else:
        outcomes = [
            _require_outcome(outcome) for _, outcome in executor.completed(search_parts, tasks)
        ]
    by_row: dict[int, list[Matches]] = {}
    for each in outcomes:
        for row, matches in each.items():
            by_row.setdefault(row, []).append(matches)
    return {row: _order_matches(several) for row, several in sorted(by_row.items())}


def search_parts(task: Task) -> dict[int, Matches]:
    """Return the matches in the parts of a task by row, the best first."""
    parts, query = task.parts, task.query
    lasts = parts.stops - parts.starts
    # Concatenate all parts, separated by one sample that matches nothing.
    firsts = np.concatenate([[0], np.cumsum(lasts + 1)])
    features = np.full((firsts[-1], query.examples[0].shape[1]), BETWEEN_PARTS, np.float32)
    for row, key in sorted(task.analyses.items()):
        at = np.flatnonzero(parts.rows == row)
        spans = zip(firsts[at].tolist(), (firsts[at] + lasts[at]).tolist(), strict=True)
        read_parts(task.folder, key, parts.starts[at].tolist(), [features[a:b] for a, b in spans])
    matches = find_matches(
        features,
        query.examples,
        query.counterexamples,
        threshold=query.threshold,
        top=query.top,
    )
    # Convert positions in the concatenation back to samples of recordings.
    owners = np.searchsorted(firsts, matches.starts, side="right") - 1
    offsets = parts.starts[owners] - firsts[owners]
    moved = Matches(matches.starts + offsets, matches.stops + offsets, matches.distances)
    rows = parts.rows[owners]
    return {row: Matches(*(column[rows == row] for column in moved)) for row in set(rows.tolist())}


def _find_nearest(windows: Windows, parts: NDArray[np.int32], top: int) -> Ints:
    """Return the indices of the windows nearest to any part of an example, sorted."""
    n = len(windows.embedded)
    least = np.empty(n, np.int32)

    def compare(first: int) -> None:
        block = slice(first, first + BLOCK)
        find_smallest_distances(
            np.asarray(windows.embedded[block]), parts, np.int32(FINER), least[block]
        )

    map_threads(compare, range(0, n, BLOCK))
    most = min(max(round(SHARE * n), MORE * top), n)
    # `argpartition` finds the smallest distances without sorting all.
    chosen: NDArray[np.int64] = np.sort(np.argpartition(least, most - 1)[:most])
    return chosen


def _make_batches(parts: Parts) -> Iterator[Parts]:
    """Yield batches of parts with about `BATCH_SAMPLES` samples; a longer part is alone."""
    reached = np.cumsum(parts.stops - parts.starts)
    batches = (reached - (parts.stops - parts.starts)) // BATCH_SAMPLES
    # Borders between batches, including both ends.
    edges = np.flatnonzero(np.diff(batches, prepend=-1, append=-1))
    for first, stop in pairwise(edges.tolist()):
        yield Parts(*(column[first:stop] for column in parts))


def _require_outcome(outcome: dict[int, Matches] | None) -> dict[int, Matches]:
    if outcome is None:
        raise KinemeError("the search processes died: they may need more memory")
    return outcome


def _order_matches(several: Sequence[Matches]) -> Matches:
    """Merge matches of one recording, the best first."""
    if len(several) == 1:
        return several[0]
    starts, stops, distances = (np.concatenate(column) for column in zip(*several, strict=True))
    order = np.lexsort((starts, distances))
    return Matches(starts[order], stops[order], distances[order])
