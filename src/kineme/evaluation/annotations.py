"""Reading what people said: the benchmark's annotations, and tables of one's own.

The benchmark (CMU subject 86, fourteen trials, three annotators) comes as
``annotations.json`` or as its authors' text (``mocap.txt``: per trial a head
line with its name, then ``label earliest mean latest`` per action). Marks are
frames at 120 Hz, counted from 1. At another rate mark m is m × rate / 120,
halves up, as in the evaluation of Vögele, Krüger, Klein 2014. Frame f counted
from 1 is frame f - 1 here.

Own tables are CSV or TSV with ``start_s``, ``stop_s``, ``label`` and, where
known, ``count`` (repetitions); or plain text with one label per frame. What is
labelled ``transition``, and the gap between two rows of a table, is the span
in which the border may lie.
"""

from __future__ import annotations

import csv
import json
import math
import re
import warnings
from collections.abc import Iterator
from dataclasses import replace
from os import PathLike
from pathlib import Path
from typing import NamedTuple

import numpy as np

from kineme.errors import KinemeWarning, ParameterError, ReadError
from kineme.evaluation.labelling import TRANSITION, Annotation, Labelling, round_half_up

MARKS_FPS = 120.0

# As first published, trial 86_04, row 5 ends before it begins; the authors' correction.
CORRECTIONS = {("86_04", 5, (4060, 5050, 5090)): (5052, 5052, 5092)}


class Action(NamedTuple):
    """One row as published: marks at 120 Hz, from 1."""

    label: str
    earliest: int
    mean: int
    latest: int


def read_trials(path: str | PathLike[str], *, fps: float = 30.0) -> dict[str, Annotation]:
    """The annotation of each trial by its name, at the given rate.

    Known errors are mended: a mean outside its span widens it, and trial
    86_04 gets its authors' correction; a warning names each.

    Raises
    ------
    ReadError : not such a file, or marks that run backwards otherwise

    Warns
    -----
    KinemeWarning : for every row that was mended
    """
    trials = _json_trials(path) if Path(path).suffix.lower() == ".json" else _text_trials(path)
    found = {}
    for name, rows in trials.items():
        try:
            found[name] = _annotation(_mended(name, rows), fps)
        except ParameterError as error:
            raise ReadError(path, f"trial {name}: {error}") from error
    return found


def read_intervals(path: str | PathLike[str], *, frames: int, fps: float) -> Annotation:
    """The truth in a CSV or TSV table of intervals, for a recording of this length.

    In a segment table with both levels the activities are taken.

    Parameters
    ----------
    path : the table; its first line names the columns
    frames, fps : length and rate at which the recording is compared

    Raises
    ------
    ReadError : a column is missing, a row cannot be understood, rows overlap
        or run backwards, or the table is of another length than the recording
    """
    borders = [0.0]
    labels: list[str] = []
    counts: list[int | None] = []
    for line, row in _table(path):
        start, stop = (_number(path, line, row[name], name) for name in ("start_s", "stop_s"))
        if stop <= start:
            raise ReadError(path, f"runs backwards, from {start:g} s to {stop:g} s", line=line)
        if start < borders[-1] - 0.5 / fps:
            reason = f"starts at {start:g} s, while the row before stops at {borders[-1]:g} s"
            raise ReadError(path, reason, line=line)
        if start >= borders[-1] + 0.5 / fps:
            borders.append(start)
            labels.append(TRANSITION)
            counts.append(None)
        borders.append(stop)
        labels.append(TRANSITION if row.get("kind") == TRANSITION else row["label"])
        counts.append(_count(path, line, row))
    if abs(borders[-1] - frames / fps) > 1 / fps:
        raise ReadError(
            path,
            f"stops at {borders[-1]:.3f} s, the recording lasts {frames / fps:.3f} s; "
            f"label the whole of it ({TRANSITION} where there is nothing to say)",
        )
    cuts = round_half_up(np.array(borders[1:-1]) * fps)
    try:
        truth = Annotation.from_labelling(Labelling.from_cuts(cuts, labels, frames=frames, fps=fps))
    except ParameterError as error:
        raise ReadError(path, str(error)) from error
    last = len(labels) - 1
    kept = [c for i, c in enumerate(counts) if labels[i] != TRANSITION or i in (0, last)]
    return replace(truth, counts=tuple(kept))


