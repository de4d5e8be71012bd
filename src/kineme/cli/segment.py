"""``kineme segment`` and ``demo``: segment recordings; write tables, plots and pages."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from json import dumps
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from kineme._util.parallel import announce_compilation
from kineme.cli.files import (
    Batch,
    FilesOfFormats,
    Recursive,
    check_suffixes,
    check_target_folder,
    check_writable,
)
from kineme.cli.help import INPUT, OUTPUT, TABLES, option, output_option
from kineme.cli.options import READING, SEGMENTING, Json, Quiet, add_options
from kineme.cli.tables import show_segments
from kineme.cli.terminal import exit_on_error, show_progress
from kineme.errors import ReadError
from kineme.formats import read
from kineme.formats.options import ReadOptions
from kineme.labels import write_segments
from kineme.labels.collections import read_labels
from kineme.labels.json_table import as_object
from kineme.methods.segmenter import SegmentOptions, segment_with_options
from kineme.recordings import Motion, Signals
from kineme.recordings.samples import join_signals
from kineme.segments.segmentation import Segmentation
from kineme.segments.table import Level

if TYPE_CHECKING:
    from kineme.methods import Progress

PrintedLevel = Annotated[
    Level,
    option(OUTPUT, "Level to print: activities with transitions between them, or primitives."),
]


@add_options(READING | SEGMENTING)
def segment(
    files: FilesOfFormats,
    read_options: ReadOptions,
    segment_options: SegmentOptions,
    output: Annotated[
        Path | None,
        output_option(
            f"Write the segments as a table, or as labels of another program: {TABLES}. Of "
            "several recordings: a folder, or a path with {name} in it."
        ),
    ] = None,
    plot: Annotated[
        Path | None,
        option(
            OUTPUT,
            "Draw the segments: .png, .pdf or .svg; or a folder, or a path with {name} in it.",
        ),
    ] = None,
    report: Annotated[
        Path | None,
        option(
            OUTPUT,
            "Write a page that plays the recording next to its segments: .html; or a "
            "folder, or a path with {name} in it.",
        ),
    ] = None,
    level: PrintedLevel = "activity",
    join: Annotated[
        bool,
        option(
            INPUT, "Treat the files as sensors of one recording and join them by time.", "--join"
        ),
    ] = False,
    recursive: Recursive = False,
    json: Json = False,
    quiet: Quiet = False,
) -> None:
    """Cut recordings into activities and repeated primitives.

    An activity is one kind of movement for a while, such as walking; a transition leads from one to
    the next. Primitives are the movements that an activity repeats, such as each double step.
    Segments with the same cluster number are the same movement. With --person all, each person in a
    recording is segmented separately; names of results include the person.

    For example: kineme segment walk.bvh --output walk.csv --plot walk.png
    """
    batch = Batch(files, recursive=recursive, quiet=quiet)
    joined = batch.join() if join else []
    tables = batch.targets("--output", output, ".csv")
    pictures = batch.targets("--plot", plot, ".png")
    pages = batch.targets("--report", report, ".html")
    for results in zip(tables, pictures, pages, strict=True):
        check_suffixes(*results)

    def work(path: Path, options: ReadOptions, _: None, *targets: Path | None) -> None:
        check_writable(*targets)
        with batch.progress(path) as stage:
            stage("reading")
            recording = _read_joined(joined, options) if joined else read(path, **vars(options))
            result = load_or_find_segments(recording, None, segment_options, stage)
            write_results(result, recording, segment_options, *targets)
        print_segments(result, recording, level, [*targets], json=json, quiet=quiet)

    for path, *targets in zip(batch.paths, tables, pictures, pages, strict=True):
        batch.run_each_person(path, read_options, work, *targets)
    batch.exit()


def demo(
    output: Annotated[
        Path,
        output_option(
            "Folder for the table and the picture.", metavar="FOLDER", show_default="current folder"
        ),
    ] = Path(),
    quiet: Quiet = False,
) -> None:
    """Segment the bundled recording; write a table and a picture."""
    from kineme.datasets import bundled_recording

    path = bundled_recording()
    table, picture = (output / f"{path.stem}{suffix}" for suffix in (".csv", ".png"))
    with exit_on_error(path):
        check_target_folder(table)
        check_writable(table, picture)
        options = SegmentOptions()
        with show_progress(path.name, quiet=quiet) as stage:
            recording, result = read_and_segment(path, ReadOptions(), None, options, stage)
        write_results(result, recording, options, table, picture)
        if not quiet:
            show_segments(result, "activity")
            typer.echo(f"Read     {path}")
            typer.echo(f"Table    {table}")
            typer.echo(f"Picture  {picture}")
            typer.echo(
                "\nThe same on your own: kineme segment FILE --output cuts.csv --plot cuts.png"
            )


def _read_joined(paths: Sequence[Path], options: ReadOptions) -> Signals:
    """Return the channels of several files, joined by time."""
    parts = []
    for path in paths:
        part = read(path, **vars(options))
        if not isinstance(part, Signals):
            raise ReadError(
                path, "is a motion, but --join needs sensor channels: leave this file out"
            )
        parts.append(part)
    return join_signals(*parts)


def read_and_segment(
    path: Path,
    read_options: ReadOptions,
    table: Path | None,
    segment_options: SegmentOptions,
    stage: Progress,
) -> tuple[Motion | Signals, Segmentation]:
    """Return the recording in a file and its segments; see `load_or_find_segments`."""
    stage("reading")
    recording = read(path, **vars(read_options))
    return recording, load_or_find_segments(recording, table, segment_options, stage)


def load_or_find_segments(
    recording: Motion | Signals, table: Path | None, options: SegmentOptions, stage: Progress
) -> Segmentation:
    """Return the segments in a table or label file; without one, segment the recording."""
    if table is None:
        with announce_compilation(stage):
            return segment_with_options(recording, options, progress=stage)[0]
    return read_labels(
        Path(recording.provenance.path or ""),
        table,
        n_frames=recording.n_frames,
        fps=recording.fps,
        clock=recording.provenance.clock,
    )


def show_envelopes(recording: Motion | Signals, options: SegmentOptions) -> Motion | Signals:
    """Return the recording for plots; muscle signals are replaced by their envelopes."""
    if not (options.emg and isinstance(recording, Signals)):
        return recording
    from kineme.features.channels import emg_envelope

    return replace(recording, values=emg_envelope(recording.values, recording.fps))


def write_results(
    result: Segmentation,
    recording: Motion | Signals,
    options: SegmentOptions,
    table: Path | None,
    picture: Path | None,
    page: Path | None = None,
) -> None:
    """Write the table, the plot and the page, as far as requested."""
    if table is not None:
        write_segments(result, table)
    if picture is not None or page is not None:
        recording = show_envelopes(recording, options)
    if picture is not None:
        from kineme.plot import plot_segmentation

        plot_segmentation(result, recording, picture, effectors=options.effectors)
    if page is not None:
        from kineme.report.page import write_report

        write_report(recording, result, page, effectors=options.effectors)


def print_segments(
    result: Segmentation,
    recording: Motion | Signals,
    level: Level,
    written: list[Path | None],
    *,
    json: bool,
    quiet: bool,
) -> None:
    """Print the segments as JSON, or as a table with the written files."""
    if json:
        typer.echo(dumps(as_object(result)))
    elif not quiet:
        show_segments(result, level, written=written, warned=recording.provenance.warnings)
