"""Read JSON of detectors with COCO's keypoints: COCO itself, MMPose and Ultralytics.

People are identified by the number of their track if all entries have one. Keypoints with a
confidence below 0.3 count as not seen.

*COCO*: a list of detection results. Each has ``image_id``, which ends in the number of the frame,
and ``keypoints``: x, y and confidence of each of the 17 keypoints below. The track is ``track_id``,
``person_id``, ``instance_id`` or ``idx`` (AlphaPose). Data sets, whose images are no video, are not
read.

*MMPose*: predictions that its inferencers and demos write. ``instance_info``, or the file itself,
is a list of frames with ``frame_id`` and ``instances``. Each instance has ``keypoints``, two or
three numbers each, ``keypoint_scores`` and perhaps ``track_id``. ``meta_info`` holds the names;
without them those of COCO (17 keypoints), Halpe (26) or the first of COCO-WholeBody (133) are used.
Hands and face of whole bodies are left out. Three-dimensional keypoints, as its lifters produce,
have z up and an unknown unit.

*Ultralytics*: results of a pose model, a list of frames with lists of people. Each person has
``keypoints`` with lists ``x``, ``y`` and confidences ``visible``, and perhaps ``track_id``.

Sources: T.-Y. Lin et al., "Microsoft COCO", ECCV 2014, and its page on formats; MMPose's guide on
inference, and its demos ``topdown_demo_with_mmdet`` and ``body3d_pose_lifter_demo``; Ultralytics'
reference of ``Results.summary`` and ``Results.to_json``.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from typing import Any

from kineme._util.checks import make_unique
from kineme.formats.files import FileContent
from kineme.formats.keypoints.video import Person, name_people, split_groups, video_to_motion
from kineme.formats.options import ReadOptions
from kineme.recordings import Motion

LIMIT = 0.3

NAMES = (
    "nose", "left_eye", "right_eye", "left_ear", "right_ear", "left_shoulder", "right_shoulder",
    "left_elbow", "right_elbow", "left_wrist", "right_wrist", "left_hip", "right_hip",
    "left_knee", "right_knee", "left_ankle", "right_ankle",
)  # fmt: skip

_TOES = ("left_big_toe", "left_small_toe", "left_heel")
_FEET = (*_TOES, *(name.replace("left", "right") for name in _TOES))
_HALPE = ("head", "neck", "hip", *(f"{side}_{part}" for part in ("big_toe", "small_toe", "heel")
                                  for side in ("left", "right")))  # fmt: skip
LAYOUTS = {17: NAMES, 26: (*NAMES, *_HALPE), 133: (*NAMES, *_FEET)}
"""Keypoints of COCO, Halpe and COCO-WholeBody by their number; hands and face are left out."""

_IDS = ("track_id", "person_id", "instance_id", "idx")
_DIGITS = re.compile(r"\d+")


def is_coco(data: Any) -> bool:
    """Return whether JSON data is a list of results of COCO."""
    return isinstance(data, list) and any(
        isinstance(entry, Mapping) and "keypoints" in entry and "image_id" in entry
        for entry in data
    )


def read_coco(content: FileContent, data: Any, options: ReadOptions) -> Motion:
    """Return the motion of one person in COCO keypoints."""
    entries = [entry for entry in data if isinstance(entry, Mapping) and entry.get("keypoints")]
    people = []
    for entry, person in zip(entries, name_people(entries, *_IDS), strict=True):
        groups = split_groups(content, entry["keypoints"], 3)
        frame = _parse_frame_number(content, entry.get("image_id"))
        people.append(Person(frame, groups[:, :2], groups[:, 2], person))
    count = len(people[0].points) if people else len(NAMES)
    if count != len(NAMES):
        raise content.error(f"a person has {count} keypoints, not {len(NAMES)} as in COCO")
    return video_to_motion(content, options, "COCO", NAMES, people, limit=LIMIT)


def _parse_frame_number(content: FileContent, image: Any) -> int:
    """Return the last number in the image of a result: 12, "12.jpg", "video_0012"."""
    numbers = _DIGITS.findall(str(image)[:200])
    if not numbers:
        raise content.error(f"image_id {str(image)[:40]!r} has no frame number in it")
    return int(numbers[-1][-18:])


def is_mmpose(data: Any) -> bool:
    """Return whether JSON data is MMPose's."""
    return any(
        isinstance(frame, Mapping) and "instances" in frame for frame in _list_mmpose_frames(data)
    )


