"""The benchmark's recordings: CMU subject 86, trials 1 to 14, with what people said of them.

They are found in a folder that holds the recordings as published (``86.asf``,
``86_01.amc``, …) and the annotations (``annotations.json`` or the authors'
``mocap.txt``). Where no folder is named, it is ``KINEME_DATA``, else the cache
that ``kineme-cmu 86`` fills.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property
from os import PathLike
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from kineme.errors import ParameterError, ReadError
from kineme.evaluation.truth import Truth
from kineme.recordings import Motion
from kineme_reproduction.annotations import read_trials
from kineme_reproduction.cmu import find_cache_folder

Floats = NDArray[np.float64]

FPS = 30.0
TRIALS = tuple(f"86_{number:02d}" for number in range(1, 15))
ANNOTATIONS = ("annotations.json", "mocap.txt")
FETCH = "download it with: kineme-cmu 86"


@dataclass(frozen=True, eq=False)
class Trial:
    """One recording at its own rate, and its truth at 30 Hz."""

    name: str
    motion: Motion
    truth: Truth

    @cached_property
    def positions(self) -> Floats:
        """Joint positions (frames, joints, 3) at 30 Hz, metres."""
        from kineme.recordings.operations import resample

        return resample(self.motion, FPS).positions

    @cached_property
    def features(self) -> Floats:
        """The 45 stacked features of Vögele et al. 2014 (frames, 45) at 30 Hz, metres."""
        from kineme.methods.prepare import compute_motion_features
        from kineme.methods.region_growing.preset import VOEGELE2014

        return compute_motion_features(self.motion, VOEGELE2014)


def find_folder(data: str | PathLike[str] | None = None) -> Path:
    """Return the folder with the benchmark's files: this one, or ``cmu86`` in it.

    Raises
    ------
    ReadError
        It holds no annotations.
    """
    named = data or os.environ.get("KINEME_DATA") or find_cache_folder()
    for folder in (Path(named), Path(named) / "cmu86"):
        if _annotations(folder) is not None:
            return folder
    raise ReadError(named, f"no {' or '.join(ANNOTATIONS)} here or in cmu86/: {FETCH}")


def read_truths(folder: Path) -> dict[str, Truth]:
    """Read the truth of every annotated trial, at 30 Hz; correct known errors."""
    path = _annotations(folder)
    if path is None:
        raise ReadError(folder, f"no {' or '.join(ANNOTATIONS)} here: {FETCH}")
    return read_trials(path, fps=FPS)


def load_trials(
    folder: Path,
    names: Sequence[str] | None = None,
    *,
    progress: Callable[[str], None] | None = None,
) -> list[Trial]:
    """Load the named trials in order; by default all that exist.

    Raises
    ------
    ParameterError
        A name that is no trial.
    ReadError
        A trial is not at hand or does not read, or its annotation is of another length.
    """
    unknown = [name for name in names or () if name not in TRIALS]
    if unknown:
        raise ParameterError(f"no trial {unknown[0]!r}; there are {TRIALS[0]} to {TRIALS[-1]}")
    chosen = names or [name for name in TRIALS if (folder / f"{name}.amc").is_file()]
    if not chosen:
        raise ReadError(folder, f"no recording of subject 86 here: {FETCH}")
    truths = read_truths(folder)
    trials = []
    for name in sorted(set(chosen)):
        if progress is not None:
            progress(f"reading {name}")
        trials.append(_trial(folder / f"{name}.amc", truths))
    return trials


def _trial(path: Path, truths: dict[str, Truth]) -> Trial:
    from kineme.formats import read_motion

    if not path.is_file():
        raise ReadError(path, f"not at hand; {FETCH}")
    if path.stem not in truths:
        raise ReadError(path, "the annotations do not know this trial")
    motion, truth = read_motion(path), truths[path.stem]
    frames = int((motion.n_frames - 1) * FPS / motion.fps) + 1
    if frames != truth.frames:
        raise ReadError(
            path,
            f"the recording has {frames} frames at {FPS:g} Hz, its annotation {truth.frames}",
        )
    return Trial(path.stem, motion, truth)


def _annotations(folder: Path) -> Path | None:
    return next((folder / name for name in ANNOTATIONS if (folder / name).is_file()), None)
