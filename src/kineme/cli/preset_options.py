"""Each constant of a preset as an option of its own, made from the fields of the presets.

Names, types, choices and help come from the dataclass and its docstring: a
constant added there appears here.
"""

from __future__ import annotations

import inspect
from collections.abc import Callable
from functools import partial, wraps
from types import NoneType
from typing import Annotated, Any, Literal, get_args, get_origin

import typer

from kineme.methods.base import Preset
from kineme.methods.constants import Constant
from kineme.methods.presets import PRESETS

PANEL = "Constants of the preset"
FINE = "Finer constants of the preset, which hardly anybody needs to change"


def with_preset_options(command: Callable[..., None]) -> Callable[..., None]:
    """The command with one option per constant; those given reach it as ``overrides``."""
    signature = inspect.signature(command, eval_str=True)
    own = [p for p in signature.parameters.values() if p.name != "overrides"]
    known = _constants()
    options = [_parameter(each) for each in known.values()]

    @wraps(command)
    def wrapped(**values: Any) -> None:
        given = {name: values.pop(name) for name in known}
        overrides = {name: value[0] for name, value in given.items() if value is not None}
        command(**values, overrides=overrides)

    wrapped.__signature__ = signature.replace(parameters=[*own, *options])  # type: ignore[attr-defined]
    wrapped.__annotations__ = {p.name: p.annotation for p in (*own, *options)}
    return wrapped


def _constants() -> dict[str, Constant]:
    """Each constant that a preset has, by name, as the first preset that has it tells it."""
    found: dict[str, Constant] = {}
    for preset in PRESETS.values():
        for known in preset.constants():
            found.setdefault(known.name, known)
    return found


def _parameter(known: Constant) -> inspect.Parameter:
    name = known.name
    defaults = ", ".join(
        f"{preset.name} {_shown(preset, name)}"
        for preset in PRESETS.values()
        if hasattr(preset, name)
    )
    unit = f", {known.unit}" if known.unit else ""
    option = typer.Option(
        f"--{name.replace('_', '-')}",
        parser=partial(_parse, known.hint),
        metavar=_metavar(known.hint),
        help=f"{known.help}{unit} [dim]\\[{defaults}][/dim]",
        rich_help_panel=FINE if known.fine else PANEL,
        show_default=False,
    )
    return inspect.Parameter(
        name, inspect.Parameter.KEYWORD_ONLY, default=None, annotation=Annotated[Any, option]
    )


def _parse(hint: Any, text: str) -> tuple[Any]:
    """The value in a tuple, which tells ``none`` from an option that was not given."""
    try:
        return (_value(hint, text.strip()),)
    except (ValueError, IndexError):
        raise typer.BadParameter(f"{text!r} is not {_metavar(hint)}") from None


def _value(hint: Any, text: str) -> Any:
    """``text`` as a value of one of the types that presets have."""
    members = get_args(hint)
    if NoneType in members:
        return None if text.lower() == "none" else _value(_without_none(hint), text)
    if get_origin(hint) is Literal:
        return members[members.index(text)]
    if get_origin(hint) is tuple and get_origin(members[0]) is tuple:
        return tuple(_pair(part) for part in text.split())
    if get_origin(hint) is tuple:
        return tuple(_value(members[0], part) for part in text.split(","))
    if hint is bool:
        return {"true": True, "yes": True, "false": False, "no": False}[text.lower()]
    return hint(text)


def _pair(text: str) -> tuple[int, int]:
    a, b = text.split(",")
    return int(a), int(b)


def _metavar(hint: Any) -> str:
    members = get_args(hint)
    if NoneType in members:
        return f"{_metavar(_without_none(hint))}|none"
    if get_origin(hint) is Literal:
        return "|".join(members)
    if get_origin(hint) is tuple:
        return '"A,B A,B …"' if get_origin(members[0]) is tuple else "NUMBER,NUMBER,…"
    return {int: "COUNT", float: "NUMBER", bool: "yes|no"}[hint]


def _without_none(hint: Any) -> Any:
    return next(member for member in get_args(hint) if member is not NoneType)


def _shown(preset: Preset, name: str) -> str:
    """A preset's own value, as it would be typed."""
    value = getattr(preset, name)
    if isinstance(value, bool):
        return "yes" if value else "no"
    if isinstance(value, tuple):
        pairs = isinstance(value[0], tuple)
        return " ".join(f"{a},{b}" for a, b in value) if pairs else ",".join(map(_short, value))
    return "none" if value is None else _short(value)


def _short(value: object) -> str:
    return f"{value:.4g}" if isinstance(value, float) else str(value)
