"""Left beside right: what the two sides of a body do in the same repetitions.

Sides are channels whose names differ in nothing but ``_l`` and ``_r`` at the end, or ``left`` and
``right``. Each cycle is its own control: differences are within a cycle, and their bounds by
Student's t for pairs. Of ``stance_l`` and ``stance_r`` the means are compared, which are the shares
of stance; what is left of a cycle is swing.
"""

from __future__ import annotations

import re

import numpy as np

from kineme._util.arrays import Floats
from kineme._util.checks import check_flag, check_type
from kineme.cycles.phases import is_phase, mean_phase, phase_differences
from kineme.cycles.table import CONFIDENCE, Columns, Cycles

MEASURES = ("range", "min", "max", "mean", "min_at", "max_at")
"""Statistics that are compared; times of the cycle are of one clock for both sides."""
_RIGHT = {"left": "right", "Left": "Right", "LEFT": "RIGHT"}


def compare_sides(cycles: Cycles, *, ends: bool = False) -> Columns:
    """Return what differs between left and right, for each group and each pair of channels.

    Parameters
    ----------
    cycles : Cycles
    ends : bool
        Whether the first and the last cycle of an activity count as well.

    Returns
    -------
    dict of str to array
        Columns: ``group``, ``left_channel``, ``right_channel``, ``measure``, ``n`` (cycles in
        which both sides were recorded), ``left``, ``right`` (means), ``difference`` (left less
        right), ``low`` and ``high`` (its bounds, 95 %), and of ranges ``symmetry_index``: the
        difference in per cent of the mean of both sides, 0 where they are equal. nan where there
        are too few cycles.

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
    # The unit tells stance channels, whose mean is the share of stance.
    stances = {
        name for name, unit in zip(cycles.channels, cycles.units, strict=True) if unit == "%"
    }
    lines: list[tuple[str | float, ...]] = []
    for group in cycles.groups:
        rows = used & (cycles.columns["group"] == group)
        for left, right in sides_of(cycles.channels):
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
    columns = zip(*lines, strict=True) if lines else [()] * len(names)
    return {name: np.array(column) for name, column in zip(names, columns, strict=True)}


def sides_of(channels: tuple[str, ...]) -> list[tuple[str, str]]:
    """Return the channels of left sides with those of the right.

    Without those that have no other side.
    """
    pairs = ((name, right_of(name)) for name in channels)
    return [(left, right) for left, right in pairs if right != left and right in channels]


def right_of(name: str) -> str:
    """Return the channel of the right side to one of the left.

    The name itself where it is of no side.
    """
    # The case of the word is kept; a name that has no `left` may end in `_l`.
    turned = re.sub("left", lambda found: _RIGHT.get(found[0], "right"), name, flags=re.IGNORECASE)
    return turned if turned != name else re.sub("_l$", "_r", name)


def _compare_values(
    left: Floats, right: Floats, measure: str, *, indexed: bool
) -> tuple[float, ...]:
    """Number, means, difference with bounds, symmetry index."""
    from scipy.special import stdtrit

    both = np.isfinite(left) & np.isfinite(right)
    n = int(both.sum())
    if n == 0:
        return 0, *[np.nan] * 6
    # Paired: the differences within each cycle are what is averaged.
    apart = left[both] - right[both]
    of_left, of_right = left[both].mean(), right[both].mean()
    if is_phase(measure):
        apart = phase_differences(apart)
        of_left, of_right = mean_phase(left[both]), mean_phase(right[both])
    mean = apart.mean()
    half = np.nan
    if n > 1:
        # Student's t with n - 1 degrees of freedom times the standard error of the mean difference.
        half = stdtrit(n - 1, (1 + CONFIDENCE) / 2) * apart.std(ddof=1) / np.sqrt(n)
    total = of_left + of_right
    # Per cent of the mean of both sides: 100 / (total / 2).
    index = 200 * mean / total if indexed and total > 0 else np.nan
    return n, *(float(each) for each in (of_left, of_right, mean, mean - half, mean + half, index))
