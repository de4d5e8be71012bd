"""Read JSON of detectors that list the people in each frame: OpenPose, COCO, MMPose, Ultralytics.

People are identified by the number of their track if all of them have one. Keypoints with a
confidence below 0.3 count as not seen. Hands and face of whole bodies are left out.

*OpenPose*: a frame, a list of frames, or frames keyed by number. ``people`` holds
``pose_keypoints_2d`` of each person: x, y and confidence of 25 (BODY_25), 18 (COCO) or 15 (MPI)
keypoints, or of 17 (COCO), 26 (Halpe) or 133 (COCO-WholeBody) from other programs.
``pose_keypoints_3d``, with z and in the unit of the cameras' calibration, is preferred if present.
OpenPose does not track people and writes a ``person_id`` of -1; other programs number them.

*COCO*: a list of detection results. Each has ``image_id``, which ends in the number of the frame,
and ``keypoints``: x, y and confidence of each of 17 keypoints. The track is ``track_id``,
``person_id``, ``instance_id`` or ``idx`` (AlphaPose). Data sets, whose images are no video, are not
read.

*MMPose*: predictions that its inferencers and demos write. ``instance_info``, or the file itself,
is a list of frames with ``frame_id`` and ``instances``. Each instance has ``keypoints``, two or
three numbers each, ``keypoint_scores`` and perhaps ``track_id``. ``meta_info`` holds the names;
without them those of COCO (17 keypoints), Halpe (26) or the first of COCO-WholeBody (133) are used.
Three-dimensional keypoints, as its lifters produce, have z up and an unknown unit.

*Ultralytics*: results of a pose model, a list of frames with lists of people. Each person has
``keypoints`` with lists ``x``, ``y`` and confidences ``visible``, and perhaps ``track_id``.

Sources: G. Hidalgo et al., OpenPose's documentation of its output; T.-Y. Lin et al., "Microsoft
COCO", ECCV 2014, and its page on formats; MMPose's guide on inference, and its demos
``topdown_demo_with_mmdet`` and ``body3d_pose_lifter_demo``; Ultralytics' reference of
``Results.summary`` and ``Results.to_json``.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any, NamedTuple

from kineme._util.checks import is_number, make_unique
from kineme.formats.files import FileContent
from kineme.formats.keypoints.video import (
    Person,
    name_people,
    order_by_number,
    split_groups,
    video_to_motion,
)
from kineme.formats.options import ReadOptions
from kineme.recordings import Motion

LIMIT = 0.3

Names = Sequence[str]

NAMES = (
    "nose", "left_eye", "right_eye", "left_ear", "right_ear", "left_shoulder", "right_shoulder",
    "left_elbow", "right_elbow", "left_wrist", "right_wrist", "left_hip", "right_hip",
    "left_knee", "right_knee", "left_ankle", "right_ankle",
)  # fmt: skip
_TOES = ("left_big_toe", "left_small_toe", "left_heel")
_FEET = (*_TOES, *(name.replace("left", "right") for name in _TOES))
_HALPE = ("head", "neck", "hip", *(f"{side}_{part}" for part in ("big_toe", "small_toe", "heel")
                                  for side in ("left", "right")))  # fmt: skip
LAYOUTS: Mapping[int, Names] = {17: NAMES, 26: (*NAMES, *_HALPE), 133: (*NAMES, *_FEET)}
"""Keypoints of COCO, Halpe and COCO-WholeBody by their number; hands and face are left out."""

_ARMS = ("RShoulder", "RElbow", "RWrist", "LShoulder", "LElbow", "LWrist")
_LEGS = ("RHip", "RKnee", "RAnkle", "LHip", "LKnee", "LAnkle")
_FACE = ("REye", "LEye", "REar", "LEar")
_SOLES = ("LBigToe", "LSmallToe", "LHeel", "RBigToe", "RSmallToe", "RHeel")
OPENPOSE_LAYOUTS: Mapping[int, Names] = {
    25: ("Nose", "Neck", *_ARMS, "MidHip", *_LEGS, *_FACE, *_SOLES),
    18: ("Nose", "Neck", *_ARMS, *_LEGS, *_FACE),
    15: ("Head", "Neck", *_ARMS, *_LEGS, "Chest"),
    **LAYOUTS,
}
"""Keypoints by their number: OpenPose's BODY_25, COCO and MPI, and those of other programs."""

_DIGITS = re.compile(r"\d+")


class Detector(NamedTuple):
    """A program, and the keys under which its JSON holds people."""

    program: str
    frame: tuple[str, ...]  # keys of a frame; () if it is a list of people
    people: str  # key of a frame's list of people; "" if the frame is the list, or one person
    number: str  # key of a frame's number; "" if frames are counted
    keypoints: Mapping[str, int]  # keys, preferred ones first; numbers of each keypoint, 0: nested
    ids: tuple[str, ...]
    layouts: Mapping[int, Names]
    up: str | None = None  # of three-dimensional keypoints


OPENPOSE = Detector(
    "OpenPose", ("people",), "people", "",
    {"pose_keypoints_3d": 4, "pose_keypoints_2d": 3, "pose_keypoints": 3},
    ("person_id",), OPENPOSE_LAYOUTS,
)  # fmt: skip
COCO = Detector(
    "COCO", ("image_id", "keypoints"), "", "image_id", {"keypoints": 3},
    ("track_id", "person_id", "instance_id", "idx"), {17: NAMES},
)  # fmt: skip
MMPOSE = Detector(
    "MMPose", ("instances",), "instances", "frame_id", {"keypoints": 0},
    ("track_id",), LAYOUTS, up="z",
)  # fmt: skip
ULTRALYTICS = Detector("Ultralytics", (), "", "", {"keypoints": 0}, ("track_id",), {17: NAMES})


