"""How a command reads recordings: what people say of them that their files do not.

`BODY` and `READING` are the keywords of `kineme.read`; `kineme.cli.options.declare.add_options`
gives them to a command.
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
Fps = Annotated[float | None, option(READING_OPTIONS, "Frames per second, in place of the file's.")]
Unit = Annotated[
    str | None, option(READING_OPTIONS, "Unit: m, cm, mm, inch, cmu, or its metres, as 0.0254.")
]
Up = Annotated[
    str | None, option(READING_OPTIONS, "Axis that points up: x, y, z, -x, -y, -z.", metavar="AXIS")
]
Person = Annotated[
    str | None,
    option(READING_OPTIONS, "Which of several people in it, by name or number.", metavar="NAME"),
]
Confidence = Annotated[
    float | None, option(READING_OPTIONS, "Leave out points of less confidence, such as 0.5.")
]
Take = Annotated[
    str | None,
    option(
        READING_OPTIONS,
        "Which of several animations, by name or number; or all.",
        metavar="NAME",
    ),
]
Columns = Annotated[
    str | None,
    option(
        INPUT,
        "Take these columns or channels instead of joints; * and ? stand for any characters, as "
        "in acc_*.",
        metavar="NAME,NAME,…",
    ),
]
Emg = Annotated[
    bool,
    option(
        INPUT,
        "The columns are signals of muscles: take their envelopes. Of a C3D, only its muscles.",
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
"""What `kineme.read` takes besides the path, for a motion."""
READING: dict[str, Any] = {**BODY, "columns": Columns, "emg": Emg}
"""And for either kind of recording."""
EVERYTHING = "all"
"""With --person or --take: each of those in a recording."""


def make_read_options(*, emg: bool | None = None, **given: Any) -> ReadOptions:
    """Return the options as they were typed; typer.BadParameter where one makes no sense."""
    with suppress(KeyError, TypeError, ValueError):
        given["unit"] = float(given["unit"])
    if (columns := given.get("columns")) is not None:
        given["columns"] = split_names(columns)
        if not given["columns"]:
            raise typer.BadParameter("names no column", param_hint="--columns")
    try:
        return ReadOptions(**given, emg=bool(emg))
    except ParameterError as error:
        raise typer.BadParameter(str(error)) from error


def split_names(*texts: str | None) -> tuple[str, ...]:
    """Return the names in texts with commas between them."""
    names = (name.strip() for text in texts if text for name in text.split(","))
    return tuple(name for name in names if name)


def expand_read_options(path: Path, options: ReadOptions) -> list[tuple[str, ReadOptions]]:
    """Return the people and takes in a file where all are asked for, and how each is read.

    A single one, or the one that was named, goes without a name.
    """
    if options.take == EVERYTHING:
        from kineme.formats import list_takes

        takes = list_takes(path, replace(options, person=None, take=None)) or (None,)
        return [
            ("_".join(filter(None, (take, who))), each)
            for take in takes
            for who, each in expand_read_options(path, replace(options, take=take))
        ]
    if options.person != EVERYTHING:
        return [("", options)]
    from kineme.formats import list_people

    people = list_people(path, options) or (None,)
    return [(who or "", replace(options, person=who)) for who in people]
