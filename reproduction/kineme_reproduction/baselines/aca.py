"""Aligned cluster analysis (ACA): k-means over the segments of a recording.

Segments are compared by the dynamic time alignment kernel (DTAK): the best sum of
frame kernel values along a warping path, over the weights of both segments. Given
the number of classes, borders and classes are improved in turn: all windows up
to the longest segment are compared with the present segments, and dynamic
programming picks the windows of least total distance to their class.

Source: Zhou, De la Torre and Hodgins, FG 2008, TPAMI 35(3), 2013, as their
program does it: the shortest length binds the start only, not the search.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray
from scipy.sparse.linalg import eigsh

from kineme._util.parallel import check_cancelled
from kineme.errors import ParameterError
from kineme_reproduction.baselines._kernels import (
    cheapest_lengths,
    propagate,
    window_alignments,
)
from kineme_reproduction.baselines.reduction import (
    block_starts,
    frame_kernel,
    tightest_clusters,
)
from kineme_reproduction.baselines.segments import Segments

if TYPE_CHECKING:
    from kineme_reproduction.baselines.constants import AcaConstants, AlignedConstants

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class State:
    """Borders (first frames, then the number of frames) and classes of the segments."""

    borders: Ints
    classes: Ints
    objective: float = np.inf

    def same(self, other: State) -> bool:
        return np.array_equal(self.borders, other.borders) and np.array_equal(
            self.classes, other.classes
        )


def aca(features: Floats, preset: AcaConstants) -> Segments:
    """Find segments in ``preset.n_classes`` clusters with the least distance to their class.

    Parameters
    ----------
    features : ndarray of shape (frames, dims)
        At 120 Hz, such as `compute_log_maps`.
    preset : AcaConstants
        Told the number of classes; equal seeds give equal results.

    Raises
    ------
    ParameterError
        The recording is too short for the classes or lengths.
    """
    n_classes, shortest, longest = preset.required_classes(), preset.shortest, preset.longest
    random = np.random.RandomState(preset.seed)
    blocks = block_starts(features, preset, random)
    check_room(len(blocks), n_classes, shortest, longest, preset.longest_block)
    kernel = frame_kernel(features[blocks], preset.nearest_share)
    weights = np.ones(len(blocks))
    lengths = shortest, longest
    first = initial_states(kernel, n_classes, lengths, preset.starts, preset, random)
    best = least([improve(kernel, weights, each, n_classes, longest, preset) for each in first])
    return segments_of(best, np.append(blocks, len(features)))


def initial_states(
    kernel: Floats,
    n_classes: int,
    lengths: tuple[int, int],
    starts: int,
    preset: AlignedConstants,
    random: np.random.RandomState,
) -> Iterator[State]:
    """Yield states from spectral clustering of the propagated kernel, one per start."""
    embedding = spectral_embedding(propagate(kernel, lengths[1]), n_classes)
    for _ in range(starts):
        check_cancelled()
        labels = tightest_clusters(embedding, n_classes, preset.kmeans_starts, random)
        yield majority_segments(labels, n_classes, *lengths)


def spectral_embedding(similarity: Floats, n_classes: int) -> Floats:
    """Leading eigenvectors of D^-1/2 S D^-1/2, rows scaled to length 1 (Ng, Jordan, Weiss)."""
    scale = 1 / np.sqrt(similarity.sum(axis=1))
    scaled = scale[:, None] * similarity * scale
    if n_classes < len(scaled):
        _, vectors = eigsh(scaled, n_classes, which="LA", v0=1 / scale)
    else:
        _, vectors = np.linalg.eigh(scaled)
    length = np.linalg.norm(vectors, axis=1, keepdims=True)
    embedding: Floats = vectors / np.where(length > 0, length, 1)
    return embedding


def majority_segments(labels: Ints, n_classes: int, shortest: int, longest: int) -> State:
    """Find segments of ``shortest`` to ``longest`` frames with few frames off their majority.

    Each is in its majority's class. The fewest is what the program means to
    find; see `cheapest_lengths` for what it finds, which is kept here.
    """
    n = len(labels)
    counts = np.zeros((n + 1, n_classes), np.int64)
    np.cumsum(labels[:, None] == np.arange(n_classes), axis=0, out=counts[1:])
    majority = np.zeros((n, longest), np.int64)
    misses = np.zeros((n, longest))
    for length in range(1, min(longest, n) + 1):
        windows = counts[length:] - counts[:-length]
        majority[length - 1 :, length - 1] = windows.argmax(axis=1)
        misses[length - 1 :, length - 1] = length - windows.max(axis=1)
    borders = np.append(0, np.cumsum(cheapest_lengths(misses, shortest, True)))
    return State(borders, majority[borders[1:] - 1, np.diff(borders) - 1])


def improve(
    kernel: Floats,
    weights: Floats,
    state: State,
    n_classes: int,
    longest: int,
    preset: AlignedConstants,
) -> State:
    """Repeat the search until the segments repeat, or ``preset.searches`` times.

    A class left without segments ends it with an infinite objective. A search
    depends on the state alone, so once a state comes back the last is known.
    """
    found: list[State] = []
    alignments: dict[tuple[int, int], Floats] = {}
    for _ in range(preset.searches):
        check_cancelled()
        spans = [(int(a), int(b)) for a, b in pairwise(state.borders)]
        alignments = {
            span: alignments[span]
            if span in alignments
            else window_alignments(kernel, weights, *span, longest)
            for span in spans
        }
        state = search(state, [alignments[span] for span in spans], n_classes)
        if len(np.unique(state.classes)) < n_classes:
            return State(state.borders, state.classes)
        for earlier, other in enumerate(found):
            if state.same(other):
                period = len(found) - earlier
                return [*found, state][earlier + 1 + (preset.searches - earlier - 2) % period]
        found.append(state)
    return state


def search(state: State, alignments: list[Floats], n_classes: int) -> State:
    """Find the windows that cover all frames with the least distance to the classes of ``state``.

    The distance of a window to a class of m segments is 1 - 2/m times the sum of
    its DTAK with them, plus their mean DTAK among themselves.

    Parameters
    ----------
    alignments : list of ndarray
        Per segment, DTAK with every window, see `window_alignments`.
    """
    distance = np.full((n_classes, *alignments[0].shape), np.inf)
    among = segment_kernel(state.borders, alignments)
    for c in np.unique(state.classes):
        members = np.flatnonzero(state.classes == c)
        mean = sum(alignments[j] for j in members) / len(members)
        distance[c] = 1 - 2 * mean + among[np.ix_(members, members)].mean()
    costs = distance.min(axis=0)
    lengths = cheapest_lengths(costs, 1, False)
    borders = np.append(0, np.cumsum(lengths))
    chosen = borders[1:] - 1, lengths - 1
    return State(borders, distance.argmin(axis=0)[chosen], costs[chosen].sum())


def segment_kernel(borders: Ints, alignments: list[Floats]) -> Floats:
    """Return the DTAK of all pairs of segments, (segments, segments)."""
    last, length = borders[1:] - 1, np.diff(borders)
    return np.stack([table[last, length - 1] for table in alignments])


def least(states: list[State]) -> State:
    """Return the state with the least objective, the first of equal ones."""
    return min(states, key=lambda state: state.objective)


def segments_of(state: State, block_borders: Ints) -> Segments:
    """Convert a state in blocks to segments in frames."""
    borders = block_borders[state.borders]
    return Segments(borders[1:-1], state.classes, int(borders[-1]), state.objective)


def check_room(
    n_blocks: int, n_classes: int, shortest: int, longest: int, longest_block: int
) -> None:
    """Raise an error if so many blocks allow no segmentation of these lengths and classes."""
    if not 1 <= shortest <= longest:
        raise ParameterError(
            f"segments of {shortest} to {longest} blocks: need 1 <= shortest <= longest"
        )
    if n_classes < 1 or n_blocks < n_classes * shortest:
        raise ParameterError(
            f"{n_blocks} blocks (of up to {longest_block} frames) cannot hold {n_classes} classes "
            f"with segments of at least {shortest}: use a longer recording or smaller values"
        )
    if -(-n_blocks // longest) > n_blocks // shortest:
        raise ParameterError(
            f"{n_blocks} blocks cannot be cut into segments of {shortest} to {longest}: "
            "let them differ more in length"
        )