def read_mmpose(content: FileContent, data: Any, options: ReadOptions) -> Motion:
    """Return the motion of one person in MMPose's predictions."""
    instances_found: list[tuple[int, Mapping[str, Any]]] = []
    numbers = []
    for index, frame in enumerate(_list_mmpose_frames(data)):
        instances = frame.get("instances") if isinstance(frame, Mapping) else None
        if not isinstance(instances, list):
            raise content.error(f"frame {index} has no list of 'instances'")
        number = frame.get("frame_id")
        numbers.append(number if isinstance(number, int) else index)
        instances_found += [
            (numbers[-1], instance) for instance in instances if isinstance(instance, Mapping)
        ]
    if not instances_found:
        raise content.error("no person found in any frame")
    width = max(len(_get_points(instance)) for _, instance in instances_found)
    names = _find_mmpose_names(data, width)
    if not names:
        raise content.error(f"a person has {width} keypoints, and 'meta_info' does not name them")
    ids = name_people([instance for _, instance in instances_found], "track_id")
    people = []
    for (number, instance), person in zip(instances_found, ids, strict=True):
        scores = instance.get("keypoint_scores")
        # Anything that is no list of numbers is refused by `video_to_motion`.
        confidence: list[Any] = scores[: len(names)] if isinstance(scores, list) else ["none"]
        people.append(Person(number, _get_points(instance)[: len(names)], confidence, person))
    first = next((person.points[0] for person in people if person.points), None)
    is_flat = isinstance(first, list) and len(first) == 2
    unit, up = ("pixel", "-y") if is_flat else (None, "z")
    return video_to_motion(
        content, options, "MMPose", names, people, limit=LIMIT, frames=numbers, unit=unit, up=up
    )


def _list_mmpose_frames(data: Any) -> Sequence[Any]:
    frames = data.get("instance_info") if isinstance(data, Mapping) else data
    return frames if isinstance(frames, list) else []


def _get_points(instance: Mapping[str, Any]) -> Sequence[Any]:
    points = instance.get("keypoints")
    return points if isinstance(points, list) else []


def _find_mmpose_names(data: Any, count: int) -> Sequence[str]:
    """Return the names in the file, else the usual ones for this count; empty if unknown."""
    metadata = data.get("meta_info") if isinstance(data, Mapping) else None
    named = metadata.get("keypoint_id2name") if isinstance(metadata, Mapping) else None
    if isinstance(named, Mapping) and count in (len(named), 133):
        listed = make_unique(str(named.get(str(i), i)) for i in range(count))
        return listed[: len(LAYOUTS[133])] if count == 133 else listed
    return LAYOUTS.get(count, ())


def is_ultralytics(data: Any) -> bool:
    """Return whether JSON data is a list of Ultralytics' frames."""
    return isinstance(data, list) and any(_list_ultralytics_people(frame) for frame in data)


def read_ultralytics(content: FileContent, data: Any, options: ReadOptions) -> Motion:
    """Return the motion of one person in Ultralytics' results."""
    people_found = [
        (number, detection)
        for number, frame in enumerate(data)
        for detection in _list_ultralytics_people(frame)
    ]
    width = max(len(detection["keypoints"]["x"]) for _, detection in people_found)
    names = NAMES if width == len(NAMES) else tuple(f"point{i + 1}" for i in range(width))
    ids = name_people([detection for _, detection in people_found], "track_id")
    people = []
    for (number, detection), person in zip(people_found, ids, strict=True):
        points = detection["keypoints"]
        x, y = points["x"], points["y"]
        if len(x) != len(y):
            raise content.error(f"frame {number} has {len(x)} x and {len(y)} y of keypoints")
        pairs = list(zip(x, y, strict=True))
        # Keypoints that were not found are at the corner of the image.
        confidence = points.get("visible") or [float(any(pair)) for pair in pairs]
        people.append(Person(number, pairs, confidence, person))
    frames = range(len(data))
    return video_to_motion(
        content, options, "Ultralytics", names, people, limit=LIMIT, frames=frames
    )


def _list_ultralytics_people(frame: Any) -> list[Mapping[str, Any]]:
    """Return the people of a frame that have keypoints."""
    return [
        person
        for person in (frame if isinstance(frame, list) else [])
        if isinstance(person, Mapping)
        and isinstance(person.get("keypoints"), Mapping)
        and all(isinstance(person["keypoints"].get(axis), list) for axis in "xy")
        and person["keypoints"]["x"]
    ]
