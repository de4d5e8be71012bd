"""The size of a body: its bones, however it stands and whatever it is told by."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from kineme.datasets import Action, synthesize
from kineme.errors import MotionError
from kineme.features import body_size, end_effectors
from kineme.recordings import Motion
from kineme.recordings.operations import move, scale, turn


def performed(name: str, size: float = 1.75) -> Motion:
    return synthesize([Action(name, repetitions=3)], fps=30, size=size).motion


def size_of(motion: Motion) -> float:
    return body_size(motion, end_effectors(motion))


def test_it_is_close_to_the_height_and_follows_it() -> None:
    sizes = [size_of(performed("walk", size)) for size in (1.0, 1.5, 2.0)]
    assert 1.5 * 0.8 < sizes[1] < 1.5
    np.testing.assert_allclose(sizes, sizes[1] * np.array([1.0, 1.5, 2.0]) / 1.5)


def test_what_the_body_does_and_where_does_not_matter() -> None:
    walk = performed("walk")
    for motion in (performed("squat"), turn(walk, 1.0), move(walk, (5, 0, -3))):
        assert size_of(motion) == pytest.approx(size_of(walk), rel=1e-6)
    assert size_of(scale(walk, 2.5)) == pytest.approx(2.5 * size_of(walk), rel=1e-6)


def test_without_rotations_it_is_measured_between_the_joints() -> None:
    walk = performed("walk")
    assert size_of(replace(walk, rotations=None)) == pytest.approx(size_of(walk), rel=1e-6)


def test_a_few_wild_frames_do_not_change_it() -> None:
    walk = performed("walk")
    positions = walk.positions.copy()
    positions[10:20] *= 100
    wild = replace(walk, rotations=None, positions=positions)
    assert size_of(wild) == pytest.approx(size_of(walk), rel=1e-6)


def test_a_body_without_extent_is_refused() -> None:
    walk = performed("walk")
    point = replace(walk, rotations=None, positions=np.zeros_like(walk.positions))
    with pytest.raises(MotionError, match="no length"):
        body_size(point, end_effectors(walk))