def find_detector(data: Any) -> Detector | None:
    """Return the program that wrote JSON data, or None."""
    frames = [frame for _, frame in list_frames(data)]
    for detector in (OPENPOSE, COCO, MMPOSE, ULTRALYTICS):
        if any(is_frame(detector, frame) for frame in frames):
            return detector
    return None


def is_frame(detector: Detector, frame: Any) -> bool:
    """Return whether JSON data is a frame of this program; for COCO, a person in a frame."""
    if detector.frame:
        return isinstance(frame, Mapping) and all(key in frame for key in detector.frame)
    people = frame if isinstance(frame, list) else []
    return any(isinstance(person, Mapping) and "keypoints" in person for person in people)


def list_frames(data: Any) -> list[tuple[int, Any]]:
    """Return the number and the data of each frame."""
    if isinstance(data, Mapping):
        if "people" in data:
            return [(0, data)]
        if "instance_info" not in data:
            return order_by_number(data)
        data = data["instance_info"]
    return list(enumerate(data)) if isinstance(data, list) else []


def read_detections(
    content: FileContent,
    options: ReadOptions,
    detector: Detector,
    frames: Sequence[tuple[int, Any]],
    data: Any = None,
) -> Motion:
    """Return the motion of one person in numbered frames; ``data`` may name the keypoints."""
    found: list[tuple[Mapping[str, Any], Person]] = []
    numbers = []
    for index, frame in frames:
        people = frame
        if detector.people:
            people = frame.get(detector.people) if isinstance(frame, Mapping) else None
            if not isinstance(people, list):
                raise content.error(f"frame {index} has no list of {detector.people!r}")
        elif detector.frame:
            if not (isinstance(frame, Mapping) and frame.get("keypoints")):
                continue
            people = [frame]
        number = _find_number(content, detector, index, frame)
        numbers.append(number)
        for person in people if isinstance(people, list) else []:
            keypoints = _parse_keypoints(content, detector, number, person)
            if keypoints:
                found.append((person, Person(number, *keypoints)))
            elif detector.people:
                keys = ", ".join(detector.keypoints)
                raise content.error(f"frame {number} has a person without {keys}")
    in_space = [(entry, person) for entry, person in found if _is_in_space(person.points)]
    found = in_space or found  # flat ones were seen by one camera only, in pixels
    names = _find_names(content, detector, data, [len(person.points) for _, person in found])
    ids = name_people([entry for entry, _ in found], *detector.ids)
    n = len(names)  # leaves out hands and face of whole bodies
    chosen = [
        replace(person, points=person.points[:n], confidence=person.confidence[:n], who=who)
        for (_, person), who in zip(found, ids, strict=True)
    ]
    unit, up = (None, detector.up) if in_space else ("pixel", "-y")
    return video_to_motion(
        content, options, detector.program, names, chosen,
        limit=LIMIT, frames=numbers, unit=unit, up=up,
    )  # fmt: skip


def _find_number(content: FileContent, detector: Detector, index: int, frame: Any) -> int:
    """Return the frame's number, the last in a text: 12, 12.0, "12.jpg", "video_0012"."""
    value = frame.get(detector.number) if detector.number else index
    if value is None and detector.people:
        return index
    if is_number(value):
        return int(value)
    digits = _DIGITS.findall(str(value)[:200])
    if not digits:
        raise content.error(f"{detector.number} {str(value)[:40]!r} has no frame number in it")
    return int(digits[-1][-18:])


def _parse_keypoints(
    content: FileContent, detector: Detector, number: int, person: Any
) -> tuple[Any, Any] | None:
    """Return the points of a person and their confidences, or None; their size is not checked."""
    entry = person if isinstance(person, Mapping) else {}
    key = next((key for key in detector.keypoints if entry.get(key)), "")
    if not key:
        return None
    points = entry[key]
    if not isinstance(points, list | Mapping):
        raise content.error(f"frame {number} has keypoints that are not numeric")
    if width := detector.keypoints[key]:
        groups = split_groups(content, points, width)
        return groups[:, :-1], groups[:, -1]
    if isinstance(points, Mapping):
        x, y = points.get("x"), points.get("y")
        if not (isinstance(x, list) and isinstance(y, list) and x):
            return None
        if len(x) != len(y):
            raise content.error(f"frame {number} has {len(x)} x and {len(y)} y of keypoints")
        points = list(zip(x, y, strict=True))
        # Keypoints that were not found are at the corner of the image.
        scores = entry[key].get("visible") or [float(any(pair)) for pair in points]
    else:
        scores = entry.get("keypoint_scores")
    # Anything that is no list of numbers is refused by `video_to_motion`.
    return points, scores if isinstance(scores, list) else ["none"]


def _is_in_space(points: Any) -> bool:
    return len(points) > 0 and hasattr(points[0], "__len__") and len(points[0]) == 3


def _find_names(
    content: FileContent, detector: Detector, data: Any, counts: Sequence[int]
) -> Names:
    """Return the names in the file, else the usual ones for the number of keypoints."""
    if not counts:
        return ()
    count = max(counts)
    metadata = data.get("meta_info") if isinstance(data, Mapping) else None
    named = metadata.get("keypoint_id2name") if isinstance(metadata, Mapping) else None
    if isinstance(named, Mapping) and count in (len(named), 133):
        listed = make_unique(str(named.get(str(i), i)) for i in range(count))
        return listed[: len(LAYOUTS[133])] if count == 133 else listed
    if count in detector.layouts:
        return detector.layouts[count]
    if detector is ULTRALYTICS:
        return [f"point{i + 1}" for i in range(count)]
    known = ", ".join(map(str, sorted(detector.layouts)))
    raise content.error(f"a person has {count} keypoints: {known} are known")
