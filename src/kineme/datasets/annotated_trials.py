"""Read the published annotations of CMU subject 86: the actions of each trial and their ends.

The benchmark (fourteen trials, three annotators) comes as ``annotations.json`` or as the authors'
text (``mocap.txt``: for each trial a line with its name, then ``label earliest mean latest`` for
each action). Marks are frames at 120 Hz, counted from 1.

Known errors are corrected: a mean outside its span widens the span, and trial 86_04 gets the
authors' correction.
"""

from __future__ import annotations

import re
import warnings
from os import PathLike
from pathlib import Path
from typing import Annotated, NamedTuple

from msgspec import Meta, Struct

from kineme._util.json import decode_json
from kineme.errors import KinemeWarning, ReadError

TRIAL_FPS = 120.0

# In the first publication, trial 86_04, row 5 ends before it begins; the authors corrected it.
CORRECTIONS = {("86_04", 5, (4060, 5050, 5090)): (5052, 5052, 5092)}


Mark = Annotated[int, Meta(ge=0, lt=10**9)]


class _Row(Struct):
    """An action in ``annotations.json``."""

    label: str
    end_earliest: Mark
    end_mean: Mark
    end_latest: Mark


class _File(Struct):
    """Content of ``annotations.json``."""

    trials: dict[str, Annotated[list[_Row], Meta(min_length=1)]]


class Action(NamedTuple):
    """One row as published: marks at 120 Hz, from 1."""

    label: str
    earliest: int
    mean: int
    latest: int


def read_actions(path: str | PathLike[str]) -> dict[str, list[Action]]:
    """Read the actions of each trial from ``annotations.json`` or the authors' text.

    Known errors are corrected, with a `KinemeWarning` for every row.
    """
    trials = (
        _read_json_trials(path) if Path(path).suffix.lower() == ".json" else _read_text_trials(path)
    )
    return {name: _correct_rows(name, rows) for name, rows in trials.items()}


def _read_json_trials(path: str | PathLike[str]) -> dict[str, list[Action]]:
    try:
        trials = decode_json(_read_text(path), path, _File).trials
    except ReadError as error:
        reason = f"no annotations.json of the benchmark: it {error.reason}"
        raise ReadError(path, reason, line=error.line) from error
    return {
        name: [Action(row.label, row.end_earliest, row.end_mean, row.end_latest) for row in rows]
        for name, rows in trials.items()
    }


def _read_text_trials(path: str | PathLike[str]) -> dict[str, list[Action]]:
    """Read the authors' text: lines with trial names, and rows of a label and three numbers."""
    trials: dict[str, list[Action]] = {}
    rows: list[Action] | None = None
    for number, line in enumerate(_read_text(path).splitlines(), 1):
        row = re.fullmatch(r"\s*(\S.*?)\s+(\d{1,9})\s+(\d{1,9})\s+(\d{1,9})\s*", line)
        head = re.search(r"\b\d+_\d+\b", line)
        if head:
            rows = trials.setdefault(head[0], [])
        elif row and rows is not None:
            rows.append(Action(row[1], *map(int, row.groups()[1:])))
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


def _correct_rows(trial: str, rows: list[Action]) -> list[Action]:
    corrected = []
    for number, row in enumerate(rows, 1):
        frames = CORRECTIONS.get((trial, number, row[1:]), row[1:])
        # A mean outside its span widens the span.
        fixed = Action(row.label, min(frames), frames[1], max(frames))
        if fixed != row:
            warnings.warn(
                f"trial {trial}, row {number} ({row.label}): marks {row[1:]} corrected to "
                f"{fixed[1:]}",
                KinemeWarning,
                stacklevel=4,
            )
        corrected.append(fixed)
    return corrected


def _read_text(path: str | PathLike[str]) -> str:
    try:
        return Path(path).read_text(encoding="utf-8-sig")
    except (OSError, UnicodeDecodeError) as error:
        raise ReadError(path, f"cannot be read: {error}") from error
