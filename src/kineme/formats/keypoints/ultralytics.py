"""Ultralytics: results of a pose model as JSON, a list of frames that list their people.

Each person has ``keypoints`` with lists ``x``, ``y`` and, as a confidence, ``visible``. People are
told apart by ``track_id`` where all have one. Keypoints less sure than 0.3 count as not seen.

Source: Ultralytics' reference of ``Results.summary`` and ``Results.to_json``.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from kineme.formats.files import FileContent
from kineme.formats.keypoints.coco import LIMIT
from kineme.formats.keypoints.coco import NAMES as COCO
from kineme.formats.keypoints.video import Person, Video, video_to_motion
from kineme.formats.options import ReadOptions
from kineme.recordings import Motion


def is_ultralytics(data: Any) -> bool:
    """Return whether JSON of this content is a list of Ultralytics' frames."""
    return isinstance(data, list) and any(_list_people(frame) for frame in data)


def read_ultralytics(content: FileContent, data: Any, options: ReadOptions) -> Motion:
    """Read the motion of one person in Ultralytics' results."""
    found = [(number, each) for number, frame in enumerate(data) for each in _list_people(frame)]
    width = max(len(each["keypoints"]["x"]) for _, each in found)
    names = COCO if width == len(COCO) else tuple(f"point{i + 1}" for i in range(width))
    tracked = all(each.get("track_id") is not None for _, each in found)
    people = []
    for number, each in found:
        points = each["keypoints"]
        x, y = points["x"], points["y"]
        if len(x) != len(y):
            raise content.error(f"frame {number} has {len(x)} x and {len(y)} y of keypoints")
        who = str(each["track_id"])[:40] if tracked else None
        pairs = list(zip(x, y, strict=True))
        # what was not found at all stands at the corner of the image
        sure = points.get("visible") or [float(any(pair)) for pair in pairs]
        people.append(Person(number, pairs, sure, who))
    video = Video("Ultralytics", names, people, LIMIT, frames=range(len(data)))
    return video_to_motion(content, video, options)


def _list_people(frame: Any) -> list[Mapping[str, Any]]:
    """Return the people of a frame that have keypoints."""
    return [
        each
        for each in (frame if isinstance(frame, list) else [])
        if isinstance(each, Mapping)
        and isinstance(each.get("keypoints"), Mapping)
        and all(isinstance(each["keypoints"].get(axis), list) for axis in "xy")
        and each["keypoints"]["x"]
    ]
