"""Read OpenPose: a folder with a JSON file for each frame of a video.

``people`` holds ``pose_keypoints_2d`` of each person: x, y and confidence of 25 (BODY_25), 18
(COCO) or 15 (MPI) keypoints, or of 17 (COCO), 26 (Halpe) or 133 (COCO-WholeBody) from other
programs. ``pose_keypoints_3d``, with z and in the unit of the cameras' calibration, is preferred if
present. Hands and face are left out. OpenPose does not track people; if another program does,
``person_id`` identifies them.

The files of a folder are ordered by the numbers in their names; missing numbers are frames without
people. One file may also hold all frames, as a list or keyed by number. Keypoints with a confidence
below 0.3 count as not seen.

Source: G. Hidalgo et al., OpenPose's documentation of its output.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import replace
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np

from kineme._util.files import read_head
from kineme.errors import ReadError
from kineme.formats.files import FileContent, load
from kineme.formats.keypoints.coco import LAYOUTS
from kineme.formats.keypoints.video import (
    Person,
    order_by_number,
    parse_json,
    split_groups,
    video_to_motion,
)
from kineme.formats.options import ReadOptions
from kineme.recordings import Motion

LIMIT = 0.3

_ARMS = ("RShoulder", "RElbow", "RWrist", "LShoulder", "LElbow", "LWrist")
_LEGS = ("RHip", "RKnee", "RAnkle", "LHip", "LKnee", "LAnkle")
_FACE = ("REye", "LEye", "REar", "LEar")
_FEET = ("LBigToe", "LSmallToe", "LHeel", "RBigToe", "RSmallToe", "RHeel")
NAMES = {
    25: ("Nose", "Neck", *_ARMS, "MidHip", *_LEGS, *_FACE, *_FEET),
    18: ("Nose", "Neck", *_ARMS, *_LEGS, *_FACE),
    15: ("Head", "Neck", *_ARMS, *_LEGS, "Chest"),
    **LAYOUTS,
}
"""Keypoints by their number: OpenPose's BODY_25, COCO and MPI, and those of other programs."""

_NUMBER = re.compile(r"(\d+)(?:_keypoints)?\.json$", re.IGNORECASE)
_KEYS = {"pose_keypoints_3d": 4, "pose_keypoints_2d": 3, "pose_keypoints": 3}


def is_openpose(data: Any) -> bool:
    """Return whether JSON data is one or more of OpenPose's frames."""
    return any(isinstance(frame, Mapping) and "people" in frame for _, frame in _list_frames(data))


def read_openpose(content: FileContent, data: Any, options: ReadOptions) -> Motion:
    """Return the motion of one person in OpenPose's frames."""
    frames = _list_frames(data)
    people = [
        person for number, frame in frames for person in _parse_people(content, number, frame)
    ]
    return _to_motion(content, people, options, [number for number, _ in frames])


def read_openpose_folder(path: Path, options: ReadOptions) -> Motion | None:
    """Return the motion of one person in a folder with a file for each frame, or None."""
    numbered = list_frame_files(path)
    if not numbered:
        return None
    for (number, file), (following, other) in pairwise(numbered):
        if number == following:
            raise ReadError(
                path,
                f"frame {number} is in {file.name} and in {other.name}: put each into its "
                "own folder",
            )
    people: list[Person] = []
    digest: list[bytes] = []
    for number, file in numbered:
        content = load(file)
        data = parse_json(content)
        if not is_openpose(data):
            raise content.error("it has no 'people', so it is not a file of OpenPose")
        people += _parse_people(content, number, data)
        digest.append(content.data)
    content = FileContent(path, b"".join(digest))
    return _to_motion(content, people, options, [number for number, _ in numbered])


def list_frame_files(folder: Path) -> list[tuple[int, Path]]:
    """Return the frame files in a folder with their frame numbers, in order.

    A series of numbered files counts if one of them starts like OpenPose's.
    """
    series: dict[str, list[tuple[int, Path]]] = {}
    for file in folder.iterdir():
        match = _NUMBER.search(file.name)
        if match:
            number = int(match[1][-18:])
            series.setdefault(file.name[: match.start()], []).append((number, file))
    return sorted(
        frame
        for frames in series.values()
        if any(_begins_frame(file) for _, file in frames)
        for frame in frames
    )


def _begins_frame(file: Path) -> bool:
    try:
        head = read_head(file)
    except OSError:
        return False
    # A byte order mark and blanks may precede the JSON.
    return head.lstrip(b"\xef\xbb\xbf \t\r\n").startswith(b"{") and b'"people"' in head


def _list_frames(data: Any) -> list[tuple[int, Any]]:
    """Return the number and the data of each frame."""
    if isinstance(data, Mapping) and "people" in data:
        return [(0, data)]
    if isinstance(data, list):
        return list(enumerate(data))
    return order_by_number(data) if isinstance(data, Mapping) else []


def _parse_people(content: FileContent, number: int, frame: Any) -> list[Person]:
    people = frame.get("people") if isinstance(frame, Mapping) else None
    if not isinstance(people, list):
        raise content.error(f"frame {number} has no list of 'people'")
    return [_parse_person(content, number, person) for person in people]


def _parse_person(content: FileContent, number: int, person: Any) -> Person:
    if not isinstance(person, Mapping):
        raise content.error(f"frame {number} has a person without keypoints")
    for key, width in _KEYS.items():
        if person.get(key):
            groups = split_groups(content, person[key], width)
            return Person(number, groups[:, :-1], groups[:, -1], _parse_id(person.get("person_id")))
    raise content.error(f"frame {number} has a person without {', '.join(_KEYS)}")


def _parse_id(value: Any) -> str | None:
    """Return the number of a tracked person; OpenPose itself writes [-1]."""
    number = value[0] if isinstance(value, list) and value else value
    return str(number) if isinstance(number, int) and number >= 0 else None


def _to_motion(
    content: FileContent, people: list[Person], options: ReadOptions, frames: list[int]
) -> Motion:
    """Return the motion of one person, whose layout follows from the number of keypoints."""
    in_space = [person for person in people if np.shape(person.points)[1:] == (3,)]
    people = in_space or people  # flat ones were seen by one camera only, in pixels
    counts = {len(person.points) for person in people}
    if unknown := counts - NAMES.keys():
        layouts = ", ".join(map(str, sorted(NAMES)))
        raise content.error(f"a person has {min(unknown)} keypoints: {layouts} are known")
    names = NAMES[max(counts, default=25)]
    n = len(names)  # leaves out hands and face of whole bodies
    people = [replace(person, points=person.points[:n], confidence=person.confidence[:n])
              for person in people]  # fmt: skip
    unit, up = (None, None) if in_space else ("pixel", "-y")
    return video_to_motion(
        content, options, "OpenPose", names, people, limit=LIMIT, frames=frames, unit=unit, up=up
    )
