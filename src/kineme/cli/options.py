"""Options that several commands share: reading, segmenting, outputs, clips.

`add_options` adds a group of them to a command. `BODY` and `READING` are keywords of `kineme.read`:
properties of recordings that their files do not state. Options of segmenting are derived from the
registered presets and their `Constant` objects, so a preset or constant added by another package
works with every command. Values are typed as they are printed: ``0.5``, ``none``, ``yes``,
``1,1 2,1``.
"""

from __future__ import annotations

import inspect
from collections.abc import Callable, Iterable, Mapping, Sequence
from contextlib import suppress
from dataclasses import replace
from functools import wraps
from pathlib import Path
from types import NoneType
from typing import TYPE_CHECKING, Annotated, Any, Literal, get_args, get_origin

import typer

from kineme.cli.help import INPUT, METHOD, OUTPUT, PRESETS, READING_OPTIONS, option
from kineme.clips import RootMotionMode, TargetName
from kineme.errors import ParameterError
from kineme.formats import list_people, list_takes
from kineme.formats.options import ReadOptions
from kineme.methods.presets import DEFAULT, resolve_preset
from kineme.methods.segmenter import SegmentOptions
from kineme.segments.hierarchy import DEFAULT_DETAIL

if TYPE_CHECKING:
    from kineme.methods.base import Constant

Quiet = Annotated[bool, option(OUTPUT, "Print warnings and errors only.", "--quiet", "-q")]
Json = Annotated[bool, option(OUTPUT, "Print JSON, one line per recording.", "--json")]
BODY: dict[str, Any] = {
    "skeleton": Annotated[
        Path | None, option(READING_OPTIONS, "ASF skeleton of an AMC file.", metavar="FILE")
    ],
    "fps": Annotated[
        float | None, option(READING_OPTIONS, "Frames per second; overrides the file.")
    ],
    "unit": Annotated[
        str | None,
        option(
            READING_OPTIONS, "Unit: m, cm, mm, inch, cmu, or its length in metres, such as 0.0254."
        ),
    ],
    "up": Annotated[
        str | None,
        option(READING_OPTIONS, "Axis that points up: x, y, z, -x, -y, -z.", metavar="AXIS"),
    ],
    "person": Annotated[
        str | None,
        option(READING_OPTIONS, "Person to read: name or number (0, 1, …).", metavar="NAME"),
    ],
    "confidence": Annotated[
        float | None, option(READING_OPTIONS, "Least confidence of points, such as 0.5.")
    ],
    "take": Annotated[
        str | None,
        option(READING_OPTIONS, "Animation to read: name, number or all.", metavar="NAME"),
    ],
}
"""Options of `kineme.read` for a motion."""
READING: dict[str, Any] = {
    **BODY,
    "columns": Annotated[
        str | None,
        option(
            INPUT,
            "Read these columns or channels, not joints; with wildcards * and ?.",
            metavar="NAME,NAME,…",
        ),
    ],
    "emg": Annotated[
        bool,
        option(
            INPUT, "Columns are muscle signals: use envelopes. Of a C3D, only muscles.", "--emg"
        ),
    ],
}
"""Options of `kineme.read` for motions and signals."""
ALL = "all"
"""Value of --person and --take that selects each of them."""
SET = "--set"
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
    "preset": Annotated[
        str | None, option(METHOD, f"{PRESETS}; see `kineme presets`.", metavar="NAME")
    ],
    "detail": Annotated[
        float | None,
        option(
            METHOD,
            "Above 1 for more, shorter segments, such as 4; below for fewer, longer ones, such as "
            "0.5.",
            metavar="NUMBER",
        ),
    ],
    "constants": Constants,
    "effectors": Effectors,
}
"""Options of `kineme.segment`."""
CLIPS: dict[str, Any] = {
    "root_motion": Annotated[
        RootMotionMode | None,
        option(OUTPUT, "keep, extract (root bone), in-place.", metavar="HOW", show_default="keep"),
    ],
    "close": Annotated[bool, option(OUTPUT, "Repeat the first frame at the end.", "--close")],
    "to_format": Annotated[
        str | None,
        option(OUTPUT, "Format, such as glb; by default bvh or csv.", "--format", metavar="SUFFIX"),
    ],
    "to_fps": Annotated[
        float | None, option(OUTPUT, "Frame rate of clips, such as 30.", metavar="HZ")
    ],
    "name": Annotated[
        str | None,
        option(
            OUTPUT,
            "Pattern of names, such as {label}_{n:02}; also {name}, {take}, {direction} and "
            "others.",
            metavar="TEMPLATE",
        ),
    ],
    "target": Annotated[
        TargetName | None,
        option(
            OUTPUT,
            "Program that the clips are for: unreal, unity, blender or godot.",
            "--for",
            metavar="PROGRAM",
        ),
    ],
    "sheet": Annotated[
        Path | None, option(OUTPUT, "Picture of all clips to write.", metavar="PNG")
    ],
    "motion_matching": Annotated[
        Path | None,
        option(
            OUTPUT,
            "Motion matching database to write: .npz or .bin.",
            metavar="FILE",
        ),
    ],
}
"""Options by keyword of `kineme.clips.split.split`, except format and rate of clips."""


