"""``kineme report``: recordings in, pages to look at out."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from kineme.cli.help import OUTPUT, option
from kineme.cli.options.inputs import Batch, Files, Recursive, SegmentTable
from kineme.cli.options.reading import READING, Quiet
from kineme.cli.options.request import SEGMENTING, Request, asks
from kineme.cli.options.targets import check_writable


@asks(READING | SEGMENTING)
def report(
    files: Files,
    request: Request,
    output: Annotated[
        Path,
        option(
            OUTPUT,
            "Page to write: .html; of several recordings a folder, or a path with {name} in "
            "it.  [default: beside you, named as the recording is]",
            "--output",
            "-o",
            show_default=False,
        ),
    ] = Path(),
    segments: SegmentTable = None,
    recursive: Recursive = False,
    quiet: Quiet = False,
) -> None:
    """Write a web page that plays a recording and its segments.

    One file with everything in it: it needs neither a server nor a network.
    """
    batch = Batch(files, recursive=recursive, quiet=quiet)
    pages = batch.files("--output", output, ".html")
    batch.tables("--segments", segments)  # whether there are any

    def work(path: Path, asked: Request, table: Path | None, page: Path) -> None:
        check_writable(page=page)
        with batch.progress(path) as stage:
            stage("reading")
            recording = asked.read(path)
            result = asked.segments(recording, table, stage)
        from kineme.report.page import write_report

        drawn = asked.drawn(recording)
        write_report(drawn, result, page, name=path.name, effectors=asked.effectors)
        if not quiet:
            typer.echo(page)

    for path, page in zip(batch.paths, pages, strict=True):
        batch.each_person(path, request, work, page, tables=("--segments", segments))
    batch.exit()
