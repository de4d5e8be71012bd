"""``kineme evaluate SEGMENTS``: one result against its truth, from files."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import typer

from kineme.cli.tables import show_scores
from kineme.errors import KinemeError, ReadError
from kineme.evaluation.annotations import is_annotations, read_trial
from kineme.evaluation.inputs import comparison, read_result, read_truth, recording_of, score
from kineme.formats import read, read_motion
from kineme.recordings import Motion
from kineme.segments.segmentation import Segmentation


def score_file(
    path: Path,
    labels: Path,
    fps: float | None,
    recording: Path | None,
    trials: list[str] | None,
    *,
    quiet: bool,
) -> list[dict[str, Any]]:
    """Return the scores of a result as records; printed unless quiet."""
    found = read_result(path, fps=fps)
    n_frames, rate = comparison(found)
    if is_annotations(labels):
        recorded = (found.provenance.get("input") or {}).get("path") or ""
        truth = read_trial(labels, trials[0] if trials else Path(recorded).stem, fps=rate)
        if truth.frames != n_frames:
            seconds = truth.frames / rate
            raise ReadError(
                labels, f"speaks of {seconds:.2f} s, the result of {n_frames / rate:.2f} s"
            )
    else:
        truth = read_truth(labels, found, fps=fps)
    motion, why = (read_motion(recording), "") if recording else _motion_of(found)
    scores = score(truth, found, motion)
    if not quiet:
        show_scores(path.name, {"score": scores})
        if why:
            typer.echo(f"There are no distances within clusters: {why}")
    return [{"result": path.name, "truth": labels.name, **scores}]


def _motion_of(found: Segmentation) -> tuple[Motion | None, str]:
    """Return the motion that a result names, or why there is none that its scores could use."""
    source = recording_of(found)
    if source is None:
        return None, "the recording is not at hand (--recording FILE)"
    try:
        motion = read(source, fps=found.fps)
    except KinemeError as error:
        return None, str(error)
    if not isinstance(motion, Motion):
        return None, "the recording has no joints"
    if motion.n_frames != found.n_frames:
        return None, f"the result has {found.n_frames} frames, {source.name} {motion.n_frames}"
    return motion, ""
