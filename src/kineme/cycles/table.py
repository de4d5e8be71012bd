"""The `Cycles` class: a table of repetitions with their curves, and statistics over groups.

`kineme.cycles.measure` computes the columns.

Phases are per cent of a cycle. They are circular: 99 and 1 are near. Means are circular means (K.
V. Mardia, P. E. Jupp, "Directional Statistics", 2000, section 2.2), and differences take the
shorter way round.
"""

from __future__ import annotations

import warnings
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from kineme._util.arrays import Floats
from kineme._util.checks import as_indices, check_flag, format_count, is_number, require_extra
from kineme.errors import ParameterError

if TYPE_CHECKING:
    import pandas as pd
    import xarray as xr


Columns = dict[str, NDArray[Any]]
PHASES = ("min_at", "max_at")
"""Statistics of a channel that are phases."""
CYCLE = 100.0
"""A whole cycle in the unit of phases, per cent."""
STATISTICS = ("range", "min", "max", "min_at", "max_at", "mean", "start", "stop")
"""Statistics of each channel in each cycle; ``_at`` in per cent of the cycle, ``start`` and
``stop`` at its borders."""
INNER = "inner"
BY_HAND, INCOMPLETE, FAR, UNSURE = "by hand", "incomplete", "far from the mean", "uncertain border"
FEWEST = 5
"""Least number of cycles in a group to find outliers."""
DEVIATION = 0.6745
"""Median absolute deviation of a normal distribution, in standard deviations."""
CONFIDENCE = 0.95
"""Confidence level of bounds."""


