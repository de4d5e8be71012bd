"""``kineme library show``: what is in a library, and what is unsure."""

from __future__ import annotations

from json import dumps
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from kineme._counts import counted
from kineme.cli.library.folder import Folder, Json, opened
from kineme.cli.messages import one_line

if TYPE_CHECKING:
    from kineme.library import Library

UNSURE = 8
"""Of what is unsure, so many are shown."""


def show(
    folder: Folder,
    pictures: Annotated[
        Path | None,
        typer.Option(
            help="Folder for pictures: a strip of small figures for each cluster, as PNG.",
        ),
    ] = None,
    json: Json = False,
) -> None:
    """Tell the recordings, hours and clusters of a library, and what is unsure."""
    with opened(folder) as library:
        if pictures is not None:
            library.pictures(pictures)
        if json:
            typer.echo(dumps(_facts(library)))
        else:
            _show(library)


def _facts(library: Library) -> dict[str, Any]:
    return {
        "recordings": len(library),
        "hours": library.hours,
        "clusters": [cluster._asdict() for cluster in library.clusters()],
        "unsure": [word._asdict() for word in library.unsure()],
        "failed": library.failed,
        "sources": library.head["sources"],
        "settings": library.head["settings"],
    }


def _show(library: Library) -> None:
    from rich.text import Text

    from kineme.cli.console import Console
    from kineme.cli.tables import cluster_cell, new_table

    console = Console(highlight=False)
    console.print(Text(str(library.folder), style="bold"))
    n = len(library)
    console.print(f"{counted(n, 'recording')}, {library.hours:.2f} h")
    table = new_table(
        "cluster", "label", "recordings", "activities", "repetitions", "minutes", "typical s",
        "example",
    )  # fmt: skip
    for each in library.clusters():
        table.add_row(
            cluster_cell(each.cluster),
            Text(each.label),
            *map(str, (each.recordings, each.activities, each.repetitions)),
            f"{each.seconds / 60:.1f}",
            f"{each.typical_s:.2f}",
            Text(f"{each.example}@{each.start_s:.2f}-{each.stop_s:.2f}"),
        )
    console.print(table)
    unsure = library.unsure()
    for word in unsure[:UNSURE]:
        console.print(
            Text(
                f"unsure: cluster {word.cluster} in {word.recording}, {word.start_s:.2f} to "
                f"{word.stop_s:.2f} s, may be {word.following}",
                style="dim",
            )
        )
    if len(unsure) > UNSURE:
        console.print(Text(f"and {len(unsure) - UNSURE} more that are unsure", style="dim"))
    for path, reason in library.failed.items():
        console.print(Text(f"failed: {one_line(reason, subject=path)}"), soft_wrap=True)
