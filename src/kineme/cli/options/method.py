"""Segmentation options: ``--preset``, ``--set NAME=VALUE``, ``--detail``, ``--effectors``.

They are derived from the registered presets and their `Constant` objects, so a preset or constant
added by another package works with every command. Values are typed as they are printed: ``0.5``,
``none``, ``yes``, ``1,1 2,1``.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from types import NoneType
from typing import TYPE_CHECKING, Annotated, Any, Literal, get_args, get_origin

import typer

from kineme.cli.help import METHOD, PRESETS, READING_OPTIONS, option
from kineme.errors import ParameterError
from kineme.methods.presets import DEFAULT, resolve_preset
from kineme.methods.segmenter import SegmentOptions
from kineme.segments.hierarchy import DEFAULT_DETAIL

if TYPE_CHECKING:
    from kineme.methods.constants import Constant

SET = "--set"
PresetName = Annotated[
    str | None, option(METHOD, f"{PRESETS}; see `kineme presets`.", "--preset", metavar="NAME")
]
Constants = Annotated[
    list[str] | None,
    option(
        METHOD,
        "Change a constant of the preset, such as min_action=2; may be repeated. `kineme "
        "presets NAME` lists them.",
        SET,
        metavar="NAME=VALUE",
    ),
]
Detail = Annotated[
    float | None,
    option(
        METHOD,
        "Above 1 for more, shorter segments, such as 4; below for fewer, longer ones, such as 0.5.",
        "--detail",
        metavar="NUMBER",
    ),
]
Effectors = Annotated[
    str | None,
    option(
        READING_OPTIONS,
        "Joints of left and right ankle, head, left and right wrist; or only some, as in "
        "head=NAME,left_wrist=NAME.",
        metavar="NAME,NAME,…",
    ),
]

SEGMENTING: dict[str, Any] = {
    "preset": PresetName,
    "detail": Detail,
    "constants": Constants,
    "effectors": Effectors,
}
"""Options of `kineme.segment`."""


def make_segment_options(
    *,
    preset: str | None = None,
    detail: float | None = None,
    constants: Sequence[str] | None = None,
    effectors: str | None = None,
    emg: bool = False,
) -> SegmentOptions:
    """Return the options from texts; typer.BadParameter if one is invalid."""
    chosen = preset or DEFAULT
    try:
        return SegmentOptions(
            preset=chosen,
            constants=parse_constants([chosen], constants or ()),
            effectors=parse_effectors(effectors),
            detail=DEFAULT_DETAIL if detail is None else detail,
            emg=emg,
        )
    except ParameterError as error:
        raise typer.BadParameter(str(error), param_hint="--detail") from error


def parse_effectors(text: str | None) -> Mapping[str, str] | list[str] | None:
    """Return joint names in the form that `end_effectors` takes."""
    if text is None:
        return None
    names = text.split(",")
    if "=" not in text:
        return names
    pairs = [name.partition("=") for name in names]
    return {part.strip().replace(" ", "_"): name for part, _, name in pairs}


def parse_constants(presets: Sequence[str], settings: Sequence[str]) -> dict[str, Any]:
    """Parse texts such as ``min_action=2`` into checked constants.

    Each preset takes the constants that it has. typer.BadParameter names an unknown preset, a
    constant that no preset has, or an invalid value.

    Examples
    --------
    >>> parse_constants(["kineme"], ["min-action=2", "bands=0.5,2"])
    {'min_action': 2.0, 'bands': (0.5, 2.0)}
    """
    typed = dict(map(_split_setting, settings))
    try:
        chosen = [resolve_preset(name) for name in presets]
    except ParameterError as error:
        raise typer.BadParameter(str(error), param_hint="--preset") from error
    try:
        constants = {
            constant.name: constant
            for preset in reversed(chosen)
            for constant in preset.constants()
        }
        for name in typed.keys() - constants.keys():
            # Raises an error that suggests similar names.
            resolve_preset(presets[0], signals=False, **{name: typed[name]})
        values = {name: parse_value(constants[name], text) for name, text in typed.items()}
        for preset in chosen:
            parameters = preset.parameters()
            preset.replace(**{name: value for name, value in values.items() if name in parameters})
    except ParameterError as error:
        raise typer.BadParameter(str(error), param_hint=SET) from error
    return values


def _split_setting(text: str) -> tuple[str, str]:
    name, equals, value = text.partition("=")
    if not equals:
        advice = f"give NAME=VALUE, such as min_action=2, not {text!r:.60}"
        raise typer.BadParameter(advice, param_hint=SET)
    return name.strip().replace("-", "_"), value


def parse_value(constant: Constant, text: str) -> Any:
    """Parse a text as a value of a constant; ParameterError describes valid values.

    Examples
    --------
    >>> from kineme.methods import PRESETS
    >>> constants = {each.name: each for each in PRESETS["voegele2014"].constants()}
    >>> parse_value(constants["max_lag"], "none"), parse_value(constants["offsets"], "-0.1,0,0.1")
    (None, (-0.1, 0.0, 0.1))
    """
    try:
        return _convert_text(constant.hint, text.strip())
    except (ValueError, KeyError):
        words = f"{_describe_type(constant.hint)} {constant.allowed} {constant.unit}"
        advice = " ".join(words.split())
        raise ParameterError(f"{constant.name} must be {advice}, not {text!r:.60}") from None


def format_value(value: Any) -> str:
    """Return a value as it would be typed; floats have four digits.

    Examples
    --------
    >>> [format_value(value) for value in (((1, 1), (2, 1)), None, True, 1 / 3, 1e4)]
    ['1,1 2,1', 'none', 'yes', '0.3333', '10000']
    """
    if isinstance(value, bool):
        return "yes" if value else "no"
    if isinstance(value, tuple):
        separator = " " if value and isinstance(value[0], tuple) else ","
        return separator.join(map(format_value, value))
    if isinstance(value, float):
        text = f"{value:.4g}"
        return f"{value:.0f}" if "e+" in text else text
    return "none" if value is None else str(value)


def _describe_type(hint: Any) -> str:
    """Return the kind of value that a type takes, for messages."""
    members = get_args(hint)
    if NoneType in members:
        hint = _drop_none(hint)
        members = get_args(hint)
    if get_origin(hint) is tuple:
        pairs = get_origin(members[0]) is tuple
        return "pairs such as 1,1 2,1, each" if pairs else "numbers separated by commas, each"
    return {int: "a whole number,", float: "a number,"}.get(hint, "one of")


def _convert_text(hint: Any, text: str) -> Any:
    members = get_args(hint)
    if NoneType in members:
        return None if text.lower() == "none" else _convert_text(_drop_none(hint), text)
    if get_origin(hint) is Literal:
        return {str(member): member for member in members}[text]
    if get_origin(hint) is tuple:
        parts = text.split() if get_origin(members[0]) is tuple else text.split(",")
        return tuple(_convert_text(members[0], part) for part in parts)
    if hint is bool:
        return {"true": True, "yes": True, "false": False, "no": False}[text.lower()]
    return hint(text)


def _drop_none(hint: Any) -> Any:
    return next(member for member in get_args(hint) if member is not NoneType)