def add_options(
    options: Mapping[str, Any], **groups: Mapping[str, Any]
) -> Callable[[Callable[..., None]], Callable[..., None]]:
    """Add options for reading, segmenting and clips to a command.

    The command receives them as ``read_options`` (`ReadOptions`), ``segment_options``
    (`SegmentOptions`) and ``clip_options`` (keywords of `kineme.clips.split.split`). Each of
    ``groups`` is passed as a dictionary of the options that were set.
    """
    added = [
        inspect.Parameter(name, inspect.Parameter.KEYWORD_ONLY, default=None, annotation=option)
        for group in (options, *groups.values())
        for name, option in group.items()
    ]

    def decorate(command: Callable[..., None]) -> Callable[..., None]:
        signature = inspect.signature(command, eval_str=True)
        injected = ("read_options", "segment_options", "clip_options", *groups)
        own = [
            parameter for name, parameter in signature.parameters.items() if name not in injected
        ]

        @wraps(command)
        def wrapped(**values: Any) -> None:
            """Call the command with its options collected in objects."""
            for group, members in groups.items():
                group_values = {name: values.pop(name) for name in members}
                values[group] = {
                    name: value for name, value in group_values.items() if value is not None
                }
            # ``options`` mixes three kinds: those left after segmenting and clips are of reading.
            given = {name: values.pop(name) for name in options}
            method = {name: given.pop(name) for name in SEGMENTING if name in given}
            clips = {name: given.pop(name) for name in CLIPS if name in given}
            read_options = make_read_options(**given)
            if given:
                values["read_options"] = read_options
            if method:
                values["segment_options"] = make_segment_options(**method, emg=read_options.emg)
            if clips:
                values["clip_options"] = make_clip_options(**clips)
            command(**values)

        # typer reads the options of a command from its signature.
        wrapped.__signature__ = signature.replace(parameters=[*own, *added])  # type: ignore[attr-defined]
        return wrapped

    return decorate


def are_given(context: typer.Context, options: Iterable[str]) -> bool:
    """Return whether the user set any of these options."""
    sources = map(context.get_parameter_source, options)
    return any(source is not None and source.name == "COMMANDLINE" for source in sources)


def make_read_options(*, emg: bool | None = None, **options: Any) -> ReadOptions:
    """Return the options from texts; typer.BadParameter if one is invalid."""
    with suppress(KeyError, TypeError, ValueError):
        options["unit"] = float(options["unit"])
    if (columns := options.get("columns")) is not None:
        options["columns"] = split_names(columns)
        if not options["columns"]:
            raise typer.BadParameter("names no column", param_hint="--columns")
    try:
        return ReadOptions(**options, emg=bool(emg))
    except ParameterError as error:
        raise typer.BadParameter(str(error)) from error


def split_names(*texts: str | None) -> tuple[str, ...]:
    """Return the names in comma-separated texts."""
    names = (name.strip() for text in texts if text for name in text.split(","))
    return tuple(name for name in names if name)


def expand_read_options(path: Path, options: ReadOptions) -> list[tuple[str, ReadOptions]]:
    """Return a name and reading options for each selected person and take of a file.

    The name is empty for a single one, and for one that the user selected.
    """
    if options.take == ALL:
        takes = list_takes(path, replace(options, person=None, take=None)) or (None,)
        return [
            ("_".join(filter(None, (take, who))), each)
            for take in takes
            for who, each in expand_read_options(path, replace(options, take=take))
        ]
    if options.person != ALL:
        return [("", options)]
    people = list_people(path, options) or (None,)
    return [(who or "", replace(options, person=who)) for who in people]


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
    """Return a text as a value of the annotated type of a constant."""
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


def make_clip_options(
    *, to_format: str | None, to_fps: float | None, close: bool | None, **options: Any
) -> dict[str, Any]:
    """Return the options as keywords of `kineme.clips.split.split`."""
    return {"format": to_format, "fps": to_fps, "close": bool(close), **options}
