"""``kineme evaluate FOLDER``: compare methods on recordings that people labelled."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import typer

from kineme._util.checks import join_names
from kineme.cli.messages import show_progress
from kineme.cli.tables import show_table
from kineme.cli.terminal import escape_controls
from kineme.errors import ParameterError
from kineme.evaluation.folder import (
    FolderScores,
    Mapped,
    RecordingScores,
    check_method,
    evaluate_folder,
    find_recordings,
)
from kineme.evaluation.score import (
    explain_disagreement,
    format_score,
    make_score_rows,
    scores,
    write_result,
)
from kineme.formats.options import ReadOptions
from kineme.labels.collections import find_labels_and_unmatched

MAX_NAMES = 5
"""File names printed; the rest is only counted."""


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
    if as_json:
        typer.echo(result.to_json())
    elif not quiet:
        _show_scores(result)
    if output is not None:
        write_result(result, output)
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
    return ["failed" if one.error else _format_score(one.scores.get(name)) for name in names]


def _format_score(value: float | None) -> str:
    return "" if value is None else format_score(value)
