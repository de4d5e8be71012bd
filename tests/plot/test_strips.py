"""Strips: a body in a few poses, channels as lines."""

from __future__ import annotations

import numpy as np
import pytest
from matplotlib.figure import Figure

import kineme
from kineme.errors import ParameterError
from kineme.plot import plot_strip
from kineme.recordings import Motion, Signals, Skeleton


def turned(motion: Motion, degrees: float) -> Motion:
    """The motion of somebody who faces elsewhere."""
    cos, sin = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
    turn = np.array([[cos, 0, sin], [0, 1, 0], [-sin, 0, cos]])
    return Motion(motion.skeleton, motion.positions @ turn.T, motion.fps)


def test_poses_look_alike_wherever_somebody_faces() -> None:
    walk = kineme.read(kineme.bundled_recording()).seconds(0.5, 1.6)
    drawn = [
        np.array(plot_strip(each, ax=Figure().subplots()).collections[0].get_segments())
        for each in (walk, turned(walk, 70))
    ]
    assert len(drawn[0]) == 7 * sum(parent >= 0 for parent in walk.skeleton.parents)
    np.testing.assert_allclose(*drawn, atol=1e-6)


def test_points_and_channels_are_drawn_without_bones() -> None:
    rng = np.random.default_rng(0)
    points = Motion(Skeleton(("a", "b"), (-1, -1), np.zeros((2, 3))), rng.normal(size=(9, 2, 3)), 9)
    dots = plot_strip(points, poses=3, ax=Figure().subplots()).collections[0]
    assert len(dots.get_offsets()) == 6
    channels = Signals(rng.normal(size=(90, 20)), 30, tuple(f"c{i}" for i in range(20)))
    assert len(plot_strip(channels, 1.0, 2.0, ax=Figure().subplots()).lines) == 12


@pytest.mark.parametrize("span", [(9.0, None), (2.0, 1.0), (-1.0, 2.0), (0.0, "end")])
def test_a_span_that_is_none_is_refused(span: tuple[float, float]) -> None:
    signals = Signals(np.zeros((90, 2)), 30, ("a", "b"))
    with pytest.raises(ParameterError, match="a span lies within the 3.00 s"):
        plot_strip(signals, *span, ax=Figure().subplots())
