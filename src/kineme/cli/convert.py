"""``kineme convert``: convert segments or recordings to another format."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from kineme._util.checks import format_count
from kineme.cli.files import Batch, Recursive, make_parent_folder
from kineme.cli.help import INPUT, LABELS, OUTPUT, option
from kineme.cli.options import READING, Quiet, add_options
from kineme.errors import ReadError, WriteError
from kineme.formats import read, write
from kineme.formats.channels.writing import write_signals
from kineme.formats.dialects import hold_channels, recognise_table
from kineme.formats.files import load
from kineme.formats.listing import holds_recording, refuse_labels
from kineme.formats.options import ReadOptions
from kineme.labels import label_formats, read_segments, write_segments
from kineme.labels.registry import find_write_format
from kineme.recordings import Motion
from kineme.segments.segmentation import Segmentation
from kineme.segments.table import Level


def _check_format(name: str | None) -> str | None:
    if name is None:
        return None
    if name not in label_formats():
        raise typer.BadParameter(f"{name!r} is not one of {', '.join(label_formats())}")
    return name


def _is_recording(path: Path) -> bool:
    """Return whether a file is a recording rather than labels, by its suffix and content."""
    suffix = path.suffix.lower()
    if suffix == ".txt":
        return _is_channel_table(path)
    return path.is_dir() or holds_recording(path) or suffix in (".asf", ".dat")


def _is_channel_table(path: Path) -> bool:
    """Return whether a text file is a table of channels; labels begin with a time instead."""
    try:
        refuse_labels(content := load(path))
        table, dialect = recognise_table(content)
    except ReadError:
        return False
    if dialect:
        return True
    table = table.number_columns()
    return (
        hold_channels(table.names) and table.names[0] != "1" and bool(table.find_numeric_columns())
    )


@add_options(READING)
def convert(
    files: Annotated[
        list[Path],
        typer.Argument(
            metavar="FROM… TO",
            help="Segment tables, label files, recordings or folders of recordings; then the "
            "new file to write, with {name} in it if there are several.",
        ),
    ],
    read_options: ReadOptions,
    from_format: Annotated[
        str | None,
        option(
            INPUT,
            f"Format of the labels to read, by default from the suffix: {LABELS}.",
            "--from",
            metavar="FORMAT",
            callback=_check_format,
        ),
    ] = None,
    to_format: Annotated[
        str | None,
        option(
            OUTPUT,
            "Format of the labels to write, by default from the suffix: one of the same.",
            "--to",
            metavar="FORMAT",
            callback=_check_format,
        ),
    ] = None,
    level: Annotated[
        Level | None,
        option(OUTPUT, "Level to write; by default every level that the format supports."),
    ] = None,
    frames: Annotated[
        int | None, option(INPUT, "Length of the recording in frames, if the labels end earlier.")
    ] = None,
    recursive: Recursive = False,
    quiet: Quiet = False,
) -> None:
    """Convert labels or recordings to another format.

    The suffixes select the formats: .bvh, .amc, .fbx, .glb, .usda, .trc, .csv and .npz hold
    recordings. Signals keep the columns of their file, or those in --columns. For labels with
    times in seconds only, --fps is the frame rate of their recording.
    """
    if len(files) < 2:
        raise typer.BadParameter(
            "give the files to read, then the file to write", param_hint="FROM… TO"
        )
    *sources, target = files

    batch = Batch(sources, recursive=recursive)
    several = not batch.single or "{" in target.name
    if several and "{" not in str(target):
        folder, suffix = target.with_suffix(""), target.suffix or ".bvh"
        raise typer.BadParameter(
            f"several inputs need {{name}} in the output, such as '{folder}/{{name}}{suffix}'",
            param_hint="TO",
        )
    targets = batch.files("TO", target) if several else [target]
    for path, target_path in zip(batch.paths, targets, strict=True):
        with batch.catch_errors(path):
            if target_path.exists():
                raise WriteError(target_path, "exists already: remove it or name another file")
            if several:
                make_parent_folder(target_path)
            is_table = read_options.columns is not None
            if from_format is None and (is_table or _is_recording(path)):
                _convert_recording(read_options, path, target_path)
            else:
                segments = read_segments(
                    path, format=from_format, fps=read_options.fps, n_frames=frames
                )
                write_segments(segments, target_path, format=to_format, level=level)
                if not quiet and level is None:
                    _note_missing_primitives(segments, target_path, to_format)
            if not quiet:
                typer.echo(f"{path} written as {target_path}")
    batch.exit()


def _note_missing_primitives(segments: Segmentation, path: Path, name: str | None) -> None:
    """Note on standard error that a file of one level lacks the primitives."""
    label_format, primitives = find_write_format(path, name), segments.primitives
    if len(primitives) and label_format.holds == "level":
        typer.echo(
            f"note: {path} holds the activities only, without the "
            f"{format_count(len(primitives), 'segment')} of level primitive; use --level "
            "primitive to write those",
            err=True,
        )


def _convert_recording(options: ReadOptions, path: Path, target: Path) -> None:
    recording = read(path, **vars(options))
    if isinstance(recording, Motion) or options.columns is None:
        write(recording, target)
    else:
        write_signals(recording, target, columns=recording.names)
