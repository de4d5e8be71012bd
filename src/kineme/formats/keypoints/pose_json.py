"""JSON of pose estimators: which of them wrote it is told by what is in it."""

from __future__ import annotations

from kineme.formats.files import FileContent
from kineme.formats.keypoints.coco import is_coco, read_coco
from kineme.formats.keypoints.mediapipe import is_mediapipe, read_mediapipe
from kineme.formats.keypoints.openpose import (
    is_openpose,
    read_openpose,
    read_openpose_folder,
)
from kineme.formats.keypoints.video import parsed_json
from kineme.formats.options import ReadOptions
from kineme.formats.registry import Format
from kineme.recordings import Motion


def read_pose_json(content: FileContent, options: ReadOptions) -> Motion:
    """The motion of one person in a JSON file of keypoints."""
    data = parsed_json(content)
    if is_openpose(data):
        return read_openpose(content, data, options)
    if is_coco(data):
        return read_coco(content, data, options)
    if is_mediapipe(data):
        return read_mediapipe(content, data, options)
    raise content.error(
        "no keypoints found in it: JSON is read as OpenPose ('people'), COCO ('keypoints' and "
        "'image_id') or MediaPipe (33 landmarks per frame)"
    )


def _never(head: bytes) -> bool:  # noqa: ARG001 - a file's beginning does not tell these apart
    return False


OPENPOSE = Format("OpenPose", (".json",), _never, read_pose_json, read_folder=read_openpose_folder)
COCO = Format("COCO", (".json",), _never, read_pose_json)
MEDIAPIPE = Format("MediaPipe", (".json",), _never, read_pose_json)
