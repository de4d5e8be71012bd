"""``kineme split``: write each segment of recordings as a clip."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Annotated, Any

import typer

from kineme._util.checks import format_count
from kineme.cli.files import Batch, Files, Recursive, SegmentTable, make_parent_folder
from kineme.cli.help import OUTPUT, option, output_option
from kineme.cli.options import (
    ALL,
    CLIPS,
    READING,
    SEGMENTING,
    Quiet,
    add_options,
    expand_read_options,
)
from kineme.cli.segment import read_and_segment
from kineme.formats.options import ReadOptions
from kineme.formats.registry import find_writer
from kineme.methods.segmenter import SegmentOptions
from kineme.recordings import Motion, Signals
from kineme.segments.segmentation import Segmentation
from kineme.segments.table import Level


@add_options(READING | SEGMENTING | CLIPS)
def split(
    files: Files,
    read_options: ReadOptions,
    segment_options: SegmentOptions,
    clip_options: dict[str, Any],
    output: Annotated[
        Path,
        output_option(
            "Folder for the clips, or one .glb or .fbx; {name} if there are several recordings."
        ),
    ],
    level: Annotated[
        Level,
        option(OUTPUT, "Level to split at: activity or primitive.", metavar="LEVEL"),
    ] = "activity",
    cluster: Annotated[int | None, option(OUTPUT, "Write this cluster only.")] = None,
    loop: Annotated[
        bool, option(OUTPUT, "Blend the ends so that each clip loops.", "--loop")
    ] = False,
    best: Annotated[
        int | None, option(OUTPUT, "Number of loops per cluster.", metavar="NUMBER")
    ] = None,
    straight: Annotated[
        bool, option(OUTPUT, "Remove the turn of each clip.", "--straight")
    ] = False,
    mirror: Annotated[bool, option(OUTPUT, "Exchange left and right.", "--mirror")] = False,
    segments: SegmentTable = None,
    recursive: Recursive = False,
    quiet: Quiet = False,
) -> None:
    """Write each segment as a file of its own.

    The clips keep the skeleton of the recording. A table lists them.
    """
    _check_output(output)
    batch = Batch(files, recursive=recursive, quiet=quiet)
    folders = batch.folders("--output", output)
    batch.tables("--segments", segments)  # fail early if there are none

    def work(path: Path, options: ReadOptions, table: Path | None, folder: Path) -> None:
        write([find(path, options, table)], folder)

    def find(
        path: Path, options: ReadOptions, table: Path | None
    ) -> tuple[Motion | Signals, Segmentation]:
        with batch.progress(path) as stage:
            return read_and_segment(path, options, table, segment_options, stage)

    def write(found: Sequence[tuple[Motion | Signals, Segmentation]], folder: Path) -> None:
        from kineme.clips.split import split_all

        if not batch.single:
            make_parent_folder(folder)
        clips = split_all(
            found,
            folder,
            level=level,
            cluster=cluster,
            loops=loop,
            best=best,
            straight=straight,
            mirror=mirror,
            **clip_options,
        )
        if not quiet:
            loop_table = loop and folder.is_dir()
            where = "; manifest.csv lists the cost of each loop (lower is better)" * loop_table
            typer.echo(f"{format_count(len(clips), 'clip')} in {folder}{where}")

    for name in ("sheet", "motion_matching"):
        if clip_options[name] is not None and len(batch.paths) > 1:
            hint = f"--{name.replace('_', '-')}"
            raise typer.BadParameter("takes one recording only", param_hint=hint)
    for path, folder in zip(batch.paths, folders, strict=True):
        if read_options.take == ALL and folder.suffix and not folder.is_dir():
            # All takes of a file become animations of one output file.
            with batch.catch_errors(path):
                tables = ("--segments", segments)
                write(
                    [
                        find(path, options, batch.table(path, *tables, options.take or ""))
                        for _, options in expand_read_options(path, read_options)
                    ],
                    folder,
                )
            continue
        batch.run_each_person(path, read_options, work, folder, tables=("--segments", segments))
    batch.exit()


def _check_output(output: Path) -> None:
    """Raise BadParameter for a new file of a format that holds one motion only."""
    suffix = output.suffix.lower()
    writer = find_writer(suffix) if suffix and not output.is_dir() else None
    if writer is not None and writer.write_animations is None:
        raise typer.BadParameter(
            f"a {suffix} holds one clip: name a folder, and give --format {suffix[1:]}",
            param_hint="--output",
        )
