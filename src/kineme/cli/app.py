"""The application: its commands, and the options of ``kineme`` itself."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from functools import cache
from importlib import import_module
from typing import TYPE_CHECKING, Annotated, Any

import typer
from typer.core import TyperGroup

from kineme._version import __version__
from kineme.cli.help import Command

if TYPE_CHECKING:
    from typer import _click

COMMANDS = (
    "segment",
    "split",
    "report",
    "convert",
    "info",
    "demo",
    "evaluate",
    "data",
    "label",
    "transfer",
    "graph",
    "synthesize",
    "studio",
)
"""Each the function of its name in the module of its name, in the order of the help."""


class _OnDemand(Mapping[str, "_click.Command"]):
    """The commands by name, each imported when it is asked for: a start is as short as can be."""

    def __getitem__(self, name: str) -> _click.Command:
        if name not in COMMANDS:
            raise KeyError(name)
        return _command(name)

    def __iter__(self) -> Iterator[str]:
        return iter(COMMANDS)

    def __len__(self) -> int:
        return len(COMMANDS)


class _Commands(TyperGroup):
    """The group of `COMMANDS`."""

    def __init__(self, **attributes: Any) -> None:
        super().__init__(**{**attributes, "commands": _OnDemand()})


@cache
def _command(name: str) -> _click.Command:
    alone = typer.Typer(
        add_completion=False, pretty_exceptions_enable=False, rich_markup_mode="rich"
    )
    alone.command(name, cls=Command)(getattr(import_module(f"kineme.cli.{name}"), name))
    return typer.main.get_command(alone)


app = typer.Typer(
    name="kineme",
    cls=_Commands,
    help="Cut recordings of human motion into activities, transitions and repeated primitives.",
    no_args_is_help=True,
    pretty_exceptions_enable=False,
    rich_markup_mode="rich",
)


def _show_version(wanted: bool) -> None:
    if wanted:
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
