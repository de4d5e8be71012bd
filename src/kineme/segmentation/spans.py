"""Recordings with gaps: the spans between them are analysed as one, and put back in place.

Samples, the frames of the analysis, count through the spans as if there were
nothing between them, so that what repeats itself is found wherever it is. Frames
are those of the recording. A segment that reaches over the end of a span becomes
two, and each gap is a transition of its own.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import ceil, floor
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from kineme.methods.base import Columns

if TYPE_CHECKING:
    from kineme.graph import NeighborGraph

Spans = Sequence[tuple[int, int]]

AT_GAP = 0.2
"""Seconds from a gap within which a border is at the gap: as much as is no gap yet."""


@dataclass(frozen=True)
class RecordedSpan:
    """A span of a recording without a gap.

    Attributes
    ----------
    start, stop : int
        Its frames of the recording.
    n_samples : int
        How many samples it has at the working rate.
    """

    start: int
    stop: int
    n_samples: int


def in_frames(
    columns: Columns,
    spans: Sequence[RecordedSpan],
    n_frames: int,
    ratio: float,
    *,
    near: float = 0.0,
) -> Columns:
    """Return the columns in frames, cut at the ends of the spans, gaps filled with transitions.

    Rows that vanish at the rate of the recording are left out.

    Parameters
    ----------
    columns : dict of str to array
        Of a segment table, ``start_frame`` and ``stop_frame`` in samples.
    spans : sequence of RecordedSpan
        In time order.
    n_frames : int
        Of the recording.
    ratio : float
        Frames in one sample.
    near : float
        Borders so many samples from a gap at most are moved to the gap.
    """
    rows: list[NDArray[np.intp]] = []
    starts: list[NDArray[np.int64]] = []
    stops: list[NDArray[np.int64]] = []
    first = 0
    for k, span in enumerate(spans):
        last = first + span.n_samples
        begin = np.maximum(columns["start_frame"], first)
        end = np.minimum(columns["stop_frame"], last)
        for borders in (begin, end):
            inner = (first < borders) & (borders < last)
            if k + 1 < len(spans):
                borders[inner & (borders >= last - near)] = last
            if k > 0:
                borders[inner & (borders <= first + near)] = first
        inside = np.flatnonzero(begin < end)
        begin, end = begin[inside], end[inside]
        at = span.start + np.rint((begin - first) * ratio).astype(np.int64)
        to = span.start + np.rint((end - first) * ratio).astype(np.int64)
        rows.append(inside)
        starts.append(at)
        stops.append(np.where(end == last, span.stop, to))
        first = last
    row, start, stop = map(np.concatenate, (rows, starts, stops))
    # At low frame rates two borders may fall on the same frame.
    full = start < stop
    cut = {name: column[row[full]] for name, column in columns.items()}
    cut |= {"start_frame": start[full], "stop_frame": stop[full]}
    if "border_confidence" in cut:  # what goes on after a gap does not start there
        at_gap = np.isin(cut["start_frame"], [span.start for span in spans])
        cut["border_confidence"] = np.where(at_gap, np.nan, cut["border_confidence"])
    return _with_gaps(cut, gaps_between(spans, n_frames))


def gaps_between(spans: Sequence[RecordedSpan], n_frames: int) -> Spans:
    """Return what lies between the spans of the recording: frames [start, stop)."""
    starts = [0, *(span.stop for span in spans)]
    stops = [*(span.start for span in spans), n_frames]
    return [(a, b) for a, b in zip(starts, stops, strict=True) if a < b]


def in_time(graph: NeighborGraph, gaps: Sequence[Sequence[int]], n_frames: int) -> NeighborGraph:
    """The graph with empty rows and columns where the gaps are, so that it shows all of the time.

    Parameters
    ----------
    graph : NeighborGraph
        Of the spans without gaps, at any rate.
    gaps : sequence of pairs of int
        Frames [start, stop).
    n_frames : int
        Of the recording.
    """
    from kineme.graph import NeighborGraph

    n_present = n_frames - sum(stop - start for start, stop in gaps)
    per_frame = len(graph) / max(n_present, 1)
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
    """The columns with a transition in no cluster for each gap, on each level that they have."""
    if not gaps:
        return columns
    present = sorted({"activity", *columns["level"].tolist()})
    rows = [(level, start, stop) for level in present for start, stop in gaps]
    levels, starts, stops = zip(*rows, strict=True)
    n = len(rows)
    more: Columns = {
        "level": np.array(levels),
        "kind": np.full(n, "transition"),
        "start_frame": np.array(starts, np.int64),
        "stop_frame": np.array(stops, np.int64),
        "cluster": np.full(n, -1, np.int64),
    }
    unknown = np.full(n, np.nan)
    return {
        name: np.concatenate([column, more.get(name, unknown)]) for name, column in columns.items()
    }
