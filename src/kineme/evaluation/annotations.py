"""Annotations of CMU subject 86 as truths: fourteen trials, each with three annotators.

At another rate than 120 Hz mark m is m × rate / 120, halves up, as in the evaluation of Vögele,
Krüger, Klein 2014. Frame f counted from 1 is frame f - 1 here.
"""

from __future__ import annotations

import math
import re
import warnings
from os import PathLike
from pathlib import Path

import numpy as np

from kineme._util.json import decode_json
from kineme.datasets.annotated_trials import TRIAL_FPS, Action, read_actions
from kineme.errors import KinemeWarning, ParameterError, ReadError
from kineme.evaluation.truth import Truth, round_half_up


def read_trials(path: str | PathLike[str], *, fps: float = 30.0) -> dict[str, Truth]:
    """Return the truth of each trial by its name, at so many frames a second.

    The file is ``annotations.json`` or the authors' ``mocap.txt``; ReadError where it is neither,
    or marks run backwards beyond the known errors. A KinemeWarning names each mended row.
    """
    found = {}
    for name, rows in read_actions(path).items():
        try:
            found[name] = _truth(rows, fps)
        except ParameterError as error:
            raise ReadError(path, f"trial {name}: {error}") from error
    return found


def read_trial(path: str | PathLike[str], name: str, *, fps: float) -> Truth:
    """Return the truth of one trial; known errors are mended in silence.

    ReadError where there is no such file, or it holds no such trial.
    """
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", KinemeWarning)
        trials = read_trials(path, fps=fps)
    if name not in trials:
        names = ", ".join(trials)
        raise ReadError(path, f"holds no trial {name!r}: name one of {names} with --trial")
    return trials[name]


def is_annotations(path: Path) -> bool:
    """Return whether a file is ``annotations.json`` or ``mocap.txt``, by what it holds."""
    suffix = path.suffix.lower()
    if suffix not in (".txt", ".json") or not path.is_file():
        return False
    try:
        text = path.read_text(encoding="utf-8-sig")
        if suffix == ".txt":
            return re.match(r"\s*\S*\b\d+_\d+\b", text) is not None
        content = decode_json(text, path)
    except (OSError, ValueError, ReadError):
        return False
    return isinstance(content, dict) and "trials" in content


def _truth(rows: list[Action], fps: float) -> Truth:
    earliest, mean, latest = (
        # Marks count frames from 1. The last row ends with the recording and has no border after
        # it.
        round_half_up(np.array([row[i] for row in rows[:-1]]) * (fps / TRIAL_FPS)) - 1
        for i in (1, 2, 3)
    )
    # Keeping every fourth frame from the first on keeps ceil(N / 4) of them.
    frames = math.ceil(rows[-1].latest * fps / TRIAL_FPS)
    return Truth(tuple(row.label for row in rows), earliest, mean, latest, frames, fps)
