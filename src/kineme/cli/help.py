"""Load commands on demand, and insert registered names into their help.

The names of formats and presets replace placeholders only when the help is shown, since importing
the registries is slow.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from functools import cache
from importlib import import_module
from itertools import zip_longest
from typing import TYPE_CHECKING, Any

import typer
from typer.core import TyperCommand, TyperGroup

if TYPE_CHECKING:
    from typer import _click
    from typer._click import Context, HelpFormatter

RECORDINGS = "@recordings@"
"""Placeholder for the names of recording formats."""
LABELS = "@labels@"
"""Placeholder for the names of label formats."""
TABLES = "@tables@"
"""Placeholder for the suffixes of tables that can be written."""
PRESETS = "@presets@"
"""Placeholder for the names of the presets, the default one first."""

INPUT, READING_OPTIONS, METHOD, OUTPUT = "Input", "Reading options", "Method", "Output"
"""Titles of the groups of options that several commands share."""


def option(group: str, text: str, *names: str, **more: Any) -> Any:
    """Return an option in a group of the help; its name is that of the parameter by default."""
    return typer.Option(*names, help=text, rich_help_panel=group, **more)


def output_option(text: str, **more: Any) -> Any:
    """Return the option ``--output`` or ``-o``."""
    return option(OUTPUT, text, "--output", "-o", **more)


class Command(TyperCommand):
    """A command that explains --set and fills registered names into its help."""

    def parse_args(self, ctx: Context, args: list[str]) -> list[str]:
        """Parse the arguments; point to --set if a constant was given as an option."""
        if any(parameter.name == "constants" for parameter in self.params):
            self._check_constants(ctx, args)
        try:
            return super().parse_args(ctx, args)
        except typer.BadParameter as error:
            error.message = error.message.removeprefix("Value error, ")  # a prefix of typer
            raise

    def _check_constants(self, ctx: Context, args: Sequence[str]) -> None:
        """Fail with a hint at ``--set`` if a constant was given as an option."""
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

    def format_help(self, ctx: Context, formatter: HelpFormatter) -> None:
        """Show the help, with the registered names in place of their placeholders."""
        for parameter in self.params:
            parameter.help = _fill_names(parameter.help or "")  # type: ignore[attr-defined]
        super().format_help(ctx, formatter)


def make_lazy_group(modules: Mapping[str, str]) -> type[TyperGroup]:
    """Return a class of command groups that import each command when it is called."""

    class OnDemand(TyperGroup):
        def __init__(self, **attributes: Any) -> None:
            super().__init__(**{**attributes, "commands": _LazyCommands(modules)})

    return OnDemand


class _LazyCommands(Mapping[str, "_click.Command"]):
    """Commands by name, imported on access."""

    def __init__(self, modules: Mapping[str, str]):
        self._modules = dict(modules)

    def __getitem__(self, name: str) -> _click.Command:
        return _load_command(self._modules[name], name)

    def __iter__(self) -> Iterator[str]:
        return iter(self._modules)

    def __len__(self) -> int:
        return len(self._modules)


@cache
def _load_command(module: str, name: str) -> _click.Command:
    """Import a command or a group of commands."""
    command = getattr(import_module(module), name)
    if isinstance(command, typer.Typer):
        return typer.main.get_command(command)
    app = typer.Typer(
        add_completion=False, pretty_exceptions_enable=False, rich_markup_mode="markdown"
    )
    app.command(name, cls=Command)(command)
    return typer.main.get_command(app)


def _fill_names(text: str) -> str:
    """Replace placeholders in a help text by the registered names."""
    if "@" not in text:
        return text
    from kineme.formats import supported_formats
    from kineme.labels import label_formats, list_written_suffixes
    from kineme.methods import PRESETS as ALL_PRESETS

    default, *others = ALL_PRESETS
    recordings = [each.name for each in supported_formats() if each.read is not None]
    names = {
        RECORDINGS: reversed(recordings),  # the oldest first
        LABELS: label_formats(),
        TABLES: list_written_suffixes(),
        PRESETS: (f"{default} (default)", *others),
    }
    for mark, entries in names.items():
        text = text.replace(mark, ", ".join(entries))
    return text
