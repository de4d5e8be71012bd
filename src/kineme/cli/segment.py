"""``kineme segment``: recordings in, tables and pictures out."""

from __future__ import annotations

from collections.abc import Sequence
from json import dumps
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from kineme.cli.help import INPUT, OUTPUT, TABLES, option
from kineme.cli.options.inputs import Batch, FilesOfFormats, Recursive
from kineme.cli.options.reading import READING, Json, Quiet
from kineme.cli.options.request import SEGMENTING, Request, Stage, asks
from kineme.cli.options.targets import check_writable
from kineme.segments.table import Level

if TYPE_CHECKING:
    from kineme.recordings import Motion, Signals
    from kineme.segments.segmentation import Segmentation

PrintedLevel = Annotated[
    Level, option(OUTPUT, "Print activities with what lies between them, or each primitive.")
]


@asks(READING | SEGMENTING)
def segment(
    files: FilesOfFormats,
    request: Request,
    output: Annotated[
        Path | None,
        option(
            OUTPUT,
            f"Write the segments as a table, or as labels of another program: {TABLES}. Of "
            "several recordings: a folder, or a path with {name} in it.",
            "--output",
            "-o",
        ),
    ] = None,
    plot: Annotated[
        Path | None,
        option(OUTPUT, "Draw them: .png, .pdf, .svg; or a folder, or a path with {name} in it."),
    ] = None,
    report: Annotated[
        Path | None,
        option(
            OUTPUT,
            "Write a page that plays the recording beside them: .html; or a folder, or a path "
            "with {name} in it.",
        ),
    ] = None,
    level: PrintedLevel = "activity",
    join: Annotated[
        bool,
        option(
            INPUT,
            "Take the files for sensors of one recording, each with its own rate and clock, and "
            "join them by time. Results are called after the first.",
        ),
    ] = False,
    recursive: Recursive = False,
    json: Json = False,
    quiet: Quiet = False,
) -> None:
    """Cut recordings into activities and repeated primitives.

    An activity is one kind of movement for a while, such as walking; a transition leads from one
    to the next. Primitives are the movements that an activity repeats, such as each double step.
    What is alike has the same cluster number. With --person all each of the people in a recording
    is segmented, and results are called after them.

    For example: kineme segment walk.bvh --output walk.csv --plot walk.png
    """
    batch = Batch(files, recursive=recursive, quiet=quiet)
    joined = batch.join() if join else []
    tables = batch.targets("--output", output, ".csv")
    pictures = batch.targets("--plot", plot, ".png")
    pages = batch.targets("--report", report, ".html")

    def work(path: Path, asked: Request, _: None, *targets: Path | None) -> None:
        check_writable(*targets)
        with batch.progress(path) as stage:
            stage("reading")
            recording = _read_joined(joined, asked) if joined else asked.read(path)
            result = _segment_one(recording, asked, targets, stage)
        print_segments(result, recording, level, [*targets], json=json, quiet=quiet)

    for path, *targets in zip(batch.paths, tables, pictures, pages, strict=True):
        batch.each_person(path, request, work, *targets)
    batch.exit()


def _read_joined(paths: Sequence[Path], request: Request) -> Signals:
    """Return the channels of several files on one clock."""
    from kineme.errors import ReadError
    from kineme.recordings import Signals
    from kineme.recordings.samples import join_signals

    parts = [(path, request.read(path)) for path in paths]
    for path, part in parts:
        if not isinstance(part, Signals):
            raise ReadError(path, "is a motion, and --join takes channels of sensors: leave it out")
    return join_signals(*(part for _, part in parts if isinstance(part, Signals)))


def _segment_one(
    recording: Motion | Signals, request: Request, targets: Sequence[Path | None], stage: Stage
) -> Segmentation:
    """Return the segments of a recording; write table, picture and page where these are wanted."""
    table, picture, page = targets
    result = request.segment(recording, stage)
    write_results(result, recording, request, table, picture)
    if page is not None:
        from kineme.report.page import write_report

        write_report(request.drawn(recording), result, page, effectors=request.effectors)
    return result


def write_results(
    result: Segmentation,
    recording: Motion | Signals,
    request: Request,
    table: Path | None,
    picture: Path | None,
) -> None:
    """Write the table and the picture, where wanted."""
    if table is not None:
        from kineme.labels import write_segments

        write_segments(result, table)
    if picture is not None:
        from kineme.plot import plot_segmentation

        plot_segmentation(result, request.drawn(recording), picture, effectors=request.effectors)


def print_segments(
    result: Segmentation,
    recording: Motion | Signals,
    level: Level,
    written: list[Path | None],
    *,
    json: bool,
    quiet: bool,
) -> None:
    """Print the segments as JSON, or as a table above the files that were written."""
    if json:
        from kineme.labels.json_table import as_object

        typer.echo(dumps(as_object(result)))
    elif not quiet:
        from kineme.cli.tables import show_segments

        show_segments(result, level, written=written, warned=recording.provenance.warnings)
