"""Describe the video of a recording for a page: its start, and the keypoints drawn over it.

Keypoints are encoded like poses (`kineme.web.display`): x and y are pixels, y from the top, and z
is the confidence in hundredths.
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
    """Keypoints of a recording in the picture of its video.

    ``picture`` tells how to read ``binary``. ``start_s`` is the time in the video at which the
    recording starts.
    """

    picture: Picture
    binary: bytes
    start_s: float


def draw_picture(recording: Path, person: str | None = None) -> DrawnPicture | None:
    """Return the keypoints over the video of a recording; None if its poses are not from one."""
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
    recording: Path, picture: DrawnPicture | None, offset_s: float | None = None
) -> Video | None:
    """Return the message about the video of a recording; None if there is none.

    ``offset_s`` is the time in the video at which the recording starts, if the user set it.
    """
    path = find_video(recording)
    if path is None:
        return None
    start = picture.start_s if picture and offset_s is None else offset_s or 0.0
    return Video(name=path.name, offset_s=start, picture=picture.picture if picture else UNSET)
