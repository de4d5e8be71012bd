"""``kineme report``: write pages that play recordings with their segments."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from kineme.cli.files import Batch, Files, Recursive, SegmentTable, check_suffixes, check_writable
from kineme.cli.help import output_option
from kineme.cli.options import READING, SEGMENTING, Quiet, add_options
from kineme.cli.segment import read_and_segment, show_envelopes
from kineme.formats.options import ReadOptions
from kineme.methods.segmenter import SegmentOptions


@add_options(READING | SEGMENTING)
def report(
    files: Files,
    read_options: ReadOptions,
    segment_options: SegmentOptions,
    output: Annotated[
        Path,
        output_option(
            "Page to write: .html; for several recordings, a folder or a path with {name} "
            "in it.  [default: the name of the recording, in the current folder]",
            show_default=False,
        ),
    ] = Path(),
    segments: SegmentTable = None,
    recursive: Recursive = False,
    quiet: Quiet = False,
) -> None:
    """Write a web page that plays a recording and its segments.

    The page is a single file that needs neither a server nor a network.
    """
    batch = Batch(files, recursive=recursive, quiet=quiet)
    pages = batch.files("--output", output, ".html")
    for page in pages:
        check_suffixes(page=page)
    batch.tables("--segments", segments)  # fail early if there are none

    def work(path: Path, options: ReadOptions, table: Path | None, page: Path) -> None:
        check_writable(page=page)
        with batch.progress(path) as stage:
            recording, result = read_and_segment(path, options, table, segment_options, stage)
        from kineme.report.page import write_report

        shown_recording = show_envelopes(recording, segment_options)
        write_report(
            shown_recording, result, page, name=path.name, effectors=segment_options.effectors
        )
        if not quiet:
            typer.echo(page)

    for path, page in zip(batch.paths, pages, strict=True):
        batch.run_each_person(path, read_options, work, page, tables=("--segments", segments))
    batch.exit()
