"""The benchmark's recordings: CMU subject 86, trials 1 to 14, with what people said of them.

They are found in a folder that holds the recordings as published (``86.asf``,
``86_01.amc``, …) and the annotations (``annotations.json`` or the authors'
``mocap.txt``). Where no folder is named, it is ``KINEME_DATA``, else the cache
that ``kineme data cmu 86`` fills.

At another rate than 120 Hz mark m is m × rate / 120, halves up, as in the evaluation of Vögele,
Krüger, Klein 2014. Frame f counted from 1 is frame f - 1 here.
"""

from __future__ import annotations

import math
import os
import re
import warnings
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property
from os import PathLike
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from kineme._json import decoded
from kineme.datasets.annotated_trials import TRIAL_FPS, Action, read_actions
from kineme.errors import KinemeWarning, MissingDependencyError, ParameterError, ReadError
from kineme.evaluation.truth import Truth, round_half_up
from kineme.recordings import Motion

Floats = NDArray[np.float64]

FPS = 30.0
TRIALS = tuple(f"86_{number:02d}" for number in range(1, 15))
ANNOTATIONS = ("annotations.json", "mocap.txt")
FETCH = "fetch it with: kineme data cmu 86"


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
        from kineme.methods.region_growing.preset import VOEGELE2014
        from kineme.segmentation.bodies import motion_features

        return motion_features(self.motion, VOEGELE2014)


def find_folder(data: str | PathLike[str] | None = None) -> Path:
    """The folder with the benchmark's files: this one, or ``cmu86`` in it.

    Raises
    ------
    ReadError
        It holds no annotations, or no folder is known.
    """
    named = data or os.environ.get("KINEME_DATA") or _cache()
    if named is None:
        raise ReadError("cmu86", "no data folder: name one with --data or KINEME_DATA")
    for folder in (Path(named), Path(named) / "cmu86"):
        if _annotations(folder) is not None:
            return folder
    raise ReadError(named, f"no {' or '.join(ANNOTATIONS)} here or in cmu86/: {FETCH}")


def read_truths(folder: Path) -> dict[str, Truth]:
    """The truth of every annotated trial, at 30 Hz; errors known of are mended in silence."""
    path = _annotations(folder)
    if path is None:
        raise ReadError(folder, f"no {' or '.join(ANNOTATIONS)} here: {FETCH}")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", KinemeWarning)
        return read_trials(path, fps=FPS)


def load_trials(
    folder: Path,
    names: Sequence[str] | None = None,
    *,
    progress: Callable[[str], None] | None = None,
) -> list[Trial]:
    """The named trials, by default all at hand, in order.

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


def read_trials(path: str | PathLike[str], *, fps: float = 30.0) -> dict[str, Truth]:
    """The annotation of each trial by its name.

    Parameters
    ----------
    path : path-like
        ``annotations.json``, or the authors' ``mocap.txt``.
    fps : float
        Frames per second of the comparison.

    Returns
    -------
    dict of str to Truth

    Raises
    ------
    ReadError
        Not such a file, or marks that run backwards beyond the known errors.

    Warns
    -----
    KinemeWarning
        For every row that was mended, see `kineme.datasets.annotated_trials`.
    """
    found = {}
    for name, rows in read_actions(path).items():
        try:
            found[name] = _truth(rows, fps)
        except ParameterError as error:
            raise ReadError(path, f"trial {name}: {error}") from error
    return found


def read_trial(path: str | PathLike[str], name: str, *, fps: float) -> Truth:
    """The annotation of one trial; known errors are mended in silence.

    Parameters
    ----------
    path : path-like
        The benchmark's annotations.
    name : str
        Of the trial, such as ``86_01``.
    fps : float
        Frames per second of the comparison.

    Returns
    -------
    Truth

    Raises
    ------
    ReadError
        Not such a file, or it holds no such trial.
    """
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", KinemeWarning)
        trials = read_trials(path, fps=fps)
    if name not in trials:
        names = ", ".join(trials)
        raise ReadError(path, f"holds no trial {name!r}: name one of {names} with --trial")
    return trials[name]


def is_annotations(path: Path) -> bool:
    """Whether a file is ``annotations.json`` or ``mocap.txt``, by what it holds."""
    suffix = path.suffix.lower()
    if suffix not in (".txt", ".json") or not path.is_file():
        return False
    try:
        text = path.read_text(encoding="utf-8-sig")
        if suffix == ".txt":
            return re.match(r"\s*\S*\b\d+_\d+\b", text) is not None
        content = decoded(text, path)
    except (OSError, ValueError, ReadError):
        return False
    return isinstance(content, dict) and "trials" in content


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


def _cache() -> Path | None:
    from kineme.datasets.cmu import cache_folder

    try:
        return cache_folder()
    except MissingDependencyError:
        return None


def _truth(rows: list[Action], fps: float) -> Truth:
    earliest, mean, latest = (
        round_half_up(np.array([row[i] for row in rows[:-1]]) * (fps / TRIAL_FPS)) - 1
        for i in (1, 2, 3)
    )
    # Keeping every fourth frame from the first on keeps ceil(N / 4) of them.
    frames = math.ceil(rows[-1].latest * fps / TRIAL_FPS)
    return Truth(tuple(row.label for row in rows), earliest, mean, latest, frames, fps)
