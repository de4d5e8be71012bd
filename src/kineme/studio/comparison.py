"""Another result beside the one shown: a preset's, or what a label file says, with the scores."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np

from kineme.errors import KinemeError, ParameterError
from kineme.evaluation import TRANSITION, Annotation, Labelling, evaluate_segmentation, labelling_of
from kineme.evaluation.inputs import comparison, read_truth
from kineme.labels import read_segments
from kineme.segments.segmentation import Segmentation


def annotation(path: Path, shown: Segmentation) -> tuple[Segmentation, dict[str, float]]:
    """What a label file says about the recording shown, and how well the result agrees with it.

    Parameters
    ----------
    path : Path
        The label file.
    shown : Segmentation
        The result.

    Returns
    -------
    other : Segmentation
        What the file says.
    scores : dict of float

    Raises
    ------
    ReadError
        It cannot be read or understood, or is of another length.
    """
    try:
        other = read_segments(path, fps=shown.fps, n_frames=shown.n_frames)
    except KinemeError as first:
        try:
            truth = read_truth(path, shown)
        except KinemeError as second:
            annotations = (".csv", ".tsv", ".txt", ".json")
            raise (second if path.suffix.lower() in annotations else first) from None
        return _as_segments(truth, shown), _scores(truth, shown)
    return other, agreement(shown, other)


def agreement(shown: Segmentation, other: Segmentation) -> dict[str, float]:
    """Scores of the result shown, with the other as the truth.

    Parameters
    ----------
    shown, other : Segmentation

    Returns
    -------
    dict of float
        By the name of the score; empty if the other has no activity.
    """
    rows = other.activities
    if TRANSITION in set(rows.kind.tolist()) and not (rows.kind == "activity").any():
        return {}
    clusters = labelling_of(rows, fps=other.fps)
    names = [row.label or name for row, name in zip(rows, clusters.labels, strict=True)]
    kinds = rows.kind == "transition"
    names = [TRANSITION if between else name for between, name in zip(kinds, names, strict=True)]
    frames, fps = comparison(shown)
    labelling = Labelling(clusters.borders, tuple(names), other.fps)
    try:
        truth = Annotation.from_labelling(labelling.at(frames=frames, fps=fps))
    except ParameterError:  # nothing of it is left at the rate of comparison
        return {}
    return _scores(truth, shown)


def _scores(truth: Annotation, shown: Segmentation) -> dict[str, float]:
    """The scores that there are: a ratio to no borders at all is none."""
    scores = evaluate_segmentation(truth, shown)
    return {name: value for name, value in scores.items() if math.isfinite(value)}


def _as_segments(truth: Annotation, shown: Segmentation) -> Segmentation:
    """An annotation as a table of activities, in frames of the recording shown."""
    labels = truth.labelling().at(frames=shown.n_frames, fps=shown.fps)
    between = np.array([label == TRANSITION for label in labels.labels])
    columns = {
        "level": np.full(len(between), "activity"),
        "kind": np.where(between, "transition", "activity"),
        "start_frame": labels.starts,
        "stop_frame": labels.stops,
        "label": np.where(between, "", labels.labels),
    }
    return Segmentation.from_columns(columns, n_frames=shown.n_frames, fps=shown.fps)
