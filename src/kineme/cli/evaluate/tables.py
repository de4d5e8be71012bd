"""Scores as tables for people."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from rich import box
from rich.table import Table
from rich.text import Text

from kineme.cli.terminal import Console
from kineme.evaluation.tables import score_rows

Scores = Mapping[str, float]

Group = tuple[str, Sequence[tuple[str, Sequence[str]]]]
"""A title, and rows: a name and the cells beside it."""


def show_scores(title: str, columns: Mapping[str, Scores]) -> None:
    """Print scores by the columns that have them."""
    show_table(title, list(columns), score_rows(columns))


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
