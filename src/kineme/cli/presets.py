"""``kineme presets``: list presets and their constants."""

from __future__ import annotations

import shutil
import textwrap
from collections.abc import Sequence
from dataclasses import MISSING
from typing import Annotated

import typer

from kineme.cli.options import format_value
from kineme.errors import ParameterError
from kineme.methods import Constant
from kineme.methods.presets import DEFAULT, PRESETS, resolve_preset

MAX_WIDTH = 20
"""Width of a column in characters; longer cells shift only their own row."""
INDENT = " " * 6


def presets(
    name: Annotated[
        str | None, typer.Argument(help="Preset whose constants to list.", show_default=False)
    ] = None,
) -> None:
    """List the presets, or the constants of one.

    A preset is a method with a value for each of its constants. `kineme segment --preset NAME`
    selects another preset, `--set NAME=VALUE` changes a constant. In a file or pipe, each constant
    is one line with tabs.
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
    constants = sorted(chosen.constants(), key=lambda constant: constant.fine)
    if not typer.get_text_stream("stdout").isatty():
        _write_rows(constants)
        return
    typer.echo(f"{chosen.name}: {chosen.help}")
    if chosen.unit != "any":
        typer.echo(f"Lengths are in {chosen.unit}.")
    fine = [constant for constant in constants if constant.fine]
    _show("Constants", constants[: len(constants) - len(fine)])
    if fine:
        _show("Fine constants, which rarely need to be changed", fine)


def _write_rows(constants: Sequence[Constant]) -> None:
    """Print one line per constant with tab-separated cells."""
    typer.echo("constant\tvalue\tunit\trange\tdefault\tfine\tmeaning")
    for constant in constants:
        cells = (
            format_value(constant.value),
            constant.unit,
            constant.allowed,
            _format_default(constant),
        )
        typer.echo(
            "\t".join((constant.name, *cells, "fine" if constant.fine else "", constant.help))
        )


def _show(title: str, constants: Sequence[Constant]) -> None:
    """Print two lines per constant: name, value, range and other default; then its meaning."""
    rows = [
        (
            constant.name,
            f"{format_value(constant.value)} {constant.unit}",
            constant.allowed,
            "" if constant.value == constant.default else _format_default(constant),
        )
        for constant in constants
    ]
    head = ("constant", "value", "may be", "default")
    widths = [min(max(map(len, column)), MAX_WIDTH) for column in zip(head, *rows, strict=True)]

    def line(cells: Sequence[str]) -> str:
        pairs = zip(cells, widths, strict=True)
        return "  ".join(f"{cell:<{width}}" for cell, width in pairs).rstrip()

    typer.secho(f"\n{title}:", bold=True)
    typer.echo(f"  {line(head)}")
    edge = shutil.get_terminal_size().columns
    for row, constant in zip(rows, constants, strict=True):
        typer.secho(f"  {line(row)}", bold=True)
        typer.echo(
            textwrap.fill(constant.help, edge, initial_indent=INDENT, subsequent_indent=INDENT)
        )


def _format_default(constant: Constant) -> str:
    """Return the default of the method; empty if every preset must set the constant."""
    return "" if constant.default is MISSING else format_value(constant.default)
