"""``kineme library split``: a cluster that is two."""

from __future__ import annotations

from typing import Annotated

import typer

from kineme.cli.library.folder import Cluster, Folder, opened


def split(
    folder: Folder,
    cluster: Cluster,
    recordings: Annotated[
        list[str], typer.Argument(help="Names of recordings where it is something else.")
    ],
) -> None:
    """Make what a cluster has in some recordings a cluster of its own; its number is printed."""
    with opened(folder) as library:
        typer.echo(library.split(cluster, recordings))
