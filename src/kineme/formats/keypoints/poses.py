"""Read and write tables of poses of `kineme pose`: Parquet, a row for each person in each frame.

The columns are ``time`` in seconds from the first frame, ``person``, a number for each person, and
for each keypoint

- ``NAME_u`` and ``NAME_v``: pixels from the left and from the top of the picture;
- ``NAME_x``, ``NAME_y`` and ``NAME_z``, if the estimator computes depth: metres from the middle of
  the hips, to the right of the picture, up, and towards the camera;
- ``NAME_confidence``: 0 to 1.

A frame without people has no row. The metadata of the table hold a JSON object under
``kineme.poses``: the estimator, the keypoints, the SHA-256 of the video, its width and height, the
number of processed frames, their rate, the seconds from the first to the last, and the second of
the video (``start``) of the first.

Reading gives frames at an even rate: each row belongs to the nearest frame. Keypoints of low
confidence are averaged with more certain ones within a tenth of a second. The recording is split at
cuts of the camera: where most keypoints jump at once, or jump a little while the colours of the
picture change (``changes`` in the metadata lists these seconds). A note says when the camera moves
(``camera_moves`` lists these spans). Positions are smoothed forwards and backwards by a Butterworth
low-pass filter of second order with a cutoff of `CUTOFF` hertz.

Source of the filter: D. A. Winter, Biomechanics and Motor Control of Human Movement, 2009, ch. 3.
"""

from __future__ import annotations

import json
import os
from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from kineme._util.arrays import Floats
from kineme._util.checks import join_names, require_extra
from kineme._util.files import POSES, atomic_write
from kineme._util.parallel import find_user_cache
from kineme.features.channels import filter_low
from kineme.formats.channels.parquet import open_parquet, read_parquet_columns
from kineme.formats.files import FileContent, load
from kineme.formats.keypoints.people import track_people
from kineme.formats.keypoints.video import MAX_FRAMES_RATIO, Person, video_to_motion
from kineme.formats.options import ReadOptions
from kineme.formats.plausibility import split_at
from kineme.recordings import Motion, Note
from kineme.recordings.regular import place_rows

KEY = b"kineme.poses"
"""Key of the JSON object in the table's metadata."""
CUTOFF = 6.0
"""Hertz: movement of people is slower, jitter of keypoints is faster."""
SURE, SMOOTHING_S = 0.5, 0.1
"""Confidence from which a keypoint is not averaged with others; standard deviation in seconds of
the Gaussian weights of the average.
"""
LEAP = 8.0
"""Body heights per second; faster movement of most keypoints is a cut."""
CHANGE = 0.4
"""Fraction of the picture whose colours change at a cut."""
PAUSE_S = 1.0
"""Seconds: a shorter pause between two moves of the camera is part of one move."""
NOBODY = -1
"""Person number of a row for a frame without people."""

Rows = NDArray[np.void]
"""Poses in order of time, see `make_row_type`."""
Head = Mapping[str, Any]
"""Metadata of all rows, as in JSON."""


@dataclass(frozen=True)
class Poses:
    """Poses of the people in a video, as stored in a file."""

    head: Head
    rows: Rows

    @property
    def seen(self) -> int:
        """Number of frames in which a person was found."""
        return len(np.unique(self.rows["time"]))


def make_row_type(keypoints: int) -> np.dtype[np.void]:
    """Return the type of a row: time, person, and image, metres and confidence of each keypoint.

    ``change`` is the fraction of the picture whose colours differ from the previous frame,
    ``moved`` the seconds before ``time`` during which the camera moved, 0 if it did not.
    """
    return np.dtype(
        [
            ("time", "<f8"),
            ("person", "<i4"),
            ("change", "<f4"),
            ("moved", "<f4"),
            ("image", "<f4", (keypoints, 2)),
            ("metres", "<f4", (keypoints, 3)),
            ("confidence", "<f4", (keypoints,)),
        ]
    )


