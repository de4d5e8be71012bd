"""``LIB``: the library that a command is about."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from kineme.cli.messages import Failures

if TYPE_CHECKING:
    from kineme.library import Library


def path_or_url(text: str) -> Path:
    """A place that was typed."""
    from kineme.errors import KinemeError
    from kineme.library.storage.places import place

    try:
        return place(text)
    except KinemeError as error:
        raise typer.BadParameter(str(error)) from error


Folder = Annotated[
    Path,
    typer.Argument(
        parser=path_or_url,
        metavar="LIB",
        help="Library that `kineme library build` made, a folder or a URL.",
    ),
]
Json = Annotated[bool, typer.Option("--json", help="Print JSON, one object a line.")]
Scheduler = Annotated[
    str | None,
    typer.Option(
        metavar="ADDRESS",
        help="Work on the cluster of this dask scheduler, such as tcp://10.0.0.1:8786.",
    ),
]
Cluster = Annotated[str, typer.Argument(help="A cluster by its number or name.")]


@contextmanager
def opened(folder: Path) -> Iterator[Library]:
    """The library; what goes wrong with it in the block is said, and ends the command with 1."""
    failures = Failures()
    with failures.caught(folder):
        from kineme.library import Library

        yield Library(folder)
    failures.exit()
