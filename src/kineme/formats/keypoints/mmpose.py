"""Read MMPose: predictions that its inferencers and demos write as JSON.

``instance_info``, or the file itself, is a list of frames with ``frame_id`` and ``instances``. Each
instance has ``keypoints``, two or three numbers each, and ``keypoint_scores``. ``meta_info`` holds
the names; without them those of COCO (17 keypoints), Halpe (26) or the first of COCO-WholeBody
(133) are used. Hands and face of whole bodies are left out. People are identified by ``track_id``
if all have one. Keypoints with a score below 0.3 count as not seen.

Three-dimensional keypoints, as its lifters produce, have z up and an unknown unit.

Source: MMPose's guide on inference, and its demos ``topdown_demo_with_mmdet`` and
``body3d_pose_lifter_demo``.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from kineme._util.checks import make_unique
from kineme.formats.files import FileContent
from kineme.formats.keypoints.coco import LAYOUTS, LIMIT
from kineme.formats.keypoints.video import Person, name_people, video_to_motion
from kineme.formats.options import ReadOptions
from kineme.recordings import Motion


def is_mmpose(data: Any) -> bool:
    """Return whether JSON data is MMPose's."""
    return any(isinstance(frame, Mapping) and "instances" in frame for frame in _list_frames(data))


def read_mmpose(content: FileContent, data: Any, options: ReadOptions) -> Motion:
    """Return the motion of one person in MMPose's predictions."""
    instances_found: list[tuple[int, Mapping[str, Any]]] = []
    numbers = []
    for index, frame in enumerate(_list_frames(data)):
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
    names = _find_names(data, width)
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


def _list_frames(data: Any) -> Sequence[Any]:
    frames = data.get("instance_info") if isinstance(data, Mapping) else data
    return frames if isinstance(frames, list) else []


def _get_points(instance: Mapping[str, Any]) -> Sequence[Any]:
    points = instance.get("keypoints")
    return points if isinstance(points, list) else []


def _find_names(data: Any, count: int) -> Sequence[str]:
    """Return the names in the file, else the usual ones for this count; empty if unknown."""
    metadata = data.get("meta_info") if isinstance(data, Mapping) else None
    named = metadata.get("keypoint_id2name") if isinstance(metadata, Mapping) else None
    if isinstance(named, Mapping) and count in (len(named), 133):
        listed = make_unique(str(named.get(str(i), i)) for i in range(count))
        return listed[: len(LAYOUTS[133])] if count == 133 else listed
    return LAYOUTS.get(count, ())
