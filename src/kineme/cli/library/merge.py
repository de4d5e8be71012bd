"""``kineme library merge``: clusters that are one."""

from __future__ import annotations

from typing import Annotated

import typer

from kineme.cli.library.folder import Cluster, Folder, opened


def merge(
    folder: Folder,
    cluster: Cluster,
    others: Annotated[list[str], typer.Argument(help="Clusters that are the same.")],
) -> None:
    """Make other clusters part of one, which keeps its number and name."""
    with opened(folder) as library:
        library.merge(cluster, *others)
