"""Read the annotations of CMU subject 86: the actions of fourteen trials, by three people.

They are in ``annotations.json`` or in the authors' text, ``mocap.txt``. The text has a line with
the name of each trial, then ``label earliest mean latest`` for each action: marks of its end, in
frames at 120 Hz, counted from 1. At another rate, mark m is m × rate / 120, with halves rounded up,
as in the evaluation of Vögele, Krüger, Klein 2014. There frames count from 1, here from 0.

Known errors are corrected: a mean outside its span widens the span, and trial 86_04 gets the
authors' correction.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from math import ceil
from os import PathLike
from pathlib import Path
from typing import Annotated

import numpy as np
from msgspec import Meta, Struct

from kineme._util.files import translate_read_errors
from kineme._util.json import load_json
from kineme.errors import ParameterError, ReadError
from kineme.evaluation.truth import Truth, round_half_up

TRIAL_FPS = 120.0
"""Frames per second of the annotated trials."""
# In the first publication, trial 86_04, row 5 ends before it begins; the authors corrected it.
CORRECTIONS = {("86_04", (4060, 5050, 5090)): (5052, 5052, 5092)}
Mark = Annotated[int, Meta(ge=0, lt=10**9)]


class Action(Struct):
    """An action as published: marks of its end at 120 Hz, from 1."""

    label: str
    end_earliest: Mark
    end_mean: Mark
    end_latest: Mark


class _File(Struct):
    """Content of ``annotations.json``."""

    trials: dict[str, Annotated[list[Action], Meta(min_length=1)]]


def read_trials(path: str | PathLike[str], *, fps: float = 30.0) -> dict[str, Truth]:
    """Read the truth of each trial by name, at a frame rate.

    Parameters
    ----------
    path : path-like
        ``annotations.json`` or the authors' ``mocap.txt``.
    fps : float
        Frames per second of the truths.

    Returns
    -------
    dict of str to Truth
        By name of the trial, such as ``86_01``.

    Raises
    ------
    ReadError
        The file is neither, or marks run backwards, apart from known errors.
    """
    path = Path(path)
    is_json = path.suffix.lower() == ".json"
    trials = load_json(path, _File).trials if is_json else _read_text(path)
    truths = {}
    for name, actions in trials.items():
        try:
            truths[name] = _make_truth(name, actions, fps)
        except ParameterError as error:
            raise ReadError(path, f"trial {name}: {error}") from error
    return truths


def _read_text(path: Path) -> dict[str, list[Action]]:
    """Read the authors' text: lines with trial names, and rows of a label and three numbers."""
    trials: dict[str, list[Action]] = {}
    actions: list[Action] | None = None
    with translate_read_errors(path):
        lines = path.read_text(encoding="utf-8-sig").splitlines()
    for number, line in enumerate(lines, 1):
        row = re.fullmatch(r"\s*(\S.*?)\s+(\d{1,9})\s+(\d{1,9})\s+(\d{1,9})\s*", line)
        head = re.search(r"\b\d+_\d+\b", line)
        if head:
            actions = trials.setdefault(head[0], [])
        elif row and actions is not None:
            actions.append(Action(row[1], *map(int, row.groups()[1:])))
        elif line.strip():
            reason = (
                "expected the name of a trial or 'label earliest mean latest', found: "
                f"{line.strip()!r}"
            )
            raise ReadError(path, reason, line=number)
    if not trials or not all(trials.values()):
        empty = next((name for name, actions in trials.items() if not actions), None)
        raise ReadError(path, f"trial {empty} has no rows" if empty else "contains no trial")
    return trials


def _make_truth(name: str, actions: Sequence[Action], fps: float) -> Truth:
    """Return the actions of a trial at a rate, with known errors corrected."""
    published = [(each.end_earliest, each.end_mean, each.end_latest) for each in actions]
    marks = np.array([CORRECTIONS.get((name, each), each) for each in published])
    # A mean outside its span widens the span.
    ends = np.stack([marks.min(axis=1), marks[:, 1], marks.max(axis=1)])
    # - 1: marks count frames from 1. The last row ends with the recording and has no border.
    earliest, mean, latest = round_half_up(ends[:, :-1] * (fps / TRIAL_FPS)) - 1
    # Every fourth of N frames, starting with the first, are ceil(N / 4) frames.
    frames = ceil(ends[2, -1] * fps / TRIAL_FPS)
    labels = tuple(each.label for each in actions)
    return Truth(labels, earliest, mean=mean, latest=latest, frames=frames, fps=fps)
