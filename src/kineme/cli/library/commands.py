"""``kineme library show``, ``query``, ``export``, ``name``, ``merge``.

Each command opens the library in the argument ``LIB``.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from json import dumps
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from kineme._util.checks import format_count
from kineme.cli.help import OUTPUT, option
from kineme.cli.messages import Failures, format_line

if TYPE_CHECKING:
    from kineme.library import Library

MAX_UNSURE = 8
"""Unsure clusters printed."""
MAX_ROWS = 1000
"""Rows of a query result printed as a table."""


def parse_path_or_url(text: str) -> Path:
    """Return a path or URL that the user typed."""
    from kineme.errors import KinemeError
    from kineme.library.storage.places import make_path

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
Json = Annotated[bool, option(OUTPUT, "Print JSON, one object a line.", "--json")]
Scheduler = Annotated[
    str | None,
    typer.Option(
        metavar="ADDRESS",
        help="Run on the workers of this dask scheduler, such as tcp://10.0.0.1:8786.",
    ),
]
Cluster = Annotated[str, typer.Argument(help="Number or name of a cluster.")]


@contextmanager
def open_library(folder: Path) -> Iterator[Library]:
    """Open a library; print an error in the block and exit with code 1."""
    failures = Failures()
    with failures.catch_errors(folder):
        from kineme.library import Library

        yield Library(folder)
    failures.exit()


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
    output: Annotated[
        Path, option(OUTPUT, "File to write: .parquet, .csv or .tsv.", "--output", "-o")
    ],
    table: Annotated[
        str,
        typer.Option(
            metavar="NAME", help="segments, recordings, clusters, local_clusters or embeddings."
        ),
    ] = "segments",
) -> None:
    """Write the segments of all recordings as one table."""
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
    from rich.text import Text

    from kineme.cli.tables import format_cluster, make_table
    from kineme.cli.terminal import Console

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
    from rich.text import Text

    from kineme.cli.tables import make_table
    from kineme.cli.terminal import Console

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
