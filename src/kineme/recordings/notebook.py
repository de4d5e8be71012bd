"""Show recordings in a notebook: a small picture and a few facts."""

from __future__ import annotations

from collections.abc import Sequence
from html import escape

import numpy as np

from kineme._util.arrays import Floats
from kineme.recordings.provenance import Provenance
from kineme.recordings.skeleton import Skeleton

_WIDTH, _HEIGHT, _MARGIN = 480, 120, 6
_POSES = 8
_CHANNELS = 6
_SAMPLES = 240
_STYLE = 'fill="none" stroke="currentColor" stroke-width="1" stroke-linejoin="round"'


def make_page(
    title: str, picture: str, facts: Sequence[tuple[str, str]], provenance: Provenance
) -> str:
    """Return HTML for a notebook: the repr, an SVG, facts, the file and its warnings."""
    rows = [*facts, *([("file", provenance.path)] if provenance.path else [])]
    rows += [("warning", note) for note in provenance.warnings]
    cells = "".join(
        f'<tr><th style="text-align:left">{escape(name)}</th>'
        f'<td style="text-align:left">{escape(value)}</td></tr>'
        for name, value in rows
    )
    return f"<div><p>{escape(title)}</p>{picture}<table>{cells}</table></div>"


def draw_poses(skeleton: Skeleton, positions: Floats) -> str:
    """Return an SVG of poses side by side, evenly spaced in time, from the broader side."""
    at = np.linspace(0, len(positions) - 1, min(_POSES, len(positions))).round().astype(int)
    poses = positions[at] - positions[at].mean(axis=1, keepdims=True)
    # View along the axis in which the body is narrower; y points down in SVG.
    wide, deep = np.ptp(poses[..., [0, 2]], axis=1).mean(axis=0)
    across = 0 if wide >= deep else 2
    flat = poses[..., [across, 1]] * (1.0, -1.0)
    size = max(float(np.ptp(flat, axis=1).max()), 1e-9)
    # One scale for all poses, so that the body keeps its size.
    scale = min(_HEIGHT, _WIDTH / len(at)) - 2 * _MARGIN
    middle = (flat.max(axis=1) + flat.min(axis=1)) / 2
    drawn = (flat - middle[:, None]) / size * scale
    drawn[..., 0] += (np.arange(len(at)) + 0.5)[:, None] * (_WIDTH / len(at))
    drawn[..., 1] += _HEIGHT / 2
    bones = [(parent, j) for j, parent in enumerate(skeleton.parents) if parent >= 0]
    dots = [(j, j) for j, parent in enumerate(skeleton.parents) if parent < 0]
    # One path for all bones; roots become dots by the round line cap.
    path = "".join(
        f"M{pose[a, 0]:.1f} {pose[a, 1]:.1f}L{pose[b, 0]:.1f} {pose[b, 1]:.1f}"
        for pose in drawn
        for a, b in (*bones, *dots)
    )
    return _wrap_svg(f'<path d="{path}" stroke-linecap="round" {_STYLE}/>')


def draw_channels(values: Floats) -> str:
    """Return an SVG of the first channels over time, below each other, each in its own range."""
    at = np.linspace(0, len(values) - 1, min(_SAMPLES, len(values))).round().astype(int)
    shown = values[at, :_CHANNELS]
    band = _HEIGHT / shown.shape[1]
    x = np.linspace(_MARGIN, _WIDTH - _MARGIN, len(at))
    low, span = shown.min(axis=0), np.ptp(shown, axis=0)
    # Scale each channel to 0..1; a constant channel becomes 0.
    level = (shown - low) / np.where(span > 0, span, 1)
    lines = []
    for channel in range(shown.shape[1]):
        y = band * (channel + 0.9 - 0.8 * level[:, channel])
        points = " ".join(f"{a:.1f},{b:.1f}" for a, b in zip(x.tolist(), y.tolist(), strict=True))
        lines.append(f'<polyline points="{points}" {_STYLE}/>')
    return _wrap_svg("".join(lines))


def _wrap_svg(inside: str) -> str:
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{_WIDTH}" height="{_HEIGHT}" '
        f'viewBox="0 0 {_WIDTH} {_HEIGHT}">{inside}</svg>'
    )
