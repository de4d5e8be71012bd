"""``kineme convert``: segments from one label format to another."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from kineme.cli.messages import Failures
from kineme.errors import ReadError, WriteError
from kineme.export import FORMATS, read_segments, write_segments
from kineme.segmentation.table import Level


def _known(name: str | None) -> str | None:
    if name not in (None, *FORMATS):
        raise typer.BadParameter(f"{name!r} is not one of {', '.join(FORMATS)}")
    return name


def _check_no_recording(source: Path, from_format: str | None) -> None:
    from kineme.formats import supported_formats

    suffix = source.suffix.lower()
    recordings = {suffix for known in supported_formats() for suffix in known.suffixes}
    labels = {suffix for known in FORMATS.values() for suffix in known.suffixes}
    if from_format is None and suffix in recordings - labels:
        raise ReadError(
            source,
            "is a recording, and convert is for segments: cut it with kineme segment; in Python "
            "kineme.write(kineme.read(FROM), TO) turns it into another format",
        )


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
        _check_no_recording(source, from_format)
        segments = read_segments(source, format=from_format, fps=fps, n_frames=frames)
        write_segments(segments, target, format=to_format, level=level)
    failures.exit()