@dataclass(frozen=True, eq=False, repr=False)
class Cycles:
    """Measured repetitions, the result of `kineme.cycles`.

    Parameters
    ----------
    columns : mapping of str to array
        Columns by name, with one value per cycle: see `kineme.cycles`.
    channels, units : sequence of str
        Names and units of the channels.
    curves : (cycles, channels, points) array
        Each channel from start (0 %) to stop (100 %) of a cycle; nan if not recorded.
    provenance : mapping
        Version, recordings, sources of channels, notes.

    Examples
    --------
    >>> import kineme
    >>> from kineme.datasets import bundled_truth
    >>> motion = kineme.read(kineme.bundled_recording())
    >>> cycles = kineme.cycles(motion, kineme.read_segments(bundled_truth()), channels=["knee_*"])
    >>> cycles
    <Cycles: 32 of 6 groups, 2 channels>
    >>> cycles.columns["group"][0].item(), cycles.curves.shape
    ('walk', (32, 2, 101))
    """

    columns: Columns
    channels: tuple[str, ...]
    units: tuple[str, ...]
    curves: Floats
    provenance: Mapping[str, Any] = field(default_factory=dict)

    def __len__(self) -> int:
        return len(self.curves)

    def __repr__(self) -> str:
        of = format_count(len(self.groups), "group")
        return f"<Cycles: {len(self)} of {of}, {format_count(len(self.channels), 'channel')}>"

    @property
    def groups(self) -> list[str]:
        """Return the groups, in the order of their first cycle."""
        return list(dict.fromkeys(self.columns["group"].tolist()))

    def select(self, rows: NDArray[np.bool_]) -> Cycles:
        """Return the cycles selected by a mask, such as those of one recording.

        Parameters
        ----------
        rows : (cycles,) array of bool

        Raises
        ------
        ParameterError
            ``rows`` is not a boolean array with one value per cycle.

        Examples
        --------
        >>> import kineme
        >>> from kineme.datasets import bundled_truth
        >>> motion = kineme.read(kineme.bundled_recording())
        >>> cycles = kineme.cycles(motion, kineme.read_segments(bundled_truth()))
        >>> cycles.select(cycles.columns["group"] == "squat")
        <Cycles: 4 of 1 group, 12 channels>
        """
        is_selected = np.asarray(rows)
        if is_selected.dtype != bool or is_selected.shape != (len(self),):
            raise ParameterError(f"rows must be a boolean array of length {len(self)}")
        columns = {name: column[is_selected] for name, column in self.columns.items()}
        return replace(self, columns=columns, curves=self.curves[is_selected])

    def used(self, *, ends: bool = False) -> NDArray[np.bool_]:
        """Return a mask of the cycles used for means: inner ones that are not excluded.

        Parameters
        ----------
        ends : bool
            Whether to include the first and last cycle of an activity.

        Returns
        -------
        (cycles,) array of bool
        """
        check_flag(ends, "ends")
        counts = np.asarray(self.columns["excluded"] == "")
        # A cycle at an end of its activity may be cut short or a start from rest.
        return counts if ends else counts & (self.columns["place"] == INNER)

    def exclude(self, rows: Collection[int], reason: str = BY_HAND) -> Cycles:
        """Exclude cycles from all means; the reason is stored in their rows.

        Parameters
        ----------
        rows : collection of int
            Numbers of rows, from 0.
        reason : str

        Raises
        ------
        ParameterError
            There is no such row.

        Examples
        --------
        >>> import kineme
        >>> from kineme.datasets import bundled_truth
        >>> motion = kineme.read(kineme.bundled_recording())
        >>> cycles = kineme.cycles(motion, kineme.read_segments(bundled_truth()))
        >>> cycles.exclude([1]).columns["excluded"][:2].tolist()
        ['', 'by hand']
        """
        chosen = as_indices(rows, "rows")
        for row in chosen:
            if not 0 <= row < len(self):
                raise ParameterError(
                    f"there is no cycle {row}: choose one from 0 to {len(self) - 1}"
                )
        # Fixed-width strings would truncate longer reasons.
        reasons = self.columns["excluded"].astype(object)
        for row in chosen:
            # The first reason stays.
            reasons[row] = reasons[row] or reason
        return replace(self, columns={**self.columns, "excluded": reasons.astype(np.str_)})

    def exclude_far(self, deviations: float = 4.0) -> Cycles:
        """Exclude cycles whose duration or curve is unusual in their group.

        Groups of fewer than five inner cycles are skipped.

        Parameters
        ----------
        deviations : float
            How many times the usual distance from the group's median a cycle may have. The usual
            distance is, for durations, one standard deviation, estimated from the median absolute
            deviation; for curves, the median distance from the median curve.

        Returns
        -------
        Cycles
        """
        _check_number(deviations, "deviations")
        far: set[int] = set()
        for group in self.groups:
            rows = np.flatnonzero((self.columns["group"] == group) & self.used())
            if len(rows) < FEWEST:
                continue
            curves, duration = self.curves[rows], self.columns["duration_s"][rows]
            # (rows, channels): distance from the median curve; a mean would follow outliers.
            with warnings.catch_warnings():
                warnings.simplefilter("ignore", RuntimeWarning)  # a channel that is never measured
                median_curves = np.nanmedian(curves, axis=0)
            curve_distances = _measure_distances(curves - median_curves)
            off = np.abs(duration - np.median(duration))
            # The factor makes a median deviation the standard one of a normal distribution.
            for values, factor in (
                (off, 1 / DEVIATION),
                *((each, 1.0) for each in curve_distances.T),
            ):
                usual = factor * np.median(values)
                if usual > 0:
                    far |= set(rows[values > deviations * usual].tolist())
        return self.exclude(sorted(far), FAR)

    def exclude_unsure(self, least: float = 0.5) -> Cycles:
        """Exclude cycles whose start is correct with less than this probability.

        Parameters
        ----------
        least : float
            From 0 to 1; cycles with unknown probability are kept.

        Raises
        ------
        ParameterError
            No start inside the recordings has a probability.
        """
        _check_number(least, "least")
        probabilities = self.columns["border_confidence"]
        # The start of an activity may be that of the recording, which has no probability.
        later = ~np.isin(self.columns["place"], ("first", "only"))
        if later.any() and np.isnan(probabilities).all():
            raise ParameterError(
                "the starts of these cycles have no confidence, so none is unsure: only results of "
                "the preset 'kineme' for bodies have it, not those of signals, of other presets or "
                "labels of people"
            )
        return self.exclude(np.flatnonzero(probabilities < least), UNSURE)

    def summary(self, *, ends: bool = False) -> Columns:
        """Return number, mean and deviation of all measures for each group.

        Parameters
        ----------
        ends : bool
            Whether the first and the last cycle of an activity count as well.

        Returns
        -------
        dict of str to array
            Columns: ``group``, ``measure`` (``duration_s``, ``cadence_per_min``, and each
            statistic of each channel), ``n``, ``mean``, ``sd``, ``cv`` (sd / mean; for times only),
            ``median``, ``q25``, ``q75``. nan for too few cycles.

        Examples
        --------
        >>> import kineme
        >>> from kineme.datasets import bundled_truth
        >>> motion = kineme.read(kineme.bundled_recording())
        >>> cycles = kineme.cycles(motion, kineme.read_segments(bundled_truth()))
        >>> summary = cycles.summary()
        >>> [summary[name][0].item() for name in ("group", "measure", "n")]
        ['walk', 'duration_s', 5]
        >>> round(summary["mean"][0], 2).item()
        1.13
        """
        used = self.used(ends=ends)
        duration = self.columns["duration_s"]
        # A cycle whose event is missing has no duration.
        with np.errstate(divide="ignore"):
            measures = {"duration_s": duration, "cadence_per_min": 60 / duration}
        measures |= {
            f"{channel}.{name}": self.columns[f"{channel}.{name}"]
            for channel in self.channels
            for name in STATISTICS
        }
        lines: list[tuple[object, ...]] = []
        for group in self.groups:
            rows = used & (self.columns["group"] == group)
            lines += [(group, measure, *_describe_values(values[rows], measure))
                      for measure, values in measures.items()]  # fmt: skip
        names = ("group", "measure", "n", "mean", "sd", "cv", "median", "q25", "q75")
        return as_columns(names, lines)

    def mean_curves(self, *, ends: bool = False) -> Columns:
        """Return mean curve, deviation and confidence band of each channel and group, in long form.

        Parameters
        ----------
        ends : bool
            Whether the first and the last cycle of an activity count as well.

        Returns
        -------
        dict of str to array
            Columns: ``group``, ``channel``, ``percent``, ``n``, ``mean``, ``sd``, ``low``, ``high``
            (of the mean, with a confidence of 95 %, by Student's t at each point). The mean is nan
            without cycles, the others with fewer than two.
        """
        blocks: list[Columns] = []
        points = self.curves.shape[2]
        for group in self.groups:
            for channel in self.channels:
                # Cycles with gaps are left out, so that all points average the same cycles.
                curves = self.layout(channel, group, ends=ends)
                n = len(curves)
                missing = np.full(points, np.nan)
                mean = curves.mean(axis=0) if n else missing
                sd = curves.std(axis=0, ddof=1) if n > 1 else missing
                half = compute_half_width(sd, n)
                blocks.append(
                    {
                        "group": np.full(points, group),
                        "channel": np.full(points, channel),
                        "percent": np.linspace(0, 100, points),
                        "n": np.full(points, n),
                        "mean": mean,
                        "sd": sd,
                        "low": mean - half,
                        "high": mean + half,
                    }
                )
        if not blocks:
            return {}
        return {name: np.concatenate([each[name] for each in blocks]) for name in blocks[0]}

    def layout(self, channel: str, group: str | None = None, *, ends: bool = False) -> Floats:
        """Return the curves of a channel as an array, the input format of `spm1d`.

        Parameters
        ----------
        channel : str
        group : str, optional
            The only one by default.
        ends : bool
            Whether the first and the last cycle of an activity count as well.

        Returns
        -------
        (n, points) array
            Without cycles that were not completely recorded.

        Raises
        ------
        ParameterError
            Unknown channel or group, or several groups and none chosen.

        Examples
        --------
        >>> import kineme
        >>> from kineme.datasets import bundled_truth
        >>> motion = kineme.read(kineme.bundled_recording())
        >>> cycles = kineme.cycles(motion, kineme.read_segments(bundled_truth()))
        >>> cycles.layout("knee_l", "walk").shape
        (5, 101)
        """
        if channel not in self.channels:
            raise ParameterError(f"no channel {channel!r}; there are {', '.join(self.channels)}")
        if group is None and len(self.groups) == 1:
            group = self.groups[0]
        if group not in self.groups:
            chosen = f"no group {group!r}" if group else "several groups"
            raise ParameterError(f"{chosen}: choose one of {', '.join(self.groups)}")
        rows = self.used(ends=ends) & (self.columns["group"] == group)
        curves: Floats = self.curves[rows, self.channels.index(channel)]
        return curves[np.isfinite(curves).all(axis=1)]

    def to_dataframe(self) -> pd.DataFrame:
        """Return a data frame with one row per cycle.

        Raises
        ------
        MissingDependencyError
            pandas is not installed.
        """
        with require_extra("pandas", "tables"):
            import pandas as pd
        return pd.DataFrame(self.columns)

    def to_xarray(self) -> xr.Dataset:
        """Return all curves as a dataset with a variable (cycle, percent) for each channel.

        Returns
        -------
        xarray.Dataset
            The columns of the table are coordinates of its cycles.

        Raises
        ------
        MissingDependencyError
            xarray is not installed.
        """
        with require_extra("xarray", "xarray"):
            import xarray as xr
        # Statistics are left out, since they can be computed from the curves.
        measured = {f"{channel}.{name}" for channel in self.channels for name in STATISTICS}
        points = self.curves.shape[2]
        return xr.Dataset(
            {
                channel: (("cycle", "percent"), self.curves[:, place], {"units": unit})
                for place, (channel, unit) in enumerate(zip(self.channels, self.units, strict=True))
            },
            coords={
                "percent": np.linspace(0, 100, points),
                **{
                    name: ("cycle", values)
                    for name, values in self.columns.items()
                    if name not in measured
                },
            },
        )


