"""``kineme library name``: what a cluster is called."""

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
