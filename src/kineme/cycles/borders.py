"""Refine the borders of repetitions and move them to one common phase per cluster.

Segmentation methods cut on the grid of their working rate, and each activity at its own phase. Here
borders move to where the recording around them is most similar to the mean over all borders of the
cluster.

1. *Common phase.* The mean cycle of each run (successive repetitions of one cluster) is rotated
   until it is most similar to that of the longest run, and the borders move by the same fraction of
   a cycle. The phase that moves the fewest repetitions is kept.
2. *Subframe position.* The template is the mean of the recording around all inner borders. Each
   border moves to the least squared difference from the template, interpolated by a parabola.
   Dimensions are weighted by the share of their variance that the template explains, which
   suppresses the noise of joints at rest. Both steps are repeated; the mean move is subtracted, so
   that the phase stays.
3. *Landmark.* All borders move to the middle of the rest in which they lie, or else to the nearest
   reversal of the mean cycle's main movement: a squat begins at its top, a step at the end of a
   swing.
4. *Uncertainty.* The standard deviation of a border follows from the remaining differences,
   weighted by the slope of the template and summed over blocks of correlated samples.

At the first and last border of a run only the half of the window inside the run is used. These
borders are averaged with the position predicted by the usual length of a repetition, weighted by
inverse variances; the spread of the inner repetitions gives the variance of the prediction.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from kineme._util.arrays import Floats, interpolate_frames

STEADY_S = 0.08
"""Standard deviation in seconds of the filter of features before speed is computed."""
WINDOWS = (0.5, 0.35, 0.25, 0.25)
"""Half-width of the compared window in each step, in cycles. Wide windows are unambiguous; narrow
ones tolerate changes of pace."""
POINTS = 50
"""Number of samples per cycle in mean cycles and windows."""
FARTHEST = 0.12
"""Largest move of a border in the first step, in cycles; halved in each following step."""
SIMILAR, BETTER = 0.7, 0.1
"""Least correlation of two mean cycles at a common phase, and its least gain over no shift."""
RESTING = 0.2
"""Fraction of the mean cycle's RMS speed below which it rests."""
LEAST = 4
"""Least number of inner repetitions to estimate the spread of lengths."""
BLOCKS = 6
INFLATION = 2.0
"""Factor on the standard deviation, since blocks ignore differences over the whole window. Chosen
on synthetic recordings (`python -m benchmarks cycles`)."""


@dataclass(frozen=True, eq=False)
class Features:
    """Features (samples, dims) of a recording, ``rate`` samples per second.

    ``comparable``: whether they can be compared between recordings.
    """

    values: Floats
    rate: float
    comparable: bool = True

    def at(self, times: Floats) -> Floats:
        """Return the features at times in seconds, interpolated; clamp at the ends."""
        frames = np.clip(times * self.rate, 0, len(self.values) - 1)
        return interpolate_frames(self.values, frames)

    @cached_property
    def speed(self) -> Floats:
        """Return the smoothed speed of the features, per second."""
        from scipy.ndimage import gaussian_filter1d

        if len(self.values) < 2:
            return np.zeros(len(self.values))
        # Smoothed once more, since a derivative amplifies noise.
        steady = gaussian_filter1d(self.values, STEADY_S * self.rate, axis=0, mode="nearest")
        return np.asarray(np.linalg.norm(np.gradient(steady, axis=0), axis=1) * self.rate)


@dataclass(frozen=True, eq=False)
class Run:
    """Successive repetitions of one cluster in a recording, with n + 1 ``borders`` in seconds.

    ``uncertainty`` holds the standard deviations of the borders, nan if unknown. ``turned`` is the
    shift of the phase in cycles.
    """

    features: Features
    borders: Floats
    uncertainty: Floats
    turned: float = 0.0

    @property
    def n(self) -> int:
        """Return the number of repetitions."""
        return len(self.borders) - 1

    @cached_property
    def period(self) -> float:
        """Return the median duration of a repetition in seconds."""
        return float(np.median(np.diff(self.borders)))

    @cached_property
    def lengths(self) -> Floats:
        """Return the duration of each repetition, averaged with the median."""
        return (np.diff(self.borders) + self.period) / 2

    def at(self, cycles: Floats) -> Floats:
        """Return the times at numbers of cycles from the start.

        Extrapolate with the median period.
        """
        # `interp` holds the end values constant outside, so whole periods are added there.
        inside = np.interp(cycles, np.arange(self.n + 1), self.borders)
        beyond = np.maximum(cycles - self.n, 0) + np.minimum(cycles, 0)
        return inside + beyond * self.period

    def to_seconds(self, border: int, offsets: Floats) -> Floats:
        """Return offsets from a border in cycles as seconds.

        Cycle lengths are averaged with the period of the run, so that windows follow the pace but
        stay stable while borders are inaccurate.
        """
        # The first and the last border have a repetition on one side only: it stands for both.
        before = self.lengths[max(border - 1, 0)]
        after = self.lengths[min(border, len(self.lengths) - 1)]
        return np.asarray(offsets * np.where(offsets < 0, before, after))


