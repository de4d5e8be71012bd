"""Motion graphs: ``kineme graph`` builds one, ``kineme synthesize`` makes new motion from it."""

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
    check_suffix,
    check_target_folder,
    check_writable,
)
from kineme.cli.help import METHOD, OUTPUT, option, output_option
from kineme.cli.options import BODY, SEGMENTING, Quiet, add_options
from kineme.cli.segment import load_or_find_segments
from kineme.cli.terminal import exit_on_error, show_progress
from kineme.errors import ParameterError
from kineme.formats import read_motion
from kineme.formats.options import ReadOptions
from kineme.formats.registry import list_motion_suffixes
from kineme.methods.segmenter import SegmentOptions

if TYPE_CHECKING:
    from kineme.recordings import Motion
    from kineme.segments.segmentation import Segmentation
    from kineme.synthesis import MotionGraph

CONTENT = "New motion"


@add_options(BODY | SEGMENTING)
def graph(
    files: Files,
    read_options: ReadOptions,
    segment_options: SegmentOptions,
    output: Annotated[Path, output_option("The motion graph: a .json file.")],
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
        bool, option(METHOD, "Keep primitives that lead to a dead end.", "--keep-dead-ends")
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
    check_suffix("--output", output, (".json",))
    with exit_on_error(output):
        check_target_folder(output)
        check_writable(output, plot)
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
    with batch.catch_result_errors(output), show_progress(output.name, quiet=quiet) as stage:
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


def synthesize(
    graph: Annotated[
        Path, typer.Argument(metavar="GRAPH", help="Motion graph that `kineme graph` made.")
    ],
    output: Annotated[Path, output_option("The new motion: a .bvh file.")],
    actions: Annotated[
        str | None,
        option(
            CONTENT,
            "Labels or cluster numbers in order, as in walk,run*3,jump; with --path, the "
            "allowed ones without counts.",
            metavar="NAME*COUNT,…",
        ),
    ] = None,
    path: Annotated[
        str | None,
        option(
            CONTENT,
            "Line on the floor to follow, as x,z in metres, such as 0,0;3,0;3,3.",
            metavar="X,Z;X,Z;…",
        ),
    ] = None,
    tolerance: Annotated[
        float, option(CONTENT, "Largest distance from that line in metres.")
    ] = 0.5,
    duration: Annotated[
        float | None,
        option(CONTENT, "Seconds of motion from randomly drawn primitives, instead of actions."),
    ] = None,
    seed: Annotated[int, option(CONTENT, "Seed of the random draw.", min=0)] = 0,
    quiet: Quiet = False,
) -> None:
    """Make new motion from a motion graph.

    The actions are named, follow a line on the floor, or are drawn at random.
    """
    if (actions is None and path is None) == (duration is None):
        raise typer.BadParameter("give --actions, --path or both, or --duration")
    check_suffix("--output", output, list_motion_suffixes())
    with exit_on_error(graph), show_progress(output.name, quiet=quiet) as stage:
        stage("reading")
        from kineme import synthesis
        from kineme.formats import write

        motion_graph = synthesis.read_graph(graph)
        motions = synthesis.load_sources(motion_graph)
        stage("searching")
        start = None
        named = synthesis.parse_actions(actions) if actions is not None else []
        if path is not None:
            route, start = synthesis.line_route(
                motion_graph,
                motions,
                synthesis.parse_line(path),
                actions=_drop_counts(named),
                tolerance=tolerance,
            )
        elif named:
            route = synthesis.action_route(motion_graph, named)
        else:
            route = synthesis.random_route(motion_graph, duration or 0, seed)
        stage("blending")
        motion = synthesis.synthesize(motion_graph, motions, route, start=start)
        write(motion, output)
        if not quiet:
            typer.echo(f"{motion.duration:.2f} s, {motion.provenance.notes[0]}: {output}")


def _drop_counts(actions: list[tuple[str, int]]) -> list[str]:
    for name, count in actions:
        if count > 1:
            raise ParameterError(
                f"{name}*{count}: with --path the line sets the length, so give {name} "
                "without a count"
            )
    return [name for name, _ in actions]
