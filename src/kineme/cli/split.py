"""``kineme split``: recordings in, a folder of clips of each out."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any

import typer

from kineme._counts import counted
from kineme.cli.help import INPUT, OUTPUT
from kineme.cli.options.inputs import Batch, Files, Recursive
from kineme.cli.options.method import Constants, Detail, PresetName
from kineme.cli.options.reading import Effectors, Quiet, with_reading_options
from kineme.cli.options.request import Request
from kineme.cli.options.targets import make_folder_of
from kineme.methods.presets import DEFAULT
from kineme.segments.table import Level


@with_reading_options
def split(
    files: Files,
    output: Annotated[
        Path,
        typer.Option(
            "--output",
            "-o",
            help="Folder to make, new or empty. Of several recordings each gets a folder in it, "
            "or one by a path with {name} in it.",
            rich_help_panel=OUTPUT,
        ),
    ],
    level: Annotated[
        Level,
        typer.Option(help="Write activities, or each primitive.", rich_help_panel=OUTPUT),
    ] = "activity",
    cluster: Annotated[
        int | None,
        typer.Option(help="Write those of this cluster only.", rich_help_panel=OUTPUT),
    ] = None,
    loop: Annotated[
        bool,
        typer.Option(
            "--loop",
            help="Blend the ends, so that each clip plays as a cycle.",
            rich_help_panel=OUTPUT,
        ),
    ] = False,
    to_format: Annotated[
        str | None,
        typer.Option(
            "--format",
            metavar="SUFFIX",
            help="Format: bvh, amc, glb (all in one file), …",
            rich_help_panel=OUTPUT,
        ),
    ] = None,
    segments: Annotated[
        Path | None,
        typer.Option(
            help="Segment table or labels to cut by, instead of segmenting anew; of several "
            "recordings a folder, or a path with {name} in it.",
            rich_help_panel=INPUT,
        ),
    ] = None,
    detail: Detail = 1.0,
    preset: PresetName = DEFAULT,
    recursive: Recursive = False,
    quiet: Quiet = False,
    effectors: Effectors = None,
    constants: Constants = None,
    reading: dict[str, Any] | None = None,
) -> None:
    """Write each segment of a recording as a file of its own, and a list of them.

    Clips are BVH, or CSV of joint positions where there are no rotations; of signals, rows of
    their file. The list is manifest.csv.
    """
    request = Request.of(preset, constants, reading, effectors, detail)
    batch = Batch(files, recursive=recursive, quiet=quiet)
    folders = batch.folders("--output", output)
    tables = batch.tables("--segments", segments)
    for path, folder, table in zip(batch.paths, folders, tables, strict=True):
        with batch.caught(path):
            with batch.progress(path) as stage:
                stage("reading")
                recording = request.read(path)
                cuts = request.segments(recording, table, stage)
            from kineme.clips.split import split as write_clips

            if not batch.single:
                make_folder_of(folder)
            clips = write_clips(
                recording,
                cuts,
                folder,
                level=level,
                cluster=cluster,
                loops=loop,
                format=to_format,
            )
            if not quiet:
                typer.echo(f"{counted(len(clips), 'clip')} in {folder}")
    batch.exit()
