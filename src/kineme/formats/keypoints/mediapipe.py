"""Read MediaPipe Pose: 33 landmarks per frame in JSON or CSV.

MediaPipe has no file format of its own. These forms are read:

- JSON: a list of frames, at top level or under ``frames``. A frame is a list of landmarks, or has
  it under ``pose_world_landmarks``, ``pose_landmarks``, ``world_landmarks``, ``landmarks`` or the
  same in camel case: one list of 33, or a list of these for each person. A landmark has ``x``,
  ``y``, ``z`` and ``visibility``, by name or in order.
- CSV: a row for each frame with columns ``x0 y0 z0 v0`` to 32 (or 1 to 33), ``nose_x`` and so on by
  name or number. Rows may have times or a rate.

World landmarks are metres from the middle of the hips, with y down. They are used if present, or if
the middle of the hips stays at 0; the position in the room is then unknown. Image landmarks are
fractions of the image's width and height; if these are unknown, the image is assumed to be square,
with a warning.
All landmarks are used: visibility states whether a landmark is occluded, not whether its position
is correct. ``confidence`` leaves out those below it.

FreeMoCap's tables of the same landmarks are in space, in millimetres with z up.

Source: Google, MediaPipe's documentation of the Pose Landmarker.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from kineme._util.checks import is_number
from kineme.formats.delimited import DelimitedText
from kineme.formats.dialects import Dialect
from kineme.formats.files import FileContent
from kineme.formats.keypoints.video import (
    Person,
    is_relative,
    to_frame_numbers,
    video_to_motion,
)
from kineme.formats.options import ReadOptions
from kineme.formats.plausibility import split_at
from kineme.formats.sniffing import find_table_timing, place_points
from kineme.recordings import Motion
from kineme.recordings.regular import Timing
from kineme.recordings.times import is_rate, is_timing

LIMIT = 0.0

NAMES = (
    "nose", "left_eye_inner", "left_eye", "left_eye_outer", "right_eye_inner", "right_eye",
    "right_eye_outer", "left_ear", "right_ear", "mouth_left", "mouth_right", "left_shoulder",
    "right_shoulder", "left_elbow", "right_elbow", "left_wrist", "right_wrist", "left_pinky",
    "right_pinky", "left_index", "right_index", "left_thumb", "right_thumb", "left_hip",
    "right_hip", "left_knee", "right_knee", "left_ankle", "right_ankle", "left_heel",
    "right_heel", "left_foot_index", "right_foot_index",
)  # fmt: skip

_WORLD = ("poseworldlandmarks", "worldlandmarks")
_IMAGE = ("poselandmarks", "landmarks")
_NUMBER = ("frame", "frameid", "frameidx", "frameindex", "framenumber", "framenum", "index")
_HIPS = [NAMES.index("left_hip"), NAMES.index("right_hip")]
_PLAIN = re.compile(r"[\s_-]")

_FIELDS = {"x": 0, "y": 1, "z": 2, "v": 3, "vis": 3, "visibility": 3}
_WORD = r"(?:pose|landmarks?|lm|kp|keypoint|point)?[\s_.-]*"
_FIELD = r"(x|y|z|v|vis|visibility)"
_FIELD_FIRST = re.compile(rf"{_WORD}{_FIELD}[\s_.-]*(\d{{1,2}})", re.IGNORECASE)
_FIELD_LAST = re.compile(rf"{_WORD}(\d{{1,2}}|[a-z_ ]+?)[\s_.-]+{_FIELD}", re.IGNORECASE)
_FRAME = re.compile(r"(frame|image)[\s_]*(id|idx|index|no|num|number)?", re.IGNORECASE)


def is_mediapipe(data: Any) -> bool:
    """Return whether JSON data has frames of 33 landmarks."""
    return any(
        _find_poses(frame, world=False) or _find_poses(frame, world=True)
        for frame in _list_frames(data)
    )


def read_mediapipe(content: FileContent, data: Any, options: ReadOptions) -> Motion:
    """Return the motion of one person's landmarks."""
    frames = _list_frames(data)
    world = any(_find_poses(frame, world=True) for frame in frames)
    people: list[Person] = []
    numbers: list[int] = []
    for i, frame in enumerate(frames):
        number = _find_value(frame, _NUMBER) if isinstance(frame, Mapping) else None
        numbers.append(number if isinstance(number, int) else i)
        poses = _find_poses(frame, world=world)
        people += [Person(numbers[-1], *_parse_landmarks(content, i, pose)) for pose in poses]
    head = data if isinstance(data, Mapping) else {}
    fps = _find_value(head, ("fps", "framerate"))
    size = [
        _to_positive(_find_value(head, (side, f"image{side}", f"frame{side}")))
        for side in ("width", "height")
    ]
    return landmarks_to_motion(
        content, people, options, world=world or None, fps=_to_positive(fps),
        size=size, frames=numbers,
    )  # fmt: skip


