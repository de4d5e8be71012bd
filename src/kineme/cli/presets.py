"""``kineme presets``: what ``--preset`` can name, and what ``--set`` can change."""

from __future__ import annotations

import shutil
import textwrap
from dataclasses import MISSING
from typing import TYPE_CHECKING, Annotated

import typer

from kineme.cli.options.method import format_value
from kineme.errors import ParameterError
from kineme.methods.presets import DEFAULT, PRESETS, resolve_preset

if TYPE_CHECKING:
    from collections.abc import Sequence

    from kineme.methods import Constant

MOST = 20
"""Characters of a column, beyond which only its own row is moved to the right."""
BELOW = " " * 6


def presets(
    name: Annotated[
        str | None, typer.Argument(help="A preset, to list its constants.", show_default=False)
    ] = None,
) -> None:
    """List the presets, or the constants of one.

    A preset is a method with a value for each of its constants. `kineme segment --preset NAME`
    takes another, `--set NAME=VALUE` changes a constant. To a file or pipe, constants are written
    one on each line, with tabs.
    """
    if name is None:
        width = max(map(len, PRESETS))
        for preset in PRESETS.values():
            remark = " (default)" if preset.name == DEFAULT else ""
            typer.echo(f"{preset.name:<{width}}  {preset.help}{remark}")
        return
    try:
        chosen = resolve_preset(name)
    except ParameterError as error:
        raise typer.BadParameter(str(error), param_hint="NAME") from error
    constants = sorted(chosen.constants(), key=lambda each: each.fine)
    if not typer.get_text_stream("stdout").isatty():
        _write_rows(constants)
        return
    typer.echo(f"{chosen.name}: {chosen.help}")
    if chosen.unit != "any":
        typer.echo(f"Lengths are in {chosen.unit}.")
    fine = [each for each in constants if each.fine]
    _show("Constants", constants[: len(constants) - len(fine)])
    if fine:
        _show("Finer constants, which hardly anybody needs to change", fine)


def _write_rows(constants: Sequence[Constant]) -> None:
    """A line for each constant, with tabs between the cells."""
    typer.echo("constant\tvalue\tunit\trange\tdefault\tfine\tmeaning")
    for each in constants:
        cells = format_value(each.value), each.unit, each.allowed, _format_default(each)
        typer.echo("\t".join((each.name, *cells, "fine" if each.fine else "", each.help)))


def _show(title: str, constants: Sequence[Constant]) -> None:
    """Two lines for each constant: what it is and may be, and below it what it means."""
    rows = [
        (
            each.name,
            f"{format_value(each.value)} {each.unit}",
            each.allowed,
            "" if each.value == each.default else _format_default(each),
        )
        for each in constants
    ]
    head = ("constant", "value", "may be", "otherwise")
    widths = [min(max(map(len, column)), MOST) for column in zip(head, *rows, strict=True)]

    def line(cells: Sequence[str]) -> str:
        pairs = zip(cells, widths, strict=True)
        return "  ".join(f"{cell:<{width}}" for cell, width in pairs).rstrip()

    typer.secho(f"\n{title}:", bold=True)
    typer.echo(f"  {line(head)}")
    edge = shutil.get_terminal_size().columns
    for row, each in zip(rows, constants, strict=True):
        typer.secho(f"  {line(row)}", bold=True)
        typer.echo(textwrap.fill(each.help, edge, initial_indent=BELOW, subsequent_indent=BELOW))


def _format_default(constant: Constant) -> str:
    """Return what the method has where a preset says nothing; empty where each preset has to."""
    return "" if constant.default is MISSING else format_value(constant.default)
