"""Aligned cluster analysis, ACA: k-means over the segments of a recording; and HACA on two levels.

A recording at 120 Hz is reduced to blocks of similar poses, each represented by its first frame.
Segments are compared by the dynamic time alignment kernel (DTAK): the best sum of
frame kernel values along a warping path, over the weights of both segments. Given
the number of classes, borders and classes are improved in turn: all windows up
to the longest segment are compared with the present segments, and dynamic
programming picks the windows of least total distance to their class.

HACA is ACA of the segments that ACA found. The first level cuts the recording into short segments;
their DTAK matrix replaces the frame kernel on the second level, where a segment weighs as much
as the blocks it is made of.

Source: Zhou, De la Torre and Hodgins, FG 2008, TPAMI 35(3), 2013, as their
program does it: the shortest length binds the start only, not the search.
The blocks are those of ``tempoReduce``, the frame kernel is that of ``conKnl``.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np
from scipy.sparse.linalg import eigsh
from scipy.spatial.distance import cdist
from sklearn.cluster import KMeans
from threadpoolctl import threadpool_limits

from kineme._util.arrays import Floats, Ints
from kineme._util.parallel import check_cancelled
from kineme.errors import ParameterError
from kineme_reproduction.baselines._kernels import (
    cheapest_lengths,
    propagate,
    window_alignments,
)
from kineme_reproduction.baselines.segments import Segments

if TYPE_CHECKING:
    from kineme_reproduction.baselines.presets import AcaPreset, AlignedPreset, HacaPreset


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


def aca(features: Floats, preset: AcaPreset) -> Segments:
    """Find segments in ``preset.n_classes`` clusters with the least distance to their class.

    Parameters
    ----------
    features : ndarray of shape (frames, dims)
        At 120 Hz, such as `compute_log_maps`.
    preset : AcaPreset
        Told the number of classes; equal seeds give equal results.

    Raises
    ------
    ParameterError
        The recording is too short for the classes or lengths.
    """
    n_classes, lengths = preset.required_classes(), (preset.shortest, preset.longest)
    random = np.random.RandomState(preset.seed)
    blocks, kernel, weights = reduce_to_blocks(features, preset, n_classes, lengths, random)
    first = initial_states(kernel, n_classes, lengths, preset.starts, preset, random)
    best = least([improve(kernel, weights, each, n_classes, lengths[1], preset) for each in first])
    return segments_of(best, np.append(blocks, len(features)))


def haca(features: Floats, preset: HacaPreset) -> Segments:
    """Return segments of the second level (``preset.n_classes`` clusters); see `haca_levels`."""
    return haca_levels(features, preset)[1]


def haca_levels(features: Floats, preset: HacaPreset) -> tuple[Segments, Segments]:
    """Find short segments in a dozen clusters, and segments of these in ``n_classes`` clusters.

    Parameters
    ----------
    features : ndarray of shape (frames, dims)
        At 120 Hz, such as `compute_log_maps`.
    preset : HacaPreset
        Told the number of classes; equal seeds give equal results.

    Raises
    ------
    ParameterError
        The recording is too short for the classes or lengths.
    """
    n_classes, fine_classes = preset.required_classes(), preset.fine_classes
    lengths = preset.fine_lengths
    random = np.random.RandomState(preset.seed)
    blocks, kernel, weights = reduce_to_blocks(features, preset, fine_classes, lengths, random)
    levels: list[tuple[State, State]] = []
    for start in initial_states(kernel, fine_classes, lengths, preset.fine_starts, preset, random):
        fine = improve(kernel, weights, start, fine_classes, lengths[1], preset)
        levels.append((fine, second_level(kernel, weights, fine, n_classes, preset, random)))
    fine, coarse = min(levels, key=lambda both: both[1].objective)
    block_borders = np.append(blocks, len(features))
    return segments_of(fine, block_borders), segments_of(coarse, block_borders[fine.borders])


def second_level(
    kernel: Floats,
    weights: Floats,
    fine: State,
    n_classes: int,
    preset: HacaPreset,
    random: np.random.RandomState,
) -> State:
    """Run ACA on the first-level segments; return the best of all starts."""
    spans = zip(fine.borders[:-1].tolist(), fine.borders[1:].tolist(), strict=True)
    longest = int(np.diff(fine.borders).max())
    windows = [window_alignments(kernel, weights, *span, longest) for span in spans]
    segments = segment_kernel(fine.borders, windows)
    segment_weights = np.add.reduceat(weights, fine.borders[:-1])
    lengths = preset.coarse_lengths
    check_room(len(segments), n_classes, *lengths, preset.longest_block)
    first = initial_states(segments, n_classes, lengths, preset.coarse_starts, preset, random)
    return least(
        [improve(segments, segment_weights, one, n_classes, lengths[1], preset) for one in first]
    )


def reduce_to_blocks(
    features: Floats,
    preset: AlignedPreset,
    n_classes: int,
    lengths: tuple[int, int],
    random: np.random.RandomState,
) -> tuple[Ints, Floats, Floats]:
    """Return the first frames of blocks of similar poses, their kernel and their weights.

    Raise ParameterError if the blocks cannot be cut into segments of these lengths and classes.
    """
    blocks = block_starts(features, preset, random)
    check_room(len(blocks), n_classes, *lengths, preset.longest_block)
    kernel = frame_kernel(features[blocks], preset.nearest_share)
    return blocks, kernel, np.ones(len(blocks))


def block_starts(features: Floats, preset: AlignedPreset, random: np.random.RandomState) -> Ints:
    """Return the first frames of blocks of similar poses.

    A block ends where the nearest of the k-means centres changes, or when it
    has ``preset.longest_block`` frames.
    """
    nearest = tightest_clusters(features, preset.centres, preset.kmeans_starts, random)
    changes = np.flatnonzero(np.diff(nearest, prepend=-1))
    runs = zip(changes, [*changes[1:], len(features)], strict=True)
    return np.concatenate([np.arange(start, stop, preset.longest_block) for start, stop in runs])


def frame_kernel(features: Floats, nearest: float) -> Floats:
    """``kernel[a, b] = exp(-|x_a - x_b|^2 / 2 sigma^2)``, (frames, frames).

    sigma is the mean distance of a frame to its nearest frames, itself among
    them; ``nearest`` is their share of all frames.
    """
    distance = cdist(features, features)
    n = len(features)
    count = max(1, int(n * nearest))
    sigma = np.partition(distance, count - 1, axis=0)[:count].mean()
    kernel: Floats = np.exp(-(distance**2) / (2 * sigma**2 + np.finfo(float).eps))
    return kernel


def tightest_clusters(
    points: Floats, count: int, starts: int, random: np.random.RandomState
) -> Ints:
    """Return the cluster of each point, from the best of several runs of k-means.

    In single precision, which tells poses apart well enough and takes half the
    time. On one thread: the order of sums, and so the result, would change with
    the number of cores, and arrays this small gain nothing from more.
    """
    means = KMeans(count, init="random", n_init=starts, random_state=random)
    with threadpool_limits(1):
        labels: Ints = means.fit_predict(points.astype(np.float32)).astype(np.int64)
    return labels


def initial_states(
    kernel: Floats,
    n_classes: int,
    lengths: tuple[int, int],
    starts: int,
    preset: AlignedPreset,
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
    preset: AlignedPreset,
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
    its DTAK with them, plus their mean DTAK among themselves. ``alignments`` has the DTAK of
    each segment with every window.
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
