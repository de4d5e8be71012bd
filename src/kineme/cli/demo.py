"""``kineme demo``: segment the bundled recording."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from kineme.cli.files import check_target_folder, check_writable
from kineme.cli.help import OUTPUT, option
from kineme.cli.options import Quiet
from kineme.cli.segment import read_and_segment, write_results
from kineme.cli.terminal import Failures, show_progress
from kineme.formats.options import ReadOptions
from kineme.methods.segmenter import SegmentOptions


def demo(
    output: Annotated[
        Path,
        option(
            OUTPUT,
            "Folder for the table and the picture.",
            "--output",
            "-o",
            metavar="FOLDER",
            show_default="current folder",
        ),
    ] = Path(),
    quiet: Quiet = False,
) -> None:
    """Segment the bundled recording; write a table and a picture."""
    from kineme.datasets import bundled_recording

    path = bundled_recording()
    table, picture = (output / f"{path.stem}{suffix}" for suffix in (".csv", ".png"))
    failures = Failures()
    with failures.catch_errors(path):
        check_target_folder(table)
        check_writable(table, picture)
        options = SegmentOptions()
        with show_progress(path.name, quiet=quiet) as stage:
            recording, result = read_and_segment(path, ReadOptions(), None, options, stage)
        write_results(result, recording, options, table, picture)
        if not quiet:
            from kineme.cli.tables import show_segments

            show_segments(result, "activity")
            typer.echo(f"Read     {path}")
            typer.echo(f"Table    {table}")
            typer.echo(f"Picture  {picture}")
            typer.echo(
                "\nThe same on your own: kineme segment FILE --output cuts.csv --plot cuts.png"
            )
    failures.exit()
