"""``kineme segment``: recordings in, tables and pictures out."""

from __future__ import annotations

from json import dumps
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from kineme.cli.inputs import Files, recordings_of
from kineme.cli.messages import Failures, progress
from kineme.cli.reading import Effectors, Json, Quiet, effector_names
from kineme.cli.signals import Columns, Emg, SignalOptions, run_signals
from kineme.cli.targets import check_writable, targets
from kineme.errors import ParameterError
from kineme.methods.base import Preset
from kineme.methods.presets import DEFAULT, PRESETS, resolve_preset
from kineme.segments.table import Level

if TYPE_CHECKING:
    from kineme.features import Names
    from kineme.methods.recurrence.analysis import RecurrenceFound
    from kineme.methods.region_growing.analysis import RegionsFound
    from kineme.recordings.motion import Motion
    from kineme.recordings.signals import Signals
    from kineme.segments.segmentation import Segmentation


def segment(
    files: Files,
    preset: Annotated[str, typer.Option(help=f"{', '.join(PRESETS)}.")] = DEFAULT,
    output: Annotated[
        Path | None,
        typer.Option(
            "--output",
            "-o",
            help="Segment table (.csv, .json, .parquet) or labels (.eaf, .TextGrid, .tsv, .txt); "
            "a folder; or a name with {name} in it.",
        ),
    ] = None,
    plot: Annotated[
        Path | None,
        typer.Option(help="Picture: .png, .pdf or .svg; a folder; or a name with {name} in it."),
    ] = None,
    report: Annotated[
        Path | None,
        typer.Option(help="Page to look at: .html; a folder; or a name with {name} in it."),
    ] = None,
    level: Annotated[Level, typer.Option(help="Rows to print.")] = "activity",
    json: Json = False,
    quiet: Quiet = False,
    effectors: Effectors = None,
    columns: Columns = None,
    emg: Emg = False,
    overrides: dict[str, Any] | None = None,
    reading: dict[str, Any] | None = None,
) -> None:
    """Cut recordings into activities, transitions and repeated primitives."""
    overrides = overrides or {}
    try:
        chosen = resolve_preset(preset, **overrides)
    except ParameterError as error:
        raise typer.BadParameter(str(error)) from error
    reading = reading or {}
    failures = Failures()
    files = recordings_of(files, failures)
    tables = targets("--output", output, files, ".csv")
    pictures = targets("--plot", plot, files, ".png")
    pages = targets("--report", report, files, ".html")
    names = effector_names(effectors)
    signals = SignalOptions.of(columns, reading.get("fps"), emg=emg)
    source: Motion | Signals
    for path, table, picture, page in zip(files, tables, pictures, pages, strict=True):
        with failures.caught(path):
            check_writable(table, picture, page)
            if signals.mean(path):
                result, analysis, source = run_signals(
                    path, signals, preset, overrides, quiet=quiet
                )
            else:
                result, analysis, source = run(path, reading, chosen, names, quiet=quiet)
            write_results(result, analysis, table, picture)
            if page is not None:
                from kineme.report.page import write_report

                write_report(source, result, page, effectors=names)
            if json:
                from kineme.labels.json_table import as_object

                typer.echo(dumps(as_object(result)))
            elif not quiet:
                from kineme.cli.tables import show_segments

                show_segments(result, level, written=[table, picture, page])
    failures.exit()


def run(
    path: Path,
    reading: dict[str, Any],
    preset: Preset,
    effectors: Names | None,
    *,
    quiet: bool,
) -> tuple[Segmentation, RegionsFound | RecurrenceFound, Motion]:
    """The segments of a file, what each stage found on the way to them, and the motion."""
    with progress(path.name, quiet=quiet) as stage:
        stage("reading")
        from kineme.formats import read
        from kineme.segmentation.segmenter import segment_and_found

        motion = read(path, **reading)
        found = segment_and_found(motion, preset, effectors=effectors, progress=stage)
        return *found, motion


def write_results(
    result: Segmentation,
    analysis: RegionsFound | RecurrenceFound,
    table: Path | None,
    picture: Path | None,
) -> None:
    """The table and the picture, where wanted."""
    if table is not None:
        from kineme.labels import write_segments

        write_segments(result, table)
    if picture is not None:
        from kineme.plot.segmentation import plot_segmentation

        plot_segmentation(result, analysis.graph, picture)
