"""RTMPose through rtmlib: 26 keypoints of each of several people, in the image.

rtmlib downloads its models when they are first used. A model that is given is the ONNX file that
finds the keypoints.

Source: T. Jiang et al., RTMPose: Real-time multi-person pose estimation based on MMPose, 2023.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import numpy as np

from kineme.formats.keypoints.coco import LAYOUTS, LIMIT
from kineme.pose.estimators import Estimate, Picture, Pose, PoseEstimator


@contextmanager
def start_rtmlib(model: Path | None) -> Iterator[Estimate]:
    """Give a function from a picture to the people in it."""
    import rtmlib

    body = rtmlib.BodyWithFeet(pose=None if model is None else str(model))

    def estimate(picture: Picture, _: float) -> list[Pose]:
        reversed_colours = np.ascontiguousarray(picture[:, :, ::-1])
        boxes = body.det_model(reversed_colours)
        # Without a box, rtmlib would take the whole picture for a person.
        if len(boxes) == 0:
            return []
        keypoints, scores = body.pose_model(reversed_colours, bboxes=boxes)
        pairs = zip(keypoints, scores, strict=True)
        return [Pose(np.asarray(points, float), np.asarray(sure, float)) for points, sure in pairs]

    yield estimate


ESTIMATOR = PoseEstimator("rtmlib", LAYOUTS[26], "rtmlib", start_rtmlib, LIMIT)
