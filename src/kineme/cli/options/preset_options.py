"""``--preset``, and each constant of each preset as an option of its own.

All of it comes from the registered presets: their names and help, and what each
`Constant` says of itself. A preset or a constant that is added, here or by
another package, appears in every command that segments.
"""

from __future__ import annotations

import inspect
from collections.abc import Callable
from functools import cache, wraps
from typing import Annotated, Any

import typer

from kineme.cli.options.constant_texts import metavar, parsed, shown
from kineme.errors import ParameterError
from kineme.methods import PRESETS, Constant
from kineme.methods.presets import DEFAULT

FINE = "Finer constants, which hardly anybody needs to change"
SHARED = "Constants of presets of several methods"
NARROW = 1000
"""Limits below this are told: somebody may meet them."""

PRESET = typer.Option(
    "--preset",
    metavar="NAME",
    help="\n\n".join(f"{name}: {preset.help}" for name, preset in PRESETS.items()),
)
PresetName = Annotated[str, PRESET]
DETAIL = typer.Option(
    "--detail",
    metavar="NUMBER",
    help="1 as found; less for fewer, longer segments, more for finer ones.",
)
Detail = Annotated[float, DETAIL]
Uses = dict[str, Constant]
"""A constant in each preset that has it, by the name of the preset."""


def with_preset_options(command: Callable[..., None]) -> Callable[..., None]:
    """The command with one option per constant; those given reach it as ``constants``.

    A constant that is called as an option of the command has none of its own.
    """
    signature = inspect.signature(command, eval_str=True)
    own = [p for p in signature.parameters.values() if p.name != "constants"]
    taken = {parameter.name for parameter in own}
    added = [option for option in _options() if option.name not in taken]

    @wraps(command)
    def wrapped(**values: Any) -> None:
        given = {option.name: values.pop(option.name) for option in added}
        typed = {name: text for name, text in given.items() if text is not None}
        command(**values, constants=_values(values["preset"] or DEFAULT, typed))

    wrapped.__signature__ = signature.replace(parameters=[*own, *added])  # type: ignore[attr-defined]
    wrapped.__annotations__ = {p.name: p.annotation for p in (*own, *added)}
    return wrapped


def _values(preset: str, typed: dict[str, str]) -> dict[str, Any]:
    """What was typed, as values of the preset's own types; as it is, what it does not have."""
    known = {each.name: each for each in PRESETS[preset].constants()} if preset in PRESETS else {}
    values: dict[str, Any] = {}
    for name, text in typed.items():
        try:
            values[name] = parsed(known[name].hint, text) if name in known else text
        except ParameterError as error:
            raise typer.BadParameter(str(error), param_hint=_flag(name)) from error
    return values


@cache
def _options() -> tuple[inspect.Parameter, ...]:
    """An option for each constant: shared ones, then method by method, then the finer ones."""
    uses: dict[str, Uses] = {}
    for preset in PRESETS.values():
        for known in preset.constants():
            uses.setdefault(known.name, {})[preset.name] = known
    panels = {name: _panel(each) for name, each in uses.items()}
    order = sorted(set(panels.values()), key=[SHARED, *panels.values()].index)
    order = [*(panel for panel in order if panel != FINE), FINE]
    names = sorted(uses, key=lambda name: order.index(panels[name]))
    return tuple(_option(name, uses[name], panels[name]) for name in names)


def _panel(uses: Uses) -> str:
    if all(known.fine for known in uses.values()):
        return FINE
    methods = {PRESETS[name].method for name in uses}
    if len(methods) > 1:
        return SHARED
    return f"Constants of {', '.join(_of_method(methods.pop()))}"


def _of_method(method: str) -> list[str]:
    """The names of its presets."""
    return [preset.name for preset in PRESETS.values() if preset.method == method]


def _option(name: str, uses: Uses, panel: str) -> inspect.Parameter:
    option = typer.Option(
        _flag(name),
        metavar=metavar(next(iter(uses.values())).hint),
        help="\n\n".join(_told(uses, panel)),
        rich_help_panel=panel,
        show_default=False,
    )
    hint = Annotated[str | None, option]
    return inspect.Parameter(name, inspect.Parameter.KEYWORD_ONLY, default=None, annotation=hint)


def _told(uses: Uses, panel: str) -> list[str]:
    """What the constant does, with its values; more than once where presets mean several things."""
    meanings: dict[str, Uses] = {}
    for preset, known in uses.items():
        parts = (known.help, known.unit, _limits(known))
        meanings.setdefault(", ".join(filter(None, parts)), {})[preset] = known
    return [
        f"{meaning} [dim]\\[{_defaults(these, panel)}][/dim]" for meaning, these in meanings.items()
    ]


def _limits(known: Constant) -> str:
    limits = known.limits
    if limits is None or limits.maximum >= NARROW:
        return ""
    low = f"above {limits.minimum:g}" if limits.above else f"{limits.minimum:g}"
    return f"{low} to {limits.maximum:g}"


def _defaults(uses: Uses, panel: str) -> str:
    """The value in each preset: ``kineme 30; aca, haca 120``; alone where the panel agrees."""
    presets_of: dict[str, list[str]] = {}
    for preset, known in uses.items():
        presets_of.setdefault(shown(known.value), []).append(preset)
    everyone = [*PRESETS] if panel == SHARED else _of_method(PRESETS[next(iter(uses))].method)
    if panel != FINE and [*presets_of.values()] == [everyone]:
        return next(iter(presets_of))
    return "; ".join(f"{', '.join(presets)} {value}" for value, presets in presets_of.items())


def _flag(name: str) -> str:
    return f"--{name.replace('_', '-')}"
