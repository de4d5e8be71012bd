"""``kineme convert``: segments from one label format to another."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from kineme.cli.messages import Failures
from kineme.errors import WriteError
from kineme.export import FORMATS, read_segments, write_segments
from kineme.segmentation.table import Level


def _known(name: str | None) -> str | None:
    if name not in (None, *FORMATS):
        raise typer.BadParameter(f"{name!r} is not one of {', '.join(FORMATS)}")
    return name


def convert(
    source: Annotated[Path, typer.Argument(metavar="FROM", help="Table or labels to read.")],
    target: Annotated[Path, typer.Argument(metavar="TO", help="File to write; it must be new.")],
    from_format: Annotated[
        str | None,
        typer.Option("--from", callback=_known, help=f"Format read: {', '.join(FORMATS)}."),
    ] = None,
    to_format: Annotated[
        str | None,
        typer.Option("--to", callback=_known, help="Format written; both follow from suffixes."),
    ] = None,
    level: Annotated[
        Level | None, typer.Option(help="Segments to write; by default all the format holds.")
    ] = None,
    fps: Annotated[
        float | None, typer.Option(help="Frame rate of the recording, for labels in seconds only.")
    ] = None,
    frames: Annotated[
        int | None, typer.Option(help="Length of the recording, where labels end before it.")
    ] = None,
) -> None:
    """Turn segments into the labels of another program, or such labels into a table."""
    failures = Failures()
    with failures.caught(source):
        if target.exists():
            raise WriteError(target, "is there already: remove it or name another file")
        segments = read_segments(source, format=from_format, fps=fps, n_frames=frames)
        write_segments(segments, target, format=to_format, level=level)
    failures.exit()
