"""``kineme synthesize``: a motion graph in, a new motion out."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from kineme.cli.messages import Failures, progress
from kineme.cli.reading import Quiet


def synthesize(
    graph: Annotated[Path, typer.Argument(metavar="GRAPH", help="Made by kineme graph.")],
    output: Annotated[Path, typer.Option("--output", "-o", help="The motion: a .bvh file.")],
    actions: Annotated[
        str | None,
        typer.Option(
            metavar="NAME*COUNT,…",
            help="Labels or cluster numbers in order, as in walk,run*3,jump.",
        ),
    ] = None,
    duration: Annotated[
        float | None, typer.Option(help="Seconds of a random walk, in place of actions.")
    ] = None,
    seed: Annotated[int, typer.Option(min=0, help="Of the random walk.")] = 0,
    quiet: Quiet = False,
) -> None:
    """Play primitives one after the other: given actions, or a random walk."""
    if (actions is None) == (duration is None):
        raise typer.BadParameter("give either --actions or --duration")
    failures = Failures()
    with failures.caught(graph), progress(output.name, quiet=quiet) as stage:
        stage("reading")
        from kineme import synthesis
        from kineme.formats import write

        made = synthesis.read_graph(graph)
        if actions is not None:
            route = synthesis.action_route(made, synthesis.parse_actions(actions))
        else:
            route = synthesis.random_route(made, duration or 0, seed)
        motions = synthesis.load_sources(made)
        stage("blending")
        motion = synthesis.synthesize(made, motions, route)
        write(motion, output)
        if not quiet:
            typer.echo(f"{motion.duration:.2f} s, {motion.provenance.notes[0]}: {output}")
    failures.exit()
