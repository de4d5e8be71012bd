"""Recordings for a small library, and what is in its folder."""

from __future__ import annotations

import shutil
from pathlib import Path

import numpy as np


def write_channels(path: Path, seed: int = 0) -> None:
    """Forty seconds of a slow, then a fast movement."""
    random = np.random.default_rng(seed)
    times = np.arange(1200) / 30
    slow, fast = np.sin(2 * np.pi * 0.7 * times), np.sin(2 * np.pi * 1.9 * times)
    shape = np.where(times < 20, slow, 0.4 * fast) + 0.02 * random.normal(size=1200)
    lines = [f"{t:.4f},{x:.5f},{y:.5f}" for t, x, y in zip(times, shape, 1.5 - shape)]
    path.write_text("\n".join(["time_s,gyro_x,gyro_y", *lines]))


def copy_takes(takes: Path, home: Path, **named: str) -> Path:
    """Return a new folder with copies of some recordings, each under a new stem."""
    own = home / "takes"
    own.mkdir()
    for stem, name in named.items():
        shutil.copy(takes / name, own / f"{stem}{Path(name).suffix}")
    return own


def contents(folder: Path) -> dict[str, bytes]:
    """The bytes of every file, by its place in the folder; drafts of killed writers are none."""
    return {
        path.relative_to(folder).as_posix(): path.read_bytes()
        for path in folder.rglob("*")
        if path.is_file() and not path.name.startswith(".kineme-")
    }
