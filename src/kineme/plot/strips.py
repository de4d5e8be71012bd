"""A span of a recording as a strip: a body in a few poses, channels as their lines.

A body is drawn from the side from which it moves most. Its poses stand beside each other; heights
are kept.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection

from kineme._util.arrays import Floats
from kineme._util.checks import check_type, is_number
from kineme.errors import ParameterError
from kineme.plot.timeline import make_axes
from kineme.recordings import Motion, Signals
from kineme.recordings.arrays import to_samples
from kineme.segments.colors import get_cluster_color

if TYPE_CHECKING:
    from collections.abc import Sequence


POSES = 7
"""Poses in a strip."""
MOST_CHANNELS = 12
"""Lines in a strip; of more channels those that vary most."""
BESIDE = 1.15
"""From one pose to the next, widths of a pose."""
SLIM = 0.35
"""Least width that is left for a pose, heights of the body."""


def plot_strip(
    recording: Motion | Signals,
    start_s: float = 0.0,
    stop_s: float | None = None,
    *,
    poses: int = POSES,
    color: str | None = None,
    ax: Axes | None = None,
) -> Axes:
    """Return a span of a recording as a strip of small figures, or as the lines of its channels.

    Parameters
    ----------
    recording : Motion or Signals
    start_s, stop_s : float
        The span, seconds; to the end by default.
    poses : int
        Of a body, evenly over the span.
    color : str, optional
        Of what is drawn, as matplotlib knows it.
    ax : Axes, optional
        Where to draw; Axes of a new figure of pyplot by default.

    Returns
    -------
    Axes

    Raises
    ------
    ParameterError
        No recording, a span outside of it, or no pose.

    Examples
    --------
    >>> import kineme
    >>> from kineme.plot import plot_strip
    >>> from matplotlib.figure import Figure
    >>> ax = plot_strip(kineme.read(kineme.bundled_recording()), 0.5, 1.6, ax=Figure().subplots())
    >>> len(ax.collections[0].get_segments()) % 7  # the same bones in seven poses
    0
    """
    if not isinstance(recording, Signals):
        check_type(recording, Motion, "plot_strip", "kineme.read gives one")
    if not (is_number(poses) and poses == int(poses) and poses >= 1):
        raise ParameterError(f"poses must be a whole number above 0, not {poses!r:.60}")
    first, last = _find_frames(recording, start_s, stop_s)
    drawn = get_cluster_color(0) if color is None else color
    axes = make_axes(6.0, 1.4) if ax is None else ax
    if isinstance(recording, Motion):
        at = np.linspace(first, last - 1, int(poses)).round().astype(np.int64)
        # A root bone stays on the floor, or anywhere: only the body is drawn.
        body, parents = list(recording.skeleton.body), recording.skeleton.parents
        places = recording.positions[:, body]
        outlines = _project_poses(places[first:last], places[at])
        above = [body.index(parents[j]) if parents[j] in body else -1 for j in body]
        _draw_poses(axes, outlines, above, drawn)
    else:
        _draw_channels(axes, recording, first, last, drawn)
    axes.set_axis_off()
    return axes


def _find_frames(
    recording: Motion | Signals, start_s: float, stop_s: float | None
) -> tuple[int, int]:
    """First frame and end of a span; ParameterError where it is none."""
    lasts = recording.n_frames / recording.fps
    stop = lasts if stop_s is None else stop_s
    if not (is_number(start_s) and is_number(stop) and 0 <= start_s < min(stop, lasts)):
        raise ParameterError(
            f"a span lies within the {lasts:.2f} s of the recording, not from {start_s!r:.20} to "
            f"{stop_s!r:.20}"
        )
    return to_samples((start_s, stop), recording.fps, recording.n_frames)


def _project_poses(span: Floats, poses: Floats) -> Floats:
    """Poses (poses, joints, 2): across and up, each around its own middle.

    The line of sight is the level one along which the joints move least about their middle.
    """
    # The level coordinates, x and z.
    level = span[:, :, [0, 2]]
    middle = level.mean(axis=1)
    # Movement of joints against each other: without the path of the body and the mean pose.
    moved = (level - middle[:, None]) - (level - middle[:, None]).mean(axis=0)
    # First right singular vector: the level direction in which the joints move most.
    across = np.linalg.svd(moved.reshape(-1, 2), full_matrices=False)[2][0]
    # Seen so that the body walks to the right; else the larger component decides, for a stable
    # sign.
    travel = float((middle[-1] - middle[0]) @ across)
    sign = np.sign(travel) or np.sign(across[np.argmax(np.abs(across))])
    outlines = poses[:, :, [0, 2]]
    beside = (outlines - outlines.mean(axis=1, keepdims=True)) @ (sign * across)
    up = poses[:, :, 1] - span[:, :, 1].min()
    return np.stack([beside, up], axis=2)


def _draw_poses(axes: Axes, outlines: Floats, parents: Sequence[int], color: str) -> None:
    """Bones of poses beside each other; joints alone where nothing joins them."""
    # A pose that stands upright and slim gets some width as well.
    wide = max(
        2 * float(np.abs(outlines[:, :, 0]).max()), SLIM * float(outlines[:, :, 1].max()), 1e-3
    )
    # (poses, 1, 1) times (2,): each pose is moved to the right of the one before.
    placed = outlines + np.arange(len(outlines))[:, None, None] * np.array([BESIDE * wide, 0.0])
    bones = [(joint, parent) for joint, parent in enumerate(parents) if parent >= 0]
    if bones:
        # A line (2 points, 2 coordinates) for each bone of each pose.
        lines = placed[:, bones].reshape(-1, 2, 2)
        axes.add_collection(LineCollection(list(lines), colors=color, capstyle="round"))
    else:
        axes.scatter(placed[..., 0], placed[..., 1], s=2, color=color)
    tall = max(float(outlines[:, :, 1].max()), 1e-3)
    axes.set_xlim(-BESIDE * wide / 2, BESIDE * wide * (len(outlines) - 0.5))
    axes.set_ylim(-0.03 * tall, 1.03 * tall)
    axes.set_aspect("equal")


def _draw_channels(axes: Axes, signals: Signals, first: int, last: int, color: str) -> None:
    """Draw the lines of channels below each other, each as high as the next."""
    values = signals.values[first:last]
    # The channels that vary most, shown in their own order.
    varied = np.argsort(-values.std(axis=0), kind="stable")
    chosen = np.sort(varied[:MOST_CHANNELS])
    low, high = values[:, chosen].min(axis=0), values[:, chosen].max(axis=0)
    # From 0 to 1; a constant channel stays 0.
    shares = (values[:, chosen] - low) / np.maximum(high - low, 1e-12)
    seconds = np.arange(first, last) / signals.fps
    for row in range(len(chosen)):
        axes.plot(seconds, shares[:, row] - 1.1 * row, color=color, linewidth=1.0)
    axes.margins(0.01)
