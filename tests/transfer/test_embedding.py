"""Whole segments in 32 numbers: what changes them little, what much, and what is refused."""

from __future__ import annotations

import numpy as np
import pytest

from kineme.datasets import Action, synthesize
from kineme.errors import ParameterError
from kineme.features.canonical import matching_poses, mirror_poses
from kineme.transfer.embeddings import embedding


def poses(name: str, **how: float) -> np.ndarray:
    return matching_poses(synthesize([Action(name, 3, **how)], fps=60).motion)


def apart(one: np.ndarray, other: np.ndarray) -> float:
    return float(np.linalg.norm(embedding(one) - embedding(other)))


def test_unit_vectors_of_32_numbers() -> None:
    found = embedding(poses("walk"))
    assert found.shape == (32,)
    assert found.dtype == np.float32
    assert np.linalg.norm(found) == pytest.approx(1, abs=1e-5)


def test_speed_and_side_change_little_and_another_movement_much() -> None:
    walk, kick = poses("walk"), poses("kick")
    assert apart(walk, poses("walk", speed=1.4)) < 0.3
    assert apart(kick, mirror_poses(kick)) < apart(kick, walk)
    for other in ("squat", "jump", "arm circles"):
        assert apart(walk, poses(other)) > 0.8


def test_a_single_pose_is_a_segment() -> None:
    assert np.isfinite(embedding(poses("walk")[:1])).all()


@pytest.mark.parametrize(
    ("given", "said"),
    [
        (np.zeros((5, 40)), "17 numbers each, not 40"),
        (np.zeros((0, 17)), "at least one"),
        (np.full((5, 17), np.nan), "finite"),
    ],
)
def test_what_is_no_segment_is_refused(given: np.ndarray, said: str) -> None:
    with pytest.raises(ParameterError, match=said):
        embedding(given)
