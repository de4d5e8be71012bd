"""The application: its commands, and the options of ``kineme`` itself."""

from __future__ import annotations

from typing import Annotated

import typer

from kineme._version import __version__
from kineme.cli.convert import convert
from kineme.cli.data import data
from kineme.cli.demo import demo
from kineme.cli.evaluate import evaluate
from kineme.cli.graph import graph
from kineme.cli.help import Command
from kineme.cli.info import info
from kineme.cli.label import label
from kineme.cli.library import library
from kineme.cli.preset_options import with_preset_options
from kineme.cli.reading import BODY, with_reading_options
from kineme.cli.report import report
from kineme.cli.segment import segment
from kineme.cli.split import split
from kineme.cli.studio import studio
from kineme.cli.synthesize import synthesize
from kineme.cli.transfer import transfer

app = typer.Typer(
    name="kineme",
    help="Cut recordings of human motion into activities, transitions and repeated primitives.",
    no_args_is_help=True,
    pretty_exceptions_enable=False,
    rich_markup_mode="rich",
)
app.command(cls=Command)(with_preset_options(with_reading_options(segment)))
app.command(cls=Command)(with_preset_options(with_reading_options(split)))
app.command(cls=Command)(with_preset_options(with_reading_options(report)))
app.command(cls=Command)(with_reading_options(convert))
app.command(cls=Command)(with_reading_options(info))
app.command(cls=Command)(demo)
app.command(cls=Command)(evaluate)
app.command(cls=Command)(data)
app.command(cls=Command)(with_reading_options(label, BODY))
app.command(cls=Command)(with_reading_options(transfer, BODY))
app.add_typer(library, name="library")
app.command(cls=Command)(with_reading_options(graph, BODY))
app.command(cls=Command)(synthesize)
app.command(cls=Command)(with_reading_options(studio, BODY))


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
