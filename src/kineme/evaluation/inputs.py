"""Read a result and its truth from files, and find where they differ.

Both are label files of any format (`kineme.labels`). They are compared at 30 Hz, as published, or
at the result's rate if that is lower.
"""

from __future__ import annotations

import warnings
from dataclasses import replace
from pathlib import Path

from kineme.errors import KinemeWarning, ParameterError, ReadError
from kineme.evaluation.comparison import Comparison
from kineme.evaluation.truth import (
    FPS,
    UNLABELLED,
    Truth,
    add_repetitions,
    check_length,
    choose_comparison_rate,
    make_truth,
)
from kineme.labels.registry import read_content
from kineme.labels.spans import Labels, as_segmentation, convert_clock_times
from kineme.recordings.arrays import find_spans
from kineme.segments.segmentation import Segmentation


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
    n_frames, rate = choose_comparison_rate(found.n_frames, found.fps)
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
    compared = Comparison.of(truth, found)
    least = compared.spans.actions.tolerance_s * compared.fps
    # Frames of a class of the truth with another class in the result.
    wrong = (compared.truth != compared.mapped) & (compared.truth != UNLABELLED)
    return [
        (start / compared.fps, stop / compared.fps)
        for start, stop in find_spans(wrong).tolist()
        if stop - start > least
    ]
