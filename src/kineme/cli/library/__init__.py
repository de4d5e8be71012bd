"""``kineme library``: collections of recordings, built once, searched and asked."""

from __future__ import annotations

import typer

from kineme.cli.on_demand import on_demand

COMMANDS = ("build", "show", "search", "name", "merge", "split", "query", "export")
"""Each the function of its name in the module of its name, in the order of the help."""

library = typer.Typer(
    name="library",
    cls=on_demand("kineme.cli.library", COMMANDS),
    help="Collections of recordings: segmented once, searched by example.",
    no_args_is_help=True,
    add_completion=False,
    pretty_exceptions_enable=False,
    rich_markup_mode="rich",
)


@library.callback()
def _library() -> None:
    pass
