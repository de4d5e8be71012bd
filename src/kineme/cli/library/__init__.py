"""``kineme library``: build collections of recordings, and search them."""

from __future__ import annotations

import typer

from kineme.cli.help import make_lazy_group

MODULES = {
    "build": "kineme.cli.library.build",
    "show": "kineme.cli.library.commands",
    "search": "kineme.cli.library.search",
    **dict.fromkeys(("name", "merge"), "kineme.cli.library.commands"),
    "split": "kineme.cli.library.commands",
    "coverage": "kineme.cli.library.commands",
    **dict.fromkeys(("query", "export"), "kineme.cli.library.commands"),
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
