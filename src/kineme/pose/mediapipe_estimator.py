"""Estimate poses with MediaPipe Pose: 33 landmarks of one person, in the image and in metres.

Versions up to 0.10.21 include the model "full" and need no file. Later versions need a model file
of the Pose Landmarker, which earlier ones also accept. The confidence is MediaPipe's
``visibility``: it tells whether something hides a landmark, not whether its position is right. So
all landmarks are used.

Source: V. Bazarevsky et al., BlazePose: On-device real-time body pose tracking, 2020.
"""

from __future__ import annotations

import os
import warnings
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, nullcontext
from pathlib import Path
from typing import Any

import numpy as np

from kineme._util.checks import require_extra
from kineme._util.files import shorten_error
from kineme.errors import ReadError
from kineme.formats.keypoints.mediapipe import LIMIT, NAMES
from kineme.pose.estimators import Estimate, Picture, Pose, PoseEstimator

MODEL_URL = (
    "https://storage.googleapis.com/mediapipe-models/pose_landmarker/pose_landmarker_full/"
    "float16/latest/pose_landmarker_full.task"
)
"""Download address of the model that later versions need."""

WARM_UP_S = 1.0
"""Seconds before the video at which a first, black picture is processed."""

_STDERR = 2


@contextmanager
def start_mediapipe(model: Path | None) -> Iterator[Estimate]:
    """Start MediaPipe and yield a function that returns the person in a picture.

    Raises ReadError if the model is no Pose Landmarker, or if one is needed and none was given.
    """
    with require_extra("mediapipe", "video"), _mute_stderr():
        import mediapipe
    if model is not None:
        with _start_landmarker(mediapipe, model) as estimate:
            yield estimate
        return
    if not hasattr(mediapipe, "solutions"):
        raise ReadError(
            "pose_landmarker_full.task",
            f"is needed by MediaPipe {mediapipe.__version__}: download {MODEL_URL} and give it "
            "with kineme pose VIDEO --pose-model FILE",
        )
    warnings.filterwarnings(
        "ignore", "SymbolDatabase", UserWarning
    )  # from protobuf, for each picture
    with _mute_stderr():
        solution = mediapipe.solutions.pose.Pose(model_complexity=1)  # "full"

    def find(picture: Picture, _: float) -> list[Pose]:
        found = solution.process(picture)
        if found.pose_landmarks is None:
            return []
        return [
            _to_pose(picture, found.pose_landmarks.landmark, found.pose_world_landmarks.landmark)
        ]

    with _run_model(solution, find) as estimate:
        yield estimate


@contextmanager
def _start_landmarker(mediapipe: Any, model: Path) -> Iterator[Estimate]:
    """Start MediaPipe with a model file, through the interface of later versions."""
    vision = mediapipe.tasks.vision
    try:
        options = vision.PoseLandmarkerOptions(
            base_options=mediapipe.tasks.BaseOptions(model_asset_buffer=model.read_bytes()),
            running_mode=vision.RunningMode.VIDEO,
        )
        with _mute_stderr():
            landmarker = vision.PoseLandmarker.create_from_options(options)
    except OSError as error:
        raise ReadError(model, f"cannot be opened: {error.strerror or error}") from error
    except (RuntimeError, ValueError) as error:
        reason = f"is not a model of the Pose Landmarker: {shorten_error(error)}"
        raise ReadError(model, f"{reason}; download one from {MODEL_URL}") from error

    def find(picture: Picture, time: float) -> list[Pose]:
        image = mediapipe.Image(image_format=mediapipe.ImageFormat.SRGB, data=picture)
        found = landmarker.detect_for_video(image, round(1000 * (time + WARM_UP_S)))
        pairs = zip(found.pose_landmarks, found.pose_world_landmarks, strict=True)
        return [_to_pose(picture, *pair) for pair in pairs]

    with _run_model(landmarker, find) as estimate:
        yield estimate


@contextmanager
def _run_model(model: Any, find: Estimate) -> Iterator[Estimate]:
    """Yield ``find`` without the log messages that MediaPipe writes until it finds somebody."""
    with _mute_stderr():  # part of the start happens with the first picture
        find(np.zeros((64, 64, 3), np.uint8), -WARM_UP_S)
    is_starting = True

    def estimate(picture: Picture, time: float) -> Sequence[Pose]:
        nonlocal is_starting
        with _mute_stderr() if is_starting else nullcontext():
            poses = find(picture, time)
        is_starting = is_starting and not poses
        return poses

    try:
        yield estimate
    finally:
        with _mute_stderr():
            model.close()


def _to_pose(picture: Picture, image_landmarks: Any, world_landmarks: Any) -> Pose:
    """Convert landmarks to a pose in pixels and in metres with y up."""
    height, width = picture.shape[:2]
    return Pose(
        np.array([(each.x * width, each.y * height) for each in image_landmarks]),
        np.array([each.visibility for each in image_landmarks]),
        # MediaPipe's y points down and its z away from the camera.
        np.array([(each.x, -each.y, -each.z) for each in world_landmarks]),
    )


@contextmanager
def _mute_stderr() -> Iterator[None]:
    """Discard standard error, to which MediaPipe's C++ code logs in any case."""
    original, sink = os.dup(_STDERR), os.open(os.devnull, os.O_WRONLY)
    try:
        os.dup2(sink, _STDERR)
        yield
    finally:
        os.dup2(original, _STDERR)
        os.close(original)
        os.close(sink)


ESTIMATOR = PoseEstimator("mediapipe", NAMES, "mediapipe", start_mediapipe, LIMIT)
