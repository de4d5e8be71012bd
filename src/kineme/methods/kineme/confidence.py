"""Confidence: the probability that a result is right.

Four things may be wrong, and each has its own probability:

- the *link* of an activity: its cluster is not that of the same movement elsewhere,
- a *border* of an activity: there is none close by,
- its *count*: it has more repetitions, or fewer,
- a *cut* between two repetitions: there is none close by.

They follow from two statistics s: the length of an activity times its preference of its own
cluster, in seconds, and the correlation of its repetitions. Each probability is
1 / (1 + exp(-(constant + weight s))). The two numbers of each kind are fitted to recordings with a
known truth and checked on sources that were left out, by ``benchmarks/truth/confidence.py``. No
stage of the method reads them.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from kineme._util.arrays import Floats
from kineme._util.parallel import map_threads
from kineme.methods.kineme._repetition_kernels import repetitions_between
from kineme.methods.kineme.primitives import Segments
from kineme.methods.kineme.repetitions import PLACES, movement_of

if TYPE_CHECKING:
    from kineme.methods.kineme.constants import KinemeConstants

Frames = NDArray[np.int64]

LEAST = 0.02
"""Least preference of a segment for its own cluster."""
CLEAREST = 0.995
"""Largest correlation: all beyond it are equal."""


@dataclass(frozen=True, eq=False)
class Evidence:
    """Statistics from which confidence is computed.

    Attributes
    ----------
    preferred : (segments,) array
        Logarithm of the seconds for which each prefers its own cluster; nan for transitions.
    repeated : (segments,) array
        Mean correlation of any two repetitions, as Fisher's z: 0 of a single one; nan where
        primitives are no repetitions.
    parents : (primitives,) array
        The segment that each primitive lies in.
    """

    preferred: Floats
    repeated: Floats
    parents: Frames


@dataclass(frozen=True, eq=False)
class Confidence:
    """Probabilities; nan where there is no cluster, count, border or cut.

    Attributes
    ----------
    links, counts, borders : (segments,) array
        That the cluster of each segment, the number of its repetitions, and its start are right.
    cuts : (primitives,) array
        That the start of each is right; that of the segment where it is the first in it.
    """

    links: Floats
    counts: Floats
    borders: Floats
    cuts: Floats


def evidence(rows: NDArray[np.float32], segments: Segments, preset: KinemeConstants) -> Evidence:
    """Statistics of activities and their repetitions.

    Parameters
    ----------
    rows : (frames, dims) array
        At the working rate.
    segments : Segments
    preset : KinemeConstants
    """
    parents, repeats, ends = segments.parents, segments.repeats, segments.firsts
    seconds = np.diff(segments.borders) / preset.working_fps
    repeated = np.full(len(seconds), np.nan)

    def correlate(segment: int) -> None:
        first, last = ends[segment], ends[segment + 1]
        edges = segments.primitives[first : last + 1]
        movement = movement_of(rows[edges[0] : max(edges[-1], edges[0] + 1)], preset)
        found = repetitions_between(movement.poses, movement.path, edges - edges[0], PLACES)
        repeated[segment] = mean_correlation(found[repeats[first:last]])

    map_threads(correlate, np.unique(parents[repeats]).tolist())
    return Evidence(np.log(seconds * np.maximum(segments.preference, LEAST)), repeated, parents)


def mean_correlation(repetitions: Floats) -> float:
    """Of any two repetitions, (count, places, dims), as Fisher's z; 0 of one."""
    count = len(repetitions)
    if count < 2:
        return 0.0
    rows = (repetitions - repetitions.mean(axis=1, keepdims=True)).reshape(count, -1)
    rows = rows / np.maximum(np.linalg.norm(rows, axis=1, keepdims=True), 1e-12)
    pairs = (np.square(rows.sum(axis=0)).sum() - count) / (count * (count - 1))
    return float(np.arctanh(np.clip(pairs, -CLEAREST, CLEAREST)))


def confidence(evidence: Evidence, preset: KinemeConstants) -> Confidence:
    """Probabilities from the statistics and the weights of the preset."""
    preferred = evidence.preferred
    lesser = np.append(np.nan, np.fmin(preferred[1:], preferred[:-1]))
    borders = probability(lesser, preset.border_weights)
    cuts = probability(evidence.repeated, preset.cut_weights)[evidence.parents]
    first = np.diff(evidence.parents, prepend=-1) > 0
    return Confidence(
        links=probability(preferred, preset.link_weights),
        counts=probability(evidence.repeated, preset.count_weights),
        borders=borders,
        cuts=np.where(first, borders[evidence.parents], cuts),
    )


def probability(statistic: Floats, weights: tuple[float, float]) -> Floats:
    """Probability by a statistic, a constant, and its weight; nan where the statistic is.

    Examples
    --------
    >>> probability(np.array([0.0, 2.0]), (0.0, 1.0)).round(2).tolist()
    [0.5, 0.88]
    """
    # The logistic function as a hyperbolic tangent, which does not overflow.
    found: Floats = 0.5 + 0.5 * np.tanh((weights[0] + weights[1] * statistic) / 2)
    return found
