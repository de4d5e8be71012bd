"""Plot a span of a recording as a strip: a body as a row of poses, channels as lines.

A body is seen from the side that shows most of its movement. Heights are kept. A contact sheet is a
picture of several strips, each with a title.
"""

from __future__ import annotations

from collections.abc import Sequence
from os import PathLike
from typing import NamedTuple

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure

from kineme._util.arrays import Floats
from kineme._util.checks import check_type, is_number, is_whole_number
from kineme._util.files import atomic_write
from kineme.errors import ParameterError
from kineme.plot.timeline import make_axes
from kineme.recordings import Motion, Signals
from kineme.recordings.arrays import to_samples
from kineme.segments.display import get_cluster_color

POSES = 7
"""Default number of poses."""
MAX_CHANNELS = 12
"""Lines in a strip; those channels are drawn that vary most."""
POSE_SPACING = 1.15
"""Distance between two poses, relative to the width of a pose."""
MIN_WIDTH = 0.35
"""Smallest width of a pose, relative to the height of the body."""
WIDTH, HEIGHT = 7.0, 1.4
"""Width and height of a strip in inches."""
MAX_SINGLE_COLUMN = 12
"""Strips up to which one column is used; above, there are three."""
MAX_STRIPS = 300
"""Strips on a sheet; the rest is left out."""