def is_phase(measure: str) -> bool:
    """Return whether a measure, such as ``knee_l.max_at``, is a phase."""
    return measure.rpartition(".")[2] in PHASES


def compute_mean_phase(phases: Floats) -> float:
    """Return the circular mean, 0 to 100, such as 1 for 98 and 4; nan if empty."""
    if not len(phases):
        return np.nan
    # Unit vectors on a circle that is one cycle long.
    directions = np.exp(2j * np.pi * phases / CYCLE)
    return float(np.angle(directions.sum()) / (2 * np.pi) * CYCLE % CYCLE)


def compute_phase_differences(differences: Floats) -> Floats:
    """Wrap differences of phases to -50 to 50."""
    # Shifted by half a cycle, so that the modulo leaves -50 to 50 instead of 0 to 100.
    return np.asarray((differences + CYCLE / 2) % CYCLE - CYCLE / 2)


def unwrap_phases(phases: Floats) -> Floats:
    """Return phases, or differences of phases, within half a cycle of their circular mean."""
    middle = compute_mean_phase(phases)
    return middle + compute_phase_differences(phases - middle)


def compute_half_width(sd: Floats | float, n: int) -> Floats:
    """Return the half-width of the `CONFIDENCE` interval of a mean; nan for fewer than two."""
    from scipy.special import stdtrit

    # Student's t with n - 1 degrees of freedom times the standard error.
    return np.asarray(
        stdtrit(n - 1, (1 + CONFIDENCE) / 2) * sd / np.sqrt(n) if n > 1 else sd * np.nan
    )


