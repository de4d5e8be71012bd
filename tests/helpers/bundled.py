"""Copy the bundled recording, or write it repeatedly to one file."""

from __future__ import annotations

import shutil
from itertools import count
from pathlib import Path

import kineme

NUMBERS = count(1)


def copy_of_bundled(folder: Path) -> Path:
    """Copy the bundled recording under a new name."""
    return Path(shutil.copy(kineme.bundled_recording(), folder / f"take_{next(NUMBERS)}.bvh"))


def write_repeated(path: Path, n_frames: int) -> Path:
    """Repeat the bundled recording to so many frames."""
    head, motion = kineme.bundled_recording().read_text().split("MOTION\n")
    _, frame_time, *frames = motion.strip().split("\n")
    lines = [frames[i % len(frames)] for i in range(n_frames)]
    path.write_text("\n".join([head + "MOTION", f"Frames: {n_frames}", frame_time, *lines, ""]))
    return path
