"""Compare cycles: left with right, and one session with another.

Sides are pairs of channels whose names differ only in ``_l`` and ``_r`` at the end, or ``left`` and
``right``. Differences are taken within each cycle, with bounds by the paired t test. For
``stance_l`` and ``stance_r`` the means are compared, which are the stance phases.

Sessions are compared by groups with the same name, such as repetitions with the same label. Unnamed
clusters of different recordings are compared only if each recording has a single group.
Differences are second minus first. Bounds are 95 % confidence intervals by Welch's t test, computed
separately for each measure and each point of a curve.
"""

from __future__ import annotations

import re
from collections.abc import Sequence

import numpy as np

from kineme._util.arrays import Floats
from kineme._util.checks import check_flag, check_type
from kineme.cycles.table import (
    CONFIDENCE,
    Columns,
    Cycles,
    as_columns,
    compute_half_width,
    compute_mean_phase,
    compute_phase_differences,
    is_phase,
    unwrap_phases,
)
from kineme.errors import ParameterError

MEASURES = ("range", "min", "max", "mean", "min_at", "max_at")
"""Statistics that are compared. Times are relative to the same cycle for both sides."""
_RIGHT = {"left": "right", "Left": "Right", "LEFT": "RIGHT"}


def compare_sides(cycles: Cycles, *, ends: bool = False) -> Columns:
    """Compare left and right for each group and each pair of channels.

    Parameters
    ----------
    cycles : Cycles
    ends : bool
        Whether the first and the last cycle of an activity count as well.

    Returns
    -------
    dict of str to array
        Columns: ``group``, ``left_channel``, ``right_channel``, ``measure``, ``n`` (cycles in
        which both sides were recorded), ``left``, ``right`` (means), ``difference`` (left minus
        right), ``low`` and ``high`` (its 95 % bounds), and for ranges ``symmetry_index``: the
        difference in per cent of the mean of both sides, 0 if they are equal. nan for too few
        cycles.

    Examples
    --------
    >>> import kineme
    >>> from kineme.cycles import compare_sides
    >>> from kineme.datasets import bundled_truth
    >>> motion = kineme.read(kineme.bundled_recording())
    >>> cycles = kineme.cycles(motion, kineme.read_segments(bundled_truth()), channels=["knee_*"])
    >>> sides = compare_sides(cycles)
    >>> sides["left_channel"][0].item(), sides["right_channel"][0].item()
    ('knee_l', 'knee_r')
    """
    check_type(cycles, Cycles, "compare_sides", "kineme.cycles(recording, segments) gives them")
    check_flag(ends, "ends")
    used = cycles.used(ends=ends)
    # Stance channels are recognised by their unit; their mean is the stance phase.
    stances = {
        name for name, unit in zip(cycles.channels, cycles.units, strict=True) if unit == "%"
    }
    lines: list[tuple[str | float, ...]] = []
    for group in cycles.groups:
        rows = used & (cycles.columns["group"] == group)
        for left, right in pair_sides(cycles.channels):
            is_stance = left in stances
            for measure in ("mean",) if is_stance else MEASURES:
                of_left, of_right = (
                    cycles.columns[f"{name}.{measure}"][rows] for name in (left, right)
                )
                indexed = is_stance or measure == "range"
                compared = _compare_values(of_left, of_right, measure, indexed=indexed)
                lines.append((group, left, right, measure, *compared))
    names = ("group", "left_channel", "right_channel", "measure", "n", "left", "right",
             "difference", "low", "high", "symmetry_index")  # fmt: skip
    return as_columns(names, lines)


def pair_sides(channels: tuple[str, ...]) -> list[tuple[str, str]]:
    """Return pairs of left and right channels."""
    pairs = []
    for left in channels:
        # Keep the case of `left`; names without it may end in `_l`.
        right = re.sub("left", lambda word: _RIGHT.get(word[0], "right"), left, flags=re.IGNORECASE)
        right = right if right != left else re.sub("_l$", "_r", left)
        if right != left and right in channels:
            pairs.append((left, right))
    return pairs


