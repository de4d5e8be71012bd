"""The reference video of a recording: a file of the same name, and when in it the recording starts.

The offset is kept in ``.kineme/walk.bvh.video.json``, seconds of the video at frame 0.
"""

from __future__ import annotations

import json
from pathlib import Path
from typing import Annotated

from msgspec import Meta, Struct

from kineme.studio.kept.records import FOLDER, kept_beside, write_file
from kineme.web.edits import LARGEST
from kineme.web.messages import Video

SUFFIXES = (".mp4", ".webm", ".m4v", ".mov", ".ogv")


def video_of(recording: Path) -> Path | None:
    """The video beside a recording; None where there is none."""
    for suffix in SUFFIXES:
        for path in (recording.with_suffix(suffix), recording.with_suffix(suffix.upper())):
            if path.is_file() and not path.is_symlink():
                return path
    return None


class _Said(Struct):
    offset_s: Annotated[float, Meta(ge=-LARGEST, le=LARGEST)] = 0.0


def offset_of(recording: Path) -> float:
    """Seconds of the video at the start of the recording; 0 where nobody said."""
    return _read(recording)[0].offset_s


def notes_on_video(recording: Path) -> list[str]:
    """That the offset of a video cannot be read, where it cannot."""
    return _read(recording)[1]


def _read(recording: Path) -> tuple[_Said, list[str]]:
    return kept_beside(_place(recording), _Said, _Said())


def video_message(recording: Path) -> Video | None:
    """What a page is told of the video."""
    found = video_of(recording)
    return Video(name=found.name, offset_s=offset_of(recording)) if found else None


def set_offset(recording: Path, seconds: float) -> None:
    """Keep the offset of the video; WriteError where it cannot be written."""
    write_file(_place(recording), json.dumps({"offset_s": seconds}).encode())


def _place(recording: Path) -> Path:
    return recording.parent / FOLDER / f"{recording.name}.video.json"
