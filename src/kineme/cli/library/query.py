"""``kineme library query``: questions in SQL."""

from __future__ import annotations

from json import dumps
from typing import Annotated, Any

import typer

from kineme._counts import counted
from kineme.cli.library.folder import Folder, Json, opened

SHOWN = 1000
"""Rows that are printed as a table."""


def query(
    folder: Folder,
    sql: Annotated[
        str,
        typer.Argument(
            help="Such as: select label, count(*) from segments group by label. There are "
            "segments, recordings, clusters, words and embeddings."
        ),
    ],
    json: Json = False,
) -> None:
    """Ask a library in SQL, by DuckDB."""
    with opened(folder) as library:
        answer = library.query(sql)
        if json:
            for row in answer.to_pylist():
                typer.echo(dumps(row, default=str))
        else:
            _show(answer)


def _show(answer: Any) -> None:
    from rich.text import Text

    from kineme.cli.console import Console
    from kineme.cli.tables import new_table

    console = Console(highlight=False)
    table = new_table(*answer.column_names)
    for row in answer.slice(0, SHOWN).to_pylist():
        table.add_row(*(Text(_cell(value)) for value in row.values()))
    console.print(table)
    if len(answer) > SHOWN:
        console.print(f"and {counted(len(answer) - SHOWN, 'row')} more: --json prints all")


def _cell(value: object) -> str:
    if value is None:
        return ""
    return f"{value:.6g}" if isinstance(value, float) else str(value)
