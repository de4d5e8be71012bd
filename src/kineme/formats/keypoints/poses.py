"""Tables of poses, as `kineme pose` leaves them: Parquet, a row for each person in each frame.

The columns are ``time`` in seconds from the first frame, ``person``, a number for each person, and
for each keypoint

- ``NAME_u`` and ``NAME_v``: pixels from the left and from the top of the picture;
- ``NAME_x``, ``NAME_y`` and ``NAME_z``, where the estimator gives depth: metres from the middle of
  the hips, to the right of the picture, up, and towards the camera;
- ``NAME_confidence``: 0 to 1.

A frame in which nobody was found has no row. The metadata of the table holds a JSON object under
``kineme.poses``: the estimator, the keypoints, the SHA-256 of the video, its width and height, the
frames that were looked at, their rate, the seconds from the first to the last, and the second of
the video (``start``) at which the first is shown.

Frames are those of an even rate: each row belongs to the one that is nearest to its time. A
keypoint of low confidence is drawn to where it is surer within a tenth of a second. The recording
is split where the camera cuts: where most keypoints jump at once, or jump a little while the
colours of the picture change (``changes`` in the metadata has the seconds). A note tells when the
camera moves (``camera_moves`` has the seconds). The positions are smoothed by a Butterworth
low-pass filter of second order, forwards and backwards, with its cutoff at `CUTOFF` hertz.

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
from kineme.features.filters import filter_low
from kineme.formats.channels.parquet import parquet_columns, parquet_file
from kineme.formats.files import FileContent, load
from kineme.formats.gaps import split_at, unseen
from kineme.formats.keypoints.people import Detections, track_people
from kineme.formats.keypoints.video import MOST_FRAMES_MORE, Person, Video, video_to_motion
from kineme.formats.options import ReadOptions
from kineme.recordings import Motion, Note
from kineme.recordings.arrays import find_spans
from kineme.recordings.regular import place_rows

KEY = b"kineme.poses"
"""Of the metadata."""
CUTOFF = 6.0
"""Hertz: movement of people is slower than that, jitter of keypoints is faster."""
SURE, NEAR_S = 0.5, 0.1
"""Confidence from which a keypoint stays where it is; deviation of the normal curve, in seconds, of
the weights by which others are averaged."""
LEAP = 8.0
"""Body heights a second: what most keypoints do not do at once but in a cut."""
CHANGE = 0.4
"""Share of a picture whose colours are others than in the one before, in a cut."""
PAUSE_S = 1.0
"""Seconds between two moves of the camera up to which they are one."""
NOBODY = -1
"""Number of the person in a row of a frame without one."""

Rows = NDArray[np.void]
"""Poses in the order of time, see `row_type`."""
Head = Mapping[str, Any]
"""What holds for all rows, as JSON has it."""


@dataclass(frozen=True)
class Poses:
    """Poses of the people in a video, as a file has them."""

    head: Head
    rows: Rows

    @property
    def seen(self) -> int:
        """Return the number of frames in which somebody was found."""
        return len(np.unique(self.rows["time"]))


def row_type(keypoints: int) -> np.dtype[np.void]:
    """Return the type of a row: time, person, and image, metres and confidence of each keypoint.

    ``change`` is the share of the picture whose colours are others than in the one before,
    ``moved`` the seconds before ``time`` in which the camera moved, 0 if it did not.
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
    """Write the rows of all frames, those without anybody among them, as a table of poses.

    Who is who from frame to frame is told by the smallest distance between keypoints; one person in
    each frame is the same, wherever they are.
    """
    with require_extra("pyarrow", "video"):
        import pyarrow as pa
        from pyarrow import parquet

    times = np.unique(rows["time"])
    found = rows[rows["person"] != NOBODY]
    frames = np.searchsorted(times, found["time"])
    points = np.pad(found["image"].astype(np.float64), ((0, 0), (0, 0), (0, 1)))
    person = [0] * len(found)
    if len(np.unique(frames)) < len(frames):
        person = track_people(Detections(frames, points, [None] * len(found)))
    columns: dict[str, Any] = {
        "time": found["time"] - times[0],
        "person": pa.array(person, "int32"),
    }
    told = {
        **head,
        "depth": bool(np.isfinite(found["metres"]).any()),
        "frames": len(times),
        "fps": round(place_rows(times).fps, 3) if len(times) > 1 else 1.0,
        "start": float(times[0]) - float(head.get("begins", 0.0)),
        "duration": float(times[-1] - times[0]),
        "camera_moves": find_camera_moves(rows, float(times[0])),
        "changes": np.unique(rows["time"][rows["change"] >= CHANGE] - times[0]).tolist(),
    }
    for column, (field, k, axis) in _columns(told).items():
        values = found[field][:, k] if axis is None else found[field][:, k, axis]
        columns[column] = np.ascontiguousarray(values)
    table = pa.table(columns).replace_schema_metadata({KEY: json.dumps(told).encode()})
    with atomic_write(path) as draft:
        parquet.write_table(table, draft)


