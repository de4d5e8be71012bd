"""Commands of ``kineme library`` on a library, except ``build`` and ``search``.

Each command opens the library in the argument ``LIB``.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from json import dumps
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal

import typer
from rich.text import Text

from kineme._util.checks import format_count
from kineme.cli.files import check_suffix
from kineme.cli.help import OUTPUT, option, output_option
from kineme.cli.options import CLIPS, add_options
from kineme.cli.tables import format_cluster, make_table
from kineme.cli.terminal import Console, exit_on_error, format_line
from kineme.errors import KinemeError

if TYPE_CHECKING:
    from kineme.library import Library

MAX_UNSURE = 8
"""Unsure clusters printed."""
MAX_ROWS = 1000
"""Rows of a query result printed as a table."""
Json = Annotated[bool, option(OUTPUT, "Print JSON, one object a line.", "--json")]
Scheduler = Annotated[
    str | None,
    typer.Option(
        metavar="ADDRESS",
        help="Run on the workers of this dask scheduler, such as tcp://10.0.0.1:8786.",
    ),
]
Cluster = Annotated[str, typer.Argument(help="Number or name of a cluster.")]


def parse_path_or_url(text: str) -> Path:
    """Return a path or URL that the user typed."""
    from kineme.library.storage.layout import make_path

    try:
        return make_path(text)
    except KinemeError as error:
        raise typer.BadParameter(str(error)) from error


Folder = Annotated[
    Path,
    typer.Argument(
        parser=parse_path_or_url,
        metavar="LIB",
        help="Library that `kineme library build` made, a folder or a URL.",
    ),
]


@contextmanager
def open_library(folder: Path) -> Iterator[Library]:
    """Open a library; print an error in the block and exit with code 1."""
    with exit_on_error(folder):
        from kineme.library import Library

        yield Library(folder)


def show(
    folder: Folder,
    pictures: Annotated[
        Path | None,
        option(
            OUTPUT,
            "Write a strip of small figures for each cluster into this folder, as PNG.",
            metavar="FOLDER",
        ),
    ] = None,
    json: Json = False,
) -> None:
    """Show recordings, hours, clusters and unsure names."""
    with open_library(folder) as library:
        if pictures is not None:
            library.pictures(pictures)
        if json:
            typer.echo(dumps(_collect_facts(library)))
        else:
            _show_library(library)


def query(
    folder: Folder,
    sql: Annotated[
        str,
        typer.Argument(
            help="Such as: select label, count(*) from segments group by label. The tables are "
            "segments, recordings, clusters, local_clusters and embeddings."
        ),
    ],
    json: Json = False,
) -> None:
    """Query a library in SQL, by DuckDB."""
    with open_library(folder) as library:
        answer = library.query(sql)
        if json:
            for row in answer.to_pylist():
                typer.echo(dumps(row, default=str))
        else:
            _show_answer(answer)


def export(
    folder: Folder,
    output: Annotated[Path, output_option("File to write: .parquet, .csv or .tsv.")],
    table: Annotated[
        str,
        typer.Option(
            metavar="NAME", help="segments, recordings, clusters, local_clusters or embeddings."
        ),
    ] = "segments",
) -> None:
    """Write the segments of all recordings as one table."""
    from kineme.library.exporting import TABLE_SUFFIXES

    check_suffix("--output", output, TABLE_SUFFIXES)
    with open_library(folder) as library:
        library.export(output, table)


def name(
    folder: Folder,
    cluster: Cluster,
    label: Annotated[
        str, typer.Argument(help="Name of the cluster in all recordings; '' removes it.")
    ],
) -> None:
    """Name a cluster, once for all recordings."""
    with open_library(folder) as library:
        library.name(cluster, label)


def merge(
    folder: Folder,
    cluster: Cluster,
    others: Annotated[list[str], typer.Argument(help="Clusters to merge, by number or name.")],
) -> None:
    """Merge clusters into the first, which keeps number and name."""
    with open_library(folder) as library:
        library.merge(cluster, *others)


def _collect_facts(library: Library) -> dict[str, Any]:
    return {
        "recordings": len(library),
        "hours": library.hours,
        "clusters": [cluster._asdict() for cluster in library.clusters()],
        "unsure": library.unsure(),
        "failed": library.failed,
        "sources": library.head["sources"],
        "read_options": library.head["read_options"],
        "segment_options": library.head["segment_options"],
    }


def _show_library(library: Library) -> None:
    console = Console(highlight=False)
    console.print(Text(str(library.folder), style="bold"))
    n_recordings = len(library)
    console.print(f"{format_count(n_recordings, 'recording')}, {library.hours:.2f} h")
    table = make_table(
        "cluster", "label", "recordings", "activities", "repetitions", "minutes", "typical s",
        "example",
    )  # fmt: skip
    for cluster in library.clusters():
        table.add_row(
            format_cluster(cluster.cluster),
            Text(cluster.label),
            *map(str, (cluster.recordings, cluster.activities, cluster.repetitions)),
            f"{cluster.seconds / 60:.1f}",
            f"{cluster.typical_s:.2f}",
            Text(f"{cluster.example}@{cluster.start_s:.2f}-{cluster.stop_s:.2f}"),
        )
    console.print(table)
    unsure = library.unsure()
    line = (
        "unsure: cluster {cluster} in {recording}, {start_s:.2f} to {stop_s:.2f} s, "
        "may be {next_cluster}"
    )
    for part in unsure[:MAX_UNSURE]:
        console.print(Text(line.format(**part), style="dim"))
    if len(unsure) > MAX_UNSURE:
        console.print(Text(f"and {len(unsure) - MAX_UNSURE} more that are unsure", style="dim"))
    for path, reason in library.failed.items():
        console.print(Text(f"failed: {format_line(reason, subject=path)}"), soft_wrap=True)


def _show_answer(answer: Any) -> None:
    console = Console(highlight=False)
    table = make_table(*answer.column_names)
    for row in answer.slice(0, MAX_ROWS).to_pylist():
        table.add_row(*(Text(_format_cell(value)) for value in row.values()))
    console.print(table)
    if len(answer) > MAX_ROWS:
        console.print(f"and {format_count(len(answer) - MAX_ROWS, 'row')} more: --json prints all")


def _format_cell(value: object) -> str:
    if value is None:
        return ""
    return f"{value:.6g}" if isinstance(value, float) else str(value)


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
    output: Annotated[Path | None, output_option("New folder for the best loops as clips.")] = None,
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
