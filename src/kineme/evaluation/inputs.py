"""Read a result and its truth from files, and compute scores.

Both are label files of any format (`kineme.labels`). They are compared at 30 Hz, as published, or
at the result's rate if that is lower. Frames before the first and after the last action of the
truth do not count.
"""

from __future__ import annotations

import warnings
from dataclasses import replace
from math import floor, isfinite
from pathlib import Path

from kineme.errors import KinemeWarning, ParameterError, ReadError
from kineme.evaluation.comparison import Comparison
from kineme.evaluation.score import compare_with_truth, compute_scores
from kineme.evaluation.truth import (
    UNLABELLED,
    Truth,
    add_repetitions,
    check_length,
    make_truth,
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
