"""``kineme split``: recordings in, a folder of clips of each out."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any

import typer

from kineme._counts import counted
from kineme.cli.options.inputs import Batch, Files, Recursive
from kineme.cli.options.preset_options import Detail, PresetName, with_preset_options
from kineme.cli.options.reading import Effectors, Quiet, with_reading_options
from kineme.cli.options.request import Request
from kineme.cli.options.targets import make_folder_of
from kineme.methods.presets import DEFAULT
from kineme.segments.table import Level


@with_preset_options
@with_reading_options
def split(
    files: Files,
    output: Annotated[
        Path,
        typer.Option(
            "--output",
            "-o",
            help="Folder to make, new or empty; with several recordings one of its own in it "
            "for each, or by a name with {name} in it.",
        ),
    ],
    level: Annotated[Level, typer.Option(help="Segments to take.")] = "activity",
    cluster: Annotated[
        int | None, typer.Option(help="Take those of this cluster only.", show_default=False)
    ] = None,
    loop: Annotated[
        bool, typer.Option("--loop", help="Blend the ends, so that each clip plays as a cycle.")
    ] = False,
    segments: Annotated[
        Path | None,
        typer.Option(
            help="Table or labels to cut by, instead of segmenting anew; a folder of them; "
            "or a name with {name} in it."
        ),
    ] = None,
    detail: Detail = 1.0,
    preset: PresetName = DEFAULT,
    recursive: Recursive = False,
    quiet: Quiet = False,
    effectors: Effectors = None,
    constants: dict[str, Any] | None = None,
    reading: dict[str, Any] | None = None,
) -> None:
    """Write each segment of a recording as a file of its own, and a manifest of them.

    BVH, or CSV of joint positions where there are no rotations. Of signals, rows of their file.
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
            clips = write_clips(recording, cuts, folder, level=level, cluster=cluster, loops=loop)
            if not quiet:
                typer.echo(f"{counted(len(clips), 'clip')} in {folder}")
    batch.exit()
