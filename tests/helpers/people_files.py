"""Write a recording with the markers of several people."""

from __future__ import annotations

from pathlib import Path

import numpy as np

import kineme
from kineme.recordings import Motion, Skeleton
from kineme.recordings.operations import move, resample, turn


def write_people(path: Path, people: dict[str, int], n_frames: int = 360) -> Path:
    """Write parts of the bundled recording as people who stand side by side.

    The rate is 30 frames per second. Marker names start with the person's name.
    """
    whole = resample(kineme.read(kineme.bundled_recording()), 30)
    names: list[str] = []
    positions = []
    for number, (who, start) in enumerate(people.items()):
        part = whole[start : start + n_frames]
        root = part.positions[0, 0] * [1, 0, 1]
        placed = move(turn(move(part, -root), 0.7 * number), (1.4 * number, 0, 0.5 * number))
        names += [f"{who}:{name}" for name in placed.skeleton.names]
        positions.append(placed.positions)
    skeleton = Skeleton(tuple(names), (-1,) * len(names), np.zeros((len(names), 3)))
    kineme.write(Motion(skeleton, np.concatenate(positions, axis=1), 30.0), path)
    return path