def landmarks_to_motion(
    content: FileContent,
    people: Sequence[Person],
    options: ReadOptions,
    *,
    world: bool | None = None,
    fps: float | None = None,
    size: Sequence[float | None] = (None, None),
    frames: Sequence[int] = (),
    notes: Sequence[str] = (),
) -> Motion:
    """Return the motion of one person from x, y and z of 33 landmarks in every frame.

    ``world`` states whether these are world landmarks (None: judge by the hips); ``size`` is width
    and height of the image, if known; ``frames`` are the numbers of all frames, also empty ones.
    """
    if world is None and people:
        middles = np.array([np.mean([p.points[hip] for hip in _HIPS], axis=0) for p in people])
        # World landmarks have the middle of the hips at 0 in each frame.
        world = bool(np.nanmax(np.abs(middles), initial=0.0) < 1e-3)
    unit: str | None = "pixel"
    up: str | None = "-y"
    remarks = [*notes]
    if world:
        unit = "m"
        remarks.append(
            "world landmarks: metres from the middle of the hips, without the position in the room"
        )
    elif _are_in_space(people):
        unit = up = None
        remarks.append(
            "landmarks in space, since the body does not stand along the vertical axis of images"
        )
    else:
        people = _scale_to_image(people, size)
    return video_to_motion(
        content, options, "MediaPipe", NAMES, people, limit=LIMIT,
        fps=fps, frames=frames, unit=unit, up=up, notes=remarks,
    )  # fmt: skip


def _scale_to_image(people: Sequence[Person], size: Sequence[float | None]) -> Sequence[Person]:
    """Return landmarks that are fractions of an image of this width and height in pixels."""
    width, height = size
    points = np.array([person.points for person in people], np.float64)
    if not (width and height and is_relative(points)):
        return people
    # z is a fraction of the width, like x.
    sides = np.array([width, height, width])
    return [replace(person, points=np.asarray(person.points) * sides) for person in people]


def _are_in_space(people: Sequence[Person]) -> bool:
    """Return whether the nose is above the ankles along z most of the time.

    In image landmarks depth is measured from the hips and much smaller.
    """
    if not people:
        return False
    ends = [NAMES.index(name) for name in ("nose", "left_ankle", "right_ankle")]
    poses = np.array([[p.points[end] for end in ends] for p in people])
    # Vectors from the middle of the ankles to the nose.
    lengths = poses[:, 0] - poses[:, 1:].mean(axis=1)
    along = np.nanmedian(lengths / np.linalg.norm(lengths, axis=1, keepdims=True), axis=0)
    return bool(along[2] > 0.7)


def _list_frames(data: Any) -> Sequence[Any]:
    frames = data.get("frames") if isinstance(data, Mapping) else data
    return frames if isinstance(frames, list) else []


def _find_poses(frame: Any, *, world: bool) -> list[Any]:
    """Return the poses in a frame: lists of 33 landmarks."""
    if isinstance(frame, Mapping):
        landmarks = _find_value(frame, _WORLD if world else _IMAGE)
    else:
        landmarks = None if world else frame
    if isinstance(landmarks, Mapping):  # a protocol buffer as JSON
        landmarks = landmarks.get("landmark")
    if not isinstance(landmarks, list):
        return []
    if _is_pose(landmarks):
        return [landmarks]
    return [pose for pose in landmarks if _is_pose(pose)]


def _is_pose(value: Any) -> bool:
    return isinstance(value, list) and len(value) == len(NAMES) and all(map(_is_landmark, value))


def _is_landmark(value: Any) -> bool:
    if isinstance(value, Mapping):
        return "x" in value and "y" in value
    return isinstance(value, list) and 2 <= len(value) <= 5 and not isinstance(value[0], list)


