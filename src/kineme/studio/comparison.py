"""Another result beside the one shown: a preset's, or what a label file says, with the scores."""

from __future__ import annotations

from pathlib import Path

from kineme.evaluation.inputs import agreement as scores_against
from kineme.labels.collections import labels_for
from kineme.segments.segmentation import Segmentation


def annotation(
    path: Path, recording: Path, shown: Segmentation
) -> tuple[Segmentation, dict[str, float]]:
    """What a label file says about a recording, and how well the result shown agrees with it.

    Raises
    ------
    ReadError
        It cannot be read or understood, or is of another recording.
    """
    other = labels_for(recording, path, n_frames=shown.n_frames, fps=shown.fps, clock=shown.clock)
    return other, agreement(shown, other)


def agreement(shown: Segmentation, other: Segmentation) -> dict[str, float]:
    """Scores of the result shown, the other taken for the truth; none if that has no activity."""
    return scores_against(other, shown)
