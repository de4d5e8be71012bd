"""Describe the video of a recording as a page shows it: its place, and what is drawn over it.

Keypoints are sent to the page as poses are (`kineme.web.display`): x and y are pixels of the
picture, y from the top, and z is the confidence in hundredths.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from msgspec import UNSET

from kineme._util.files import find_video
from kineme.formats.keypoints.overlay import find_overlay
from kineme.web.display import FINE, encode_positions
from kineme.web.messages import MotionHead, Picture, Video


@dataclass(frozen=True, eq=False)
class DrawnPicture:
    """How to read ``binary``, the keypoints of a recording in the picture of its video.

    ``start_s`` is where in the video the recording starts.
    """

    picture: Picture
    binary: bytes
    start_s: float


def draw_picture(recording: Path, person: str | None = None) -> DrawnPicture | None:
    """Return what is drawn over the video of a recording; None where its poses are of none."""
    overlay = find_overlay(recording, person)
    if overlay is None or not overlay.width:
        return None
    origin, step, binary = encode_positions(overlay.points * np.array([1.0, 1.0, 100.0]), FINE)
    head = MotionHead(
        n_samples=len(overlay.points),
        sample_fps=overlay.fps,
        joints=list(overlay.names),
        parents=[-1] * len(overlay.names),
        bones=list(overlay.lines),
        origin=origin,
        step=step,
        heading=None,
        effectors={},
    )
    picture = Picture(width=overlay.width, height=overlay.height, keypoints=head)
    return DrawnPicture(picture, binary, overlay.start_s)


def describe_video(
    recording: Path, drawn: DrawnPicture | None, offset_s: float | None = None
) -> Video | None:
    """Return what a page is told of the video of a recording; None where there is none.

    ``offset_s`` is where in it the recording starts, where people said so.
    """
    found = find_video(recording)
    if found is None:
        return None
    start = drawn.start_s if drawn and offset_s is None else offset_s or 0.0
    return Video(name=found.name, offset_s=start, picture=drawn.picture if drawn else UNSET)