def read_frame_labels(
    path: str | PathLike[str], *, frames: int, fps: float, labels_fps: float | None = None
) -> Annotation:
    """The truth in a text file with one label per line and frame.

    Parameters
    ----------
    frames, fps : length and rate at which the recording is compared
    labels_fps : frames per second of the file, if not ``fps``

    Raises
    ------
    ReadError : an empty line, or another length than the recording
    """
    lines = _text(path).splitlines()
    for number, line in enumerate(lines, 1):
        if not line.strip():
            raise ReadError(path, "no label on this line", line=number)
    try:
        whole = Labelling.from_frames([line.strip() for line in lines], fps=labels_fps or fps)
        return Annotation.from_labelling(whole.at(frames=frames, fps=fps))
    except ParameterError as error:
        raise ReadError(path, str(error)) from error


def _json_trials(path: str | PathLike[str]) -> dict[str, list[Action]]:
    try:
        trials = json.loads(_text(path))["trials"]
        return {
            name: [
                Action(
                    row["label"], *(int(row[f"end_{m}"]) for m in ("earliest", "mean", "latest"))
                )
                for row in rows
            ]
            for name, rows in trials.items()
        }
    except (ValueError, KeyError, TypeError, AttributeError) as error:
        raise ReadError(path, f"no annotations.json of the benchmark: {error}") from error


def _text_trials(path: str | PathLike[str]) -> dict[str, list[Action]]:
    """Head lines hold a trial's name; what follows a label and three numbers is a row."""
    trials: dict[str, list[Action]] = {}
    rows: list[Action] | None = None
    for number, line in enumerate(_text(path).splitlines(), 1):
        row = re.fullmatch(r"\s*(\S.*?)\s+(\d+)\s+(\d+)\s+(\d+)\s*", line)
        head = re.search(r"\b\d+_\d+\b", line)
        if head:
            rows = trials.setdefault(head[0], [])
        elif row and rows is not None:
            rows.append(Action(row[1], *map(int, row.groups()[1:])))
        elif line.strip():
            reason = f"neither a trial's name nor 'label earliest mean latest': {line.strip()!r}"
            raise ReadError(path, reason, line=number)
    if not trials or not all(trials.values()):
        empty = next((name for name, actions in trials.items() if not actions), None)
        raise ReadError(path, f"trial {empty} has no rows" if empty else "holds no trial")
    return trials


def _mended(trial: str, rows: list[Action]) -> list[Action]:
    mended = []
    for number, row in enumerate(rows, 1):
        marks = CORRECTIONS.get((trial, number, row[1:]), row[1:])
        fixed = Action(row.label, min(marks), marks[1], max(marks))
        if fixed != row:
            warnings.warn(
                f"trial {trial}, row {number} ({row.label}): marks {row[1:]} mended to {fixed[1:]}",
                KinemeWarning,
                stacklevel=3,
            )
        mended.append(fixed)
    return mended


def _annotation(rows: list[Action], fps: float) -> Annotation:
    earliest, mean, latest = (
        round_half_up(np.array([row[i] for row in rows[:-1]]) * (fps / MARKS_FPS)) - 1
        for i in (1, 2, 3)
    )
    # Keeping every fourth frame from the first on keeps ceil(N / 4) of them.
    frames = math.ceil(rows[-1].latest * fps / MARKS_FPS)
    return Annotation(tuple(row.label for row in rows), earliest, mean, latest, frames, fps)


def _table(path: str | PathLike[str]) -> Iterator[tuple[int, dict[str, str]]]:
    lines = _text(path).splitlines()
    separator = "\t" if lines and "\t" in lines[0] else ","
    table = csv.DictReader(lines, delimiter=separator, restval="")
    missing = {"start_s", "stop_s", "label"} - set(table.fieldnames or ())
    if missing:
        raise ReadError(path, f"a column {min(missing)!r} is needed", line=1)
    rows = [(table.line_num, row) for row in table if row.get("level", "activity") == "activity"]
    if not rows:
        raise ReadError(path, "holds no interval")
    yield from rows


def _number(path: str | PathLike[str], line: int, text: str, name: str) -> float:
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not (math.isfinite(value) and value >= 0):
        raise ReadError(path, f"{name} must be a number from 0 on, not {text!r}", line=line)
    return value


def _count(path: str | PathLike[str], line: int, row: dict[str, str]) -> int | None:
    text = row.get("count", "").strip()
    if not text:
        return None
    if not text.isdecimal():
        raise ReadError(path, f"count must be a whole number, not {text!r}", line=line)
    return int(text)


def _text(path: str | PathLike[str]) -> str:
    try:
        return Path(path).read_text(encoding="utf-8-sig")
    except (OSError, UnicodeDecodeError) as error:
        raise ReadError(path, f"cannot be read: {error}") from error
