"""CSV of pose estimators whose columns are no joints' names: MediaPipe's landmarks and SLEAP.

What MediaPipe's columns may be called: `kineme.formats.keypoints.mediapipe`. SLEAP exports
``track``, ``frame_idx``, ``instance.score`` and ``NODE.x NODE.y NODE.score``, a row for
each animal in a frame; nodes less sure than 0.2, SLEAP's own limit for peaks, count
as not seen.
"""

from __future__ import annotations

import csv
import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from kineme.formats.columns import dated, is_timing, timed
from kineme.formats.delimited import rows_of, texts_of
from kineme.formats.files import FileContent
from kineme.formats.gaps import split_at
from kineme.formats.keypoints.mediapipe import NAMES, landmarks_to_motion
from kineme.formats.keypoints.video import Person, Video, video_to_motion
from kineme.formats.layout import has_commas
from kineme.formats.options import ReadOptions
from kineme.formats.timing import Timing
from kineme.recordings import Motion

Floats = NDArray[np.float64]

SLEAP_SURE = 0.2

_BYTES_PER_POSE = 8 * 3 * 4 * len(NAMES)  # read, stacked and placed

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
_PLACES = {re.sub("_", "", name): i for i, name in enumerate(NAMES)}


@dataclass(frozen=True)
class PoseTable:
    """A table as it is in the file.

    Parameters
    ----------
    names : sequence of str
        Of its columns.
    lines : sequence of str
        Below them.
    first : int
        The number of the first of these in the file.
    separator : str
        Between cells.
    """

    content: FileContent
    names: Sequence[str]
    lines: Sequence[str]
    first: int
    separator: str

    def numbers(self, columns: Sequence[int]) -> Floats:
        """(rows, columns): some of the columns."""
        cells = next(csv.reader(self.lines[:1], delimiter=self.separator), [])
        return rows_of(
            self.content,
            self.lines,
            self.first,
            self.separator,
            len(self.names),
            columns,
            dates=dated(self.names, cells),
            comma=has_commas(self.lines, self.separator),
        )

    def texts(self, column: int) -> list[str]:
        return texts_of(self.lines, self.separator, column)


def is_pose_table(names: Sequence[str]) -> bool:
    """Whether columns of these names are keypoints in one of the ways below."""
    return any(recognises(names) for recognises, _ in POSE_TABLES)


def is_landmarks(names: Sequence[str]) -> bool:
    """Whether columns of these names are MediaPipe's, a row for each frame."""
    return len(_landmark_columns(names)) >= 2 * len(NAMES)


def is_long(names: Sequence[str]) -> bool:
    """Whether columns of these names are landmarks, a row for each of them."""
    lower = [name.lower() for name in names]
    return {"x", "y"} <= set(lower) and None not in (
        _named(names, _FRAME),
        _named(names, _LANDMARK),
    )


def is_sleap(names: Sequence[str]) -> bool:
    """Whether columns of these names are SLEAP's."""
    return "frame_idx" in names and any(name.endswith(".score") for name in names)


def read_landmarks(table: PoseTable, options: ReadOptions) -> Motion:
    """The motion of MediaPipe's landmarks, a row for each frame."""
    at = _landmark_columns(table.names)
    timing = [i for i, name in enumerate(table.names) if is_timing(name)]
    numbered = _named(table.names, _FRAME)
    extra = [*timing, *([numbered] if numbered is not None else [])]
    rows = table.numbers([*at.values(), *extra])
    marks = np.zeros((len(rows), len(NAMES), 4))
    marks[..., 3] = 1.0
    for (landmark, field), column in zip(at, rows[:, : len(at)].T, strict=True):
        marks[:, landmark, field] = column
    frames, clock = np.arange(len(rows)), Timing(options.fps or 0.0)
    if timing and not options.fps:
        columns = {table.names[i]: rows[:, len(at) + k] for k, i in enumerate(timing)}
        clock = timed(table.content, columns, None)
    elif numbered is not None:
        frames = _whole(table.content, rows[:, -1])
    people = [
        Person(frame, mark[:, :3], mark[:, 3])
        for frame, mark in zip(frames.tolist(), marks, strict=True)
        if np.isfinite(mark[:, :2]).any()
    ]
    motion = landmarks_to_motion(
        table.content,
        people,
        options,
        fps=clock.fps or None,
        frames=frames.tolist(),
        notes=clock.notes,
    )
    timed_motion = replace(motion, provenance=motion.provenance.timed(clock.clock))
    return split_at(timed_motion, clock.gaps)


