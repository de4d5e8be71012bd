"""Reading options: properties of recordings that their files do not state.

`BODY` and `READING` are keywords of `kineme.read`; `kineme.cli.options.declare.add_options` adds
them to a command.
"""

from __future__ import annotations

from contextlib import suppress
from dataclasses import replace
from pathlib import Path
from typing import Annotated, Any

import typer

from kineme.cli.help import INPUT, OUTPUT, READING_OPTIONS, option
from kineme.errors import ParameterError
from kineme.formats.options import ReadOptions

Skeleton = Annotated[
    Path | None, option(READING_OPTIONS, "ASF skeleton of an AMC file.", metavar="FILE")
]
Fps = Annotated[float | None, option(READING_OPTIONS, "Frames per second; overrides the file.")]
Unit = Annotated[
    str | None,
    option(READING_OPTIONS, "Unit: m, cm, mm, inch, cmu, or its length in metres, such as 0.0254."),
]
Up = Annotated[
    str | None, option(READING_OPTIONS, "Axis that points up: x, y, z, -x, -y, -z.", metavar="AXIS")
]
Person = Annotated[
    str | None,
    option(READING_OPTIONS, "Person to read: name or number.", metavar="NAME"),
]
Confidence = Annotated[
    float | None, option(READING_OPTIONS, "Least confidence of points, such as 0.5.")
]
Take = Annotated[
    str | None,
    option(
        READING_OPTIONS,
        "Animation to read: name, number or all.",
        metavar="NAME",
    ),
]
Columns = Annotated[
    str | None,
    option(
        INPUT,
        "Read these columns or channels, not joints; with wildcards * and ?.",
        metavar="NAME,NAME,…",
    ),
]
Emg = Annotated[
    bool,
    option(
        INPUT,
        "Columns are muscle signals: use envelopes. Of a C3D, only muscles.",
        "--emg",
    ),
]
Quiet = Annotated[bool, option(OUTPUT, "Print warnings and errors only.", "--quiet", "-q")]
Json = Annotated[bool, option(OUTPUT, "Print JSON, one line per recording.", "--json")]

BODY: dict[str, Any] = {
    "skeleton": Skeleton,
    "fps": Fps,
    "unit": Unit,
    "up": Up,
    "person": Person,
    "confidence": Confidence,
    "take": Take,
}
"""Options of `kineme.read` for a motion."""
READING: dict[str, Any] = {**BODY, "columns": Columns, "emg": Emg}
"""Options of `kineme.read` for motions and signals."""
ALL = "all"
"""Value of --person and --take that selects each of them."""


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
        from kineme.formats import list_takes

        takes = list_takes(path, replace(options, person=None, take=None)) or (None,)
        return [
            ("_".join(filter(None, (take, who))), each)
            for take in takes
            for who, each in expand_read_options(path, replace(options, take=take))
        ]
    if options.person != ALL:
        return [("", options)]
    from kineme.formats import list_people

    people = list_people(path, options) or (None,)
    return [(who or "", replace(options, person=who)) for who in people]
