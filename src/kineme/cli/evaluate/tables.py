"""Scores as tables for people."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from rich import box
from rich.table import Table
from rich.text import Text

from kineme._counts import counted
from kineme.cli.terminal import Console
from kineme.evaluation.tables import score_rows
from kineme.reproduction.benchmark import Result, mean_scores

Scores = Mapping[str, float]

Group = tuple[str, Sequence[tuple[str, Sequence[str]]]]
"""A title, and rows: a name and the cells beside it."""


def show_results(results: Sequence[Result]) -> None:
    """Print one table per trial, methods as columns, and the means over the trials."""
    by_trial: dict[str, dict[str, Scores]] = {}
    for result in results:
        by_trial.setdefault(result.trial.name, {})[result.method] = result.scores
    for trial, columns in by_trial.items():
        _show(trial, columns)
    if len(by_trial) > 1:
        _show(f"mean of {counted(len(by_trial), 'trial')}", mean_scores(results))


def show_one(name: str, scores: Scores) -> None:
    """Print the scores of a single result."""
    _show(name, {"score": scores})


def show_table(
    title: str,
    header: Sequence[str],
    groups: Sequence[Group],
) -> None:
    """Print a table: a column of names, one per title in the header, rows in groups."""
    table = Table(box=box.SIMPLE_HEAD, pad_edge=False, padding=(0, 1, 0, 0))
    table.add_column("", no_wrap=True)
    for name in header:
        table.add_column(name, justify="right", overflow="fold")
    for group, rows in groups:
        if group:
            table.add_row(Text(group, style="bold"))
        for name, cells in rows:
            table.add_row(f"  {name}" if group else name, *cells)
    console = Console(highlight=False)
    console.print(Text(title, style="bold"))
    console.print(table)


def _show(title: str, columns: Mapping[str, Scores]) -> None:
    show_table(title, list(columns), score_rows(columns))
