"""Statistics of what the method found, by which it is told how sure it is."""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from kineme._threads import map_threads
from kineme.methods.evidence import (
    COMPARED,
    Evidence,
    border_statistics,
    correlations,
    count_statistics,
    cut_statistics,
    link_statistics,
)
from kineme.methods.recurrence._recurrence_kernels import mean_in_band
from kineme.methods.recurrence.recurrence import Recurrence
from kineme.methods.recurrence.repeating import _candidate_kernels as kernels
from kineme.methods.recurrence.repeating.placing import Segments
from kineme.methods.recurrence.repeating.repetitions import movement
from kineme.methods.samples import spread

if TYPE_CHECKING:
    from kineme.methods.recurrence.repeating.counting import CountingPreset

Floats = NDArray[np.float64]
Frames = NDArray[np.int64]

NEAR = 0.5
"""Seconds on either side of a border that are compared with both segments."""


def evidence(recurring: Recurrence, preset: CountingPreset, segments: Segments) -> Evidence:
    """Statistics of activities, their borders and their repetitions.

    Parameters
    ----------
    recurring : Recurrence
    preset : CountingPreset
    segments : Segments
    """
    borders, labels, own = segments.borders, segments.labels, segments.own
    from scipy.sparse import coo_array, triu

    samples, width = recurring.similarity.shape

    def similar(rows: Frames, columns: Frames) -> float:
        found: float = mean_in_band(recurring.similarity, rows, columns, recurring.phase)
        return found

    at = np.append(borders[:-1] // recurring.step, samples)
    spans = [spread(start, stop, COMPARED) for start, stop in pairwise(at.tolist())]
    within_reach = np.searchsorted(at[:-1], at[1:] + width)
    pairs = np.array([(g, h) for g, last in enumerate(within_reach) for h in range(g, last)])
    shares = [similar(spans[g], spans[h]) for g, h in pairs.tolist()]
    forth = coo_array((shares, pairs.T), (len(labels), len(labels)))
    alike = forth + triu(forth, 1).T
    near = round(NEAR * preset.working_fps / recurring.step)
    parents = segments.parents
    return Evidence(
        link_statistics(labels, alike, own),
        border_statistics(at, labels, alike, similar, near),
        *counted(recurring.features, segments.primitives, parents, segments.repeats, own, preset),
        parents,
    )


def counted(
    features: NDArray[np.float32],
    primitives: Frames,
    parents: Frames,
    repeats: NDArray[np.bool_],
    own: Floats,
    preset: CountingPreset,
) -> tuple[Floats, Floats]:
    """Statistics of the count of each segment, and of the start of each primitive.

    Parameters
    ----------
    features : (frames, dims) array
    primitives : (primitives + 1,) array
        Borders, frames.
    parents : (primitives,) array
        The segment that each lies in.
    repeats : (primitives,) array of bool
        Which primitives are repetitions.
    own : (segments,) array
        How much more similar each segment is to its own cluster than to others.
    preset : CountingPreset
    """
    ends = np.searchsorted(parents, np.arange(len(own) + 1))
    counts = np.full((len(own), 2), np.nan)
    cuts = np.full((len(parents), 2), np.nan)
    smoothing = preset.frames(preset.repetition_smoothing)

    def judge(segment: int) -> None:
        first, last = ends[segment], ends[segment + 1]
        edges = primitives[first : last + 1]
        along = movement(features[edges[0] : max(edges[-1], edges[0] + 1)], smoothing)
        are = repeats[first:last]
        repetitions = kernels.repetitions_between(
            along.poses, along.path, edges - edges[0], preset.path_points
        )[are]
        similar, lengths = correlations(repetitions), np.diff(edges)[are]
        counts[segment] = count_statistics(similar, own[segment])
        cuts[first + 1 : last] = cut_statistics(similar, lengths, are)

    map_threads(judge, np.unique(parents[repeats]).tolist())
    return counts, cuts
