"""``kineme library``: collections of recordings, built once, searched and asked."""

from __future__ import annotations

import typer

from kineme.cli.help import Command
from kineme.cli.library.answers import export, query
from kineme.cli.library.build import build
from kineme.cli.library.edit import merge, name, split
from kineme.cli.library.search import search
from kineme.cli.library.show import show
from kineme.cli.preset_options import with_preset_options
from kineme.cli.reading import with_reading_options

library = typer.Typer(
    help="Collections of recordings: segmented once, searched by example.", no_args_is_help=True
)
library.command(cls=Command)(with_preset_options(with_reading_options(build)))
for command in (show, search, name, merge, split, query, export):
    library.command(cls=Command)(command)

__all__ = ["library"]
