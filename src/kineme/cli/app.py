"""The application: its commands, and the options of ``kineme`` itself."""

from __future__ import annotations

from typing import Annotated

import typer

from kineme._version import __version__
from kineme.cli.help import make_lazy_group

# fmt: off
COMMANDS = (
    "segment", "live", "pose", "presets", "cycles", "events", "split", "report", "studio",
    "convert", "info", "demo", "evaluate", "label", "transfer", "library", "graph", "synthesize",
)
# fmt: on
"""Commands in the order of the help; each is a function in the module of its name."""
OTHER_MODULES = {"demo": "segment", "label": "transfer", "synthesize": "graph"}
"""Modules of commands that share one."""

app = typer.Typer(
    name="kineme",
    cls=make_lazy_group({name: f"kineme.cli.{OTHER_MODULES.get(name, name)}" for name in COMMANDS}),
    help="Cut recordings of human motion into activities, transitions and repeated primitives.\n\n"
    "Begin with `kineme demo`, then `kineme segment FILE` on your own.",
    no_args_is_help=True,
    pretty_exceptions_enable=False,
    rich_markup_mode=None,
)


def _show_version(requested: bool) -> None:
    if requested:
        typer.echo(f"kineme {__version__}")
        raise typer.Exit


@app.callback()
def _kineme(
    version: Annotated[
        bool,
        typer.Option("--version", callback=_show_version, is_eager=True, help="Print the version."),
    ] = False,
) -> None:
    pass
