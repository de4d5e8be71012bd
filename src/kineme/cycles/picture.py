"""Mean curves of a channel, drawn: of groups, or of two sessions over each other."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from kineme._colors import cluster_color
from kineme.cycles.table import Columns, Cycles
from kineme.errors import ParameterError
from kineme.segments.timeline import new_axes

if TYPE_CHECKING:
    from matplotlib.axes import Axes


FIRST, SECOND = "#777777", "#332288"
"""Colours of two sessions; the first is dashed, too, so that paper without colour tells them."""


def plot_curves(
    cycles: Cycles, channel: str, *, ends: bool = False, ax: Axes | None = None
) -> Axes:
    """Mean and standard deviation of a channel over the cycle, a line for each group.

    Parameters
    ----------
    cycles : Cycles
    channel : str
    ends : bool
        Whether the first and the last cycle of an activity count as well.
    ax : Axes, optional
        Where to draw; Axes of a new figure of pyplot by default.

    Returns
    -------
    Axes

    Raises
    ------
    ParameterError
        There is no such channel.

    Examples
    --------
    >>> import kineme
    >>> from kineme.cycles import plot_curves
    >>> from kineme.datasets import bundled_truth
    >>> from matplotlib.figure import Figure
    >>> motion = kineme.read(kineme.bundled_recording())
    >>> cycles = kineme.cycles(motion, kineme.read_segments(bundled_truth()))
    >>> axes = plot_curves(cycles, "knee_l", ax=Figure().add_subplot())
    """
    if channel not in cycles.channels:
        raise ParameterError(f"no channel {channel!r}; there are {', '.join(cycles.channels)}")
    axes = ax if ax is not None else new_axes(6, 3.5)
    percent = np.linspace(0, 100, cycles.curves.shape[2])
    numbers = zip(cycles.columns["group"].tolist(), cycles.columns["cluster"].tolist(), strict=True)
    clusters = dict(numbers)
    for place, group in enumerate(cycles.groups):
        curves = cycles.layout(channel, group, ends=ends)
        if len(curves) == 0:
            continue
        many = len(set(clusters.values())) == len(clusters)
        color = cluster_color(clusters[group] if many else place)
        mean = curves.mean(axis=0)
        axes.plot(percent, mean, color=color, label=f"{group} (n = {len(curves)})")
        if len(curves) > 1:
            sd = curves.std(axis=0, ddof=1)
            axes.fill_between(percent, mean - sd, mean + sd, color=color, alpha=0.2, linewidth=0)
    unit = cycles.units[cycles.channels.index(channel)]
    axes.set_xlabel("cycle (%)")
    axes.set_ylabel(f"{channel} ({unit})" if unit else channel)
    axes.set_xlim(0, 100)
    if axes.get_legend_handles_labels()[0]:
        axes.legend(frameon=False)
    return axes


def plot_sessions(
    curves: Columns, channel: str, group: str, *, unit: str = "", ax: Axes | None = None
) -> Axes:
    """Mean and standard deviation of a channel in two sessions, and where they surely differ.

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
    >>> from kineme.cycles import compare_curves, plot_sessions
    >>> from kineme.datasets import bundled_truth
    >>> from matplotlib.figure import Figure
    >>> motion = kineme.read(kineme.bundled_recording())
    >>> cycles = kineme.cycles(motion, kineme.read_segments(bundled_truth()), channels=["knee_l"])
    >>> both = compare_curves(cycles, cycles)
    >>> axes = plot_sessions(both, "knee_l", "walk", ax=Figure().add_subplot())
    """
    rows = (curves["channel"] == channel) & (curves["group"] == group)
    axes = ax if ax is not None else new_axes(6, 3.5)
    percent = curves["percent"][rows]
    for session, color, style in (("first", FIRST, "--"), ("second", SECOND, "-")):
        mean, sd = (curves[f"{session}_{name}"][rows] for name in ("mean", "sd"))
        axes.plot(percent, mean, style, color=color, label=session)
        axes.fill_between(percent, mean - sd, mean + sd, color=color, alpha=0.2, linewidth=0)
    differs = (curves["low"][rows] > 0) | (curves["high"][rows] < 0)
    axes.fill_between(
        percent, 0, 0.03, where=differs, color=SECOND, linewidth=0, step="mid",
        transform=axes.get_xaxis_transform(),
    )  # fmt: skip
    axes.set_xlabel("cycle (%)")
    axes.set_ylabel(f"{channel} ({unit})" if unit else channel)
    axes.set_xlim(0, 100)
    return axes
