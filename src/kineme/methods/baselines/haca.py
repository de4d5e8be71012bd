"""Hierarchical aligned cluster analysis (HACA): ACA of the segments that ACA found.

The first level cuts the recording into short segments; their DTAK matrix takes
the frame kernel's place on the second level, where a segment weighs as much as
the blocks it is made of.

Source: Zhou, De la Torre and Hodgins, TPAMI 35(3), 2013, as their program does
it.
"""

from __future__ import annotations

import numpy as np

from kineme.methods.baselines._kernels import window_alignments
from kineme.methods.baselines.aca import (
    Floats,
    State,
    check_room,
    improve,
    initial_states,
    least,
    segment_kernel,
    segments_of,
)
from kineme.methods.baselines.reduction import block_starts, frame_kernel
from kineme.methods.baselines.segments import Segments

FINE_CLASSES = 12
FINE_STARTS, COARSE_STARTS = 5, 10


def haca(
    features: Floats,
    *,
    n_classes: int,
    fine_lengths: tuple[int, int] = (8, 10),
    coarse_lengths: tuple[int, int] = (4, 6),
    centres: int = 20,
    seed: int = 0,
) -> Segments:
    """Segments of the second level, in ``n_classes`` clusters; see `haca_levels`."""
    return haca_levels(
        features,
        n_classes=n_classes,
        fine_lengths=fine_lengths,
        coarse_lengths=coarse_lengths,
        centres=centres,
        seed=seed,
    )[1]


def haca_levels(
    features: Floats,
    *,
    n_classes: int,
    fine_lengths: tuple[int, int] = (8, 10),
    coarse_lengths: tuple[int, int] = (4, 6),
    centres: int = 20,
    seed: int = 0,
) -> tuple[Segments, Segments]:
    """Short segments in 12 clusters, and segments made of these in ``n_classes`` clusters.

    Parameters
    ----------
    features : ndarray of shape (frames, dims)
        At 120 Hz, such as `joints.log_maps`.
    n_classes : int
        The number of classes, which the method has to be told.
    fine_lengths : (int, int), optional
        Shortest and longest first-level segment, in blocks of at most five frames.
    coarse_lengths : (int, int), optional
        Shortest and longest second-level segment, in first-level segments.
    centres : int, optional
        K-means centres of the reduction to blocks.
    seed : int, optional
        Of all k-means starts; equal seeds give equal results.

    Raises
    ------
    ParameterError
        The recording is too short for the classes or lengths.
    """
    random = np.random.RandomState(seed)
    blocks = block_starts(features, centres=centres, random=random)
    check_room(len(blocks), FINE_CLASSES, *fine_lengths)
    kernel = frame_kernel(features[blocks])
    weights = np.ones(len(blocks))
    levels: list[tuple[State, State]] = []
    for start in initial_states(kernel, FINE_CLASSES, *fine_lengths, FINE_STARTS, random):
        fine = improve(kernel, weights, start, FINE_CLASSES, fine_lengths[1])
        levels.append(
            (fine, second_level(kernel, weights, fine, n_classes, coarse_lengths, random))
        )
    fine, coarse = min(levels, key=lambda both: both[1].objective)
    block_borders = np.append(blocks, len(features))
    return segments_of(fine, block_borders), segments_of(coarse, block_borders[fine.borders])


def second_level(
    kernel: Floats,
    weights: Floats,
    fine: State,
    n_classes: int,
    lengths: tuple[int, int],
    random: np.random.RandomState,
) -> State:
    """ACA of the first-level segments: the best of ten starts, with borders in such segments."""
    spans = zip(fine.borders[:-1].tolist(), fine.borders[1:].tolist(), strict=True)
    longest = int(np.diff(fine.borders).max())
    windows = [window_alignments(kernel, weights, *span, longest) for span in spans]
    segments = segment_kernel(fine.borders, windows)
    segment_weights = np.add.reduceat(weights, fine.borders[:-1])
    check_room(len(segments), n_classes, *lengths)
    first = initial_states(segments, n_classes, *lengths, COARSE_STARTS, random)
    return least([improve(segments, segment_weights, one, n_classes, lengths[1]) for one in first])