def read_long(table: PoseTable, options: ReadOptions) -> Motion:
    """The motion of MediaPipe's landmarks, a row for each landmark."""
    lower = [name.lower() for name in table.names]
    at = {field: lower.index(name) for name, field in _FIELDS.items() if name in lower}
    which, numbered = _named(table.names, _LANDMARK), _named(table.names, _FRAME)
    timing = [i for i, name in enumerate(table.names) if is_timing(name)][:1]
    rows = table.numbers([numbered or 0, *at.values(), *timing])
    landmarks = _landmark_numbers(table.content, table.texts(which or 0)[: len(rows)])
    frames, place = np.unique(_whole(table.content, rows[:, 0]), return_inverse=True)
    size = _BYTES_PER_POSE * len(frames)
    table.content.claim(size, f"{len(NAMES)} landmarks in {len(frames)} frames")
    marks = np.full((len(frames), len(NAMES), 4), np.nan)
    marks[..., 2:] = (0.0, 1.0)
    for k, field in enumerate(at, 1):
        marks[place, landmarks, field] = rows[:, k]
    fps = options.fps
    if timing and not fps:
        times = np.zeros(len(frames))
        times[place] = rows[:, -1]
        fps = timed(table.content, {table.names[timing[0]]: times}, None).fps
    people = [
        Person(frame, mark[:, :3], mark[:, 3])
        for frame, mark in zip(frames.tolist(), marks, strict=True)
    ]
    return landmarks_to_motion(table.content, people, options, fps=fps)


def read_sleap_csv(table: PoseTable, options: ReadOptions) -> Motion:
    """The motion of one animal in a table of SLEAP's."""
    nodes = [
        name[:-2] for name in table.names if name.endswith(".x") and f"{name[:-2]}.y" in table.names
    ]
    if not nodes:
        raise table.content.error("no columns NODE.x and NODE.y found", table.first - 1)
    columns = [table.names.index(f"{node}.{axis}") for node in nodes for axis in "xy"]
    scores = [table.names.index(f"{n}.score") for n in nodes if f"{n}.score" in table.names]
    rows = table.numbers([table.names.index("frame_idx"), *columns, *scores])
    k = len(nodes)
    sure = rows[:, 1 + 2 * k :] if len(scores) == k else np.ones((len(rows), k))
    points = rows[:, 1 : 1 + 2 * k].reshape(-1, k, 2)
    frames = _whole(table.content, rows[:, 0]).tolist()
    tracks = table.texts(table.names.index("track")) if "track" in table.names else []
    known = any(tracks)
    people = [
        Person(frame, points[i].tolist(), sure[i].tolist(), tracks[i] if known else None)
        for i, frame in enumerate(frames)
    ]
    start = [0] if 0 <= min(frames) < len(frames) else []  # where the video starts
    video = Video("SLEAP", nodes, people, SLEAP_SURE, frames=start)
    return video_to_motion(table.content, video, options)


POSE_TABLES: tuple[
    tuple[Callable[[Sequence[str]], bool], Callable[[PoseTable, ReadOptions], Motion]], ...
] = ((is_sleap, read_sleap_csv), (is_landmarks, read_landmarks), (is_long, read_long))
"""What recognises a table by its columns, and reads it."""


def _landmark_columns(names: Sequence[str]) -> dict[tuple[int, int], int]:
    """For each landmark and field the column; empty unless x and y of all 33 are there."""
    found: dict[tuple[str, int], int] = {}
    for column, name in enumerate(names):
        first, last = _FIELD_FIRST.fullmatch(name.strip()), _FIELD_LAST.fullmatch(name.strip())
        if first:
            found.setdefault((first[2], _FIELDS[first[1].lower()]), column)
        elif last:
            found.setdefault((_plain(last[1]), _FIELDS[last[2].lower()]), column)
    named = {(_PLACES[mark], field): i for (mark, field), i in found.items() if mark in _PLACES}
    counted = {(int(m), field): i for (m, field), i in found.items() if m.isdecimal()}
    if counted and min(mark for mark, _ in counted) == 1:
        counted = {(mark - 1, field): i for (mark, field), i in counted.items()}
    for table in (named, counted):
        if {(mark, field) for mark in range(len(NAMES)) for field in (0, 1)} <= table.keys():
            return {key: i for key, i in table.items() if key[0] < len(NAMES)}
    return {}


def _landmark_numbers(content: FileContent, texts: Sequence[str]) -> NDArray[np.intp]:
    """The landmarks that people call by number or name."""
    numbers = []
    for text in texts:
        plain = _plain(text.rpartition(".")[2])  # PoseLandmark.NOSE
        number = _PLACES.get(plain, int(plain) if plain.isdecimal() and len(plain) < 3 else -1)
        if not 0 <= number < len(NAMES):
            raise content.error(f"{text[:40]!r} is none of MediaPipe's {len(NAMES)} landmarks")
        numbers.append(number)
    return np.array(numbers, np.intp)


def _plain(name: str) -> str:
    return re.sub(r"[\s_-]", "", name).lower()


def _named(names: Sequence[str], pattern: re.Pattern[str]) -> int | None:
    return next((i for i, name in enumerate(names) if pattern.fullmatch(name.strip())), None)


def _whole(content: FileContent, numbers: Floats) -> NDArray[np.int64]:
    """Frame numbers as such."""
    if not np.isfinite(numbers).all() or np.abs(numbers).max(initial=0) > 2**53:
        raise content.error("the frames have no whole numbers")
    return np.rint(numbers).astype(np.int64)
