"""Pose the synthetic figure at known angles, and find recordings that not every set has."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

from kineme.datasets.figure import ANGLES, compute_joint_rotations, make_figure
from kineme.recordings import Motion


def find_recording(data_dir: Path, name: str) -> Path:
    """Return the path of a recording; skip the test without it."""
    path = data_dir / name
    if not path.exists():
        pytest.skip(f"no {name} among the recordings")
    return path


def pose_figure(fps: float = 60.0, **angles: NDArray[np.float64]) -> Motion:
    """The figure at angles in degrees, by names with ``_`` for a blank; the others are 0."""
    n = max(map(len, angles.values()))
    given = {name.replace("_", " "): values for name, values in angles.items()}
    full = {name: np.resize(given.get(name, np.zeros(1)), n) for name in ANGLES}
    heading = np.resize(given.get("heading", np.zeros(1)), n)
    skeleton = make_figure()
    rotations = compute_joint_rotations(skeleton, full, heading)
    return Motion.from_rotations(skeleton, rotations, fps, np.tile([0.0, 1.0, 0.0], (n, 1)))