def find_poses(video: Path, digest: str) -> Path:
    """Return where the poses of a video are kept, or will be: beside it, else in the cache."""
    beside = video.with_name(video.name + POSES)
    if beside.exists() or os.access(video.parent, os.W_OK):
        return beside
    return find_user_cache() / "kineme" / "poses" / f"{digest}{POSES}"


def read_poses(path: Path) -> Poses:
    """Return the poses in a Parquet file; ReadError where it is no table of poses."""
    content = load(path)
    return parse_poses(content, parquet_file(content))


def holds_poses(file: Any) -> bool:
    """Return whether an open Parquet file is a table of poses."""
    return KEY in (file.schema_arrow.metadata or {})


def parse_head(content: FileContent, file: Any) -> Head:
    """Return what an open Parquet file tells of its poses; ReadError where it holds none."""
    if not holds_poses(file):
        raise content.error("is no table of poses")
    try:
        head: Head = json.loads(file.schema_arrow.metadata[KEY])
        frames, most = head["fps"] * head["duration"], MOST_FRAMES_MORE * (head["frames"] + 1)
        is_whole = head["fps"] > 0 and 0 <= frames < most and bool(_columns(head))
        is_whole = is_whole and {"estimator", "limit"} <= head.keys()
        _ = [(float(begin), float(end)) for begin, end in head.get("camera_moves", [])]
    except (ValueError, TypeError, LookupError):
        is_whole = False
    if not is_whole:
        raise content.error(f"is a damaged table of poses: see its {KEY.decode()}")
    return head


def parse_poses(content: FileContent, file: Any) -> Poses:
    """Return the poses in an open Parquet file; ReadError where it is damaged."""
    head = parse_head(content, file)
    columns, keypoints = _columns(head), len(head["keypoints"])
    table = parquet_columns(content, file, ["time", "person", *columns])
    rows = np.zeros(table.num_rows, row_type(keypoints))
    try:
        for name in ("time", "person"):
            rows[name] = table.column(name).to_numpy()
        for name, (field, k, axis) in columns.items():
            part = rows[field][:, k] if axis is None else rows[field][:, k, axis]
            part[:] = table.column(name).to_numpy()
    except (ValueError, TypeError, LookupError) as error:
        raise content.error("is a damaged table of poses: a column holds no numbers") from error
    return Poses(head, rows)


