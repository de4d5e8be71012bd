"""The mean curve of a channel, drawn."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from kineme._colors import cluster_color
from kineme.cycles.table import Cycles
from kineme.errors import ParameterError
from kineme.segments.timeline import new_axes

if TYPE_CHECKING:
    from matplotlib.axes import Axes


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
