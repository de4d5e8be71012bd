"""``kineme evaluate SEGMENTS``: compare a result with the truth, both from files."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from kineme.cli.tables import show_scores
from kineme.errors import ReadError
from kineme.evaluation.inputs import (
    choose_comparison_rate,
    is_annotation_file,
    read_result,
    read_trial,
    read_truth,
    score,
)


def score_file(
    path: Path,
    labels: Path,
    fps: float | None,
    trials: list[str] | None,
    *,
    quiet: bool,
) -> list[dict[str, Any]]:
    """Return the scores of a result as records; print them unless quiet."""
    result = read_result(path, fps=fps)
    n_frames, rate = choose_comparison_rate(result)
    if is_annotation_file(labels):
        recording_path = (result.provenance.get("input") or {}).get("path") or ""
        truth = read_trial(labels, trials[0] if trials else Path(recording_path).stem, fps=rate)
        if truth.frames != n_frames:
            seconds = truth.frames / rate
            raise ReadError(
                labels, f"covers {seconds:.2f} s, but the result lasts {n_frames / rate:.2f} s"
            )
    else:
        truth = read_truth(labels, result, fps=fps)
    scores = score(truth, result)
    if not quiet:
        show_scores(path.name, {"score": scores})
    return [{"result": path.name, "truth": labels.name, **scores}]