def _parse_landmarks(
    content: FileContent, frame: int, pose: list[Any]
) -> tuple[list[list[float]], list[float]]:
    """Return position and confidence of each landmark, an object or a list of numbers."""
    points, confidence = [], []
    for landmark in pose:
        if isinstance(landmark, Mapping):
            x, y, z = landmark["x"], landmark["y"], landmark.get("z", 0.0)
            visibility = landmark.get("visibility", 1.0)
        else:
            # Fill in a missing z with 0 and visibility with 1.
            x, y, z, visibility = [*landmark, *(0.0, 1.0)[len(landmark) - 2 :]][:4]
        try:
            points.append([float(x), float(y), float(z or 0.0)])
            confidence.append(1.0 if visibility is None else float(visibility))
        except (TypeError, ValueError, OverflowError):
            raise content.error(f"frame {frame} has a landmark that is not numeric") from None
    return points, confidence


def _find_value(mapping: Mapping[str, Any], keys: Sequence[str]) -> Any:
    """Return the value of the first existing key, ignoring case and underscores."""
    values = {normalize_name(str(key)): value for key, value in mapping.items()}
    return next((values[key] for key in keys if key in values), None)


def _to_positive(value: Any) -> float | None:
    good = is_number(value) and value > 0
    return float(value) if good else None


def normalize_name(name: str) -> str:
    """Return a name in lower case without blanks, underscores and hyphens."""
    return _PLAIN.sub("", name).lower()


_PLACES = {normalize_name(name): i for i, name in enumerate(NAMES)}


def read_landmarks(table: DelimitedText, options: ReadOptions) -> Motion:
    """Return the motion of MediaPipe's landmarks from a table."""
    fields = _find_landmark_columns(table.names)
    timing = [i for i, name in enumerate(table.names) if is_timing(name)]
    frame = next((i for i, name in enumerate(table.names) if _FRAME.fullmatch(name.strip())), None)
    rows = table.numbers([*fields.values(), *timing, *([] if frame is None else [frame])]).T
    poses = np.full((rows.shape[1], len(NAMES), 4), np.nan)
    poses[..., 2:] = (0.0, 1.0)  # z and visibility if there are none
    for (landmark, field), column in zip(fields, rows, strict=False):
        poses[:, landmark, field] = column
    times = {table.names[i]: column for i, column in zip(timing, rows[len(fields) :], strict=False)}
    clock = Timing(options.fps or 0.0)
    gaps = clock.gaps
    if times and not options.fps:
        clock = find_table_timing(table.content, times)
        poses, gaps = place_points(clock, poses)
    # Numbers count frames only if no times do; a rate takes precedence over times.
    is_numbered = not times or options.fps or any(map(is_rate, times))
    frames = np.arange(len(poses))
    if frame is not None and is_numbered:
        frames = to_frame_numbers(table.content, rows[-1])
    people = [
        Person(number, pose[:, :3], pose[:, 3])
        for number, pose in zip(frames.tolist(), poses, strict=True)
        if np.isfinite(pose[:, :2]).any()
    ]
    motion = landmarks_to_motion(
        table.content, people, options, fps=clock.fps or None, frames=frames.tolist(),
        notes=clock.notes,
    )  # fmt: skip
    provenance = motion.provenance.timed(clock.clock, clock.row_seconds)
    return split_at(replace(motion, provenance=provenance), gaps)


def _find_landmark_columns(names: Sequence[str]) -> dict[tuple[int, int], int]:
    """Return the column of each landmark and field; empty unless x and y of all 33 exist."""
    columns: dict[tuple[str, int], int] = {}
    for column, name in enumerate(names):
        first, last = _FIELD_FIRST.fullmatch(name.strip()), _FIELD_LAST.fullmatch(name.strip())
        if first:
            columns.setdefault((first[2], _FIELDS[first[1].lower()]), column)
        elif last:
            columns.setdefault((normalize_name(last[1]), _FIELDS[last[2].lower()]), column)
    by_name = {(_PLACES[name], field): i for (name, field), i in columns.items() if name in _PLACES}
    by_number = {(int(m), field): i for (m, field), i in columns.items() if m.isdecimal()}
    # Landmarks may count from 1.
    if by_number and min(landmark for landmark, _ in by_number) == 1:
        by_number = {(landmark - 1, field): i for (landmark, field), i in by_number.items()}
    for table in (by_name, by_number):
        if {(i, field) for i in range(len(NAMES)) for field in (0, 1)} <= table.keys():
            return {key: i for key, i in table.items() if key[0] < len(NAMES)}
    return {}


DIALECTS = (
    Dialect(
        "MediaPipe",
        lambda names, _: bool(_find_landmark_columns(names)),
        read_landmarks,
        motion=True,
    ),
)
