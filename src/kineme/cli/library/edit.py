"""``kineme library name``, ``merge`` and ``split``: what people say of clusters."""

from __future__ import annotations

from typing import Annotated

import typer

from kineme.cli.library.folder import Cluster, Folder, opened


def name(
    folder: Folder,
    cluster: Cluster,
    label: Annotated[str, typer.Argument(help="Its name in all recordings; '' takes it away.")],
) -> None:
    """Name a cluster, once for all recordings."""
    with opened(folder) as library:
        library.name(cluster, label)


def merge(
    folder: Folder,
    cluster: Cluster,
    others: Annotated[list[str], typer.Argument(help="Clusters that are the same.")],
) -> None:
    """Make other clusters part of one, which keeps its number and name."""
    with opened(folder) as library:
        library.merge(cluster, *others)


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
