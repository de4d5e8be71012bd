"""MediaPipe Pose: 33 landmarks of one person, in the image and in metres.

Versions up to 0.10.21 bring their models along and need no file. Later ones take a model of the
Pose Landmarker, and so do earlier ones where one is given. The model that is brought along is
"full". ``visibility`` is the confidence: whether something is in front of a landmark, not whether
its place is right; so all landmarks are used.

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
"""Where the model of later versions can be downloaded."""

BEFORE_S = 1.0
"""Seconds before a video at which a first, black picture is shown."""

_STDERR = 2


@contextmanager
def start_mediapipe(model: Path | None) -> Iterator[Estimate]:
    """Give a function from a picture and its time to the person in it.

    ReadError where the model is no Pose Landmarker, or one is needed and none was given.
    """
    with require_extra("mediapipe", "video"), _muted():
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
    warnings.filterwarnings("ignore", "SymbolDatabase", UserWarning)  # of each picture, by protobuf
    with _muted():
        solution = mediapipe.solutions.pose.Pose(model_complexity=1)  # "full"

    def find(picture: Picture, _: float) -> list[Pose]:
        found = solution.process(picture)
        if found.pose_landmarks is None:
            return []
        return [_pose(picture, found.pose_landmarks.landmark, found.pose_world_landmarks.landmark)]

    with _running(solution, find) as estimate:
        yield estimate


@contextmanager
def _start_landmarker(mediapipe: Any, model: Path) -> Iterator[Estimate]:
    """As `start_mediapipe` with a model file, through the interface of later versions."""
    vision = mediapipe.tasks.vision
    try:
        options = vision.PoseLandmarkerOptions(
            base_options=mediapipe.tasks.BaseOptions(model_asset_buffer=model.read_bytes()),
            running_mode=vision.RunningMode.VIDEO,
        )
        with _muted():
            landmarker = vision.PoseLandmarker.create_from_options(options)
    except OSError as error:
        raise ReadError(model, f"cannot be opened: {error.strerror or error}") from error
    except (RuntimeError, ValueError) as error:
        reason = f"is no model of the Pose Landmarker: {shorten_error(error)}"
        raise ReadError(model, f"{reason}; one is at {MODEL_URL}") from error

    def find(picture: Picture, time: float) -> list[Pose]:
        image = mediapipe.Image(image_format=mediapipe.ImageFormat.SRGB, data=picture)
        found = landmarker.detect_for_video(image, round(1000 * (time + BEFORE_S)))
        pairs = zip(found.pose_landmarks, found.pose_world_landmarks, strict=True)
        return [_pose(picture, *pair) for pair in pairs]

    with _running(landmarker, find) as estimate:
        yield estimate


@contextmanager
def _running(model: Any, find: Estimate) -> Iterator[Estimate]:
    """Give ``find``, muted until it finds somebody: all parts of the model have spoken up then."""
    with _muted():  # some of it is logged once the parts are up, which a picture waits for
        find(np.zeros((64, 64, 3), np.uint8), -BEFORE_S)
    is_muted = True

    def estimate(picture: Picture, time: float) -> Sequence[Pose]:
        nonlocal is_muted
        with _muted() if is_muted else nullcontext():
            poses = find(picture, time)
        is_muted = is_muted and not poses
        return poses

    try:
        yield estimate
    finally:
        with _muted():
            model.close()


def _pose(picture: Picture, image_landmarks: Any, world_landmarks: Any) -> Pose:
    """Return a pose: image points in pixels, visibilities, world points in metres, y up."""
    height, width = picture.shape[:2]
    return Pose(
        np.array([(each.x * width, each.y * height) for each in image_landmarks]),
        np.array([each.visibility for each in image_landmarks]),
        # World landmarks have y down and z away from the camera.
        np.array([(each.x, -each.y, -each.z) for each in world_landmarks]),
    )


@contextmanager
def _muted() -> Iterator[None]:
    """Drop the log of MediaPipe's C++ code, which it writes to standard error in any case."""
    kept, sink = os.dup(_STDERR), os.open(os.devnull, os.O_WRONLY)
    try:
        os.dup2(sink, _STDERR)
        yield
    finally:
        os.dup2(kept, _STDERR)
        os.close(kept)
        os.close(sink)


ESTIMATOR = PoseEstimator("mediapipe", NAMES, "mediapipe", start_mediapipe, LIMIT)