def make_run(features: Features, borders: Floats) -> Run:
    """Return a run with the borders of a segmentation method, of unknown uncertainty (nan)."""
    return Run(features, borders, np.full(len(borders), np.nan))


def shift_to_common_phase(runs: list[Run]) -> list[Run]:
    """Return the runs of one cluster with refined borders at a common phase.

    The features of all runs have equal dims. Steps are those of the module docstring.
    """
    # Step 1.
    runs = _align_phases(runs)
    n_inner = sum(run.n - 1 for run in runs)
    if n_inner < 2:  # a single border would be its own template
        return runs
    # Steps 2 and 4.
    for step, window in enumerate(WINDOWS):
        # Shares of a cycle before and after a border, symmetric about 0.
        offsets = np.arange(-round(window * POINTS), round(window * POINTS) + 1) / POINTS
        template, weights = _make_template(runs, offsets)
        # Halved with each step: the windows become narrower.
        reach = FARTHEST / 2**step
        moved = [_move_borders(run, template, weights, offsets, reach) for run in runs]
        # Subtract the mean move in cycles, so that the common phase stays.
        drift = float(np.mean(np.concatenate([
            (new.borders - old.borders)[1:-1] / old.period
            for new, old in zip(moved, runs, strict=True)
        ])))  # fmt: skip
        runs = [replace(run, borders=run.borders - drift * run.period) for run in moved]
    runs = _average_end_borders(runs)
    # Step 3.
    shift = _measure_landmark_shift(runs)
    return [replace(run, borders=run.borders + shift * run.period) for run in runs]


def _average_end_borders(runs: list[Run]) -> list[Run]:
    """Return runs with end borders averaged with those predicted by the usual length."""
    # The first and the last repetition of a run are left out: they end at the borders in question.
    inner_lengths = [np.diff(run.borders)[1:-1] for run in runs]
    # Lengths relative to the median of their run, since runs differ in pace.
    ratios = np.concatenate(
        [each / np.median(each) for each in inner_lengths if len(each) > 1] or [np.empty(0)]
    )
    if len(ratios) < LEAST:
        return runs
    deviation, drawn = float(ratios.std()), []
    for run, lengths in zip(runs, inner_lengths, strict=True):
        borders, uncertainty = run.borders.copy(), run.uncertainty.copy()
        # A run of two repetitions has no inner one, and keeps its ends.
        usual = float(np.median(lengths)) if len(lengths) else 0.0
        for end, place in ((0, borders[1] - usual), (-1, borders[-2] + usual)):
            # Variances of the measured border and of the border that the usual length gives.
            measured, usual_variance = uncertainty[end] ** 2, (deviation * usual) ** 2
            total = measured + usual_variance
            if total > 0:  # and both are known
                # Mean weighted by the inverse variances, and its deviation.
                borders[end] = (usual_variance * borders[end] + measured * place) / total
                uncertainty[end] = np.sqrt(measured * usual_variance / total)
        drawn.append(replace(run, borders=borders, uncertainty=uncertainty) if usual else run)
    return drawn


def _measure_landmark_shift(runs: list[Run]) -> float:
    """Return the shift in cycles that moves borders to a reproducible landmark.

    If the mean cycle rests at the border, this is the middle of the rest. Otherwise it is the
    nearest reversal of the main movement, the first principal component.
    """
    # Single repetitions have no neighbours that show where the movement reverses.
    repeated = [run for run in runs if run.n > 1]
    # Weighted by repetitions. The sum need not be divided: only its shape counts.
    mean = sum(_average_cycles(run) * run.n for run in repeated)
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


def _align_phases(runs: list[Run]) -> list[Run]:
    """Return the runs with borders moved to approximately one phase."""
    repeated = [run for run in runs if run.n > 1]
    if len(repeated) < 2:
        return runs
    # The phase is measured relative to the run with the most repetitions, in cycles.
    reference = _average_cycles(max(repeated, key=lambda run: run.n))
    lateness = {run: _measure_lateness(_average_cycles(run), reference) for run in repeated}

    def sum_moves(origin: float) -> float:
        """Return how far all borders move, in cycles, if those at this phase stay."""
        return sum(run.n * abs(_wrap_phase(late - origin)) for run, late in lateness.items())

    origin = min(lateness.values(), key=sum_moves)
    turned = []
    for run in runs:
        # Runs without a phase of their own are not moved.
        by = _wrap_phase(lateness.get(run, origin) - origin)
        cycles = np.arange(run.n + 1, dtype=np.float64) + by
        turned.append(replace(run, borders=run.at(cycles), turned=by) if by else run)
    return turned


