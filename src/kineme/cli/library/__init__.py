"""``kineme library``: build collections of recordings, and search them."""

from __future__ import annotations

import typer

from kineme.cli.help import make_lazy_group

COMMANDS = "show", "search", "name", "merge", "split", "coverage", "query", "export"
MODULES = {
    "build": "kineme.cli.library.build",
    **dict.fromkeys(COMMANDS, "kineme.cli.library.commands"),
    "search": "kineme.cli.library.search",
}
"""Module of each command, in the order of the help."""

library = typer.Typer(
    name="library",
    cls=make_lazy_group(MODULES),
    help="Build and search collections of recordings.",
    no_args_is_help=True,
    add_completion=False,
    pretty_exceptions_enable=False,
    rich_markup_mode=None,
)


@library.callback()
def _library() -> None:
    pass
