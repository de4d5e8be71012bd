"""How a command reads recordings: what people say of them that their files do not.

`BODY` and `READING` are the keywords of `kineme.read`; `kineme.cli.options.request.asks` gives
them to a command.
"""

from __future__ import annotations

from collections.abc import Mapping
from contextlib import suppress
from pathlib import Path
from typing import Annotated, Any

import typer

from kineme.cli.help import INPUT, OUTPUT, READING_OPTIONS, option
from kineme.errors import ParameterError

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
        "Which of several animations, by name or number; all for each of them.",
        metavar="NAME",
    ),
]
Effectors = Annotated[
    str | None,
    option(
        READING_OPTIONS,
        "Joints at left and right ankle, head, left and right wrist; or some, as in "
        "head=NAME,left_wrist=NAME.",
        metavar="NAME,NAME,…",
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


def keywords_of(given: dict[str, Any]) -> dict[str, Any]:
    """Keywords for `kineme.read`, before any file is opened."""
    from kineme.formats import ReadOptions

    keywords = {
        name: value for name, value in given.items() if value is not None and value is not False
    }
    with suppress(KeyError, ValueError):
        keywords["unit"] = float(keywords["unit"])
    if "columns" in keywords:
        keywords["columns"] = tuple(filter(None, map(str.strip, keywords["columns"].split(","))))
        if not keywords["columns"]:
            raise typer.BadParameter("names no column", param_hint="--columns")
    try:
        ReadOptions(**keywords)
    except ParameterError as error:
        raise typer.BadParameter(str(error)) from error
    return keywords


def effector_names(text: str | None) -> Mapping[str, str] | list[str] | None:
    """Joint names as `end_effectors` takes them."""
    if text is None:
        return None
    names = text.split(",")
    if "=" not in text:
        return names
    pairs = [name.partition("=") for name in names]
    return {part.strip().replace(" ", "_"): name for part, _, name in pairs}
