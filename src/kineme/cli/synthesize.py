"""``kineme synthesize``: make new motion from a motion graph."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from kineme.cli.help import OUTPUT, option
from kineme.cli.options import Quiet
from kineme.cli.terminal import Failures, show_progress
from kineme.errors import ParameterError

CONTENT = "New motion"


def synthesize(
    graph: Annotated[
        Path, typer.Argument(metavar="GRAPH", help="Motion graph that `kineme graph` made.")
    ],
    output: Annotated[Path, option(OUTPUT, "The new motion: a .bvh file.", "--output", "-o")],
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
        option(
            CONTENT,
            "Seconds of motion from randomly drawn primitives, instead of actions.",
        ),
    ] = None,
    seed: Annotated[int, option(CONTENT, "Seed of the random draw.", min=0)] = 0,
    quiet: Quiet = False,
) -> None:
    """Make new motion from a motion graph.

    The actions are named, follow a line on the floor, or are drawn at random.
    """
    if (actions is None and path is None) == (duration is None):
        raise typer.BadParameter("give --actions, --path or both, or --duration")
    failures = Failures()
    with failures.catch_errors(graph), show_progress(output.name, quiet=quiet) as stage:
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
    failures.exit()


def _drop_counts(actions: list[tuple[str, int]]) -> list[str]:
    for name, count in actions:
        if count > 1:
            raise ParameterError(
                f"{name}*{count}: with --path the line sets the length, so give {name} "
                "without a count"
            )
    return [name for name, _ in actions]
