"""Hierarchical aligned cluster analysis (HACA): ACA of the segments that ACA found.

The first level cuts the recording into short segments; their DTAK matrix takes
the frame kernel's place on the second level, where a segment weighs as much as
the blocks it is made of.

Source: Zhou, De la Torre and Hodgins, TPAMI 35(3), 2013, as their program does
it.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from kineme_reproduction.baselines._kernels import window_alignments
from kineme_reproduction.baselines.aca import (
    Floats,
    State,
    check_room,
    improve,
    initial_states,
    least,
    segment_kernel,
    segments_of,
)
from kineme_reproduction.baselines.reduction import block_starts, frame_kernel
from kineme_reproduction.baselines.segments import Segments

if TYPE_CHECKING:
    from kineme_reproduction.baselines.constants import HacaConstants


def haca(features: Floats, preset: HacaConstants) -> Segments:
    """Return segments of the second level (``preset.n_classes`` clusters); see `haca_levels`."""
    return haca_levels(features, preset)[1]


def haca_levels(features: Floats, preset: HacaConstants) -> tuple[Segments, Segments]:
    """Find short segments in a dozen clusters, and segments of these in ``n_classes`` clusters.

    Parameters
    ----------
    features : ndarray of shape (frames, dims)
        At 120 Hz, such as `compute_log_maps`.
    preset : HacaConstants
        Told the number of classes; equal seeds give equal results.

    Raises
    ------
    ParameterError
        The recording is too short for the classes or lengths.
    """
    n_classes, fine_classes, lengths = (
        preset.required_classes(),
        preset.fine_classes,
        preset.fine_lengths,
    )
    random = np.random.RandomState(preset.seed)
    blocks = block_starts(features, preset, random)
    check_room(len(blocks), fine_classes, *lengths, preset.longest_block)
    kernel = frame_kernel(features[blocks], preset.nearest_share)
    weights = np.ones(len(blocks))
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
    preset: HacaConstants,
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
