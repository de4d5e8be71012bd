"""Read JSON of pose estimators; the content identifies the program."""

from __future__ import annotations

import re

from kineme.formats.files import FileContent
from kineme.formats.keypoints.coco import is_coco, read_coco
from kineme.formats.keypoints.mediapipe import is_mediapipe, read_mediapipe
from kineme.formats.keypoints.mmpose import is_mmpose, read_mmpose
from kineme.formats.keypoints.openpose import (
    is_openpose,
    read_openpose,
    read_openpose_folder,
)
from kineme.formats.keypoints.ultralytics import is_ultralytics, read_ultralytics
from kineme.formats.keypoints.video import parse_json
from kineme.formats.options import ReadOptions
from kineme.formats.registry import Format
from kineme.recordings import Motion

_SEVERAL = re.compile(rb'\s*(\[|\{\s*"\d+"\s*:)')
_FRAMES = re.compile(rb"\s*\[\s*\[")
_READERS = (
    (is_openpose, read_openpose),
    (is_coco, read_coco),
    (is_mmpose, read_mmpose),
    (is_mediapipe, read_mediapipe),
    (is_ultralytics, read_ultralytics),
)
"""Test and reader of each program, in the order in which they are tried."""

_OF_COCO = (b'"image_id"', b'"images"', b'"annotations"')


def read_pose_json(content: FileContent, options: ReadOptions) -> Motion:
    """Return the motion of one person in a JSON file of keypoints."""
    data = parse_json(content)
    for recognises, read in _READERS:
        if recognises(data):
            return read(content, data, options)
    raise content.error(
        "no keypoints found in it: kineme reads JSON of OpenPose ('people'), COCO "
        "('keypoints' and 'image_id'), MMPose ('instances'), MediaPipe (33 landmarks per "
        "frame) or Ultralytics"
    )


def begins_openpose(head: bytes) -> bool:
    """Return whether JSON starts like a list of OpenPose's frames, or frames keyed by number.

    A single frame does not count: it belongs to its folder.
    """
    return b'"people"' in head and _SEVERAL.match(head) is not None


def begins_coco(head: bytes) -> bool:
    """Return whether JSON starts like COCO's results, or like a data set of COCO.

    For data sets that begin with their images, ``head`` includes the last bytes of the file.
    """
    return b'"keypoints"' in head and any(key in head for key in _OF_COCO)


OPENPOSE = Format(
    "OpenPose", (".json",), begins_openpose, read_pose_json, read_folder=read_openpose_folder
)
COCO = Format("COCO", (".json",), begins_coco, read_pose_json)
MMPOSE = Format(
    "MMPose",
    (".json",),
    lambda head: b'"instance_info"' in head or (b'"instances"' in head and b'"frame_id"' in head),
    read_pose_json,
)
MEDIAPIPE = Format(
    "MediaPipe",
    (".json",),
    lambda head: b'landmarks":' in head.lower().replace(b" ", b""),
    read_pose_json,
)
ULTRALYTICS = Format(
    "Ultralytics",
    (".json",),
    lambda head: b'"box"' in head and _FRAMES.match(head) is not None,  # lists of people with boxes
    read_pose_json,
)
