"""Recordings with gaps: the stretches that were seen are analysed as one, and put back in place.

Working frames, those of the analysis, count through the stretches as if there
were nothing between them, so that what repeats itself is found wherever it is.
Source frames are those of the recording. A segment that reaches over the end of
a stretch becomes two, and each gap is a transition of its own.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import ceil, floor
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from kineme.graph import NeighborGraph

Columns = dict[str, NDArray[Any]]
Spans = Sequence[tuple[int, int]]


@dataclass(frozen=True)
class Part:
    """A stretch that was seen.

    Parameters
    ----------
    start, stop : its source frames
    n_working : how many working frames it has
    """

    start: int
    stop: int
    n_working: int


def in_source_frames(
    columns: Columns, parts: Sequence[Part], n_frames: int, ratio: float
) -> Columns:
    """The columns in source frames, cut at the ends of the parts, gaps filled with transitions.

    Rows that vanish at the rate of the source are left out.

    Parameters
    ----------
    columns : of a segment table, ``start_frame`` and ``stop_frame`` in working frames
    parts : in time order
    n_frames : of the recording
    ratio : source frames in one working frame
    """
    rows: list[NDArray[np.intp]] = []
    starts: list[NDArray[np.int64]] = []
    stops: list[NDArray[np.int64]] = []
    first = 0
    for part in parts:
        last = first + part.n_working
        begin = np.maximum(columns["start_frame"], first)
        end = np.minimum(columns["stop_frame"], last)
        inside = np.flatnonzero(begin < end)
        begin, end = begin[inside], end[inside]
        at = part.start + np.rint((begin - first) * ratio).astype(np.int64)
        to = part.start + np.rint((end - first) * ratio).astype(np.int64)
        rows.append(inside)
        starts.append(at)
        stops.append(np.where(end == last, part.stop, to))
        first = last
    row, start, stop = map(np.concatenate, (rows, starts, stops))
    # At low frame rates two borders may fall on the same frame.
    full = start < stop
    taken = {name: column[row[full]] for name, column in columns.items()}
    taken |= {"start_frame": start[full], "stop_frame": stop[full]}
    return _with_gaps(taken, gaps_between(parts, n_frames))


def gaps_between(parts: Sequence[Part], n_frames: int) -> Spans:
    """What the parts leave of the recording: source frames [start, stop)."""
    starts = [0, *(part.stop for part in parts)]
    stops = [*(part.start for part in parts), n_frames]
    return [(a, b) for a, b in zip(starts, stops, strict=True) if a < b]


def in_time(graph: NeighborGraph, gaps: Sequence[Sequence[int]], n_frames: int) -> NeighborGraph:
    """The graph with empty rows and columns where the gaps are, so that it shows all of the time.

    Parameters
    ----------
    graph : of the stretches that were seen, at any rate
    gaps : source frames [start, stop)
    n_frames : of the recording
    """
    from kineme.graph import NeighborGraph

    seen = n_frames - sum(stop - start for start, stop in gaps)
    per_frame = len(graph) / max(seen, 1)
    place = np.arange(len(graph))
    before = 0
    for start, stop in gaps:
        at = floor((start - before) * per_frame + 0.5)
        before += stop - start
        place[at:] = np.arange(at, len(graph)) + ceil(before * per_frame)
    n = max(floor(n_frames * per_frame + 0.5), int(place[-1]) + 1)
    counts = np.zeros(n, np.int64)
    counts[place] = graph.counts
    indptr = np.concatenate([[0], np.cumsum(counts)])
    indices = place[graph.indices].astype(np.int32)
    return NeighborGraph(indptr, indices, graph.distances, n, graph.radius)


def _with_gaps(columns: Columns, gaps: Spans) -> Columns:
    """The columns with a transition in no cluster for each gap, on both levels."""
    if not gaps:
        return columns
    rows = [(level, start, stop) for level in ("activity", "primitive") for start, stop in gaps]
    levels, starts, stops = zip(*rows, strict=True)
    n = len(rows)
    more: Columns = {
        "level": np.array(levels),
        "kind": np.full(n, "transition"),
        "start_frame": np.array(starts, np.int64),
        "stop_frame": np.array(stops, np.int64),
        "cluster": np.full(n, -1, np.int64),
        "score": np.full(n, np.nan),
    }
    return {name: np.concatenate([column, more[name]]) for name, column in columns.items()}