def write_poses(path: Path, head: Head, rows: Rows) -> None:
    """Write the rows of all frames, including those without people, as a table of poses.

    People are tracked by the smallest distance between keypoints. If each frame has at most one
    person, it is the same one.
    """
    with require_extra("pyarrow", "video"):
        import pyarrow as pa
        from pyarrow import parquet

    times = np.unique(rows["time"])
    person_rows = rows[rows["person"] != NOBODY]
    frames = np.searchsorted(times, person_rows["time"])
    points = np.pad(person_rows["image"].astype(np.float64), ((0, 0), (0, 0), (0, 1)))
    person = [0] * len(person_rows)
    if len(np.unique(frames)) < len(frames):
        person = track_people(frames, points)
    columns: dict[str, Any] = {
        "time": person_rows["time"] - times[0],
        "person": pa.array(person, "int32"),
    }
    metadata = {
        **head,
        "depth": bool(np.isfinite(person_rows["metres"]).any()),
        "frames": len(times),
        "fps": round(place_rows(times).fps, 3) if len(times) > 1 else 1.0,
        "start": float(times[0]) - float(head.get("begins", 0.0)),
        "duration": float(times[-1] - times[0]),
        "camera_moves": find_camera_moves(rows, float(times[0])),
        "changes": np.unique(rows["time"][rows["change"] >= CHANGE] - times[0]).tolist(),
    }
    for column, (field, k, axis) in _list_columns(metadata).items():
        values = person_rows[field][:, k] if axis is None else person_rows[field][:, k, axis]
        columns[column] = np.ascontiguousarray(values)
    table = pa.table(columns).replace_schema_metadata({KEY: json.dumps(metadata).encode()})
    with atomic_write(path) as draft:
        parquet.write_table(table, draft)


def find_poses(video: Path, digest: str) -> Path:
    """Return the path for the poses of a video: next to it, else in the user's cache."""
    sibling = video.with_name(video.name + POSES)
    if sibling.exists() or os.access(video.parent, os.W_OK):
        return sibling
    return find_user_cache() / "kineme" / "poses" / f"{digest}{POSES}"


def read_poses(path: Path) -> Poses:
    """Return the poses in a Parquet file; raise ReadError if it is not a table of poses."""
    content = load(path)
    return parse_poses(content, open_parquet(content))


def holds_poses(file: Any) -> bool:
    """Return whether an open Parquet file is a table of poses."""
    return KEY in (file.schema_arrow.metadata or {})


def parse_head(content: FileContent, file: Any) -> Head:
    """Return the metadata of poses in an open Parquet file; raise ReadError if it has none."""
    if not holds_poses(file):
        raise content.error("is not a table of poses")
    try:
        head: Head = json.loads(file.schema_arrow.metadata[KEY])
        frames, most = head["fps"] * head["duration"], MAX_FRAMES_RATIO * (head["frames"] + 1)
        is_whole = head["fps"] > 0 and 0 <= frames < most and bool(_list_columns(head))
        is_whole = is_whole and {"estimator", "limit"} <= head.keys()
        _ = [(float(begin), float(end)) for begin, end in head.get("camera_moves", [])]
    except (ValueError, TypeError, LookupError):
        is_whole = False
    if not is_whole:
        raise content.error(f"is a damaged table of poses: see its {KEY.decode()}")
    return head


def parse_poses(content: FileContent, file: Any) -> Poses:
    """Return the poses in an open Parquet file; raise ReadError if it is damaged."""
    head = parse_head(content, file)
    columns, keypoints = _list_columns(head), len(head["keypoints"])
    table = read_parquet_columns(content, file, ["time", "person", *columns])
    rows = np.zeros(table.num_rows, make_row_type(keypoints))
    try:
        for name in ("time", "person"):
            rows[name] = table.column(name).to_numpy()
        for name, (field, k, axis) in columns.items():
            part = rows[field][:, k] if axis is None else rows[field][:, k, axis]
            part[:] = table.column(name).to_numpy()
    except (ValueError, TypeError, LookupError) as error:
        raise content.error("is a damaged table of poses: a column is not numeric") from error
    return Poses(head, rows)


def poses_to_motion(content: FileContent, poses: Poses, options: ReadOptions) -> Motion:
    """Return the motion of one person, in metres if available, else from the picture.

    Raise ReadError if there is no person. Frames without the person are gaps.
    """
    head, rows = poses.head, poses.rows
    numbers = np.rint(rows["time"] * float(head["fps"])).astype(np.int64)
    field = "metres" if head["depth"] else "image"
    steady_points = np.array(rows[field], np.float64)
    for person in np.unique(rows["person"]):
        is_person = rows["person"] == person
        steady_points[is_person] = _steady_points(
            steady_points[is_person], rows["confidence"][is_person], float(head["fps"])
        )
    unit, up = ("m", "y") if head["depth"] else ("pixel", "-y")
    people = [
        Person(number, points, row["confidence"], str(row["person"]))
        for number, points, row in zip(numbers.tolist(), steady_points, rows, strict=True)
    ]
    frames = range(round(float(head["duration"]) * float(head["fps"])) + 1)
    notes = ["metres from the middle of the hips, without the position in the room"]
    motion = video_to_motion(
        content, options, f"video poses ({head['estimator']})", head["keypoints"], people,
        limit=float(head["limit"]), fps=float(head["fps"]), frames=frames, unit=unit, up=up,
        notes=notes if head["depth"] else (),
    )  # fmt: skip
    cuts = find_cuts(rows[rows["person"] == int(motion.provenance.person or 0)], head)
    frames_cut = [round(cut * float(head["fps"])) for cut in cuts]
    motion = split_at(motion, [(n, n + 1) for n in frames_cut if 0 < n < motion.n_frames - 1])
    if cuts:
        cut_times = join_names([f"{cut:.1f} s" for cut in cuts])
        motion = motion.noted(
            Note(f"the camera cuts at {cut_times}: the recording is split there", "warning")
        )
    if moves := head.get("camera_moves", []):
        move_times = join_names([f"{begin:.1f} to {end:.1f} s" for begin, end in moves])
        note = f"the camera moves at {move_times}: positions in the picture contain this movement"
        motion = motion.noted(note if head["depth"] else Note(note, "warning"))
    return _smooth(motion)


