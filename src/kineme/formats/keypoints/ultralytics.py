"""Read Ultralytics: results of a pose model as JSON, a list of frames with lists of people.

Each person has ``keypoints`` with lists ``x``, ``y`` and confidences ``visible``. People are
identified by ``track_id`` if all have one. Keypoints with a confidence below 0.3 count as not seen.

Source: Ultralytics' reference of ``Results.summary`` and ``Results.to_json``.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from kineme.formats.files import FileContent
from kineme.formats.keypoints.coco import LIMIT
from kineme.formats.keypoints.coco import NAMES as COCO
from kineme.formats.keypoints.video import Person, name_people, video_to_motion
from kineme.formats.options import ReadOptions
from kineme.recordings import Motion


def is_ultralytics(data: Any) -> bool:
    """Return whether JSON data is a list of Ultralytics' frames."""
    return isinstance(data, list) and any(_list_people(frame) for frame in data)


def read_ultralytics(content: FileContent, data: Any, options: ReadOptions) -> Motion:
    """Return the motion of one person in Ultralytics' results."""
    people_found = [
        (number, detection)
        for number, frame in enumerate(data)
        for detection in _list_people(frame)
    ]
    width = max(len(detection["keypoints"]["x"]) for _, detection in people_found)
    names = COCO if width == len(COCO) else tuple(f"point{i + 1}" for i in range(width))
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


def _list_people(frame: Any) -> list[Mapping[str, Any]]:
    """Return the people of a frame that have keypoints."""
    return [
        person
        for person in (frame if isinstance(frame, list) else [])
        if isinstance(person, Mapping)
        and isinstance(person.get("keypoints"), Mapping)
        and all(isinstance(person["keypoints"].get(axis), list) for axis in "xy")
        and person["keypoints"]["x"]
    ]
