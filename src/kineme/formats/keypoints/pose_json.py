"""Read JSON of pose estimators; the content identifies the program."""

from __future__ import annotations

import re
from dataclasses import replace
from itertools import starmap

from kineme.formats.files import FileContent
from kineme.formats.keypoints import mediapipe, openpose
from kineme.formats.keypoints.detectors import find_detector, list_frames, read_detections
from kineme.formats.keypoints.video import parse_json
from kineme.formats.options import ReadOptions
from kineme.formats.registry import Format
from kineme.recordings import Motion

_STARTS = {
    # A single frame of OpenPose does not count: it belongs to its folder.
    "OpenPose": rb'\s*(\[|\{\s*"\d+"\s*:).*"people"',
    # The metadata of MMPose come first and may be long.
    "MMPose": rb'.*"meta_info"|(?=.*"frame_id").*"instances"',
    "COCO": rb'\s*\[(?=.*"image_id").*"keypoints"',
    "MediaPipe": rb'(?i).*landmarks"\s*:',
    "Ultralytics": rb'\s*\[\s*\[.*"box"',
}
"""How a JSON file of each program starts."""


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


def _make_format(name: str, start: bytes) -> Format:
    pattern = re.compile(start, re.DOTALL)
    return Format(name, (".json",), lambda head: pattern.match(head) is not None, read_pose_json)


_OPENPOSE, *_OTHERS = starmap(_make_format, _STARTS.items())
FORMATS = (replace(_OPENPOSE, read_folder=openpose.read_openpose_folder), *_OTHERS)
