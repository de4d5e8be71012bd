"""Count the repetitions of an activity, find the start of each, and measure what they save.

Each repetition passes every pose of the activity once. So the distance to a fixed pose has a dip
in each repetition: the repetition *visits* the pose. Not all dips are visits. So the deepest two,
three, ... dips of several poses give *candidate* divisions of the activity. The best candidate is
the one whose repetitions are most similar to the mean of the others.

The ends, before the first visit and after the last, count as far as they follow the mean, and less
if they deviate from it more than repetitions do. Paths of repetitions should have similar lengths.

Repetitions are compared by position on their path, not by time, so that pace does not matter and a
rest has no length. They are compared by correlation: a deep bend and a shallow one are two bends,
while a step with the left foot and one with the right are halves of one repetition. `centering`
controls the influence of posture.

If there is a rest between repetitions, they begin at rest. People perceive the ends of events where
movement is slowest (Zacks, Kumar, Abrams and Mehta 2009), and clips that begin at rest are easier
to use.

`measure_saving` measures how much repetitions shorten the description of a segment. By its samples
a segment costs half of their mean distances to each other. If it repeats, one repetition describes
all. It repeats if the mean of the other repetitions, scaled, explains most of each one. Then this
share of the cost is saved:

    (1 - max((chance_period / period)², few)) · evenness
    few = min(chance_count / count, chance_duration / (count · period), 1)

Fast repetitions save little, because the averaged view does not show them. Few repetitions save
little, because they may be similar by chance, unless they last long. Two different movements in
sequence save nothing. They are detected by comparing two means, of the first and of the last
repetitions, with a single mean: once for the shapes of the repetitions, once for which channels
move. The method is ours; see ``docs/method.md``.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from kineme._util.arrays import Floats
from kineme.methods.kineme import _repetition_kernels as kernels
from kineme.methods.kineme._repetition_kernels import sample_repetitions

if TYPE_CHECKING:
    from kineme.methods.kineme.constants import KinemeConstants

Frames = NDArray[np.int64]
Rows = NDArray[np.float32]

PLACES = 16
"""Number of positions on its path at which a repetition is sampled."""
N_VOTERS, N_COUNTS, N_POSES = 80, 8, 4
"""Poses that vote on the number of repetitions, numbers that are tried, and poses for each."""
DEPTH_QUANTILE = 0.9
"""Depths of dips are relative to this quantile of the distances to a pose."""
SMOOTHING = 0.14
"""Seconds before and after a frame over which poses are averaged."""
MIN_EXPLAINED = 0.5
"""Share of the variance of repetitions that the means of the others explain, at least."""
MAX_END = 1.5
"""Longest first or last repetition of an activity, in repetitions."""
MIN_PART = 0.35
"""Part of a repetition from which it counts as one."""
MOST_EXTRA = 0.2
"""Largest share of visits that are dropped as extra ones."""
SAME_COUNT = 0.75
"""Largest difference of the numbers of repetitions of candidates that are averaged."""
SPEED_WINDOW = 0.1
"""Seconds before and after a frame over which its speed is averaged."""
REST_SPEED = 0.25
"""Share of the mean speed below which there is a rest."""
REST_RANGE = 0.15
"""Share of a repetition within which each rest is searched."""
SPAN = (1.0, 90.0)
"""Shortest and longest segment that is tested, s."""
MAX_COMPARED = 32
"""Largest number of samples whose distances give the cost of a segment."""
EXTREME = 3.0
"""Variance by which the visited pose of one channel of noise exceeds that of an average one."""
RAMP = 0.05
"""Half width of the linear ramp around a threshold."""


@dataclass(frozen=True, eq=False)
class Movement:
    """A span of a recording as a path of poses."""

    poses: Floats
    """Smoothed poses (frames, dims), centred."""
    middle: Floats
    """Subtracted mean pose: the mean of poses weighted by their speed."""
    path: Floats
    """Length of the path up to each frame, and to the end, (frames + 1,)."""
    variance: float
    """Mean square of the poses, weighted by speed."""
    noise: float
    """Share of the variance that white noise leaves after smoothing, at most; 0 to 1."""


@dataclass(frozen=True, eq=False)
class Candidate:
    """A possible division of an activity into repetitions."""

    visits: Frames
    """Frames at which the pose is visited."""
    before: float
    """Length of the end before the first visit, in repetitions."""
    after: float
    """Length of the end after the last visit."""
    ends: float
    """Sum of both ends, weighted down if they deviate from the repetitions."""
    unexplained: float
    """Share of the activity that the other repetitions do not explain."""

    @property
    def cost(self) -> float:
        # Few long repetitions leave less unexplained, so they cost more.
        return self.unexplained + 1 / self.number

    @property
    def number(self) -> float:
        return len(self.visits) - 1 + self.ends

    @property
    def count(self) -> int:
        return _round_count(self.number)

    def is_chance(self, most: float, noise: float) -> bool:
        """Return whether the mean of many repetitions would leave more than ``most`` unexplained.

        The mean of a few repetitions is noisy and explains less. So the threshold is what their
        mean explains if any two have the correlation 1 - ``most``. ``noise`` is the share that
        noise explains by chance.
        """
        # Variance of a mean: the common part stays, the noise is divided by the number.
        common, others = 1 - most, max(self.number - 1, 1)
        explained = common**2 * others / (1 + (others - 1) * common)
        return self.unexplained >= (1 - explained) * (1 - noise)

    def choose_cuts(self, count: int) -> Frames | None:
        """Return the visits that separate ``count`` repetitions.

        Return None if there are too few visits, or more than one too many at either end.
        """
        spare = len(self.visits) - (count - 1)
        if not 0 <= spare <= 2:
            return None
        # Drop a spare visit at the shorter end.
        drop_first = spare == 2 or (spare == 1 and self.before < self.after)
        return self.visits[int(drop_first) : len(self.visits) - (spare - int(drop_first))]


def find_repetitions(features: Rows, start: int, stop: int, preset: KinemeConstants) -> Frames:
    """Return the starts of the second, third, ... repetition of an activity, at equal phase.

    The first repetition begins with the activity. The others begin at rest, if there are rests.
    Features (frames, dims) are at the working rate; the activity is from frame start to stop.
    """
    rows = features[start:stop]
    movement = trace_movement(rows, preset)
    candidates = _find_candidates(rows, movement, preset)
    if not candidates:
        return np.empty(0, np.int64)
    best = min(candidates, key=lambda each: each.cost)
    same = [
        each
        for each in candidates
        if each.cost <= best.cost + preset.same_cost
        and abs(each.number - best.number) <= SAME_COUNT
    ]
    # The mean over candidates of nearly the same cost is a better estimate than the best one.
    count = _round_count(float(np.mean([each.number for each in same])))
    divisions = [cuts for each in same if (cuts := each.choose_cuts(count)) is not None]
    if not divisions:
        divisions = [cuts for cuts in [best.choose_cuts(best.count)] if cuts is not None]
    # Choose the division whose repetitions are most even.
    lengths = np.diff(np.array(divisions), axis=1, prepend=0, append=len(rows))
    cuts = divisions[lengths.std(axis=1).argmin()]
    return start + shift_to_rest(cuts, movement.path, preset.frames(SPEED_WINDOW))


def trace_movement(rows: Rows, preset: KinemeConstants) -> Movement:
    """Compute the path of poses of a span of a recording."""
    poses, speeds = kernels.smooth_rows(rows, preset.frames(SMOOTHING))
    path = np.append(0, np.cumsum(speeds))
    shares = speeds / max(path[-1], 1e-12)
    middle = shares @ poses
    poses = poses - middle
    # The mean of n frames keeps 1/n of the variance of white noise; smoothing removed the rest.
    removed = (rows - middle - poses).var(axis=0).sum() / max(2 * preset.frames(SMOOTHING), 1)
    noise = min(float(removed / max(poses.var(axis=0).sum(), 1e-12)), 1.0)
    return Movement(poses, middle, path, float(shares @ (poses**2).sum(axis=1)), noise)


def propose_visits(rows: Rows, movement: Movement, preset: KinemeConstants) -> Iterator[Frames]:
    """Yield candidate divisions: the frames at which a pose is visited once per repetition."""
    # Reference poses, evenly spaced in time; the span is searched for each of them.
    references = np.unique(np.linspace(0, len(rows) - 1, min(N_VOTERS, len(rows))).astype(np.int64))
    distances = kernels.measure_distances(rows, references)
    rank = int(DEPTH_QUANTILE * (len(rows) - 1))
    # A quantile is robust to outliers, unlike the largest distance.
    large = np.maximum(np.partition(distances, rank, axis=1)[:, rank], np.float32(1e-6))
    noise = np.float32(preset.noise_share)
    # Depths and frames of the dips of each reference, deepest first; later columns are empty.
    depths, centers = kernels.find_dips(distances, noise * large)
    most = max(int(np.count_nonzero(depths.any(axis=0))), 1)
    shares = np.minimum(depths[:, :most] / large[:, None], 1)
    depths, centers = np.maximum(shares - noise, 0), centers[:, :most]
    # The largest fall of depth is after the last true visit.
    falls = -np.diff(depths, axis=1, append=np.float32(0))
    # Weight votes by speed: poses at rest are visited without a repetition.
    votes = np.diff(movement.path)[references] @ falls
    votes[0] = 0  # every pose visits itself
    # The numbers of visits with most votes; for each, the poses with the largest fall.
    for column in np.argsort(-votes, kind="stable")[:N_COUNTS]:
        best = np.argsort(-falls[:, column], kind="stable")[:N_POSES]
        if votes[column] > 0:
            for visits in np.sort(centers[best[falls[best, column] > 0], : column + 1], axis=1):
                yield kernels.drop_extra_visits(visits, 1 + MIN_PART, MOST_EXTRA)


def _find_candidates(rows: Rows, movement: Movement, preset: KinemeConstants) -> list[Candidate]:
    """Return the divisions of an activity into more than one repetition."""
    candidates = []
    extremes = EXTREME / count_independent_channels(rows)
    window = 2 * preset.frames(SMOOTHING) + 1
    for visits in propose_visits(rows, movement, preset):
        candidate = without_posture = assess_division(movement, visits, preset, preset.centering)
        if candidate.count > 1:
            # Leaning to one side and the other while standing is no repetition.
            if preset.centering < 1:
                without_posture = assess_division(movement, visits, preset, centering=1.0)
            # Noise explains itself where poses are chosen to be similar: around each visit.
            period = (visits[-1] - visits[0]) / (len(visits) - 1)
            noise = movement.noise * (1 + extremes) * window / period
            if not without_posture.is_chance(preset.max_unexplained, min(noise, 1.0)):
                candidates.append(candidate)
    return candidates


def count_independent_channels(rows: Rows) -> float:
    """Return the number of independent channels with the same concentration of variance.

    It is the participation ratio: the squared sum of the eigenvalues of the covariance matrix,
    divided by the sum of their squares.

    Examples
    --------
    >>> channel = np.sin(np.arange(100, dtype=np.float32))
    >>> round(count_independent_channels(np.column_stack([channel, channel])), 3)
    1.0
    """
    centred = rows - rows.mean(axis=0)
    # Both products have the same eigenvalues; the smaller one is cheaper.
    product = centred.T @ centred if rows.shape[1] <= len(rows) else centred @ centred.T
    ratio = np.trace(product) ** 2 / max(float((product**2).sum()), 1e-12)
    return max(float(ratio), 1.0)  # below 1 only if nothing moves


def assess_division(
    movement: Movement, visits: Frames, preset: KinemeConstants, centering: float
) -> Candidate:
    """Measure the ends and the unexplained share of the division at these visits."""
    max_distance, max_scatter = preset.end_distance * movement.variance, preset.end_scatter
    before, after, ends, unexplained = kernels.measure_division(
        movement.poses, movement.path, visits, PLACES, max_distance, MAX_END, centering, max_scatter
    )
    return Candidate(visits, before, after, ends, unexplained)


def _round_count(number: float) -> int:
    """Round a number of repetitions; parts from `MIN_PART` on count as one."""
    return int(number + 1 - MIN_PART)


def shift_to_rest(cuts: Frames, path: Floats, averaged: int) -> Frames:
    """Move all cuts by the same phase to where movement is slowest.

    They stay if there is no rest, or if the first or last repetition would become shorter than
    half of one. ``cuts`` are the starts of the second, third, ... repetition, and ``path`` the
    length of the path up to each frame and to the end. The speed of a frame is averaged over
    ``averaged`` frames before and after it.

    Examples
    --------
    >>> path = np.append(0, np.cumsum(np.tile([1.0, 1, 1, 1, 0, 0, 0, 1], 3)))
    >>> shift_to_rest(np.array([8, 16]), path, 1).tolist()
    [5, 13]
    """
    if not len(cuts):
        return cuts
    n = len(path) - 1
    # Shifts by up to half a repetition to either side.
    period = float(np.median(np.diff(cuts, prepend=0, append=n)))
    half = period / 2
    shifts = np.arange(-int(half), int(half) + 1)
    shifts = shifts[(cuts[0] + shifts >= half) & (cuts[-1] + shifts <= n - half)]
    if not len(shifts):
        return cuts
    frames = np.arange(n)
    first, last = np.maximum(frames - averaged, 0), np.minimum(frames + averaged + 1, n)
    # The path is the cumulative sum of speeds, so differences give means.
    speeds = (path[last] - path[first]) / (last - first)
    # Mean speed at all cuts for each shift.
    shifted_speeds = speeds[cuts[:, None] + shifts].mean(axis=0)
    if shifted_speeds.min() > REST_SPEED * path[-1] / n:
        return cuts
    # Then move each cut to the slowest frame nearby, as rests are never exactly even.
    rests = cuts + shifts[shifted_speeds.argmin()]
    reach = int(REST_RANGE * period)
    offsets = np.arange(-reach, reach + 1)
    nearby = np.clip(rests[:, None] + offsets, 1, n - 1)
    slowest = np.take_along_axis(nearby, speeds[nearby].argmin(axis=1)[:, None], axis=1)[:, 0]
    return slowest if (np.diff(slowest) > 0).all() else rests


def measure_saving(
    rows: Rows, view: Rows, unit: float, span: tuple[int, int], preset: KinemeConstants
) -> float:
    """Return the cost that a span of a view saves by repeating, in samples at the distance `unit`.

    It is 0 if the span does not repeat, or if its length is outside `SPAN`. ``rows`` (frames, dims)
    are the poses or channels at the working rate, ``span`` samples of the view.
    """
    start, stop = span
    rate, fps = preset.rate, preset.working_fps
    rows = rows[round(start / rate * fps) : round(stop / rate * fps)]
    if not SPAN[0] <= (stop - start) / rate <= SPAN[1] or len(rows) < PLACES:
        return 0.0
    # A pose that is visited once per repetition divides the span; the best division counts.
    movement = trace_movement(rows, preset)
    divisions = (
        (_compute_share(movement, visits, preset), visits)
        for visits in propose_visits(rows, movement, preset)
    )
    share, visits = max(
        divisions,
        key=lambda each: each[0] * (each[1][-1] - each[1][0]),
        default=(0.0, np.empty(0, np.int64)),
    )
    if share <= 0:
        return 0.0
    # Extend by the partial repetitions before the first visit and after the last.
    ends = assess_division(movement, visits, preset, centering=1.0)
    period = (visits[-1] - visits[0]) / (len(visits) - 1)
    first = start + (visits[0] - min(ends.before, 1.0) * period) / fps * rate
    last = start + (visits[-1] + min(ends.after, 1.0) * period) / fps * rate
    spread: float = kernels.measure_spread(
        view, max(round(first), start), min(round(last), stop), MAX_COMPARED
    )
    return share * spread / unit


def _compute_share(movement: Movement, visits: Frames, preset: KinemeConstants) -> float:
    """Return the share of cost that a division saves, 0 to 1."""
    # Cheap tests first: the others are skipped if they fail.
    share: float = kernels.score_durations(
        visits,
        preset.working_fps,
        preset.max_repetition,
        preset.chance_period,
        preset.chance_count,
        preset.chance_duration,
    )
    if share <= 0:
        return 0.0
    repetitions = sample_repetitions(movement.poses, movement.path, visits, PLACES)
    kernels.center_repetitions(repetitions)
    explained = kernels.explain_variance(movement.poses, movement.path, visits, repetitions)
    share *= _ramp_up(explained, MIN_EXPLAINED)
    return share and share * score_one_movement(repetitions, preset)


def score_one_movement(repetitions: NDArray[np.float64], preset: KinemeConstants) -> float:
    """Return 1 if repetitions are one movement, 0 if they are two, and values between on a ramp.

    Repetitions (repetitions, places, dims) are centred.
    """
    share = _ramp_up(kernels.find_best_parting(repetitions), preset.two_movements)
    return share and share * _ramp_up(
        kernels.find_best_parting(measure_channel_energies(repetitions)), preset.same_channels
    )


def measure_channel_energies(centered: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the relative strength of movement of each channel, (repetitions, 1, dims).

    It is the root mean square over the places of centred repetitions (repetitions, places, dims),
    divided by the norm over the channels.

    Examples
    --------
    >>> measure_channel_energies(np.array([[[3.0, 4.0], [-3.0, -4.0]]])).tolist()
    [[[0.6, 0.8]]]
    """
    energies = np.sqrt((centered**2).mean(axis=1, keepdims=True))
    norms = np.linalg.norm(energies, axis=2, keepdims=True)
    energies /= np.maximum(norms, 1e-12)  # zeros stay zeros
    return np.ascontiguousarray(energies)


def _ramp_up(share: float, threshold: float) -> float:
    """Return 0 below the threshold and 1 above it, with a linear ramp within `RAMP` of it."""
    return min(max((share - threshold) / (2 * RAMP) + 0.5, 0.0), 1.0)
