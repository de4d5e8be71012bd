"""Read OpenPose's folders: a JSON file for each frame of a video.

The files of a folder are ordered by the numbers in their names; missing numbers are frames without
people. `kineme.formats.keypoints.detectors` describes the files.
"""

from __future__ import annotations

import re
from itertools import pairwise
from pathlib import Path

from kineme._util.files import read_head
from kineme.errors import ReadError
from kineme.formats.files import FileContent, load
from kineme.formats.keypoints.detectors import OPENPOSE, is_frame, read_detections
from kineme.formats.keypoints.video import parse_json
from kineme.formats.options import ReadOptions
from kineme.recordings import Motion

_NUMBER = re.compile(r"(\d+)(?:_keypoints)?\.json$", re.IGNORECASE)


def read_openpose_folder(path: Path, options: ReadOptions) -> Motion | None:
    """Return the motion of one person in a folder with a file for each frame, or None."""
    numbered = list_frame_files(path)
    if not numbered:
        return None
    for (number, file), (following, other) in pairwise(numbered):
        if number == following:
            raise ReadError(
                path,
                f"frame {number} is in {file.name} and in {other.name}: put each into its "
                "own folder",
            )
    frames, digest = [], []
    for number, file in numbered:
        content = load(file)
        data = parse_json(content)
        if not is_frame(OPENPOSE, data):
            raise content.error("it has no 'people', so it is not a file of OpenPose")
        frames.append((number, data))
        digest.append(content.data)
    return read_detections(FileContent(path, b"".join(digest)), options, OPENPOSE, frames)


def list_frame_files(folder: Path) -> list[tuple[int, Path]]:
    """Return the frame files in a folder with their frame numbers, in order.

    A series of numbered files counts if one of them starts like OpenPose's.
    """
    series: dict[str, list[tuple[int, Path]]] = {}
    for file in folder.iterdir():
        match = _NUMBER.search(file.name)
        if match:
            number = int(match[1][-18:])
            series.setdefault(file.name[: match.start()], []).append((number, file))
    return sorted(
        frame
        for frames in series.values()
        if any(_begins_frame(file) for _, file in frames)
        for frame in frames
    )


def _begins_frame(file: Path) -> bool:
    try:
        head = read_head(file)
    except OSError:
        return False
    # A byte order mark and blanks may precede the JSON.
    return head.lstrip(b"\xef\xbb\xbf \t\r\n").startswith(b"{") and b'"people"' in head
