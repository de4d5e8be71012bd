"""``kineme evaluate SEGMENTS``: one result against its truth, from files."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import typer

from kineme.cli.evaluate.tables import show_one
from kineme.errors import ReadError
from kineme.evaluation.inputs import comparison, read_result, read_truth, recording_of, score
from kineme.formats import read_motion
from kineme.reproduction.annotations import is_annotations, read_trial


def score_file(
    path: Path,
    labels: Path,
    fps: float | None,
    recording: Path | None,
    trials: list[str] | None,
    *,
    quiet: bool,
) -> list[dict[str, Any]]:
    """The scores of a result as records; printed unless quiet."""
    found = read_result(path, fps=fps)
    n_frames, rate = comparison(found)
    if is_annotations(labels):
        recorded = (found.provenance.get("input") or {}).get("path") or ""
        truth = read_trial(labels, trials[0] if trials else Path(recorded).stem, fps=rate)
        if truth.frames != n_frames:
            said, lasts = truth.frames / rate, n_frames / rate
            raise ReadError(labels, f"speaks of {said:.2f} s, the result of {lasts:.2f} s")
    else:
        truth = read_truth(labels, found, fps=fps)
    source = recording or recording_of(found)
    scores = score(truth, found, read_motion(source) if source else None)
    if not quiet:
        show_one(path.name, scores)
        if source is None:
            typer.echo("The recording is not at hand, so there are no distances: --recording FILE")
    return [{"result": path.name, "truth": labels.name, **scores}]
