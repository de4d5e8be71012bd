"""Groups of commands, each imported when it is asked for: a start is as short as can be."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from functools import cache
from importlib import import_module
from typing import TYPE_CHECKING, Any

import typer
from typer.core import TyperGroup

from kineme.cli.help import Command

if TYPE_CHECKING:
    from typer import _click


def on_demand(package: str, names: Sequence[str]) -> type[TyperGroup]:
    """A group of the commands in a package, each the function of its name in a module of its name.

    Parameters
    ----------
    package : str
    names : sequence of str
        In the order of the help.
    """

    class Commands(TyperGroup):
        def __init__(self, **attributes: Any) -> None:
            super().__init__(**{**attributes, "commands": _OnDemand(package, names)})

    return Commands


class _OnDemand(Mapping[str, "_click.Command"]):
    """The commands by name."""

    def __init__(self, package: str, names: Sequence[str]):
        self._package = package
        self._names = tuple(names)

    def __getitem__(self, name: str) -> _click.Command:
        if name not in self._names:
            raise KeyError(name)
        return _command(self._package, name)

    def __iter__(self) -> Iterator[str]:
        return iter(self._names)

    def __len__(self) -> int:
        return len(self._names)


@cache
def _command(package: str, name: str) -> _click.Command:
    """A command, or a group of them."""
    found = getattr(import_module(f"{package}.{name}"), name)
    if isinstance(found, typer.Typer):
        return typer.main.get_command(found)
    alone = typer.Typer(
        add_completion=False, pretty_exceptions_enable=False, rich_markup_mode="rich"
    )
    alone.command(name, cls=Command)(found)
    return typer.main.get_command(alone)
