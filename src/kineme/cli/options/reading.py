"""What people say of a recording that its file does not: options shared by the commands.

`with_reading_options` gives a command those of `OPTIONS`, which are the keywords
of `kineme.read`.
"""

from __future__ import annotations

import inspect
from collections.abc import Callable, Mapping
from contextlib import suppress
from functools import wraps
from pathlib import Path
from typing import Annotated, Any

import typer

from kineme.cli.help import INPUT, OUTPUT, UNSAID
from kineme.errors import ParameterError

Skeleton = Annotated[
    Path | None,
    typer.Option(metavar="FILE", help="ASF skeleton of an AMC file.", rich_help_panel=UNSAID),
]
Fps = Annotated[
    float | None,
    typer.Option(help="Frames per second, in place of the file's.", rich_help_panel=UNSAID),
]
Unit = Annotated[
    str | None,
    typer.Option(
        help="Unit of lengths: m, cm, mm, inch, cmu, or the metres in one unit.",
        rich_help_panel=UNSAID,
    ),
]
Up = Annotated[
    str | None,
    typer.Option(
        metavar="AXIS", help="Axis that points up: x, y, z, -x, -y, -z.", rich_help_panel=UNSAID
    ),
]
Person = Annotated[
    str | None,
    typer.Option(
        metavar="NAME",
        help="Which person of several, by name or number.",
        rich_help_panel=UNSAID,
    ),
]
Confidence = Annotated[
    float | None,
    typer.Option(
        help="Leave out points that a pose estimator is less sure of, such as 0.5.",
        rich_help_panel=UNSAID,
    ),
]
Take = Annotated[
    str | None,
    typer.Option(
        metavar="NAME",
        help="Which animation of several, by name or number.",
        rich_help_panel=UNSAID,
    ),
]
Effectors = Annotated[
    str | None,
    typer.Option(
        metavar="NAME,NAME,…",
        help="Joints to take for left ankle, right ankle, head, left wrist and right wrist, in "
        "this order; or some of them, as in left_wrist=NAME,head=NAME.",
        rich_help_panel=UNSAID,
    ),
]
Columns = Annotated[
    str | None,
    typer.Option(
        metavar="NAME,NAME,…",
        help="Take these columns of a table, or channels of a C3D, instead of joints; * and ? "
        "stand for any characters, as in acc_*.",
        rich_help_panel=INPUT,
    ),
]
Emg = Annotated[
    bool,
    typer.Option(
        "--emg",
        help="The columns are signals of muscles: take their envelopes. Of a C3D, only its "
        "muscles.",
        rich_help_panel=INPUT,
    ),
]
Quiet = Annotated[
    bool,
    typer.Option("--quiet", "-q", help="Print warnings and errors only.", rich_help_panel=OUTPUT),
]
Json = Annotated[
    bool,
    typer.Option("--json", help="Print JSON, one line per recording.", rich_help_panel=OUTPUT),
]

BODY: dict[str, Any] = {
    "skeleton": Skeleton,
    "fps": Fps,
    "unit": Unit,
    "up": Up,
    "person": Person,
    "confidence": Confidence,
    "take": Take,
}
"""What `kineme.read` takes besides the path, for a motion."""
OPTIONS: dict[str, Any] = {**BODY, "columns": Columns, "emg": Emg}
"""And for either kind of recording."""


def with_reading_options(
    command: Callable[..., None], options: Mapping[str, Any] = OPTIONS
) -> Callable[..., None]:
    """The command with these options; checked, they reach it as ``reading``."""
    signature = inspect.signature(command, eval_str=True)
    own = [p for p in signature.parameters.values() if p.name != "reading"]
    added = [
        inspect.Parameter(
            name,
            inspect.Parameter.KEYWORD_ONLY,
            default=False if option is Emg else None,
            annotation=option,
        )
        for name, option in options.items()
    ]

    @wraps(command)
    def wrapped(**values: Any) -> None:
        given = {name: values.pop(name) for name in options}
        command(**values, reading=_checked(given))

    wrapped.__signature__ = signature.replace(parameters=[*own, *added])  # type: ignore[attr-defined]
    wrapped.__annotations__ = {p.name: p.annotation for p in (*own, *added)}
    return wrapped


def with_body_options(command: Callable[..., None]) -> Callable[..., None]:
    """The command with those of them that bodies need."""
    return with_reading_options(command, BODY)


def _checked(given: dict[str, Any]) -> dict[str, Any]:
    """Keywords for `kineme.read`, before any file is opened."""
    from kineme.formats import ReadOptions

    said = {
        name: value for name, value in given.items() if value is not None and value is not False
    }
    with suppress(KeyError, ValueError):
        said["unit"] = float(said["unit"])
    if "columns" in said:
        said["columns"] = tuple(filter(None, map(str.strip, said["columns"].split(","))))
        if not said["columns"]:
            raise typer.BadParameter("names no column", param_hint="--columns")
    try:
        ReadOptions(**said)
    except ParameterError as error:
        raise typer.BadParameter(str(error)) from error
    return said


def effector_names(text: str | None) -> Mapping[str, str] | list[str] | None:
    """Joint names as `end_effectors` takes them."""
    if text is None:
        return None
    names = text.split(",")
    if "=" not in text:
        return names
    pairs = [name.partition("=") for name in names]
    return {part.strip().replace(" ", "_"): name for part, _, name in pairs}
