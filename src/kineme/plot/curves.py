"""Plot mean curves of a channel: of groups, two sessions, or left and right."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes

from kineme._util.arrays import Floats
from kineme.cycles.table import Columns, Cycles
from kineme.errors import ParameterError
from kineme.plot.timeline import make_axes
from kineme.segments.display import PALETTE, get_cluster_color

FIRST, SECOND = "#777777", "#332288"
"""Colours of two sessions; the first is also dashed, for prints without colour."""


def plot_curves(
    cycles: Cycles, channel: str, *, ends: bool = False, ax: Axes | None = None
) -> Axes:
    """Draw mean and standard deviation of a channel over the cycle, one line per group.

    Parameters
    ----------
    cycles : Cycles
    channel : str
    ends : bool
        Whether the first and the last cycle of an activity count as well.
    ax : Axes, optional
        Where to draw; Axes of a new figure of pyplot by default.

    Raises
    ------
    ParameterError
        There is no such channel.

    Examples
    --------
    >>> import kineme
    >>> from kineme.plot import plot_curves
    >>> from kineme.datasets import bundled_truth
    >>> from matplotlib.figure import Figure
    >>> motion = kineme.read(kineme.bundled_recording())
    >>> cycles = kineme.cycles(motion, kineme.read_segments(bundled_truth()))
    >>> axes = plot_curves(cycles, "knee_l", ax=Figure().add_subplot())
    """
    if channel not in cycles.channels:
        raise ParameterError(f"no channel {channel!r}; there are {', '.join(cycles.channels)}")
    axes = ax if ax is not None else make_axes(6, 3.5)
    pairs = zip(cycles.columns["group"].tolist(), cycles.columns["cluster"].tolist(), strict=True)
    clusters = dict(pairs)
    # Use cluster colours only if every group has its own cluster.
    is_unique = len(set(clusters.values())) == len(clusters)
    for number, group in enumerate(cycles.groups):
        curves = cycles.layout(channel, group, ends=ends)
        color = get_cluster_color(clusters[group] if is_unique else number)
        _add_mean(axes, curves, color, f"{group} (n = {len(curves)})")
    _label_axes(axes, cycles, channel, channel)
    return axes


def plot_sides(
    cycles: Cycles, left: str, right: str, group: str, *, ends: bool = False, ax: Axes | None = None
) -> Axes:
    """Draw mean and standard deviation of a left and a right channel over a group's cycles.

    Parameters
    ----------
    cycles : Cycles
    left, right : str
        Channels.
    group : str
    ends : bool
        Whether the first and the last cycle of an activity count as well.
    ax : Axes, optional
        Where to draw; Axes of a new figure of pyplot by default.

    Raises
    ------
    ParameterError
        There is no such channel or group.

    Examples
    --------
    >>> import kineme
    >>> from kineme.plot import plot_sides
    >>> from kineme.datasets import bundled_truth
    >>> from matplotlib.figure import Figure
    >>> motion = kineme.read(kineme.bundled_recording())
    >>> cycles = kineme.cycles(motion, kineme.read_segments(bundled_truth()))
    >>> axes = plot_sides(cycles, "knee_l", "knee_r", "squat", ax=Figure().add_subplot())
    """
    axes = ax if ax is not None else make_axes(6, 3.5)
    for channel, color, style in ((left, PALETTE[0], "-"), (right, PALETTE[4], "--")):
        curves = cycles.layout(channel, group, ends=ends)
        _add_mean(axes, curves, color, f"{channel} (n = {len(curves)})", style)
    axes.set_title(group, loc="left", fontsize="medium")
    _label_axes(axes, cycles, left, f"{left}, {right}")
    return axes


def plot_sessions(
    curves: Columns, channel: str, group: str, *, unit: str = "", ax: Axes | None = None
) -> Axes:
    """Draw mean and standard deviation of a channel in two sessions; mark clear differences.

    Parameters
    ----------
    curves : dict of str to array
        Both sessions side by side, from `kineme.cycles.compare_curves`.
    channel, group : str
    unit : str
        Of the channel.
    ax : Axes, optional
        Where to draw; Axes of a new figure of pyplot by default.

    Returns
    -------
    Axes
        The first session dashed; a bar at the bottom where the bounds of the difference leave
        out 0.

    Examples
    --------
    >>> import kineme
    >>> from kineme.cycles import compare_curves
    >>> from kineme.plot import plot_sessions
    >>> from kineme.datasets import bundled_truth
    >>> from matplotlib.figure import Figure
    >>> motion = kineme.read(kineme.bundled_recording())
    >>> cycles = kineme.cycles(motion, kineme.read_segments(bundled_truth()), channels=["knee_l"])
    >>> both = compare_curves(cycles, cycles)
    >>> axes = plot_sessions(both, "knee_l", "walk", ax=Figure().add_subplot())
    """
    rows = (curves["channel"] == channel) & (curves["group"] == group)
    axes = ax if ax is not None else make_axes(6, 3.5)
    percent = curves["percent"][rows]
    for session, color, style in (("first", FIRST, "--"), ("second", SECOND, "-")):
        mean, sd = (curves[f"{session}_{name}"][rows] for name in ("mean", "sd"))
        _add_band(axes, percent, mean, sd, color, session, style)
    differs = (curves["low"][rows] > 0) | (curves["high"][rows] < 0)
    # A bar along the bottom: x in per cent of the cycle, y as a share of the axes' height.
    axes.fill_between(
        percent, 0, 0.03, where=differs, color=SECOND, linewidth=0, step="mid",
        transform=axes.get_xaxis_transform(),
    )  # fmt: skip
    axes.set_xlabel("cycle (%)")
    axes.set_ylabel(f"{channel} ({unit})" if unit else channel)
    axes.set_xlim(0, 100)
    return axes


def _add_mean(axes: Axes, curves: Floats, color: str, label: str, style: str = "-") -> None:
    """Draw the mean of curves with its standard deviation; nothing without curves."""
    if len(curves) == 0:
        return
    sd = curves.std(axis=0, ddof=1) if len(curves) > 1 else None
    percent = np.linspace(0, 100, curves.shape[1])
    _add_band(axes, percent, curves.mean(axis=0), sd, color, label, style)


def _add_band(
    axes: Axes, percent: Floats, mean: Floats, sd: Floats | None, color: str, label: str, style: str
) -> None:
    axes.plot(percent, mean, style, color=color, label=label)
    if sd is not None:
        axes.fill_between(percent, mean - sd, mean + sd, color=color, alpha=0.2, linewidth=0)


def _label_axes(axes: Axes, cycles: Cycles, channel: str, name: str) -> None:
    unit = cycles.units[cycles.channels.index(channel)]
    axes.set_xlabel("cycle (%)")
    axes.set_ylabel(f"{name} ({unit})" if unit else name)
    axes.set_xlim(0, 100)
    if unit == "%":
        axes.set_ylim(-5, 105)
    if axes.get_legend_handles_labels()[0]:
        axes.legend(frameon=False)