def as_columns(names: Sequence[str], lines: Sequence[Sequence[object]]) -> Columns:
    """Transpose the lines of a table to columns by name."""
    columns = zip(*lines, strict=True) if lines else [()] * len(names)
    return {name: np.array(column) for name, column in zip(names, columns, strict=True)}


def _describe_values(values: Floats, measure: str) -> tuple[float, ...]:
    """Return n, mean, sd, cv, median and quartiles of values; nan for too few."""
    values = values[np.isfinite(values)]
    n = len(values)
    if n == 0:
        return 0, *[np.nan] * 6
    circular = is_phase(measure)
    if circular:
        values = unwrap_phases(values)
    mean, sd = float(values.mean()), float(values.std(ddof=1)) if n > 1 else np.nan
    # A ratio to the mean is meaningless for angles, since their zero is arbitrary.
    cv = sd / mean if measure in ("duration_s", "cadence_per_min") else np.nan
    low, median, high = np.percentile(values, [25, 50, 75]).tolist()
    # Back to 0 to 100 %.
    if circular:
        mean, median, low, high = (each % CYCLE for each in (mean, median, low, high))
    return n, mean, sd, cv, median, low, high


def _measure_distances(differences: Floats) -> Floats:
    """Return the RMS of each curve over its recorded points."""
    recorded = np.isfinite(differences)
    total = (np.where(recorded, differences, 0.0) ** 2).sum(axis=2)
    # The floor avoids 0 / 0 where nothing was recorded.
    return np.asarray(np.sqrt(total / np.maximum(recorded.sum(axis=2), 1)))


def _check_number(value: object, name: str) -> None:
    if not is_number(value) or float(value) < 0:  # type: ignore[arg-type]
        raise ParameterError(f"{name} is {value!r:.60}: give a number from 0")
