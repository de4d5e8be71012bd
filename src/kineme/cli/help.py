"""Commands and their help, which fits on a page: options in named groups, in two columns.

Where a help text names the registered formats or presets, these are filled in only when
it is shown: they are many modules, and other packages may add theirs, so that importing them
takes time that a command which needs none of them does not have.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from functools import cache
from importlib import import_module
from itertools import zip_longest
from typing import TYPE_CHECKING, Any

import typer
from typer.core import TyperCommand, TyperGroup

if TYPE_CHECKING:
    from typer import _click
    from typer._click import Context, HelpFormatter, Parameter

RECORDINGS = "@recordings@"
"""Stands in a help text for the names of the formats of recordings."""
LABELS = "@labels@"
"""Stands for those of the formats of labels."""
TABLES = "@tables@"
"""Stands for the suffixes by which these are written."""
PRESETS = "@presets@"
"""Stands for the names of the presets, the default one first."""

INPUT, UNSAID, METHOD, OUTPUT = "Input", "What the file does not say", "Method", "Output"
_ARGUMENTS, _OTHER = "Arguments", "Other"
_FIRST, _LAST = (_ARGUMENTS, INPUT), (METHOD, OUTPUT, UNSAID, _OTHER)
"""Groups before and after those that only some command has."""
_COLUMN = 26
"""Characters of the column of names; a longer name has a line of its own."""
_TYPES = {"path": "PATH", "int": "N", "int range": "N", "float": "NUMBER", "str": "TEXT"}


def option(group: str, text: str, *names: str, **more: Any) -> Any:
    """An option in a group of the help; called as its parameter is, unless names are given."""
    return typer.Option(*names, help=text, rich_help_panel=group, **more)


class Command(TyperCommand):
    """A command whose options stand in groups."""

    def parse_args(self, ctx: Context, args: list[str]) -> list[str]:
        """What the command is given; a constant as an option of its own is told how it is set."""
        if any(parameter.name == "constants" for parameter in self.params):
            self._check_constants(ctx, args)
        try:
            return super().parse_args(ctx, args)
        except typer.BadParameter as error:
            error.message = error.message.removeprefix("Value error, ")  # what says so is in it
            raise

    def _check_constants(self, ctx: Context, args: Sequence[str]) -> None:
        flags = {name for each in self.get_params(ctx) for name in each.opts + each.secondary_opts}
        for arg, following in zip_longest(args, args[1:], fillvalue=""):
            flag, equals, value = arg.partition("=")
            if not flag.startswith("--") or flag in flags:
                continue
            from kineme.methods import PRESETS as ALL_PRESETS

            name = flag[2:].replace("-", "_")
            if any(name in preset.parameters() for preset in ALL_PRESETS.values()):
                value = value if equals else following
                ctx.fail(f"No such option: {flag}; use --set {name}={value or 'VALUE'}")

    def collect_usage_pieces(self, ctx: Context) -> list[str]:
        """The options, then the arguments by the names that the help gives them."""
        arguments = [each for each in self.get_params(ctx) if _is_argument(each)]
        return ["[OPTIONS]", *map(_usage, arguments)]

    def format_options(self, ctx: Context, formatter: HelpFormatter) -> None:
        """Write the groups of options."""
        _write_groups(self.get_params(ctx), ctx, formatter)


class Commands(TyperGroup):
    """Several commands, each with its first sentence."""

    def format_options(self, ctx: Context, formatter: HelpFormatter) -> None:
        """Write the commands, then the options of all of them."""
        named = ((name, self.get_command(ctx, name)) for name in self.list_commands(ctx))
        lines = [(name, _first_sentence(one.help or "")) for name, one in named if one]
        with formatter.section("Commands"):
            formatter.write_dl(lines)
        _write_groups(self.get_params(ctx), ctx, formatter)


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


def _write_groups(parameters: Sequence[Parameter], ctx: Context, formatter: HelpFormatter) -> None:
    groups: dict[str, list[tuple[str, str]]] = {}
    for each in parameters:
        record = each.get_help_record(ctx)
        if record is None:  # a hidden one
            continue
        name, text = record
        group = getattr(each, "rich_help_panel", None) or _OTHER
        if _is_argument(each):
            group, name = _ARGUMENTS, _name(each)
            text = text.removesuffix("  [required]").replace("; required]", "]")
        groups.setdefault(group, []).append((_typed(name), _filled(text)))
    order = [*_FIRST, *(name for name in groups if name not in _FIRST + _LAST), *_LAST]
    for group in filter(groups.get, order):
        with formatter.section(group):
            formatter.write_dl(groups[group], col_max=_COLUMN)


def _is_argument(parameter: Parameter) -> bool:
    return parameter.param_type_name == "argument"


def _name(argument: Parameter) -> str:
    return argument.metavar or (argument.name or "").upper()


def _usage(argument: Parameter) -> str:
    """An argument in the line of usage: ``FILES...``, ``[NAME]``."""
    name = _name(argument) + "..." * (argument.nargs != 1 and "…" not in _name(argument))
    return name if argument.required or name.startswith("[") else f"[{name}]"


def _typed(name: str) -> str:
    """The name of an option with its value as people write it: ``PATH`` for ``<path>``."""
    plain = re.sub(r"<list\[(\w+)\]>", r"<\1>", name)
    return re.sub(r"<([^>]*)>", lambda found: _TYPES.get(found[1].lower(), found[1]), plain)


def _first_sentence(text: str) -> str:
    return " ".join(text.split("\n\n", 1)[0].split())


def _filled(text: str) -> str:
    """A help text with names in place of what stands for them, and limits in words."""
    text = re.sub(r"x>=(\d+)", r"at least \1", text)
    text = re.sub(r"default: \(([^)]*)\)", r"default: \1", text)
    if "@" not in text:
        return text
    from kineme.formats import supported_formats
    from kineme.labels import label_formats, written_suffixes
    from kineme.methods import PRESETS as ALL_PRESETS

    default, *others = ALL_PRESETS
    recordings = [each.name for each in supported_formats() if each.read is not None]
    names = {
        RECORDINGS: reversed(recordings),  # the oldest first
        LABELS: label_formats(),
        TABLES: written_suffixes(),
        PRESETS: (f"{default} (default)", *others),
    }
    for mark, entries in names.items():
        text = text.replace(mark, ", ".join(entries))
    return text
