"""Read COCO keypoints in JSON: a data set with ``annotations``, or a list of detection results.

Each entry has ``image_id`` and ``keypoints``: x, y and a third number for each of the 17 keypoints
below, or of those named in ``categories``. In a data set the third number is 0 for keypoints that
are not labelled, 1 for hidden and 2 for visible ones; in results it is a confidence. People are
identified by ``track_id``, ``person_id``, ``instance_id`` or ``idx`` (AlphaPose) if all entries
have one.

Frames are the ``images`` of a data set ordered by number or name, else the numbers in ``image_id``.
Keypoints with a confidence below 0.3 count as not seen.

Source: T.-Y. Lin et al., "Microsoft COCO", ECCV 2014, and its page on formats.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from typing import Any

from kineme._util.checks import make_unique
from kineme.formats.files import FileContent
from kineme.formats.keypoints.video import (
    Person,
    name_people,
    split_groups,
    video_to_motion,
)
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
    """Return whether JSON data is a COCO data set or a list of results."""
    entries = data.get("annotations") if isinstance(data, Mapping) else data
    return isinstance(entries, list) and any(
        isinstance(entry, Mapping) and "keypoints" in entry and "image_id" in entry
        for entry in entries
    )


def read_coco(content: FileContent, data: Any, options: ReadOptions) -> Motion:
    """Return the motion of one person in COCO keypoints."""
    is_set = isinstance(data, Mapping)
    entries = [
        entry
        for entry in (data["annotations"] if is_set else data)
        if isinstance(entry, Mapping) and entry.get("keypoints")
    ]
    names = _find_names(data) if is_set else None
    images = data.get("images") if is_set else None
    frames = _find_frames(content, images, entries)
    people = []
    for entry, frame, person in zip(entries, frames, name_people(entries, *_IDS), strict=True):
        groups = split_groups(content, entry["keypoints"], 3)
        people.append(Person(frame, groups[:, :2], groups[:, 2], person))
    count = len(people[0].points) if people else len(NAMES)
    if names is None or len(names) != count:
        names = list(NAMES)
    if count != len(names):
        raise content.error(f"a person has {count} keypoints, not {len(names)} as in COCO")
    numbers = range(len(images)) if isinstance(images, list) else ()
    return video_to_motion(content, options, "COCO", names, people, limit=LIMIT, frames=numbers)


def _find_names(data: Mapping[str, Any]) -> list[str] | None:
    """Return the keypoint names of the first category that has any."""
    categories = data.get("categories")
    for category in categories if isinstance(categories, list) else []:
        names = category.get("keypoints") if isinstance(category, Mapping) else None
        if isinstance(names, list) and names:
            return make_unique(map(str, names))
    return None


def _find_frames(
    content: FileContent, images: Any, entries: Sequence[Mapping[str, Any]]
) -> list[int]:
    """Return the frame of each entry."""
    if isinstance(images, list) and images:
        usable = [image for image in images if isinstance(image, Mapping) and "id" in image]
        # Order images by frame, since ids may be arbitrary.
        order = {str(image["id"]): i for i, image in enumerate(sorted(usable, key=_make_sort_key))}
        for entry in entries:
            if str(entry.get("image_id")) not in order:
                raise content.error(f"image {entry.get('image_id')!r:.40} is not in 'images'")
        return [order[str(entry["image_id"])] for entry in entries]
    return [_parse_frame_number(content, entry.get("image_id")) for entry in entries]


def _make_sort_key(image: Mapping[str, Any]) -> tuple[int, list[int], str]:
    """Return the sort key of an image: frame number, then numbers in its name, then the name."""
    number = image.get("frame_id")
    name = str(image.get("file_name") or image["id"])
    return (number if isinstance(number, int) else 0, _find_numbers(name), name)


def _find_numbers(name: str) -> list[int]:
    return [int(digits[-18:]) for digits in _DIGITS.findall(name)]


def _parse_frame_number(content: FileContent, image: Any) -> int:
    """Return the last number in the image of a result: 12, "12.jpg", "video_0012"."""
    numbers = _find_numbers(str(image)[:200])
    if not numbers:
        raise content.error(f"image_id {str(image)[:40]!r} has no frame number in it")
    return numbers[-1]
