"""Read JSON of pose estimators; the content identifies the program."""

from __future__ import annotations

import re
from dataclasses import replace

from kineme.formats.files import FileContent
from kineme.formats.keypoints import mediapipe, openpose
from kineme.formats.keypoints.detectors import find_detector, list_frames, read_detections
from kineme.formats.keypoints.video import parse_json
from kineme.formats.options import ReadOptions
from kineme.formats.registry import Format
from kineme.recordings import Motion

_SEVERAL = re.compile(rb'\s*(\[|\{\s*"\d+"\s*:)')
_FRAMES = re.compile(rb"\s*\[\s*\[")


def read_pose_json(content: FileContent, options: ReadOptions) -> Motion:
    """Return the motion of one person in a JSON file of keypoints."""
    data = parse_json(content)
    if detector := find_detector(data):
        return read_detections(content, options, detector, list_frames(data), data)
    if mediapipe.is_mediapipe(data):
        return mediapipe.read_mediapipe(content, data, options)
    raise content.error(
        "no keypoints found in it: kineme reads JSON of OpenPose ('people'), COCO "
        "(a list with 'keypoints' and 'image_id'), MMPose ('instances'), MediaPipe (a list "
        "of frames with 33 landmarks) or Ultralytics"
    )


def begins_openpose(head: bytes) -> bool:
    """Return whether JSON starts like a list of OpenPose's frames, or frames keyed by number.

    A single frame does not count: it belongs to its folder.
    """
    return b'"people"' in head and _SEVERAL.match(head) is not None


def begins_coco(head: bytes) -> bool:
    """Return whether JSON starts like a list of COCO's results."""
    is_list = head.lstrip().startswith(b"[")
    return is_list and b'"keypoints"' in head and b'"image_id"' in head


def begins_mmpose(head: bytes) -> bool:
    """Return whether JSON starts like MMPose's predictions, with or without their metadata."""
    # The metadata come first and may be long.
    return b'"meta_info"' in head or (b'"instances"' in head and b'"frame_id"' in head)


def begins_mediapipe(head: bytes) -> bool:
    """Return whether JSON starts like a list of MediaPipe's landmarks."""
    return b'landmarks":' in head.lower().replace(b" ", b"")


def begins_ultralytics(head: bytes) -> bool:
    """Return whether JSON starts like Ultralytics' lists of people with boxes."""
    return b'"box"' in head and _FRAMES.match(head) is not None


_JSON = Format("OpenPose", (".json",), begins_openpose, read_pose_json)
FORMATS = (
    replace(_JSON, read_folder=openpose.read_openpose_folder),
    replace(_JSON, name="MMPose", recognises=begins_mmpose),
    replace(_JSON, name="COCO", recognises=begins_coco),
    replace(_JSON, name="MediaPipe", recognises=begins_mediapipe),
    replace(_JSON, name="Ultralytics", recognises=begins_ultralytics),
)
