"""``kineme evaluate FOLDER --labels A --labels B``: measure the agreement of people."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import typer

from kineme.cli.messages import show_progress
from kineme.cli.tables import show_table
from kineme.cli.terminal import escape_controls
from kineme.errors import ReadError
from kineme.evaluation.annotators import (
    AnnotatorAgreement,
    annotator_agreement,
    gather_labels,
    name_annotators,
    read_extent,
)
from kineme.evaluation.folder import find_recordings
from kineme.evaluation.score import format_score, write_result
from kineme.labels.collections import Extent, find_labels

MATCHED_BY = {
    "names": "by names",
    "mapping": "by the best mapping: names are missing, or differ between people",
}


def run_people(
    folder: Path, labels: Sequence[Path], *, output: Path | None, as_json: bool, quiet: bool
) -> None:
    """Print and write how well people agree who labelled the recordings of a folder."""
    with show_progress(folder, quiet=quiet or as_json) as stage:
        stage("looking for recordings")
        recordings = find_recordings(folder)
        names = name_annotators(labels)
        sources = {
            name: find_labels(recordings, path) for name, path in zip(names, labels, strict=True)
        }

        def read_length(path: Path) -> Extent:
            stage(f"reading {path.name}")
            return read_extent(path)

        labelled, failures = gather_labels(sources, read_length)
    for failure in failures:
        typer.echo(escape_controls(failure), err=True)
    if not any(len(sides) > 1 for sides in labelled.values()):
        raise ReadError(folder, "has no recording that two people labelled")
    result = annotator_agreement(labelled)
    if as_json:
        typer.echo(result.to_json())
    elif not quiet:
        _show_agreement(result)
    if output is not None:
        write_result(result, output)


def _show_agreement(result: AnnotatorAgreement) -> None:
    """Print a row for each pair of people, one for all, and one for each recording."""
    pairs = [
        (f"{first}, {second}", [format_score(kappa), format_score(f1), "", str(recordings)])
        for first, second, kappa, f1, recordings in result.pairs
    ]
    n_complete = sum(len(one.annotators) == len(result.annotators) for one in result.recordings)
    all_row = ("all together", ["", "", format_score(result.fleiss_kappa), str(n_complete)])
    show_table(
        f"agreement of {len(result.annotators)} annotators, {MATCHED_BY[result.by]}",
        ["Cohen's kappa", "border F1", "Fleiss' kappa", "recordings"],
        [("", [*pairs, all_row])],
    )
    rows = [
        (one.recording, [format_score(one.fleiss_kappa), str(len(one.differences))])
        for one in result.recordings
    ]
    show_table("by recording", ["Fleiss' kappa", "differences"], [("", rows)])
