"""Estimate poses with RTMPose through rtmlib: 26 keypoints of each of several people, in the image.

rtmlib downloads its models at the first use. A model file replaces the one that finds keypoints
(ONNX).

Source: T. Jiang et al., RTMPose: Real-time multi-person pose estimation based on MMPose, 2023.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import numpy as np

from kineme.formats.keypoints.detectors import LAYOUTS, LIMIT
from kineme.pose.estimators import Estimate, Picture, Pose, PoseEstimator


@contextmanager
def start_rtmlib(model: Path | None) -> Iterator[Estimate]:
    """Start rtmlib and yield a function that returns the people in a picture."""
    import rtmlib

    body = rtmlib.BodyWithFeet(pose=None if model is None else str(model))

    def estimate(picture: Picture, _: float) -> list[Pose]:
        bgr = np.ascontiguousarray(picture[:, :, ::-1])
        boxes = body.det_model(bgr)
        # Without boxes, rtmlib would treat the whole picture as one person.
        if len(boxes) == 0:
            return []
        keypoints, scores = body.pose_model(bgr, bboxes=boxes)
        pairs = zip(keypoints, scores, strict=True)
        return [
            Pose(np.asarray(points, float), np.asarray(score, float)) for points, score in pairs
        ]

    yield estimate


ESTIMATOR = PoseEstimator("rtmlib", LAYOUTS[26], "rtmlib", start_rtmlib, LIMIT)
