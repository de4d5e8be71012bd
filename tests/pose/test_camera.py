"""Moves of the camera are found in drawn pictures, and said when the poses are read."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

import kineme
from kineme.errors import KinemeWarning
from kineme.pose import Pose
from kineme.pose.camera import CameraWatch
from squats import squat, write_squats

ROOM = np.kron(np.random.default_rng(0).integers(0, 256, (60, 80)), np.ones((12, 12)))
"""A wall of grey squares, 720 by 960 pixels, larger than a picture."""

View = Callable[[float], tuple[float, float, float]]
"""From a time to the left and top of the picture on the wall, and its zoom."""


def draw(view: tuple[float, float, float], time: float) -> np.ndarray:
    """Draw the wall from there, and a person in front of it who moves up and down."""
    left, top, zoom = view
    rows = top + 180 + (np.arange(360) - 180) / zoom
    columns = left + 320 + (np.arange(640) - 320) / zoom
    grey = ROOM[np.ix_(rows.astype(int), columns.astype(int))]
    at = round(100 + 60 * np.sin(3 * time))
    grey[at : at + 200, 270:370] = 40
    grey = grey + np.random.default_rng(round(1000 * time)).normal(0, 8, grey.shape)
    return np.repeat(np.clip(grey, 0, 255).astype(np.uint8)[..., None], 3, axis=2)


def find_moves(view: View) -> list[float]:
    """Return the times in 6 s at which the camera is found to move."""
    camera = CameraWatch()
    times = np.arange(90) / 15
    return [time for time in times.tolist() if camera.measure(draw(view(time), time), time) > 0]


def test_a_still_camera_does_not_move() -> None:
    assert find_moves(lambda time: (50, 50, 1)) == []


@pytest.mark.parametrize(
    "view",
    [
        lambda time: (50 + 60 * np.clip(time - 2, 0, 2), 50, 1),
        lambda time: (50, 50 + 60 * np.clip(time - 2, 0, 2), 1),
        lambda time: (50, 50, 1 + 0.15 * np.clip(time - 2, 0, 2)),
    ],
    ids=["pan", "tilt", "zoom"],
)
def test_moves_are_found(view: View) -> None:
    moves = find_moves(view)
    assert len(moves) >= 3
    assert 2 < moves[0] < 3
    assert 3.4 < moves[-1] < 4.5


@pytest.mark.parametrize(
    "picture",
    [
        lambda time: draw((50, 50, 1), time) * (0.5 + 0.1 * time),
        lambda time: np.random.default_rng(round(15 * time)).normal(128, 4, (360, 640, 3)),
    ],
    ids=["light that changes", "a wall without edges"],
)
def test_what_is_no_move(picture: Callable[[float], np.ndarray]) -> None:
    camera = CameraWatch()
    for time in (np.arange(60) / 15).tolist():
        assert camera.measure(picture(time).astype(np.uint8), time) == 0


def write_moves(path: Path, person: Callable[[float], Pose]) -> Path:
    moves = {2.0: 0.5, 2.4: 0.4, 7.0: 0.5}
    return write_squats(path, np.arange(150) / 15, lambda time: [person(time)], moves=moves)


def test_moves_are_said_with_their_seconds(tmp_path: Path) -> None:
    motion = kineme.read(write_moves(tmp_path / "a.parquet", squat))
    note = next(note for note in motion.provenance.notes if "camera moves" in note)
    assert "at 1.5 to 2.4 s, 6.5 to 7.0 s" in note


def test_in_the_picture_moves_are_a_warning(tmp_path: Path) -> None:
    path = write_moves(
        tmp_path / "a.parquet", lambda time: Pose(squat(time).image, squat(time).confidence)
    )
    with pytest.warns(KinemeWarning, match="camera moves"):
        kineme.read(path)
