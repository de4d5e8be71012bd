"""Score methods on a folder, one result, or the agreement of people, and print the scores.

These are the parts of `kineme evaluate` that import the methods.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

import typer

from kineme._util.checks import join_names
from kineme.cli.tables import show_scores, show_table
from kineme.cli.terminal import escape_controls, show_progress
from kineme.errors import ParameterError, ReadError
from kineme.evaluation.annotators import (
    AnnotatorAgreement,
    annotator_agreement,
    gather_labels,
    name_annotators,
    read_extent,
)
from kineme.evaluation.folder import (
    FolderScores,
    Mapped,
    RecordingScores,
    check_method,
    evaluate_folder,
    find_recordings,
)
from kineme.evaluation.inputs import read_result, read_truth
from kineme.evaluation.score import (
    Result,
    evaluate,
    explain_disagreement,
    format_score,
    make_score_rows,
    scores,
    write_result,
)
from kineme.formats.options import ReadOptions
from kineme.labels.collections import Extent, find_labels, find_labels_and_unmatched

MAX_NAMES = 5
"""File names printed; the rest is only counted."""
MATCHED_BY = {
    "names": "by names",
    "mapping": "by the best mapping: names are missing, or differ between people",
}


def run_folder(
    folder: Path,
    labels: Path,
    methods: Sequence[str],
    *,
    mapping: Mapped,
    n_clusters: int | None,
    read_options: ReadOptions,
    without: Sequence[str],
    constants: Mapping[str, Any],
    output: Path | None,
    as_json: bool,
    quiet: bool,
) -> bool:
    """Print and write the scores of the methods; return whether any recording was scored."""
    try:
        for name in methods:
            check_method(name)
    except ParameterError as error:
        raise typer.BadParameter(str(error)) from error
    with show_progress(folder, quiet=quiet or as_json) as stage:
        stage("looking for recordings")
        recordings = find_recordings(folder)
        labelled, strays = find_labels_and_unmatched(recordings, labels)
        result = evaluate_folder(
            labelled,
            methods,
            mapping=mapping,
            n_clusters=n_clusters,
            read_options=read_options,
            without=without,
            constants=constants,
            progress=stage,
        )
    if not quiet:
        _print_names("labels without a recording", strays)
        _print_names(
            "recordings without labels, left out",
            [path.name for path in recordings if path not in labelled],
        )
    _print_problems(result, quiet=quiet)
    _output_result(result, lambda: _show_scores(result), output, as_json=as_json, quiet=quiet)
    return any(not one.error for ones in result.methods.values() for one in ones)


def _print_names(what: str, names: Sequence[str]) -> None:
    if names:
        typer.echo(escape_controls(f"{what}: {join_names(names, MAX_NAMES)}"), err=True)


def _print_problems(result: FolderScores, *, quiet: bool) -> None:
    """Print which recordings failed and why, and notes on the labels of the others."""
    for name, ones in result.methods.items():
        for one in ones:
            if one.error:
                typer.echo(escape_controls(f"{one.recording}, {name}: {one.error}"), err=True)
    for one in next(iter(result.methods.values())):
        if one.notes and not quiet:
            typer.echo(escape_controls(f"{one.recording}: {'; '.join(one.notes)}"), err=True)


def _show_scores(result: FolderScores) -> None:
    """Print the scores of each recording by method, then the scores over all recordings."""
    columns: dict[str, Any] = {method: result.pool_scores(method) for method in result.methods}
    evaluated = [one for some in result.methods.values() for one in some]
    counts = [name for name in ("count_error",) if any(name in one.scores for one in evaluated)]
    score_names = ("mof", "edit", "f1@50", "border_f1", *counts)
    by_method = [
        (
            method if len(columns) > 1 else "",
            [(one.recording, _format_row(one, score_names)) for one in evaluated],
        )
        for method, evaluated in result.methods.items()
    ]
    show_table("by recording", [scores()[name].title for name in score_names], by_method)
    counted = [
        f"{sum(not one.error for one in evaluated)} of {len(evaluated)}"
        for evaluated in result.methods.values()
    ]
    groups = [*make_score_rows(columns), ("recordings", [("recordings scored", counted)])]
    title = f"over all recordings, one mapping for each {result.mapping}"
    show_table(title, list(columns), groups, note=explain_disagreement(columns))


def _format_row(one: RecordingScores, names: Sequence[str]) -> list[str]:
    if one.error:
        return ["failed"] * len(names)
    values = (one.scores.get(name) for name in names)
    return ["" if value is None else format_score(value) for value in values]


def run_people(
    folder: Path, labels: Sequence[Path], *, output: Path | None, as_json: bool, quiet: bool
) -> None:
    """Print and write how well people agree who labelled the recordings of a folder."""
    with show_progress(folder, quiet=quiet or as_json) as stage:
        stage("looking for recordings")
        recordings = find_recordings(folder)
        names = name_annotators(labels)
        paths = zip(names, labels, strict=True)
        sources = {name: find_labels(recordings, path) for name, path in paths}

        def read_length(path: Path) -> Extent:
            stage(f"reading {path.name}")
            return read_extent(path)

        labelled, failures = gather_labels(sources, read_length)
    for failure in failures:
        typer.echo(escape_controls(failure), err=True)
    if not any(len(sides) > 1 for sides in labelled.values()):
        raise ReadError(folder, "has no recording that two people labelled")
    result = annotator_agreement(labelled)
    _output_result(result, lambda: _show_agreement(result), output, as_json=as_json, quiet=quiet)


def _output_result(
    result: Result, show: Callable[[], None], output: Path | None, *, as_json: bool, quiet: bool
) -> None:
    """Print a result as JSON or tables, and write it."""
    if as_json:
        typer.echo(result.to_json())
    elif not quiet:
        show()
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


def score_file(path: Path, labels: Path, fps: float | None, *, quiet: bool) -> list[dict[str, Any]]:
    """Return the scores of a result as records; print them unless quiet."""
    result = read_result(path, fps=fps)
    scores = evaluate(read_truth(labels, result, fps=fps), result)
    if not quiet:
        show_scores(path.name, {"score": scores})
    return [{"result": path.name, "truth": labels.name, **scores}]
