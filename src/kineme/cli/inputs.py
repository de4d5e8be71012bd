"""What is given as FILES: recordings, or folders of them."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from kineme.cli.messages import Failures

Files = Annotated[
    list[Path],
    typer.Argument(
        metavar="FILES",
        help="Recordings, or folders of them: BVH, AMC, C3D, TRC, tables, npz, MOT.",
    ),
]


def recordings_of(given: list[Path], failures: Failures) -> list[Path]:
    """The files, and in place of each folder the recordings in it."""
    found: list[Path] = []
    for path in given:
        with failures.caught(path):
            if path.is_dir():
                from kineme.formats.listing import recordings_in

                found += recordings_in(path)
            else:
                found.append(path)
    return found