def poses_to_motion(content: FileContent, poses: Poses, options: ReadOptions) -> Motion:
    """Return the motion of one person, in metres where there are any, else from the picture.

    ReadError where nobody was found. A frame without the person is a gap.
    """
    head, rows = poses.head, poses.rows
    fps = float(options.fps or head["fps"])
    numbers = np.rint(rows["time"] * float(head["fps"])).astype(np.int64)
    field = "metres" if head["depth"] else "image"
    steadied = np.array(rows[field], np.float64)
    for each in np.unique(rows["person"]):
        mine = rows["person"] == each
        steadied[mine] = _steady(steadied[mine], rows["confidence"][mine], float(head["fps"]))
    unit, up = ("m", "y") if head["depth"] else ("pixel", "-y")
    people = [
        Person(number, points, row["confidence"], str(row["person"]))
        for number, points, row in zip(numbers.tolist(), steadied, rows, strict=True)
    ]
    frames = range(round(float(head["duration"]) * float(head["fps"])) + 1)
    notes = ["the place in the room is not known: metres from the middle of the hips"]
    video = Video(
        f"video poses ({head['estimator']})", head["keypoints"], people, float(head["limit"]), fps,
        frames, unit, up, notes if head["depth"] else (),
    )  # fmt: skip
    motion = video_to_motion(content, video, options)
    cuts = find_cuts(rows[rows["person"] == int(motion.provenance.person or 0)], head)
    frames_cut = [round(cut * float(head["fps"])) for cut in cuts]
    motion = split_at(motion, [(n, n + 1) for n in frames_cut if 0 < n < motion.n_frames - 1])
    if cuts:
        at = join_names([f"{cut:.1f} s" for cut in cuts])
        motion = motion.noted(Note(f"the camera cuts at {at}: it is split there", "warning"))
    if moves := head.get("camera_moves", []):
        at = join_names([f"{begin:.1f} to {end:.1f} s" for begin, end in moves])
        note = f"the camera moves at {at}: positions in the picture contain this movement"
        motion = motion.noted(note if head["depth"] else Note(note, "warning"))
    return _smooth(motion)


def find_cuts(rows: Rows, head: Head) -> list[float]:
    """Return the seconds of the first frames after cuts, from the rows of one person.

    Most keypoints are farther from where they were in the frame before than a body goes.
    """
    if len(rows) < 2:
        return []
    image = rows["image"].astype(np.float64)
    height = float(np.median(np.ptp(image, axis=1).max(axis=1))) or 1.0
    steps = np.diff(rows["time"])
    # The median over keypoints: half of them went at least so far, in body heights.
    jumps = np.median(np.linalg.norm(np.diff(image, axis=0), axis=2), axis=1) / height
    limits = np.maximum(LEAP * steps, LEAP / 30)
    changed = np.isin(rows["time"][1:], head.get("changes", []))
    is_next = steps < 2 / float(head["fps"])  # otherwise there is a gap already
    cut = is_next & ((jumps > limits) | (changed & (jumps > limits / 4)))
    found: list[float] = rows["time"][1:][cut].tolist()
    return found


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


def _steady(points: Floats, confidence: Floats, fps: float) -> Floats:
    """Return a person's points (rows, keypoints, axes), the unsure drawn to surer ones nearby."""
    from scipy.ndimage import gaussian_filter1d

    weights = np.clip(confidence / SURE, 1e-3, 1.0).astype(np.float64)[..., None]
    if weights.min() == 1.0:
        return points
    width = NEAR_S * fps
    total = gaussian_filter1d(weights, width, axis=0, mode="nearest")
    mean = gaussian_filter1d(weights * points, width, axis=0, mode="nearest") / total
    return np.asarray(weights * points + (1 - weights) * mean)


def _columns(head: Head) -> dict[str, tuple[str, int, int | None]]:
    """Return for each column of keypoints its field, keypoint and axis in a row."""
    columns: dict[str, tuple[str, int, int | None]] = {}
    for k, name in enumerate(head["keypoints"]):
        columns |= {f"{name}_{axis}": ("image", k, i) for i, axis in enumerate("uv")}
        if head["depth"]:
            columns |= {f"{name}_{axis}": ("metres", k, i) for i, axis in enumerate("xyz")}
        columns[f"{name}_confidence"] = ("confidence", k, None)
    return columns


def _smooth(motion: Motion) -> Motion:
    """Return the motion without jitter; each span between gaps is filtered by itself."""
    if motion.fps <= 2 * CUTOFF:
        return motion.noted(f"not smoothed: {motion.fps:g} Hz are too few for {CUTOFF:g} Hz")
    positions = motion.positions.copy()
    for start, stop in find_spans(~np.array(unseen(motion))).tolist():
        padding = min(round(motion.fps), stop - start - 2)
        if padding > 0:
            flat = positions[start:stop].reshape(stop - start, -1)
            smooth = filter_low(flat, motion.fps, CUTOFF, padding)
            positions[start:stop] = smooth.reshape(positions[start:stop].shape)
    note = f"smoothed: Butterworth low-pass filter of second order, {CUTOFF:g} Hz, both ways"
    return replace(motion, positions=positions).noted(note)