def plot_strip(
    recording: Motion | Signals,
    start_s: float = 0.0,
    stop_s: float | None = None,
    *,
    poses: int = POSES,
    color: str | None = None,
    ax: Axes | None = None,
) -> Axes:
    """Draw a span of a recording as a row of poses, or as the lines of its channels.

    Parameters
    ----------
    recording : Motion or Signals
    start_s, stop_s : float
        The span in seconds; by default up to the end.
    poses : int
        Number of poses of a body, evenly spaced over the span.
    color : str, optional
        A matplotlib colour.
    ax : Axes, optional
        Where to draw; Axes of a new figure of pyplot by default.

    Raises
    ------
    ParameterError
        The first argument is no recording, the span is outside of it, or ``poses`` is below 1.

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
    if not is_whole_number(poses, 1):
        raise ParameterError(f"poses must be a whole number above 0, not {poses!r:.60}")
    first, last = _find_frames(recording, start_s, stop_s)
    stroke = get_cluster_color(0) if color is None else color
    axes = make_axes(6.0, 1.4) if ax is None else ax
    if isinstance(recording, Motion):
        frames = np.linspace(first, last - 1, int(poses)).round().astype(np.int64)
        # Draw the body only: a root bone may be anywhere, such as on the floor.
        body, parents = list(recording.skeleton.body), recording.skeleton.parents
        positions = recording.positions[:, body]
        outlines = _project_poses(positions[first:last], positions[frames])
        body_parents = [body.index(parents[j]) if parents[j] in body else -1 for j in body]
        _draw_poses(axes, outlines, body_parents, stroke)
    else:
        _draw_channels(axes, recording, first, last, stroke)
    axes.set_axis_off()
    return axes


def _find_frames(
    recording: Motion | Signals, start_s: float, stop_s: float | None
) -> tuple[int, int]:
    """Return first frame and end of a span; ParameterError if it is outside the recording."""
    duration = recording.n_frames / recording.fps
    stop = duration if stop_s is None else stop_s
    if not (is_number(start_s) and is_number(stop) and 0 <= start_s < min(stop, duration)):
        raise ParameterError(
            f"a span must be within the {duration:.2f} s of the recording, not from "
            f"{start_s!r:.20} to {stop_s!r:.20}"
        )
    return to_samples((start_s, stop), recording.fps, recording.n_frames)


def _project_poses(span: Floats, poses: Floats) -> Floats:
    """Return poses (poses, joints, 2): horizontal and vertical, each centred.

    The viewing direction is the horizontal one along which the joints move least relative to each
    other.
    """
    # Horizontal coordinates, x and z.
    horizontal = span[:, :, [0, 2]]
    middle = horizontal.mean(axis=1)
    # Movement of joints relative to each other: subtract the path of the body and the mean pose.
    relative = (horizontal - middle[:, None]) - (horizontal - middle[:, None]).mean(axis=0)
    # First right singular vector: the horizontal direction in which the joints move most.
    across = np.linalg.svd(relative.reshape(-1, 2), full_matrices=False)[2][0]
    # Choose the sign so that the body walks to the right; without travel, so that the larger
    # component is positive.
    travel = float((middle[-1] - middle[0]) @ across)
    sign = np.sign(travel) or np.sign(across[np.argmax(np.abs(across))])
    outlines = poses[:, :, [0, 2]]
    beside = (outlines - outlines.mean(axis=1, keepdims=True)) @ (sign * across)
    up = poses[:, :, 1] - span[:, :, 1].min()
    return np.stack([beside, up], axis=2)


def _draw_poses(axes: Axes, outlines: Floats, parents: Sequence[int], color: str) -> None:
    """Draw the bones of poses next to each other; joints only if there are no bones."""
    # Slim upright poses get a minimum width.
    width = max(
        2 * float(np.abs(outlines[:, :, 0]).max()), MIN_WIDTH * float(outlines[:, :, 1].max()), 1e-3
    )
    # (poses, 1, 1) times (2,) shifts each pose to the right of the previous one.
    placed = outlines + np.arange(len(outlines))[:, None, None] * np.array(
        [POSE_SPACING * width, 0.0]
    )
    bones = [(joint, parent) for joint, parent in enumerate(parents) if parent >= 0]
    if bones:
        # One line (2 points, 2 coordinates) per bone and pose.
        lines = placed[:, bones].reshape(-1, 2, 2)
        axes.add_collection(LineCollection(list(lines), colors=color, capstyle="round"))
    else:
        axes.scatter(placed[..., 0], placed[..., 1], s=2, color=color)
    height = max(float(outlines[:, :, 1].max()), 1e-3)
    axes.set_xlim(-POSE_SPACING * width / 2, POSE_SPACING * width * (len(outlines) - 0.5))
    axes.set_ylim(-0.03 * height, 1.03 * height)
    axes.set_aspect("equal")


def _draw_channels(axes: Axes, signals: Signals, first: int, last: int, color: str) -> None:
    """Draw the lines of channels below each other, scaled to the same height."""
    values = signals.values[first:last]
    # The channels that vary most, shown in their own order.
    by_variation = np.argsort(-values.std(axis=0), kind="stable")
    chosen = np.sort(by_variation[:MAX_CHANNELS])
    low, high = values[:, chosen].min(axis=0), values[:, chosen].max(axis=0)
    # Scale to 0 to 1; a constant channel becomes 0.
    shares = (values[:, chosen] - low) / np.maximum(high - low, 1e-12)
    seconds = np.arange(first, last) / signals.fps
    for row in range(len(chosen)):
        axes.plot(seconds, shares[:, row] - 1.1 * row, color=color, linewidth=1.0)
    axes.margins(0.01)


def write_sheet(strips: Sequence[Strip], path: str | PathLike[str]) -> None:
    """Write strips as one picture: ``.png``, ``.pdf`` or ``.svg``."""
    drawn_strips = strips[:MAX_STRIPS]
    columns = 1 if len(drawn_strips) <= MAX_SINGLE_COLUMN else 3
    rows = max(1, -(-len(drawn_strips) // columns))
    figure = Figure(figsize=(WIDTH * columns, HEIGHT * rows), layout="constrained")
    grid = figure.subplots(rows, columns, squeeze=False).ravel()
    for axes in grid:
        axes.set_axis_off()
    for axes, strip in zip(grid, drawn_strips, strict=False):
        plot_strip(strip.recording, color=get_cluster_color(strip.cluster), ax=axes)
        axes.set_title(strip.title, loc="left", fontsize=8)
    if len(strips) > MAX_STRIPS:
        figure.suptitle(f"the first {MAX_STRIPS} of {len(strips)}", fontsize=8)
    with atomic_write(path) as draft:
        figure.savefig(draft, dpi=120)


class Strip(NamedTuple):
    """A span of a recording, and the cluster that sets its colour."""

    title: str
    recording: Motion | Signals
    cluster: int
