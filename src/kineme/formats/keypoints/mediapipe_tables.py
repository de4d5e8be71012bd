"""Read MediaPipe's landmarks in tables with a row for each frame, or for each landmark.

`kineme.formats.keypoints.mediapipe` describes the names of columns.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from kineme.formats.delimited import DelimitedText
from kineme.formats.dialects import Dialect
from kineme.formats.files import FileContent
from kineme.formats.gaps import split_at
from kineme.formats.keypoints.mediapipe import NAMES, landmarks_to_motion, normalize_name
from kineme.formats.keypoints.video import Person, to_frame_numbers
from kineme.formats.options import ReadOptions
from kineme.formats.timing import find_table_timing, place_points
from kineme.recordings import Motion
from kineme.recordings.regular import Timing
from kineme.recordings.times import is_rate, is_timing

_BYTES_PER_POSE = 8 * 3 * 4 * len(NAMES)  # three copies of four numbers

_FIELDS = {"x": 0, "y": 1, "z": 2, "v": 3, "vis": 3, "visibility": 3, "presence": 3, "score": 3}
_WORD = r"(?:pose|landmarks?|lm|kp|keypoint|point)?[\s_.-]*"
_FIELD = r"(x|y|z|v|vis|visibility)"
_FIELD_FIRST = re.compile(rf"{_WORD}{_FIELD}[\s_.-]*(\d{{1,2}})", re.IGNORECASE)
_FIELD_LAST = re.compile(rf"{_WORD}(\d{{1,2}}|[a-z_ ]+?)[\s_.-]+{_FIELD}", re.IGNORECASE)
_FRAME = re.compile(r"(frame|image)[\s_]*(id|idx|index|no|num|number)?", re.IGNORECASE)
_LANDMARK = re.compile(
    r"(landmark|keypoint|joint|point)([\s_]*(id|idx|index|name|no|num|number))?|name|id",
    re.IGNORECASE,
)
_PLACES = {normalize_name(name): i for i, name in enumerate(NAMES)}


def is_long(names: Sequence[str]) -> bool:
    """Return whether these are the columns of a table with a row for each landmark."""
    lower = [name.lower() for name in names]
    return {"x", "y"} <= set(lower) and None not in (
        _find_column(names, _FRAME),
        _find_column(names, _LANDMARK),
    )


def read_landmarks(table: DelimitedText, options: ReadOptions) -> Motion:
    """Return the motion of MediaPipe's landmarks from a table with a row for each frame."""
    field_columns = _find_landmark_columns(table.names)
    timing = [i for i, name in enumerate(table.names) if is_timing(name)]
    frame = _find_column(table.names, _FRAME)
    extra = [*timing, *([frame] if frame is not None else [])]
    rows = table.numbers([*field_columns.values(), *extra])
    # x, y, z and visibility, which is 1 if there is no column for it.
    poses = np.zeros((len(rows), len(NAMES), 4))
    poses[..., 3] = 1.0
    for (landmark, field), column in zip(
        field_columns, rows[:, : len(field_columns)].T, strict=True
    ):
        poses[:, landmark, field] = column
    frames, clock = np.arange(len(rows)), Timing(options.fps or 0.0)
    gaps = clock.gaps
    if timing and not options.fps:
        columns = {table.names[i]: rows[:, len(field_columns) + k] for k, i in enumerate(timing)}
        clock = find_table_timing(table.content, columns)
        poses, gaps = place_points(clock, poses)
        frames = np.arange(len(poses))
    # A rate takes precedence over times, so that rows are frames only by their number.
    has_rate = any(is_rate(table.names[i]) for i in timing)
    if frame is not None and (options.fps or has_rate or not timing):
        frames = to_frame_numbers(table.content, rows[:, -1])
    people = [
        Person(frame, pose[:, :3], pose[:, 3])
        for frame, pose in zip(frames.tolist(), poses, strict=True)
        if np.isfinite(pose[:, :2]).any()
    ]
    motion = landmarks_to_motion(
        table.content,
        people,
        options,
        fps=clock.fps or None,
        frames=frames.tolist(),
        notes=clock.notes,
    )
    return _apply_clock(motion, clock, gaps)


def read_long(table: DelimitedText, options: ReadOptions) -> Motion:
    """Return the motion of MediaPipe's landmarks from a table with a row for each landmark."""
    lower = [name.lower() for name in table.names]
    field_columns = {field: lower.index(name) for name, field in _FIELDS.items() if name in lower}
    landmark_column, frame = _find_column(table.names, _LANDMARK), _find_column(table.names, _FRAME)
    timing = [i for i, name in enumerate(table.names) if is_timing(name)][:1]
    rows = table.numbers([frame or 0, *field_columns.values(), *timing])
    landmarks = _parse_landmark_numbers(
        table.content, table.texts(landmark_column or 0)[: len(rows)]
    )
    # Index of the frame of each row.
    frames, frame_index = np.unique(
        to_frame_numbers(table.content, rows[:, 0]), return_inverse=True
    )
    size = _BYTES_PER_POSE * len(frames)
    table.content.require_memory(size, f"{len(NAMES)} landmarks in {len(frames)} frames")
    poses = np.full((len(frames), len(NAMES), 4), np.nan)
    # Defaults of z and visibility.
    poses[..., 2:] = (0.0, 1.0)
    for k, field in enumerate(field_columns, 1):
        poses[frame_index, landmarks, field] = rows[:, k]
    clock = Timing(options.fps or 0.0)
    gaps = clock.gaps
    if timing and not options.fps:
        times = np.zeros(len(frames))
        times[frame_index] = rows[:, -1]
        clock = find_table_timing(table.content, {table.names[timing[0]]: times})
        poses, gaps = place_points(clock, poses)
        if not is_rate(table.names[timing[0]]):
            frames = np.arange(len(poses))
    people = [
        Person(frame, pose[:, :3], pose[:, 3])
        for frame, pose in zip(frames.tolist(), poses, strict=True)
    ]
    motion = landmarks_to_motion(
        table.content, people, options, fps=clock.fps or None, notes=clock.notes
    )
    return _apply_clock(motion, clock, gaps)


def _apply_clock(motion: Motion, clock: Timing, gaps: Iterable[tuple[int, int]]) -> Motion:
    """Return the motion with the times of its rows, split at the gaps."""
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


def _parse_landmark_numbers(content: FileContent, texts: Sequence[str]) -> NDArray[np.intp]:
    """Return the numbers of landmarks that are given by number or name."""
    numbers = []
    for text in texts:
        # Names may be written as PoseLandmark.NOSE, numbers as 12.0.
        word = text.rpartition(".")[2] if text[:1].isalpha() else text.removesuffix(".0")
        name = normalize_name(word)
        number = _PLACES.get(name, int(name) if name.isdecimal() and len(name) < 3 else -1)
        if not 0 <= number < len(NAMES):
            raise content.error(f"{text[:40]!r} is none of MediaPipe's {len(NAMES)} landmarks")
        numbers.append(number)
    return np.array(numbers, np.intp)


def _find_column(names: Sequence[str], pattern: re.Pattern[str]) -> int | None:
    return next((i for i, name in enumerate(names) if pattern.fullmatch(name.strip())), None)


WIDE = Dialect(
    "MediaPipe",
    lambda names, _: len(_find_landmark_columns(names)) >= 2 * len(NAMES),
    read_landmarks,
    motion=True,
)
LONG = Dialect(
    "MediaPipe, a row per landmark", lambda names, _: is_long(names), read_long, motion=True
)