def _wrap_phase(share: float) -> float:
    """Wrap a phase in cycles to -1/2 to 1/2."""
    return (share + 0.5) % 1 - 0.5


def _average_cycles(run: Run) -> Floats:
    """Return the mean of the repetitions of a run, (points, dims)."""
    # (repetitions, points): phases of all cycles, evenly spaced.
    cycles = np.arange(run.n)[:, None] + np.arange(POINTS) / POINTS
    return np.asarray(run.features.at(run.at(cycles)).mean(axis=0))


def _measure_lateness(mean: Floats, reference: Floats) -> float:
    """Return how much later in its cycle a mean cycle resembles the reference, in cycles.

    0 if no phase makes them similar, or none much more than the present one.
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


def _make_template(runs: list[Run], offsets: Floats) -> tuple[Floats, Floats]:
    """Return the mean around all inner borders (window, dims), and explained variance (dims,)."""
    windows = []
    for run in runs:
        times = [run.borders[i] + run.to_seconds(i, offsets) for i in range(1, run.n)]
        if times:
            windows.append(run.features.at(np.array(times)))
    # (borders, window, dims).
    all_windows = np.concatenate(windows)
    template = np.asarray(all_windows.mean(axis=0))
    # Share of the variance explained by the template: high if repetitions agree.
    explained, total = template.var(axis=0), all_windows.var(axis=(0, 1))
    return template, np.divide(explained, total, out=np.zeros_like(total), where=total > 0)


def _move_borders(
    run: Run, template: Floats, weights: Floats, offsets: Floats, reach: float
) -> Run:
    """Return the run with each border at the best match of the template.

    ``template`` (window, dims) is compared at ``offsets`` (window,), shares of a cycle from the
    border. Borders move by at most ``reach``, a share of a cycle. ``weights`` are those of dims.
    """
    # The gradient per cycle; square roots of the weights go with differences squared later.
    slope, roots = np.gradient(template, axis=0) * POINTS, np.sqrt(weights)
    shifts = np.linspace(-reach, reach, 13)
    borders, uncertainty = run.borders.copy(), np.full(run.n + 1, np.nan)
    for i, border in enumerate(run.borders):
        # Outside of the run there is nothing to compare.
        used = np.ones(len(offsets), bool)
        if i == 0:
            used &= offsets >= 0
        if i == run.n:
            used &= offsets <= 0
        pace = run.to_seconds(i, offsets[used])
        # (shifts, window): times of the window for each tried shift.
        times = border + shifts[:, None] * run.period + pace
        # (shifts,): weighted squared difference to the template.
        left = ((run.features.at(times) - template[used]) ** 2).sum(axis=1) @ weights
        best = int(left.argmin())
        shift = shifts[best]
        if 0 < best < len(shifts) - 1:
            # Vertex of the parabola through the three best shifts, in units of their spacing.
            shift += find_vertex(*left[best - 1 : best + 2]) * (shifts[1] - shifts[0])
        borders[i] = border + shift * run.period
        window = run.features.at(borders[i] + pace)
        # Differences that remain at the new border give its uncertainty.
        left = roots * (window - template[used])
        uncertainty[i] = _estimate_deviation(left, roots * slope[used]) * run.period
    return replace(run, borders=borders, uncertainty=uncertainty)


def _estimate_deviation(left: Floats, slope: Floats) -> float:
    """Return the standard deviation of a border in cycles; nan if the template has no slope."""
    steepness = float((slope**2).sum())
    if steepness == 0:
        return np.nan
    # Differences of neighbouring samples are correlated: block sums are taken as independent.
    pulls = [block.sum() for block in np.array_split((left * slope).sum(axis=1), BLOCKS)]
    # Error of a least-squares shift: deviation of the pulls, divided by the summed squared slope.
    return INFLATION * float(np.sqrt(BLOCKS / (BLOCKS - 1) * np.square(pulls).sum()) / steepness)


def find_vertex(left: float, middle: float, right: float) -> float:
    """Return the minimum of the parabola through values at -1, 0 and 1, clipped to -1/2 to 1/2."""
    # Positive curvature only: other parabolas have no minimum.
    curvature = left - 2 * middle + right
    return float(np.clip((left - right) / (2 * curvature), -0.5, 0.5)) if curvature > 0 else 0.0
