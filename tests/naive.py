"""Slow, literal versions of the formulas: the oracle of every fast path."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from kineme.motion import Motion

Floats = NDArray[np.float64]


# --- features: one frame and one joint at a time, on scipy rotations --------------------------


def pose_features(motion: Motion, joints: Sequence[int]) -> Floats:
    """Features of a motion whose root is its pelvis and has the body's left at +x."""
    rows = []
    for pose, quaternions in zip(motion.positions, motion.rotations, strict=True):
        to_left = Rotation.from_quat(quaternions[0], scalar_first=True).apply([1.0, 0.0, 0.0])
        turn = Rotation.from_euler("y", np.arctan2(to_left[2], to_left[0]))
        rows.append(np.concatenate([turn.apply(pose[joint] - pose[0]) for joint in joints]))
    return np.array(rows)


def stack(features: Floats, offsets: Sequence[int]) -> Floats:
    n = len(features)
    rows = []
    for t in range(n):
        row = []
        for offset in sorted(offsets):
            at = t + offset
            if at < 0:
                row.append(features[0] + at * (features[min(1, n - 1)] - features[0]))
            elif at >= n:
                beyond = at - (n - 1)
                row.append(features[-1] + beyond * (features[-1] - features[max(n - 2, 0)]))
            else:
                row.append(features[at])
        rows.append(np.concatenate(row))
    return np.array(rows)
