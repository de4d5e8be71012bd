"""Groups of commands, each imported when it is asked for: a start is as short as can be."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from functools import cache
from importlib import import_module
from typing import TYPE_CHECKING, Any

import typer
from typer.core import TyperGroup

from kineme.cli.help import Command, Commands

if TYPE_CHECKING:
    from typer import _click


def on_demand(homes: Mapping[str, str]) -> type[TyperGroup]:
    """A group of commands in the order of the help, each the function of its name in a module."""

    class OnDemand(Commands):
        def __init__(self, **attributes: Any) -> None:
            super().__init__(**{**attributes, "commands": _Homes(homes)})

    return OnDemand


class _Homes(Mapping[str, "_click.Command"]):
    """The commands by name."""

    def __init__(self, homes: Mapping[str, str]):
        self._homes = dict(homes)

    def __getitem__(self, name: str) -> _click.Command:
        return _command(self._homes[name], name)

    def __iter__(self) -> Iterator[str]:
        return iter(self._homes)

    def __len__(self) -> int:
        return len(self._homes)


@cache
def _command(module: str, name: str) -> _click.Command:
    """A command, or a group of them."""
    found = getattr(import_module(module), name)
    if isinstance(found, typer.Typer):
        return typer.main.get_command(found)
    alone = typer.Typer(add_completion=False, pretty_exceptions_enable=False, rich_markup_mode=None)
    alone.command(name, cls=Command)(found)
    return typer.main.get_command(alone)
