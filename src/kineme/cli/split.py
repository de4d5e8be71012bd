"""``kineme split``: recordings in, a folder of clips of each out."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from kineme._util.checks import format_count
from kineme.cli.help import OUTPUT, option
from kineme.cli.options.declare import add_options
from kineme.cli.options.inputs import Batch, Files, Recursive, SegmentTable
from kineme.cli.options.method import SEGMENTING
from kineme.cli.options.reading import READING, Quiet
from kineme.cli.options.targets import make_folder_of
from kineme.cli.segment import read_and_segment
from kineme.clips import RootMotionMode
from kineme.formats.options import ReadOptions
from kineme.methods.segmenter import SegmentOptions
from kineme.segments.table import Level


@add_options(READING | SEGMENTING)
def split(
    files: Files,
    read_options: ReadOptions,
    segment_options: SegmentOptions,
    output: Annotated[
        Path,
        option(
            OUTPUT,
            "Folder, or .glb of all clips; of several recordings with {name} in it.",
            "--output",
            "-o",
        ),
    ],
    level: Annotated[Level, option(OUTPUT, "Activities, or primitives.")] = "activity",
    cluster: Annotated[int | None, option(OUTPUT, "Write those of this cluster only.")] = None,
    loop: Annotated[
        bool, option(OUTPUT, "Blend the ends so that each clip loops.", "--loop")
    ] = False,
    best: Annotated[
        int | None, option(OUTPUT, "Of loops: so many of each cluster.", "--best", min=1)
    ] = None,
    root_motion: Annotated[
        RootMotionMode,
        option(OUTPUT, "keep, extract (to a root bone), in-place.", metavar="HOW"),
    ] = "keep",
    straight: Annotated[bool, option(OUTPUT, "Take out each clip's turn.", "--straight")] = False,
    mirror: Annotated[
        bool, option(OUTPUT, "Exchange left and right in each clip.", "--mirror")
    ] = False,
    close: Annotated[
        bool, option(OUTPUT, "Repeat the first frame of loops at their end.", "--close")
    ] = False,
    to_format: Annotated[
        str | None,
        option(
            OUTPUT, "Such as glb; by default bvh, or csv of points.", "--format", metavar="SUFFIX"
        ),
    ] = None,
    segments: SegmentTable = None,
    recursive: Recursive = False,
    quiet: Quiet = False,
) -> None:
    """Write each segment as a file of its own.

    The clips keep the skeleton of the recording. A table lists them.
    """
    batch = Batch(files, recursive=recursive, quiet=quiet)
    folders = batch.folders("--output", output)
    batch.tables("--segments", segments)  # whether there are any

    def work(path: Path, options: ReadOptions, table: Path | None, folder: Path) -> None:
        with batch.progress(path) as stage:
            recording, cuts = read_and_segment(path, options, table, segment_options, stage)
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
            best=best,
            root_motion=root_motion,
            straight=straight,
            mirror=mirror,
            close=close,
        )
        if not quiet:
            loop_table = loop and folder.is_dir()
            where = "; manifest.csv tells how good each loop is (cost, less is better)" * loop_table
            typer.echo(f"{format_count(len(clips), 'clip')} in {folder}{where}")

    for path, folder in zip(batch.paths, folders, strict=True):
        batch.each_person(path, read_options, work, folder, tables=("--segments", segments))
    batch.exit()