def map_sides(channels: tuple[str, ...]) -> dict[str, str]:
    """Return the channel of the other side for each left and right channel."""
    pairs = pair_sides(channels)
    return dict(pairs) | {right: left for left, right in pairs}


def is_right(channel: str) -> bool:
    """Return whether a channel is of the right side, judging by its name."""
    return re.search("(?<![a-z])(?i:right)|Right|_r$", channel) is not None


def _compare_values(
    left: Floats, right: Floats, measure: str, *, indexed: bool
) -> tuple[float, ...]:
    """Return number of pairs, means, difference with bounds, and symmetry index.

    All but the number are nan without pairs. Bounds are nan for one pair. The index is nan if
    ``indexed`` is False, or if the means do not add up to more than 0.
    """
    both = np.isfinite(left) & np.isfinite(right)
    n = int(both.sum())
    if n == 0:
        return 0, *[np.nan] * 6
    # Paired test: average the differences within cycles.
    differences = left[both] - right[both]
    of_left, of_right = left[both].mean(), right[both].mean()
    if is_phase(measure):
        differences = unwrap_phases(differences)
        of_left, of_right = compute_mean_phase(left[both]), compute_mean_phase(right[both])
    mean, half = (
        differences.mean(),
        compute_half_width(differences.std(ddof=1) if n > 1 else np.nan, n),
    )
    if is_phase(measure):
        mean = compute_phase_differences(mean)  # the bounds around it may pass half a cycle
    total = of_left + of_right
    # Per cent of the mean of both sides: 100 / (total / 2).
    index = 200 * mean / total if indexed and total > 0 else np.nan
    return n, *(float(each) for each in (of_left, of_right, mean, mean - half, mean + half, index))


def compare_sessions(first: Cycles, second: Cycles, *, ends: bool = False) -> Columns:
    """Compare the statistics of two sessions.

    Parameters
    ----------
    first, second : Cycles
        Cycles with the same channels.
    ends : bool
        Whether the first and the last cycle of an activity count as well.

    Returns
    -------
    dict of str to array
        Columns: ``group``, ``measure`` as in `Cycles.summary`; ``first_n``, ``first_mean``,
        ``first_sd``, and the same for ``second``; ``difference``, second minus first,
        and its 95 % bounds ``low`` and ``high``, nan if a session has fewer than two cycles.

    Raises
    ------
    ParameterError
        No group is in both, or their channels differ.

    Examples
    --------
    >>> import kineme
    >>> from kineme.cycles import compare_sessions
    >>> from kineme.datasets import bundled_truth
    >>> motion = kineme.read(kineme.bundled_recording())
    >>> cycles = kineme.cycles(motion, kineme.read_segments(bundled_truth()), channels=["knee_l"])
    >>> table = compare_sessions(cycles, cycles)
    >>> table["group"][0].item(), table["measure"][0].item(), table["difference"][0].item()
    ('walk', 'duration_s', 0.0)
    """
    first, second = _select_comparable(first, second)
    summaries = (each.summary(ends=ends) for each in (first, second))
    compared = _join_sessions(("group", "measure"), *summaries)
    # Take the shorter of both differences of a phase; its bounds shift by the same amount.
    difference = compared["difference"]
    shift = np.where([is_phase(measure) for measure in compared["measure"].tolist()],
                     compute_phase_differences(difference) - difference, 0.0)  # fmt: skip
    return compared | {name: compared[name] + shift for name in ("difference", "low", "high")}


