"""``kineme convert``: segments or recordings from one format to another."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any

import typer

from kineme.cli.messages import Failures
from kineme.errors import WriteError
from kineme.labels import label_formats, read_segments, write_segments, written_suffixes
from kineme.segments.table import Level


def _known(name: str | None) -> str | None:
    if name not in (None, *label_formats()):
        raise typer.BadParameter(f"{name!r} is not one of {', '.join(label_formats())}")
    return name


def _is_recording(source: Path) -> bool:
    """Whether the suffix is one of recordings and of no labels."""
    from kineme.formats import supported_formats

    recordings = {suffix for known in supported_formats() for suffix in known.suffixes}
    return source.suffix.lower() in recordings - set(written_suffixes())


def convert(
    source: Annotated[Path, typer.Argument(metavar="FROM", help="Segments, or a recording.")],
    target: Annotated[Path, typer.Argument(metavar="TO", help="File to write; it must be new.")],
    from_format: Annotated[
        str | None,
        typer.Option("--from", callback=_known, help=f"Format read: {', '.join(label_formats())}."),
    ] = None,
    to_format: Annotated[
        str | None,
        typer.Option("--to", callback=_known, help="Format written; both follow from suffixes."),
    ] = None,
    level: Annotated[
        Level | None, typer.Option(help="Segments to write; by default all the format holds.")
    ] = None,
    frames: Annotated[
        int | None, typer.Option(help="Length of the recording, where labels end before it.")
    ] = None,
    reading: dict[str, Any] | None = None,
) -> None:
    """Turn segments into labels of another program and back, or a recording into another format.

    The suffixes say what is read and written: BVH, AMC, TRC, CSV and npz hold recordings.
    --fps is the recording's frame rate, too, for labels that hold seconds only.
    """
    options = reading or {}
    failures = Failures()
    with failures.caught(source):
        if target.exists():
            raise WriteError(target, "is there already: remove it or name another file")
        if from_format is None and _is_recording(source):
            from kineme.formats import read, write

            write(read(source, **options), target)
        else:
            segments = read_segments(
                source, format=from_format, fps=options.get("fps"), n_frames=frames
            )
            write_segments(segments, target, format=to_format, level=level)
    failures.exit()
