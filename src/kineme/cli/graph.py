"""``kineme graph``: build a motion graph from recordings."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from kineme._util.checks import format_count
from kineme.cli.files import (
    Batch,
    Files,
    Recursive,
    SegmentTable,
    check_target_folder,
    check_writable,
)
from kineme.cli.help import METHOD, OUTPUT, option
from kineme.cli.options import BODY, SEGMENTING, Quiet, add_options
from kineme.cli.segment import load_or_find_segments
from kineme.cli.terminal import Failures, show_progress
from kineme.formats import read_motion
from kineme.formats.options import ReadOptions
from kineme.methods.segmenter import SegmentOptions

if TYPE_CHECKING:
    from kineme.recordings import Motion
    from kineme.segments.segmentation import Segmentation
    from kineme.synthesis import MotionGraph


@add_options(BODY | SEGMENTING)
def graph(
    files: Files,
    read_options: ReadOptions,
    segment_options: SegmentOptions,
    output: Annotated[Path, option(OUTPUT, "The motion graph: a .json file.", "--output", "-o")],
    segments: SegmentTable = None,
    plot: Annotated[Path | None, option(OUTPUT, "Draw the graph: .png, .pdf or .svg.")] = None,
    threshold: Annotated[
        float,
        option(
            METHOD,
            "Largest mean distance of joints, in metres, at which one primitive may follow "
            "another.",
        ),
    ] = 0.08,
    window: Annotated[
        float,
        option(
            METHOD, "Seconds that are compared and blended at a transition.", show_default="0.33"
        ),
    ] = 1 / 3,
    keep_dead_ends: Annotated[
        bool,
        option(
            METHOD,
            "Keep primitives that lead to a dead end.",
            "--keep-dead-ends",
        ),
    ] = False,
    recursive: Recursive = False,
    quiet: Quiet = False,
) -> None:
    """Find primitives that can follow each other.

    Primitives are single movements, such as a step or a jump. The output is a motion graph, from
    which `kineme synthesize` makes new motion.
    """
    batch = Batch(files, recursive=recursive, quiet=quiet)
    tables = batch.tables("--segments", segments, read_options.person or "")
    failures = Failures()
    with failures.catch_errors(output):
        check_target_folder(output)
        check_writable(output, plot)
    failures.exit()
    motions: list[Motion] = []
    segmentations: list[Segmentation] = []
    for path, table in zip(batch.paths, tables, strict=True):
        with batch.catch_errors(path), batch.progress(path) as stage:
            from kineme.synthesis import check_source

            stage("reading")
            motion = read_motion(path, **vars(read_options))
            check_source(motion, (motions or [motion])[0])
            stage("segments")
            segmentations.append(load_or_find_segments(motion, table, segment_options, stage))
            motions.append(motion)
    if not motions:
        batch.exit()
    with failures.catch_errors(output), show_progress(output.name, quiet=quiet) as stage:
        from kineme.synthesis import motion_graph, write_graph

        stage("jumps")
        result = motion_graph(
            motions, segmentations, threshold=threshold, window=window, prune=not keep_dead_ends
        )
        sources = tuple(replace(source, options=read_options) for source in result.sources)
        result = replace(result, sources=sources)
        write_graph(result, output)
        if plot is not None:
            from kineme.plot.graph import plot_graph

            plot_graph(result, plot)
        if not quiet:
            _show(result)
    batch.exit()
    failures.exit()


def _show(graph: MotionGraph) -> None:
    """Print a line per super-node: its nodes, and the names that can follow."""
    from kineme.synthesis import find_following

    for name, count in graph.names.items():
        onward = ", ".join(find_following(graph, name)) or "nothing"
        typer.echo(f"{name}: {format_count(count, 'primitive')}, then {onward}")
    jumps = sum(edge.jump for edge in graph.edges)
    typer.echo(
        f"{format_count(len(graph.nodes), 'node')}, {format_count(len(graph.edges), 'edge')}, "
        f"{format_count(jumps, 'jump')} among them."
    )
