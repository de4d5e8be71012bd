"""``kineme evaluate FOLDER``: methods side by side on recordings that people have labelled."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import typer

from kineme._util.checks import join_names
from kineme.cli.messages import progress
from kineme.cli.tables import show_table
from kineme.cli.terminal import harmless
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
from kineme.labels.collections import find_labels_and_strays

NAMED = 5
"""Names that a list of files shows before it only counts."""


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
    """Print and write the scores of the methods; whether any recording could be scored."""
    try:
        for name in methods:
            check_method(name)
    except ParameterError as error:
        raise typer.BadParameter(str(error)) from error
    with progress(folder, quiet=quiet or as_json) as stage:
        stage("looking for recordings")
        recordings = find_recordings(folder)
        found, strays = find_labels_and_strays(recordings, labels)
        result = evaluate_folder(
            found,
            methods,
            mapping=mapping,
            n_clusters=n_clusters,
            read_options=read_options,
            without=without,
            constants=constants,
            progress=stage,
        )
    if not quiet:
        _tell("labels of recordings that are not there", strays)
        _tell("without labels, left out", [path.name for path in recordings if path not in found])
    _tell_of_recordings(result, quiet=quiet)
    if as_json:
        typer.echo(result.to_json())
    elif not quiet:
        _show(result)
    if output is not None:
        write_result(result, output)
    return any(not one.error for ones in result.methods.values() for one in ones)


def _tell(what: str, names: Sequence[str]) -> None:
    if names:
        typer.echo(harmless(f"{what}: {join_names(names, NAMED)}"), err=True)


def _tell_of_recordings(result: FolderScores, *, quiet: bool) -> None:
    """Say which recordings failed and why, and what is unusual about the labels of others."""
    for name, ones in result.methods.items():
        for one in ones:
            if one.error:
                typer.echo(harmless(f"{one.recording}, {name}: {one.error}"), err=True)
    for one in next(iter(result.methods.values())):
        if one.notes and not quiet:
            typer.echo(harmless(f"{one.recording}: {'; '.join(one.notes)}"), err=True)


def _show(result: FolderScores) -> None:
    """Print the scores of each recording by the methods, then those over all of them."""
    columns: dict[str, Any] = {method: result.pool_scores(method) for method in result.methods}
    ones = [one for some in result.methods.values() for one in some]
    counts = [name for name in ("count_error",) if any(name in one.scores for one in ones)]
    short = ("mof", "edit", "f1@50", "border_f1", *counts)
    by_method = [
        (method if len(columns) > 1 else "", [(one.recording, _row(one, short)) for one in ones])
        for method, ones in result.methods.items()
    ]
    show_table("by recording", [scores()[name].title for name in short], by_method)
    counted = [
        f"{sum(not one.error for one in ones)} of {len(ones)}" for ones in result.methods.values()
    ]
    groups = [*make_score_rows(columns), ("recordings", [("recordings scored", counted)])]
    title = f"over all recordings, one mapping for each {result.mapping}"
    show_table(title, list(columns), groups, note=explain_disagreement(columns))


def _row(one: RecordingScores, names: Sequence[str]) -> list[str]:
    return ["failed" if one.error else _format_score(one.scores.get(name)) for name in names]


def _format_score(value: float | None) -> str:
    return "" if value is None else format_score(value)
