"""``kineme evaluate cmu86``: methods on the trials of subject 86."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import typer

from kineme._util.checks import format_count
from kineme._util.files import atomic_write
from kineme.cli.tables import show_scores
from kineme.cli.terminal import show_progress
from kineme.errors import ParameterError, WriteError
from kineme_reproduction.benchmark import (
    METHODS,
    Method,
    Result,
    Scores,
    as_records,
    mean_scores,
    method,
    run,
)
from kineme_reproduction.trials import find_folder, load_trials


def run_benchmark(
    names: list[str],
    trials: list[str] | None,
    data: Path | None,
    plot: Path | None,
    figures: Path | None,
    *,
    quiet: bool,
) -> list[dict[str, Any]]:
    """Score methods on trials; print the records unless quiet, draw if a folder is given."""
    methods = _methods(names)
    for folder in (plot, figures):
        _make_folder(folder)
    with show_progress("cmu86", quiet=quiet) as stage:
        folder = find_folder(data)
        loaded = load_trials(folder, trials, progress=stage)
        results = run(loaded, methods, progress=stage)
    if not quiet:
        _show(results)
    with show_progress("figures", quiet=quiet) as stage:
        _draw(results, folder, plot, figures, stage)
    return as_records(results)


def _methods(names: list[str]) -> Mapping[str, Method]:
    try:
        return {name: method(name) for name in names} or METHODS
    except ParameterError as error:
        raise typer.BadParameter(str(error)) from error


def _show(results: list[Result]) -> None:
    """Print one table per trial, methods as columns, and the means over the trials."""
    by_trial: dict[str, dict[str, Scores]] = {}
    for result in results:
        by_trial.setdefault(result.trial.name, {})[result.method] = result.scores
    for trial, columns in by_trial.items():
        show_scores(trial, columns)
    if len(by_trial) > 1:
        show_scores(f"mean of {format_count(len(by_trial), 'trial')}", mean_scores(results))


def _draw(
    results: list[Result], data: Path, plot: Path | None, figures: Path | None, stage: Any
) -> None:
    if plot is not None:
        from kineme_reproduction.figures.segments import plot_trials

        plot_trials(results, plot)
    if figures is not None:
        from kineme_reproduction.figures import make_figures

        tables = make_figures(results, data, figures, progress=stage)
        text = "\n".join(f"## {title}\n\n{table}" for title, table in tables.items())
        with atomic_write(figures / "tables.md") as draft:
            draft.write_text(text, encoding="utf-8")


def _make_folder(folder: Path | None) -> None:
    try:
        if folder is not None:
            folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise WriteError(folder or "", f"cannot be created: {error.strerror}") from error
