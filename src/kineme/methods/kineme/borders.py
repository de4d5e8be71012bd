"""Refine borders to the frame, fit the ends of activities, and merge neighbours that are one set.

*Borders.* Views are averaged over a second, so borders of the tree are imprecise: strong movement
seems to start late and to end early. `refine_borders` uses single frames. Each side of a border is
modelled by one normal distribution per channel, fitted to frames that are not mixed with the other
side by the averaging. A third model is fitted to the whole recording. A *transition* is a span
around the border, shorter than the averaging window, in which the model of the whole recording is
more likely than those of both sides. Without a transition, the border is where the likelihood of
both sides is largest. This is often too far on the quiet side, because a single movement that a
quiet segment never contains ends it. So `border_shift` moves the border only part of the way, as
people do.

*Ends.* The first repetition of an activity is the span before the first cut that fits the mean of
the inner repetitions best, at any pace. If it begins before the activity, in a transition, the
activity is extended to it. If it begins later, the span before it becomes a transition of the
primitive level. The last repetition is found in the same way, backwards in time.

*Sets.* Posture drifts during a set of repetitions: the hand moves on, the body sinks, the camera
turns. The tree can take this for a new activity, above all if repetitions are fast. So two
neighbours are divided into repetitions again as one span. They are merged if

- one of them has too few repetitions to be a certain activity by itself;
- the joint division has the same number of repetitions on each side as the side has alone, give
  or take one, which is unlikely by chance;
- it is not two movements (`score_one_movement`);
- without their mean pose, repetitions near the border are about as similar to those across it as
  to each other, and last about as long (at least `same_set`).

The last test is relative, because repetitions of a badly performed set correlate less with each
other than two well performed exercises do. The method is ours; see ``docs/method.md``.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import ceil
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import NDArray

from kineme._util.arrays import Floats
from kineme._util.parallel import map_threads
from kineme.methods.kineme import _repetition_kernels as kernels
from kineme.methods.kineme._repetition_kernels import (
    ROUGH,
    measure_evenness,
    sample_repetitions,
)
from kineme.methods.kineme.repetitions import (
    MAX_END,
    PLACES,
    SMOOTHING,
    SPAN,
    find_repetitions,
    score_one_movement,
    trace_movement,
)
from kineme.methods.segments import find_segments, number_by_appearance

if TYPE_CHECKING:
    from kineme.methods.kineme.constants import KinemeConstants

Frames = NDArray[np.int64]
Rows = NDArray[np.float32]
Spans = tuple[Frames, Frames]

MAX_SIDE = 4.0
"""Longest span of a side from which its distribution is estimated, s."""
MIN_DEVIATION = 0.05
"""Smallest standard deviation of a channel, as a share of that in the whole recording."""
SHARE = 3
"""A border moves by at most 1 / SHARE of a segment."""
N_COMPARED = 4
"""Number of repetitions on each side of a border that are compared; others have drifted."""
CERTAIN_FACTOR = 2
"""A side with this many times `chance_count` repetitions is an activity by itself."""
TINY = 1e-12
"""Smallest divisor."""


def refine_borders(channels: Floats, borders: Frames, preset: KinemeConstants) -> Spans:
    """Return the first frame and the end of each segment; frames between two are a transition.

    Channels (frames, channels) are at the working rate; borders are frames from 0 to the end.
    """
    averaged = max(1, preset.frames(preset.averaging))
    max_side = max(1, preset.frames(MAX_SIDE))
    centred = channels - channels.mean(axis=0)
    deviations = np.sqrt((centred**2).mean(axis=0))
    scaled = centred / np.where(deviations > 0, deviations, 1.0)
    starts, stops = borders[:-1].copy(), borders[1:].copy()
    for i in range(1, len(borders) - 1):
        start, at, stop = borders[i - 1 : i + 2].tolist()
        # Half of the averaged time is mixed with the other side of the border.
        left_side = slice(max(start + averaged // 2 * (i > 1), at - max_side), at - averaged // 2)
        last = stop - averaged // 2 * (i < len(borders) - 2)
        right_side = slice(at + averaged // 2, min(last, at + max_side))
        if min(left_side.stop - left_side.start, right_side.stop - right_side.start) < averaged:
            continue
        # A border moves by the averaged time at most, and never far into a short segment.
        first = at - min(averaged, (at - start) // SHARE)
        window = scaled[first : at + min(averaged, (stop - at) // SHARE)]
        # Log-likelihoods relative to the whole recording: cumulative sums of the left model up to
        # each frame, and of the right model from each frame on.
        overall = -0.5 * (window**2).mean(axis=1)
        before = np.append(
            0.0, np.cumsum(_compute_likelihoods(window, scaled[left_side]) - overall)
        )
        gains = _compute_likelihoods(window, scaled[right_side]) - overall
        after = np.append(np.cumsum(gains[::-1])[::-1], 0.0)
        likeliest = int(np.argmax(before + after))
        left, right = _place_ends(before, after, averaged - 1)
        # Frames between both ends are described by the overall model, whose gain is 0.
        gain = before[left] + after[right] - before[likeliest] - after[likeliest]
        if gain > preset.transition_cost * preset.working_fps:
            stops[i - 1], starts[i] = first + left, first + right
        else:
            moved = at + round(preset.border_shift * (first + likeliest - at))
            stops[i - 1] = starts[i] = moved
    return starts, stops


def _place_ends(before: Floats, after: Floats, longest: int) -> tuple[int, int]:
    """Return the likeliest end of the left side and start of the right, at most `longest` apart."""
    # For each start of the right side, the best end of the left side within `longest` before it.
    rights = np.arange(len(before))
    firsts = np.maximum(rights - longest, 0)
    spans = zip(firsts.tolist(), rights.tolist(), strict=True)
    lefts = np.array([first + int(np.argmax(before[first : right + 1])) for first, right in spans])
    right = int(np.argmax(before[lefts] + after))
    return int(lefts[right]), right


def _compute_likelihoods(rows: Floats, side: Floats) -> Floats:
    """Return the log-likelihood of each row under the model of a side, averaged over channels."""
    variances = np.maximum(side.var(axis=0), MIN_DEVIATION**2)
    squares = (rows - side.mean(axis=0)) ** 2 / variances
    likelihoods: Floats = -0.5 * (np.log(variances) + squares).mean(axis=1)
    return likelihoods


def convert_to_samples(frames: Frames, preset: KinemeConstants, n: int) -> Frames:
    """Convert borders from frames to the nearest samples, 0 to n, at least one per segment."""
    nearest = np.rint(frames / (preset.working_fps / preset.rate)).astype(np.int64)
    order = np.arange(len(frames))
    # Subtracting the index turns "strictly ascending" into "ascending": a running maximum.
    ascending = np.maximum.accumulate(nearest - order)
    borders: Frames = np.minimum(ascending, n - order[-1]) + order
    borders[-1] = n
    return borders


def move_fine_borders(fine: Frames, before: Frames, after: Frames) -> Frames:
    """Return the finest borders, with those of a level moved to their new places.

    ``fine`` includes ``before``, the old borders of the level; ``after`` are the new ones.

    Examples
    --------
    >>> fine, level = np.array([0, 2, 5, 6, 9]), np.array([0, 5, 9])
    >>> move_fine_borders(fine, level, np.array([0, 7, 9])).tolist()
    [0, 2, 7, 9]
    """
    # Remove fine borders between the old and the new place of a border.
    low, high = np.minimum(before, after), np.maximum(before, after)
    last = find_segments(low, fine)
    passed = fine <= high[last]
    return np.unique(np.concatenate([fine[~passed], after]))


class Ends(NamedTuple):
    """Starts and ends of activities, starts of the first repetitions and ends of the last ones."""

    starts: Frames
    stops: Frames
    firsts: Frames
    lasts: Frames


def fit_ends(
    features: Rows,
    starts: Frames,
    stops: Frames,
    labels: Frames,
    cuts: Sequence[Frames],
    preset: KinemeConstants,
) -> Ends:
    """Fit the first and last repetition of each activity; activities do not overlap.

    Activities are in time order, in frames of features (frames, dims) at the working rate. A gap
    between two activities of one cluster is never closed. ``cuts`` are the starts of the second,
    third, ... repetition of each activity.
    """
    n = len(features)
    # The last repetition is the first one of the reversed recording.
    reversed_features = np.ascontiguousarray(features[::-1])

    def fit(i: int) -> tuple[int, int, int, int]:
        """Return start and stop of activity i, start of its first repetition, stop of its last."""
        start, first = _find_begin(features, int(starts[i]), cuts[i])
        reversed_cuts = (n - cuts[i])[::-1].copy()
        stop, last = _find_begin(reversed_features, n - int(stops[i]), reversed_cuts)
        return start, n - stop, first, n - last

    fitted = np.array(map_threads(fit, range(len(cuts))), np.int64).reshape(-1, 4)
    begins, ends, firsts, lasts = fitted.T
    for left in np.flatnonzero(ends[:-1] >= begins[1:]).tolist():
        right = left + 1
        low, high = int(stops[left]), int(starts[right])
        # Keep the pause between two activities of one cluster, or they would become one.
        if labels[left] == labels[right]:
            ends[left], begins[right] = low, high
        elif ends[left] > begins[right]:  # they overlap: meet in the middle
            middle = (ends[left] + begins[right]) // 2
            ends[left] = begins[right] = min(max(middle, low), high)
    # Shorter transitions are not resolved by averaged poses, and are closed.
    tolerance = preset.frames(SMOOTHING)
    firsts = np.where(firsts - begins < tolerance, begins, firsts)
    lasts = np.where(ends - lasts < tolerance, ends, lasts)
    return Ends(begins, ends, firsts, lasts)


def fit_edges(rows: Rows, cuts: Frames) -> Frames:
    """Return the starts of the repetitions of a span, and the end of the last one.

    ``cuts`` are the starts of the second, third, ... repetition.
    """
    n, reversed_rows = len(rows), np.ascontiguousarray(rows[::-1])
    _, first = _find_begin(rows, 0, cuts)
    _, last = _find_begin(reversed_rows, 0, (n - cuts)[::-1].copy())
    return np.concatenate([[first], cuts, [n - last]])


def _find_begin(rows: Rows, start: int, cuts: Frames) -> tuple[int, int]:
    """Return the start of an activity found at ``start``, and that of its first repetition."""
    if len(cuts) < 2:  # there is no inner repetition
        return start, start
    lengths = np.diff(cuts)
    inner = kernels.sample_evenly(rows, cuts[:-1], lengths, PLACES)
    mean_length, stop = float(lengths.mean()), int(cuts[0])
    shortest = max(1, ceil(mean_length / 2))
    longest = min(int(MAX_END * mean_length), stop)
    first = 0
    if shortest <= longest:
        mean = inner.mean(axis=0)
        first = stop - int(kernels.find_best_length(rows, stop, shortest, longest, mean))
    return min(first, start), first


class Sets(NamedTuple):
    """Activities in time order: frames, clusters and repetitions.

    ``cuts`` are the starts of the second, third, ... repetition of each activity.
    """

    starts: Frames
    stops: Frames
    labels: Frames
    cuts: list[Frames]


def join_sets(rows: Rows, found: Sets, preset: KinemeConstants) -> Sets:
    """Merge neighbouring activities that are one set, the most similar ones first.

    A merged activity has the cluster of its longer part. Rows (frames, dims) are at the working
    rate; frames between two activities are a transition.
    """
    starts, stops, labels = (values.tolist() for values in found[:3])
    cuts = list(found.cuts)

    def evaluate(left: int) -> tuple[float, Frames]:
        """Return the similarity of two neighbours across their border, and their joint cuts."""
        right = left + 1
        counts = len(cuts[left]) + 1, len(cuts[right]) + 1
        start, stop = starts[left], stops[right]
        if labels[left] == labels[right] and stops[left] == starts[right]:
            # A merge has brought together two of one cluster, without a pause: they are one, too.
            return np.inf, find_repetitions(rows, start, stop, preset)
        # With fewer than three repetitions there is no inner one to compare. Two sides that are
        # both certain, such as walking and running, are not merged.
        is_certain = min(counts) >= CERTAIN_FACTOR * preset.chance_count
        if max(counts) < 3 or is_certain or stop - start > preset.frames(SPAN[1]):
            return 0.0, np.empty(0, np.int64)
        joint_cuts = find_repetitions(rows, start, stop, preset)
        border = (stops[left] + starts[right]) // 2 - start
        similarity = compare_sides(rows[start:stop], joint_cuts - start, border, counts, preset)
        return similarity, joint_cuts

    candidates = map_threads(evaluate, range(len(starts) - 1))
    while candidates:
        best = int(np.argmax([similarity for similarity, _ in candidates]))
        similarity, joint_cuts = candidates[best]
        if similarity < preset.same_set:
            break
        longer = best + int(stops[best + 1] - starts[best + 1] > stops[best] - starts[best])
        labels[best] = labels[longer]
        stops[best] = stops[best + 1]
        cuts[best] = joint_cuts
        for values in (starts, stops, labels, cuts):
            del values[best + 1]
        del candidates[best]
        # Only the merged activity has new neighbours.
        for left in (best - 1, best):
            if 0 <= left < len(candidates):
                candidates[left] = evaluate(left)
    clusters = number_by_appearance(np.array(labels, np.int64))
    return Sets(np.array(starts), np.array(stops), clusters, cuts)


def compare_sides(
    rows: Rows, cuts: Frames, border: int, counts: tuple[int, int], preset: KinemeConstants
) -> float:
    """Return how well repetitions match across a border, relative to within each side.

    It is the correlation across the border over that within the sides, times the evenness of the
    durations; 0 if another test of the module docstring fails. ``rows`` are the frames of both
    sides, ``cuts`` the starts of the second, third, ... repetition of the joint division,
    ``border`` the first frame of the right side. ``counts`` are the numbers of repetitions of each
    side when divided alone.
    """
    if len(cuts) < 2:  # there is no inner repetition
        return 0.0
    edges = fit_edges(rows, cuts)
    durations = np.diff(edges)
    before = int(np.count_nonzero(edges[:-1] + durations / 2 < border))
    # Counts may differ by one, since a repetition may lie across the border. A count of two is no
    # evidence: any span has two halves.
    counts_agree = all(
        abs(alone - together) <= 1
        for alone, together in zip(counts, (before, len(durations) - before), strict=True)
        if alone > 2
    )
    if not (counts_agree and 0 < before < len(durations)):
        return 0.0
    movement = trace_movement(rows, preset)
    repeated = sample_repetitions(movement.poses, movement.path, edges, PLACES)
    evenness = float(measure_evenness(durations.astype(np.float64)))
    centered = repeated - repeated.mean(axis=1, keepdims=True)
    if evenness < preset.same_set or not score_one_movement(centered, preset):
        return 0.0
    compared = repeated[max(before - N_COMPARED, 0) : before + N_COMPARED]
    beside, across = compare_at_border(compared, min(before, N_COMPARED), preset.centering)
    # Two movements: much less alike across the border than within the sides. `ROUGH` keeps the test
    # from rejecting very uniform sides for a small difference.
    if 1 - beside + ROUGH < preset.two_movements * (1 - across + ROUGH):
        return 0.0
    return evenness * across / max(beside, TINY)


def compare_at_border(repeated: Floats, border: int, centering: float) -> tuple[float, float]:
    """Return the mean correlation of repetitions on the same side of a border, and across it.

    ``repeated`` (repetitions, places, dims) are at least three, ``border`` is the first one of the
    right side. A share ``centering`` of its mean pose is subtracted from each.

    Examples
    --------
    >>> swing = np.array([[0.0], [1.0], [0.0], [-1.0]])
    >>> beside, across = compare_at_border(np.stack([swing, swing + 5, -swing]), 2, 1.0)
    >>> round(beside, 2), round(across, 2)
    (1.0, -1.0)
    """
    rows = repeated - centering * repeated.mean(axis=1, keepdims=True)
    rows = rows.reshape(len(rows), -1)
    rows = rows / np.maximum(np.linalg.norm(rows, axis=1, keepdims=True), TINY)
    correlations = rows @ rows.T
    sides = [correlations[:border, :border], correlations[border:, border:]]
    # A side with one repetition has no pairs.
    beside = [side[np.triu_indices(len(side), 1)].mean() for side in sides if len(side) > 1]
    return float(np.mean(beside)), float(correlations[:border, border:].mean())