def compare_curves(first: Cycles, second: Cycles, *, ends: bool = False) -> Columns:
    """Compare the mean curves of two sessions.

    Parameters
    ----------
    first, second : Cycles
        Cycles with the same channels and number of points.
    ends : bool
        Whether the first and the last cycle of an activity count as well.

    Returns
    -------
    dict of str to array
        Columns: ``group``, ``channel``, ``percent``, ``first_n``, ``first_mean``, ``first_sd``,
        the same for ``second``, ``difference``, ``low``, ``high``.

    Raises
    ------
    ParameterError
        No group is in both, or their channels or points differ.

    Examples
    --------
    >>> import kineme
    >>> from kineme.cycles import compare_curves
    >>> from kineme.datasets import bundled_truth
    >>> motion = kineme.read(kineme.bundled_recording())
    >>> cycles = kineme.cycles(motion, kineme.read_segments(bundled_truth()), channels=["knee_l"])
    >>> len(compare_curves(cycles, cycles)["percent"]) == 101 * len(cycles.groups)
    True
    """
    first, second = _select_comparable(first, second)
    if first.curves.shape[2] != second.curves.shape[2]:
        raise ParameterError(
            f"curves of {first.curves.shape[2]} and of {second.curves.shape[2]} points cannot be "
            "compared: measure both with the same points="
        )
    curves = (each.mean_curves(ends=ends) for each in (first, second))
    return _join_sessions(("group", "channel", "percent"), *curves)


def _select_comparable(first: Cycles, second: Cycles) -> tuple[Cycles, Cycles]:
    """Return the cycles of the groups in both; raise ParameterError if there are none."""
    for each in (first, second):
        check_type(
            each, Cycles, "comparing sessions", "kineme.cycles(recording, segments) gives them"
        )
    if first.channels != second.channels:
        raise ParameterError(
            "two sessions can only be compared by the same channels: choose them by name"
        )
    shared = {*first.groups} & {*second.groups}
    # Cluster numbers of two recordings are unrelated, but a single group of each may be compared.
    if len(first.groups) > 1 or len(second.groups) > 1:
        unnamed = [each.provenance.get("unnamed", {}) for each in (first, second)]
        shared = {group for group in shared if unnamed[0].get(group) == unnamed[1].get(group)}
    if not shared:
        raise ParameterError(
            f"the sessions have no group in common: {', '.join(first.groups) or 'none'} and "
            f"{', '.join(second.groups) or 'none'}. Numbers of clusters hold within one recording: "
            "give clusters the same names (in the studio, or with `kineme library name` and "
            "`export` for --segments), or use --common (common=True) if equal numbers are equal "
            "movements"
        )
    one, other = (
        each.select(np.isin(each.columns["group"], list(shared))) for each in (first, second)
    )
    return one, other


def _join_sessions(keys: Sequence[str], first: Columns, second: Columns) -> Columns:
    """Join the rows with keys in both: keys, statistics, differences and their bounds."""
    places, others = (
        {key: row for row, key in enumerate(zip(*(each[k].tolist() for k in keys), strict=True))}
        for each in (first, second)
    )
    # In the order of the first.
    rows = [row for key, row in places.items() if key in others]
    order = [others[key] for key in places if key in others]
    first = {name: column[rows] for name, column in first.items()}
    second = {name: column[order] for name, column in second.items()}
    numbers = ("n", "mean", "sd")
    difference, low, high = _compare_means(
        *(each[name] for each in (first, second) for name in numbers)
    )
    return {
        **{name: first[name] for name in keys},
        **{f"first_{name}": first[name] for name in numbers},
        **{f"second_{name}": second[name] for name in numbers},
        "difference": difference,
        "low": low,
        "high": high,
    }


def _compare_means(
    n: Floats, mean: Floats, sd: Floats, other_n: Floats, other_mean: Floats, other_sd: Floats
) -> tuple[Floats, Floats, Floats]:
    """Return the second mean minus the first, and its bounds."""
    from scipy.special import stdtrit

    # With fewer than two cycles this divides by zero, and the bounds are nan.
    with np.errstate(divide="ignore", invalid="ignore"):
        # Squared standard errors of both means.
        parts = sd**2 / n, other_sd**2 / other_n
        error = np.sqrt(parts[0] + parts[1])
        # Degrees of freedom after Welch and Satterthwaite.
        freedom = error**4 / (parts[0] ** 2 / (n - 1) + parts[1] ** 2 / (other_n - 1))
        half = stdtrit(freedom, (1 + CONFIDENCE) / 2) * error
    # Without any spread the freedom is 0 / 0, but the bounds are the difference itself.
    half = np.where(error == 0, 0.0, half)
    difference = other_mean - mean
    return difference, difference - half, difference + half
