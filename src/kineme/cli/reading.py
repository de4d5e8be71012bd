"""Options shared by the commands that read a recording, and what they become."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Annotated, Any

import typer

from kineme.errors import ParameterError

PANEL = "What the file does not say"

Skeleton = Annotated[
    Path | None,
    typer.Option(help="ASF skeleton of an AMC file.", rich_help_panel=PANEL),
]
Fps = Annotated[
    float | None,
    typer.Option(help="Frames per second, in place of the file's.", rich_help_panel=PANEL),
]
Unit = Annotated[
    str | None,
    typer.Option(
        help="Unit of lengths: m, cm, mm, inch, cmu, or the metres in one unit.",
        rich_help_panel=PANEL,
    ),
]
Up = Annotated[
    str | None,
    typer.Option(help="Axis that points up: x, y, z, -x, -y, -z.", rich_help_panel=PANEL),
]
Person = Annotated[
    str | None,
    typer.Option(
        help="Which of several people in the file, by name or number.", rich_help_panel=PANEL
    ),
]
Confidence = Annotated[
    float | None,
    typer.Option(help="From which a keypoint counts as seen, such as 0.5.", rich_help_panel=PANEL),
]
Effectors = Annotated[
    str | None,
    typer.Option(
        metavar="NAME,NAME,…",
        help="Joints of left ankle, right ankle, head, left wrist and right wrist; "
        "or some of them as left_wrist=NAME,….",
        rich_help_panel=PANEL,
    ),
]
Quiet = Annotated[bool, typer.Option("--quiet", "-q", help="Print warnings and errors only.")]
Json = Annotated[bool, typer.Option("--json", help="Print JSON, one line per recording.")]


def read_options(
    skeleton: Path | None,
    fps: float | None,
    unit: str | None,
    up: str | None,
    person: str | None = None,
    confidence: float | None = None,
) -> dict[str, Any]:
    """Keywords for `kineme.read`, checked before any file is opened."""
    from kineme.formats import ReadOptions

    try:
        size = float(unit) if unit is not None else None
    except ValueError:
        size = None
    given = {
        "skeleton": skeleton,
        "fps": fps,
        "unit": unit if size is None else size,
        "up": up,
        "person": person,
        "confidence": confidence,
    }
    try:
        ReadOptions(**given)  # type: ignore[arg-type]
    except ParameterError as error:
        raise typer.BadParameter(str(error)) from error
    return given


def effector_names(text: str | None) -> Mapping[str, str] | list[str] | None:
    """Joint names as `end_effectors` takes them."""
    if text is None:
        return None
    names = text.split(",")
    if "=" not in text:
        return names
    pairs = [name.partition("=") for name in names]
    return {part.strip().replace(" ", "_"): name for part, _, name in pairs}
