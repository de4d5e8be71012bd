"""``kineme library export``: a table of a library, taken along."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from kineme.cli.library.folder import Folder, opened


def export(
    folder: Folder,
    output: Annotated[
        Path, typer.Option("--output", "-o", help="File to write: .parquet, .csv or .tsv.")
    ],
    table: Annotated[
        str, typer.Option(help="segments, recordings, clusters, words or embeddings.")
    ] = "segments",
) -> None:
    """Write one table of a library: its segments, with a column for the recording."""
    with opened(folder) as library:
        library.export(output, table)
