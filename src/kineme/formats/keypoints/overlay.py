"""Find the keypoints of a video in image coordinates, to draw them over the picture.

They come from a recording that is a table of poses, or from the table next to a video. They are the
estimator's original keypoints, neither smoothed nor rotated.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from kineme._util.arrays import Floats
from kineme.errors import KinemeError
from kineme.formats.channels.parquet import open_parquet
from kineme.formats.files import load, load_head
from kineme.formats.keypoints.poses import Poses, find_poses, holds_poses, parse_poses
from kineme.formats.registry import is_video

_SIDES = (
    ("shoulder", "elbow"), ("elbow", "wrist"), ("wrist", "index"), ("shoulder", "hip"),
    ("hip", "knee"), ("knee", "ankle"), ("ankle", "heel"), ("ankle", "foot_index"),
    ("heel", "foot_index"), ("ankle", "big_toe"), ("heel", "big_toe"), ("ear", "eye"),
)  # fmt: skip
_ACROSS = ("shoulder", "hip")
LINES = (
    *((f"{side}_{a}", f"{side}_{b}") for side in ("left", "right") for a, b in _SIDES),
    *((f"left_{part}", f"right_{part}") for part in _ACROSS),
    *(("nose", f"{side}_eye") for side in ("left", "right")),
)
"""Names of keypoints between which a line is drawn, if both exist."""


@dataclass(frozen=True, eq=False)
class Overlay:
    """Keypoints of a person in the picture of a video.

    ``points`` (frames, keypoints, 3) are pixels from the left and from the top, and the confidence,
    0 to 1; NaN where nobody was found. Frame 0 is at second ``start_s`` of the video, whose picture
    is ``width`` by ``height`` pixels.
    """

    names: tuple[str, ...]
    lines: tuple[tuple[int, int], ...]
    points: Floats
    fps: float
    start_s: float
    width: int
    height: int


def find_overlay(recording: Path, person: str | None = None) -> Overlay | None:
    """Return the keypoints of a recording that came from a video, else None.

    ``person`` selects one of several people. Errors of the table are not reported again.
    """
    try:
        path = recording
        if is_video(recording):
            path = find_poses(recording, load_head(recording).digest)
        if path.suffix.lower() != ".parquet" or not path.is_file():
            return None
        content = load(path)
        file = open_parquet(content)
        return make_overlay(parse_poses(content, file), person) if holds_poses(file) else None
    except KinemeError:
        return None


def make_overlay(poses: Poses, person: str | None) -> Overlay:
    """Return the keypoints of a person, by default the most frequent one, at an even frame rate."""
    head, rows = poses.head, poses.rows
    names, fps = tuple(map(str, head["keypoints"])), float(head["fps"])
    people, counts = np.unique(rows["person"], return_counts=True)
    chosen = people[counts.argmax()] if person is None else int(person)
    person_rows = rows[rows["person"] == chosen]
    points = np.full((round(float(head["duration"]) * fps) + 1, len(names), 3), np.nan)
    frames = np.rint(person_rows["time"] * fps).astype(np.intp)
    points[frames, :, :2], points[frames, :, 2] = person_rows["image"], person_rows["confidence"]
    lines = tuple((names.index(a), names.index(b)) for a, b in LINES if {a, b} <= {*names})
    return Overlay(
        names, lines, points=points, fps=fps, start_s=float(head.get("start", 0.0)),
        width=int(head.get("width", 0)), height=int(head.get("height", 0)),
    )  # fmt: skip
