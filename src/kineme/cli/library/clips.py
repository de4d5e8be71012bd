"""``kineme library split`` and ``coverage``: clips of all recordings, and their variety."""

from __future__ import annotations

from json import dumps
from pathlib import Path
from typing import Annotated, Any, Literal

import typer

from kineme._util.checks import format_count
from kineme.cli.help import OUTPUT, option
from kineme.cli.library.commands import Folder, Json, open_library
from kineme.cli.options.clips import CLIPS
from kineme.cli.options.declare import add_options


@add_options(CLIPS)
def split(
    folder: Folder,
    clip_options: dict[str, Any],
    cluster: Annotated[
        str | None, typer.Argument(help="Number or name of the cluster to split in two.")
    ] = None,
    recordings: Annotated[
        list[str] | None,
        typer.Argument(help="Names of the recordings in which it is another movement."),
    ] = None,
    output: Annotated[
        Path | None,
        option(OUTPUT, "New folder for the best loops as clips.", "--output", "-o"),
    ] = None,
    best: Annotated[int, option(OUTPUT, "Largest number of loops per cluster.", min=1)] = 3,
    per: Annotated[
        Literal["cluster", "direction", "recording"],
        option(
            OUTPUT,
            "Choose the best loops per cluster, or per direction or recording within each cluster.",
        ),
    ] = "cluster",
) -> None:
    """Write the best loops of each cluster, or split a cluster in two.

    For example: kineme library split LIB --best 3 --per cluster -o loops. Near duplicates are left
    out. With a cluster and recordings, the segments in these recordings move to a new cluster,
    whose number is printed.
    """
    if cluster is not None:
        if not recordings:
            raise typer.BadParameter(
                "name the recordings in which this cluster is another movement",
                param_hint="RECORDINGS",
            )
        with open_library(folder) as library:
            typer.echo(library.split(cluster, recordings))
        return
    target = output or Path(f"{folder.name}_loops")
    with open_library(folder) as library:
        clips = library.loops(target, best=best, per=per, **clip_options)
        typer.echo(f"{format_count(len(clips), 'clip')} in {target}")


def coverage(folder: Folder, json: Json = False) -> None:
    """Show the directions, speeds and turns in each cluster."""
    with open_library(folder) as library:
        covered = library.coverage()
        if json:
            for row in covered:
                typer.echo(dumps(row._asdict()))
            return
        from rich.text import Text

        from kineme.cli.tables import format_cluster, make_table
        from kineme.cli.terminal import Console

        table = make_table(
            "cluster", "label", "direction", "clips", "seconds", "m/s", "turn °", "starts", "stops"
        )
        for row in covered:
            turns = [f"{row.left_deg:.0f} left"] * (row.left_deg >= 1)
            turns += [f"{row.right_deg:.0f} right"] * (row.right_deg >= 1)
            table.add_row(
                format_cluster(row.cluster),
                Text(row.label),
                row.direction,
                str(row.clips),
                f"{row.seconds:.1f}",
                f"{row.slowest_m_s:.1f}-{row.fastest_m_s:.1f}",
                ", ".join(turns),
                str(row.starts),
                str(row.stops),
            )
        Console(highlight=False).print(table)
