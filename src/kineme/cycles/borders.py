"""Borders of repetitions at the rate of the file, and at one phase of all repetitions of a cluster.

A method cuts on a grid of its working rate, and each activity at a phase of its own. Here borders
move to where the recording about them is most similar to the mean of all borders of the cluster.

1. *One phase.* Of each run (repetitions of one cluster back to back) the mean cycle is turned, as
   on a clock, until it is most similar to that of the longest run; its borders move by as much of
   a cycle. Of all phases that one is kept at which the fewest repetitions move.
2. *Between two frames.* The template is the mean of the recording about all inner borders; each
   border moves to the place where the squared difference to it is least, found between samples by
   a parabola. A dimension counts by the share of its variance that the template explains: where
   one hand waves, the noise of all others says nothing. Both are repeated; the mean of all moves
   is taken out, so that the phase stays.
3. *One place for all readings.* All borders move to the middle of the rest in which they lie, else
   to where the main movement of the mean cycle turns back, at the nearest such place: a squat
   begins at its top, a step at the end of a swing.
4. *Uncertainty.* The deviation of that place: the differences that are left, weighed by the slope
   of the template, summed over blocks of the window, within which they may hang together.

At the first and the last border of a run only the half of the window that lies inside it counts.
Where that tells little, they are drawn to where a repetition of usual length would have them: both
places are weighed by how uncertain they are, the second by how much inner repetitions differ.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from kineme._util.arrays import Floats, interpolate_frames

WINDOWS = (0.5, 0.35, 0.25, 0.25)
"""Of a cycle, for each step: what is compared before and after a border. The wide ones cannot be
mistaken; the narrow ones do not mind that the next repetition is faster."""
POINTS = 50
"""Of a mean cycle while its phase is searched for; of a window as many for each cycle."""
FARTHEST = 0.12
"""Of a cycle: as far a border moves in the first of these steps; half as far in each next one."""
SIMILAR, BETTER = 0.7, 0.1
"""Correlation of two mean cycles of one phase, and how much more that must be than before."""
RESTING = 0.2
"""Of the speed of a mean cycle, the root of its mean square: what is slower rests."""
LEAST = 4
"""Inner repetitions that tell how much they differ in length."""
BLOCKS = 6
DOUBT = 2.0
"""By this the deviation is multiplied: the sum over blocks leaves out by how much repetitions
differ all over the window. Chosen on synthetic recordings (`python -m benchmarks cycles`)."""


@dataclass(frozen=True)
class Run:
    """Repetitions of one cluster back to back, with n + 1 ``borders`` in seconds.

    ``uncertainty``: standard deviations of the borders; nan where nothing tells. ``turned``: by how
    much of a cycle its phase was moved.
    """

    recording: int
    borders: Floats
    uncertainty: Floats
    turned: float = 0.0

    @cached_property
    def period(self) -> float:
        """Seconds of a repetition, the median."""
        return float(np.median(np.diff(self.borders)))

    @cached_property
    def lengths(self) -> Floats:
        """Seconds of each repetition, halfway to the median."""
        return (np.diff(self.borders) + self.period) / 2

    def at(self, cycles: Floats) -> Floats:
        """Return the seconds at which so many cycles are done.

        Beyond its ends at its own period.
        """
        n = len(self.borders) - 1
        # `interp` holds the end values constant outside, so whole periods are added there.
        inside = np.interp(cycles, np.arange(n + 1), self.borders)
        beyond = np.maximum(cycles - n, 0) + np.minimum(cycles, 0)
        return inside + beyond * self.period

    def pace(self, border: int, offsets: Floats) -> Floats:
        """Seconds from a border at shares of the cycles before and after it.

        Their lengths count by half, the period of the run by the other half: a window follows the
        pace, and does not run away where borders are not right yet.
        """
        # The first and the last border have a repetition on one side only.
        before = self.lengths[max(border - 1, 0)]
        after = self.lengths[min(border, len(self.lengths) - 1)]
        return np.asarray(offsets * np.where(offsets < 0, before, after))


def make_run(recording: int, borders: Floats) -> Run:
    """Return a run as a method cut it."""
    return Run(recording, borders, np.full(len(borders), np.nan))


def shift_to_common_phase(runs: list[Run], features: list[Floats], rates: list[float]) -> list[Run]:
    """Return the runs of one cluster with borders at one phase, between two frames.

    ``features`` has an array (samples, dims) of each recording, all of as many dimensions;
    ``rates`` their samples per second.
    """
    runs = _turn_borders(runs, features, rates)
    inner = sum(len(run.borders) - 2 for run in runs)
    if inner < 2:
        return runs
    for step, window in enumerate(WINDOWS):
        # Shares of a cycle before and after a border, symmetric about 0.
        offsets = np.arange(-round(window * POINTS), round(window * POINTS) + 1) / POINTS
        template, weights = _make_template(runs, features, rates, offsets)
        # Halved with each step: the windows become narrower.
        reach = FARTHEST / 2**step
        moved = [
            _move_borders(run, features, rates, template, weights, offsets, reach) for run in runs
        ]
        # The mean move, in cycles: the template must not wander.
        drift = float(np.mean(np.concatenate([
            (new.borders - old.borders)[1:-1] / old.period
            for new, old in zip(moved, runs, strict=True)
        ])))  # fmt: skip
        runs = [replace(run, borders=run.borders - drift * run.period) for run in moved]
    runs = _extend_ends(runs)
    by = _measure_landmark_shift(runs, features, rates)
    return [replace(run, borders=run.borders + by * run.period) for run in runs]


def _extend_ends(runs: list[Run]) -> list[Run]:
    """Return runs with their ends drawn to where a repetition of usual length would have them."""
    # The first and the last repetition of a run are left out: they end at the borders in question.
    inner = [np.diff(run.borders)[1:-1] for run in runs]
    # Lengths relative to the median of their run, since runs differ in pace.
    ratios = np.concatenate(
        [each / np.median(each) for each in inner if len(each) > 1] or [np.empty(0)]
    )
    if len(ratios) < LEAST:
        return runs
    deviation, drawn = float(ratios.std()), []
    for run, lengths in zip(runs, inner, strict=True):
        borders, uncertainty = run.borders.copy(), run.uncertainty.copy()
        # A run of two repetitions has no inner one, and keeps its ends.
        usual = float(np.median(lengths)) if len(lengths) else 0.0
        for end, place in ((0, borders[1] - usual), (-1, borders[-2] + usual)):
            # Variances of the measured place and of the one that the usual length gives.
            first, second = uncertainty[end] ** 2, (deviation * usual) ** 2
            if first + second > 0:  # and both are known
                # Mean weighted by the inverse variances, and its deviation.
                borders[end] = (second * borders[end] + first * place) / (first + second)
                uncertainty[end] = np.sqrt(first * second / (first + second))
        drawn.append(replace(run, borders=borders, uncertainty=uncertainty) if usual else run)
    return drawn


def _measure_landmark_shift(runs: list[Run], features: list[Floats], rates: list[float]) -> float:
    """By how much of a cycle later borders lie at a place that every reading can find again.

    Where the mean cycle stands still, that is the middle of its rest. Else it is the nearest place
    at which its main movement, the first principal component, turns back.
    """
    # A single repetition has no neighbour that shows where the movement turns.
    repeated = [run for run in runs if len(run.borders) > 2]
    # Weighted by repetitions. The sum need not be divided: only its shape counts.
    mean = sum(_average_cycles(run, features, rates) * (len(run.borders) - 1) for run in repeated)
    centred = np.asarray(mean) - np.mean(mean, axis=0)
    # Central differences round the cycle: its end is followed by its start.
    change = np.roll(centred, -1, axis=0) - np.roll(centred, 1, axis=0)
    speed = np.linalg.norm(change, axis=1)
    moves = np.flatnonzero(speed > RESTING * np.sqrt(np.mean(speed**2)))
    if len(moves) == 0:
        return 0.0
    # A rest about the border: it begins after the last movement and ends before the first one.
    if moves[0] > 0 and moves[-1] < POINTS - 1:  # the border lies in a rest
        # In points; the rest's start is one cycle back, hence -POINTS.
        return float(_wrap_phase((moves[0] + moves[-1] - POINTS) / 2 / POINTS))
    # The first right singular vector is the direction of the main movement.
    main = centred @ np.linalg.svd(centred, full_matrices=False)[2][0]
    slope = np.roll(main, -1) - np.roll(main, 1)
    after = np.roll(slope, -1)
    # Points after which the slope changes its sign, and where it is 0 between two points.
    turns = np.flatnonzero(np.signbit(slope) != np.signbit(after))
    shares = slope[turns] / (slope[turns] - after[turns])
    places = [_wrap_phase(place) for place in ((turns + shares) / POINTS).tolist()]
    return float(min(places, key=abs, default=0.0))


def _turn_borders(runs: list[Run], features: list[Floats], rates: list[float]) -> list[Run]:
    """Return the runs with their borders at about one phase."""
    repeated = [run for run in runs if len(run.borders) > 2]
    if len(repeated) < 2:
        return runs
    means = {id(run): _average_cycles(run, features, rates) for run in repeated}
    longest = max(repeated, key=lambda run: len(run.borders))
    # In cycles, relative to the run with the most repetitions.
    late = {id(run): _measure_lateness(means[id(run)], means[id(longest)]) for run in repeated}
    weights = {id(run): len(run.borders) - 1 for run in repeated}

    def moves(origin: float) -> float:
        return sum(weights[key] * abs(_wrap_phase(late[key] - origin)) for key in late)

    origin = min(late.values(), key=moves)
    turned = []
    for run in runs:
        # Runs without a phase of their own are not moved.
        by = _wrap_phase(late.get(id(run), origin) - origin)
        cycles = np.arange(len(run.borders), dtype=np.float64) + by
        turned.append(replace(run, borders=run.at(cycles), turned=by) if by else run)
    return turned


def _wrap_phase(share: float) -> float:
    """Return a share of a cycle from -1/2 to 1/2."""
    return (share + 0.5) % 1 - 0.5


def _average_cycles(run: Run, features: list[Floats], rates: list[float]) -> Floats:
    """(points, dims): the mean of the repetitions of a run."""
    n = len(run.borders) - 1
    # (repetitions, points): phases of all cycles, evenly spaced.
    cycles = np.arange(n)[:, None] + np.arange(POINTS) / POINTS
    values = sample_at(features[run.recording], rates[run.recording], run.at(cycles))
    return np.asarray(values.mean(axis=0))


def _measure_lateness(mean: Floats, reference: Floats) -> float:
    """By how much of a cycle later than its border a mean cycle is as the reference at its own.

    0 where no phase makes them similar, or none much more than the present one.
    """
    # Without the means the correlation compares shapes only.
    first, second = (each - each.mean(axis=0) for each in (mean, reference))
    norm = np.sqrt((first**2).sum() * (second**2).sum())
    if norm == 0:
        return 0.0
    # Circular cross-correlation at all lags by FFT, summed over dimensions.
    spectra = np.fft.rfft(first, axis=0) * np.conj(np.fft.rfft(second, axis=0))
    correlation = np.fft.irfft(spectra, n=POINTS, axis=0).sum(axis=1) / norm
    best = int(correlation.argmax())
    # A small gain may be noise, and turning the phase moves all borders.
    if correlation[best] < SIMILAR or correlation[best] - correlation[0] < BETTER:
        return 0.0
    left, right = correlation[best - 1], correlation[(best + 1) % POINTS]
    # `find_vertex` finds a minimum, so the correlations are negated. Lags beyond half a cycle wrap.
    return _wrap_phase((best + find_vertex(-left, -correlation[best], -right)) / POINTS)


def _make_template(
    runs: list[Run], features: list[Floats], rates: list[float], offsets: Floats
) -> tuple[Floats, Floats]:
    """(window, dims): the mean about all inner borders; and (dims,): what share it explains."""
    windows = []
    for run in runs:
        times = [run.borders[i] + run.pace(i, offsets) for i in range(1, len(run.borders) - 1)]
        if times:
            values, rate = features[run.recording], rates[run.recording]
            windows.append(sample_at(values, rate, np.array(times)))
    # (borders, window, dims).
    every = np.concatenate(windows)
    template = np.asarray(every.mean(axis=0))
    # Variance of the template in the window, as a share of all: high where repetitions agree.
    explained, total = template.var(axis=0), every.var(axis=(0, 1))
    shares = np.where(total > 0, explained / np.where(total > 0, total, 1.0), 0.0)
    return template, shares


def _move_borders(
    run: Run,
    features: list[Floats],
    rates: list[float],
    template: Floats,
    weights: Floats,
    offsets: Floats,
    reach: float,
) -> Run:
    """Return the run with each border where the recording is most similar to the template."""
    values, rate = features[run.recording], rates[run.recording]
    # The gradient per cycle; square roots of the weights go with differences squared later.
    slope, roots = np.gradient(template, axis=0) * POINTS, np.sqrt(weights)
    shifts = np.linspace(-reach, reach, 13)
    borders, uncertainty = run.borders.copy(), np.full(len(run.borders), np.nan)
    for i, border in enumerate(run.borders):
        # At an end of a run nothing comparable lies outside.
        used = np.ones(len(offsets), bool)
        if i == 0:
            used &= offsets >= 0
        if i == len(borders) - 1:
            used &= offsets <= 0
        pace = run.pace(i, offsets[used])
        # (shifts, window): times of the window for each tried shift.
        times = border + shifts[:, None] * run.period + pace
        # (shifts,): weighted squared difference to the template.
        left = ((sample_at(values, rate, times) - template[used]) ** 2).sum(axis=1) @ weights
        best = int(left.argmin())
        shift = shifts[best]
        if 0 < best < len(shifts) - 1:
            # Vertex of the parabola through the three best shifts, in units of their spacing.
            shift += find_vertex(*left[best - 1 : best + 2]) * (shifts[1] - shifts[0])
        borders[i] = border + shift * run.period
        window = sample_at(values, rate, borders[i] + pace)
        # Differences that remain at the new border give its uncertainty.
        left = roots * (window - template[used])
        uncertainty[i] = _estimate_deviation(left, roots * slope[used]) * run.period
    return replace(run, borders=borders, uncertainty=uncertainty)


def _estimate_deviation(left: Floats, slope: Floats) -> float:
    """Standard deviation of a place, in cycles; nan where the template has no slope."""
    steepness = float((slope**2).sum())
    if steepness == 0:
        return np.nan
    # Differences of neighbouring samples are correlated: block sums are taken as independent.
    pulls = [block.sum() for block in np.array_split((left * slope).sum(axis=1), BLOCKS)]
    # Error of a least-squares shift: deviation of the pulls, divided by the summed squared slope.
    return DOUBT * float(np.sqrt(BLOCKS / (BLOCKS - 1) * np.square(pulls).sum()) / steepness)


def find_vertex(left: float, middle: float, right: float) -> float:
    """Where the parabola through three values at -1, 0 and 1 is least, from -1/2 to 1/2."""
    # Positive curvature only: other parabolas have no minimum.
    curvature = left - 2 * middle + right
    return float(np.clip((left - right) / (2 * curvature), -0.5, 0.5)) if curvature > 0 else 0.0


def sample_at(values: Floats, rate: float, times: Floats) -> Floats:
    """Values (samples, dims) at times in seconds, between samples on lines; the ends go on."""
    return interpolate_frames(values, np.clip(times * rate, 0, len(values) - 1))
