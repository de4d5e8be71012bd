"""``kineme events``: find foot contacts and measure the gait."""

from __future__ import annotations

from dataclasses import replace
from math import isnan
from pathlib import Path
from typing import Annotated

import typer
from rich.text import Text

from kineme._util.checks import format_count
from kineme.cli.files import Batch, Files, Recursive, check_suffix
from kineme.cli.help import OUTPUT, TABLES, option, output_option
from kineme.cli.options import READING, Quiet, add_options
from kineme.cli.tables import make_table, show_written
from kineme.cli.terminal import Console
from kineme.cycles.events import Events, foot_events, strides
from kineme.cycles.events import gait as gait_of
from kineme.cycles.export import TABLE_SUFFIXES, write_table
from kineme.cycles.table import Columns
from kineme.formats import read
from kineme.formats.files import load
from kineme.formats.markers.c3d_file import parse_c3d
from kineme.formats.options import ReadOptions
from kineme.labels import list_written_suffixes, write_segments
from kineme.labels.c3d_events import require_c3d, write_events
from kineme.recordings import Motion, Signals

FEET = "Feet"


@add_options(READING)
def events(
    files: Files,
    read_options: ReadOptions,
    output: Annotated[
        Path | None,
        output_option(
            "Write a table of the events: .csv or .parquet; for several recordings, a "
            "folder or a path with {name} in it."
        ),
    ] = None,
    gait: Annotated[
        Path | None,
        option(
            OUTPUT,
            "Write means of strides, stances, swings and steps: .csv or .parquet, and each "
            "stride next to it (.strides.csv).",
        ),
    ] = None,
    labels: Annotated[
        Path | None,
        option(OUTPUT, f"Write the spans from each event to the next as labels: {TABLES}."),
    ] = None,
    c3d: Annotated[
        Path | None, option(OUTPUT, "Write a copy of a C3D file with the events.")
    ] = None,
    left: Annotated[
        str | None,
        option(
            FEET,
            "Channels of the left foot, such as lf_gyr_*: three axes of its gyroscope, or the "
            "vertical force under it; by default found by name.",
            metavar="NAME",
        ),
    ] = None,
    right: Annotated[
        str | None, option(FEET, "Channels of the right foot.", metavar="NAME")
    ] = None,
    recursive: Recursive = False,
    quiet: Quiet = False,
) -> None:
    """Find foot contacts and measure the gait.

    Uses the positions of heel and toe, gyroscopes on the feet, or the force under them.
    """
    batch = Batch(files, recursive=recursive, quiet=quiet)
    tables = batch.targets("--output", output, ".csv")
    gaits = batch.targets("--gait", gait, ".csv")
    spans = batch.targets("--labels", labels, ".csv")
    copies = batch.targets("--c3d", c3d, ".c3d")
    for table, measures, span, copy in zip(tables, gaits, spans, copies, strict=True):
        check_suffix("--output", table, TABLE_SUFFIXES)
        check_suffix("--gait", measures, TABLE_SUFFIXES)
        check_suffix("--labels", span, list_written_suffixes())
        check_suffix("--c3d", copy, (".c3d",))
    if c3d is not None and read_options.fps:
        raise typer.BadParameter(
            "a C3D has its own frame rate: leave out --fps", param_hint="--c3d"
        )

    def work(path: Path, options: ReadOptions, _: None, *targets: Path | None) -> None:
        table_path, gait_path, label_path, c3d_path = targets
        with batch.progress(path) as stage:
            stage("reading")
            if c3d_path is not None:
                require_c3d(path)
            recording = read(path, **vars(options))
            contacts = foot_events(recording, left=left, right=right)
            measures = gait_of(contacts, recording)
            contacts = _count_file_frames(contacts, recording, path, options)
        written = [target for target in targets if target is not None]
        for target in written:
            target.parent.mkdir(exist_ok=True)
        note = ""
        if table_path is not None:
            write_table(contacts.columns(), table_path)
        if gait_path is not None:
            write_table(measures, gait_path)
            stride_path = gait_path.with_suffix(f".strides{gait_path.suffix}")
            write_table(strides(contacts, recording), stride_path)
            written.append(stride_path)
        if label_path is not None:
            write_segments(contacts.segmentation(), label_path)
        if c3d_path is not None:
            # In a file of several people, an event names the person it belongs to.
            source = recording.provenance
            subject = source.person if len(source.people) > 1 else None
            n_added = write_events(path, c3d_path, contacts.times, contacts.names, subject=subject)
            note = f"{format_count(n_added, 'event')} added to those in the file"
        if not quiet:
            _show(path, contacts, measures, written, note)

    for path, *targets in zip(batch.paths, tables, gaits, spans, copies, strict=True):
        batch.run_each_person(path, read_options, work, *targets)
    batch.exit()


def _count_file_frames(
    events: Events, recording: Motion | Signals, path: Path, options: ReadOptions
) -> Events:
    """Return events of analog channels of a C3D with the frames of its points."""
    if recording.provenance.format != "C3D" or isinstance(recording, Motion) or options.fps:
        return events
    file = parse_c3d(load(path))
    return replace(events, n_frames=len(file.points), fps=file.rate) if file.labels else events


def _show(path: Path, events: Events, gait: Columns, written: list[Path], note: str) -> None:
    """Print the number of events, the gait measures, and the note if there is one."""
    console = Console(highlight=False)
    console.print(Text.assemble((path.name, "bold"), f"  {format_count(len(events), 'event')}"))
    for side, source in events.sources.items():
        console.print(Text(f"{side} foot: from {source}"))
    table = make_table("measure", "left", "n", "right", "n", "asymmetry %")
    table.columns[0].justify = "left"
    for name, *values in zip(*(column.tolist() for column in gait.values()), strict=True):
        n, mean, sd, other_n, other, other_sd, asymmetry = values
        table.add_row(
            name, _format_mean(mean, sd), str(n), _format_mean(other, other_sd), str(other_n),
            "" if isnan(asymmetry) else f"{asymmetry:+.1f}",
        )  # fmt: skip
    if len(gait["measure"]):
        console.print(table)
    if note:
        console.print(note)
    show_written(console, written)


def _format_mean(mean: float, deviation: float) -> str:
    """Return a mean with its standard deviation, without missing numbers."""
    return f"{mean:.3f} ± {deviation:.3f}".replace(" ± nan", "").replace("nan", "")