def find_cuts(rows: Rows, head: Head) -> list[float]:
    """Return the seconds of the first frames after cuts, from the rows of one person.

    At a cut most keypoints jump farther than a body can move.
    """
    if len(rows) < 2:
        return []
    image = rows["image"].astype(np.float64)
    height = float(np.median(np.ptp(image, axis=1).max(axis=1))) or 1.0
    steps = np.diff(rows["time"])
    # Median over keypoints, in body heights: half of them moved at least this far.
    jumps = np.median(np.linalg.norm(np.diff(image, axis=0), axis=2), axis=1) / height
    # Above 30 Hz the limit per frame stays that of 30 Hz.
    limits = np.maximum(LEAP * steps, LEAP / 30)
    changed = np.isin(rows["time"][1:], head.get("changes", []))
    is_next = steps < 2 / float(head["fps"])  # otherwise there is a gap already
    is_cut = is_next & ((jumps > limits) | (changed & (jumps > limits / 4)))
    seconds: list[float] = rows["time"][1:][is_cut].tolist()
    return seconds


def find_camera_moves(rows: Rows, start: float) -> list[list[float]]:
    """Return the spans in which the camera moves, in seconds after ``start``."""
    moving = rows[rows["moved"] > 0]
    spans: list[list[float]] = []
    for begin, end in zip(
        moving["time"] - moving["moved"] - start, moving["time"] - start, strict=True
    ):
        if spans and begin <= spans[-1][1] + PAUSE_S:
            spans[-1][1] = round(float(end), 3)
        else:
            spans.append([round(float(begin), 3), round(float(end), 3)])
    return spans


def _steady_points(points: Floats, confidence: Floats, fps: float) -> Floats:
    """Return a person's points (rows, keypoints, axes), averaged over time if uncertain."""
    from scipy.ndimage import gaussian_filter1d

    # Weights fall linearly below the sure confidence and never reach 0.
    weights = np.clip(confidence / SURE, 1e-3, 1.0).astype(np.float64)[..., None]
    if weights.min() == 1.0:
        return points
    width = SMOOTHING_S * fps
    total = gaussian_filter1d(weights, width, axis=0, mode="nearest")
    mean = gaussian_filter1d(weights * points, width, axis=0, mode="nearest") / total
    return np.asarray(weights * points + (1 - weights) * mean)


def _list_columns(head: Head) -> dict[str, tuple[str, int, int | None]]:
    """Return the field, keypoint and axis of each column of keypoints."""
    columns: dict[str, tuple[str, int, int | None]] = {}
    for k, name in enumerate(head["keypoints"]):
        columns |= {f"{name}_{axis}": ("image", k, i) for i, axis in enumerate("uv")}
        if head["depth"]:
            columns |= {f"{name}_{axis}": ("metres", k, i) for i, axis in enumerate("xyz")}
        columns[f"{name}_confidence"] = ("confidence", k, None)
    return columns


def _smooth(motion: Motion) -> Motion:
    """Return the motion without jitter; each span between gaps is filtered separately."""
    if motion.fps <= 2 * CUTOFF:
        return motion.noted(
            f"not smoothed: {motion.fps:g} Hz is too low for a filter of {CUTOFF:g} Hz"
        )
    positions = motion.positions.copy()
    for start, stop in motion.spans():
        # The filter needs fewer padding frames than the span has.
        padding = min(round(motion.fps), stop - start - 2)
        if padding > 0:
            flat = positions[start:stop].reshape(stop - start, -1)
            smooth = filter_low(flat, motion.fps, CUTOFF, padding)
            positions[start:stop] = smooth.reshape(positions[start:stop].shape)
    note = f"smoothed: Butterworth low-pass filter of second order, {CUTOFF:g} Hz, both ways"
    return replace(motion, positions=positions).noted(note)
