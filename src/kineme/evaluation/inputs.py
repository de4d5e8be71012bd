"""Read a result and its truth from files, and compute scores.

Both are label files of any format (`kineme.labels`). They are compared at 30 Hz, as published, or
at the result's rate if that is lower. Frames before the first and after the last action of the
truth do not count.

A truth may also be the annotations of CMU subject 86: fourteen trials, each with three annotators.
At another rate than 120 Hz, mark m is m × rate / 120, with halves rounded up, as in the evaluation
of Vögele, Krüger, Klein 2014. There frames count from 1, here from 0.
"""

from __future__ import annotations

import re
import warnings
from dataclasses import replace
from math import ceil, floor, isfinite
from os import PathLike
from pathlib import Path

import numpy as np

from kineme._util.json import decode_json
from kineme.datasets.cmu import TRIAL_FPS, Action, read_actions
from kineme.errors import KinemeWarning, ParameterError, ReadError
from kineme.evaluation.comparison import Comparison
from kineme.evaluation.score import compare_with_truth, compute_scores
from kineme.evaluation.truth import (
    UNLABELLED,
    Truth,
    add_repetitions,
    check_length,
    make_truth,
    round_half_up,
)
from kineme.labels.registry import read_content
from kineme.labels.spans import Labels, as_segmentation, convert_clock_times
from kineme.recordings.arrays import find_spans
from kineme.segments.segmentation import Segmentation

FPS = 30.0
"""Highest rate of comparison, Hz."""


def read_result(path: Path, *, fps: float | None = None) -> Segmentation:
    """Read the result of a method from a file of any label format.

    ``fps`` is used if the file has no frame rate; by default, labels in seconds are read at 30 Hz.
    """
    label_format, content = read_content(path)
    if isinstance(content, Segmentation):
        return content
    rate = content.fps or fps or (FPS if content.unit == "seconds" else None)
    return as_segmentation(content, path, label_format.name, fps=rate)[0]


def read_truth(path: Path, found: Segmentation, *, fps: float | None = None) -> Truth:
    """Read the truth for the recording of a result, at the rate of comparison.

    ``fps`` is the rate of labels in frames; by default that of the result. Problems of the labels
    are reported as `KinemeWarning`.
    """
    n_frames, rate = choose_comparison_rate(found)
    label_format, content = read_content(path)
    try:
        if isinstance(content, Labels):
            counted = content.fps or fps or found.fps
            length_s = found.n_frames / found.fps
            content = convert_clock_times(content, found.clock, length_s=length_s)
            content = replace(content, fps=counted)
            # Without a length, labels extend to the end of the recording.
            if content.length is None:
                length = length_s if content.unit == "seconds" else round(length_s * counted)
                content = replace(content, length=length)
            content, unusual = as_segmentation(content, path, label_format.name, fps=found.fps)
            if unusual:
                warnings.warn(f"{path}: {'; '.join(unusual)}", KinemeWarning, stacklevel=2)
        check_length(content.n_frames, content.fps, found.n_frames, found.fps)
        return make_truth(add_repetitions(content), n_frames=n_frames, fps=rate)
    except ParameterError as error:
        raise ReadError(path, str(error)) from error


def score_agreement(truth: Segmentation, found: Segmentation) -> dict[str, float]:
    """Return the scores of a result, with another segmentation of the recording as truth.

    Examples
    --------
    >>> import kineme
    >>> from kineme.datasets import bundled_truth
    >>> truth = kineme.read_segments(bundled_truth())
    >>> score_agreement(truth, truth)["border_f1"]
    1.0
    """
    compared = _compare_to_truth(truth, found)
    scores = {} if compared is None else compute_scores(compared.without_silence())
    return {name: value for name, value in scores.items() if isfinite(value)}


def find_differences(truth: Segmentation, found: Segmentation) -> list[tuple[float, float]]:
    """Find the spans in seconds in which two segmentations of a recording differ.

    Spans up to the tolerance of borders, and transitions of the truth, are ignored.

    Examples
    --------
    >>> import kineme
    >>> from kineme.datasets import bundled_truth
    >>> truth = kineme.read_segments(bundled_truth())
    >>> find_differences(truth, truth)
    []
    """
    compared = _compare_to_truth(truth, found)
    if compared is None:
        return []
    least = compared.spans.actions.tolerance_s * compared.fps
    # Frames of a class of the truth with another class in the result.
    wrong = (compared.truth != compared.mapped) & (compared.truth != UNLABELLED)
    return [
        (start / compared.fps, stop / compared.fps)
        for start, stop in find_spans(wrong).tolist()
        if stop - start > least
    ]


def _compare_to_truth(truth: Segmentation, found: Segmentation) -> Comparison | None:
    """Compare both at the rate of comparison; return None if the truth has no activity."""
    if not (truth.activities.kind == "activity").any():
        return None
    n_frames, fps = choose_comparison_rate(found)
    return compare_with_truth(make_truth(add_repetitions(truth), n_frames=n_frames, fps=fps), found)


def choose_comparison_rate(found: Segmentation) -> tuple[int, float]:
    """Return the number of frames and the rate of comparison: 30 Hz, or the result's if lower."""
    rate = min(FPS, found.fps)
    # Number of frames up to the last one; 1e-9 guards against rounding.
    return floor((found.n_frames - 1) * rate / found.fps + 1e-9) + 1, rate


def score(truth: Truth, found: Segmentation) -> dict[str, float]:
    """Return all scores, for a truth at the rate of comparison."""
    return compute_scores(compare_with_truth(truth, found).without_silence())


def read_trials(path: str | PathLike[str], *, fps: float = 30.0) -> dict[str, Truth]:
    """Read the truth of each trial by name, at a frame rate.

    The file is ``annotations.json`` or the authors' ``mocap.txt``. Raise ReadError if it is
    neither, or if marks run backwards, apart from known errors. A KinemeWarning names each
    corrected row.
    """
    found = {}
    for name, rows in read_actions(path).items():
        try:
            found[name] = _find_trial_truth(rows, fps)
        except ParameterError as error:
            raise ReadError(path, f"trial {name}: {error}") from error
    return found


def read_trial(path: str | PathLike[str], name: str, *, fps: float) -> Truth:
    """Read the truth of one trial; known errors are corrected without a warning.

    Raise ReadError if the file or the trial does not exist.
    """
    with warnings.catch_warnings(action="ignore", category=KinemeWarning):
        trials = read_trials(path, fps=fps)
    if name not in trials:
        names = ", ".join(trials)
        raise ReadError(path, f"contains no trial {name!r}: name one of {names} with --trial")
    return trials[name]


def is_annotation_file(path: Path) -> bool:
    """Return whether a file is ``annotations.json`` or ``mocap.txt``, judged by its content."""
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


def _find_trial_truth(rows: list[Action], fps: float) -> Truth:
    """Return the actions of a trial at a rate; each row has three marks of its end."""
    earliest, mean, latest = (
        # - 1: marks count frames from 1. The last row ends with the recording and has no border.
        round_half_up(np.array([getattr(row, mark) for row in rows[:-1]]) * (fps / TRIAL_FPS)) - 1
        for mark in ("earliest", "mean", "latest")
    )
    # Every fourth of N frames, starting with the first, are ceil(N / 4) frames.
    frames = ceil(rows[-1].latest * fps / TRIAL_FPS)
    return Truth(
        tuple(row.label for row in rows), earliest, mean=mean, latest=latest, frames=frames, fps=fps
    )
