"""Options for the shape, names and format of clips, for ``split`` and ``library split``.

`kineme.cli.options.declare.add_options` adds them to a command.
"""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any

from kineme.cli.help import OUTPUT, option
from kineme.clips import RootMotionMode, TargetName

RootMotion = Annotated[
    RootMotionMode | None,
    option(OUTPUT, "keep, extract (root bone), in-place.", metavar="HOW", show_default="keep"),
]
Close = Annotated[bool, option(OUTPUT, "Repeat the first frame at the end.", "--close")]
ToFormat = Annotated[
    str | None,
    option(OUTPUT, "Format, such as glb; by default bvh or csv.", "--format", metavar="SUFFIX"),
]
ToFps = Annotated[
    float | None,
    option(OUTPUT, "Frame rate of clips, such as 30.", "--to-fps", metavar="HZ"),
]
Name = Annotated[
    str | None,
    option(
        OUTPUT,
        "Pattern of names, such as {label}_{n:02}; also {name}, {take}, {direction} and others.",
        "--name",
        metavar="TEMPLATE",
    ),
]
ForTarget = Annotated[
    TargetName | None,
    option(
        OUTPUT,
        "Program that the clips are for: unreal, unity, blender or godot.",
        "--for",
        metavar="PROGRAM",
    ),
]
Sheet = Annotated[
    Path | None, option(OUTPUT, "Picture of all clips to write.", "--sheet", metavar="PNG")
]
MotionMatching = Annotated[
    Path | None,
    option(
        OUTPUT,
        "Motion matching database to write: .npz or .bin.",
        "--motion-matching",
        metavar="FILE",
    ),
]

CLIPS: dict[str, Any] = {
    "root_motion": RootMotion,
    "close": Close,
    "to_format": ToFormat,
    "to_fps": ToFps,
    "name": Name,
    "target": ForTarget,
    "sheet": Sheet,
    "motion_matching": MotionMatching,
}
"""Options by keyword of `kineme.clips.split.split`, except format and rate of clips."""


def make_clip_options(
    *, to_format: str | None, to_fps: float | None, close: bool | None, **options: Any
) -> dict[str, Any]:
    """Return the options as keywords of `kineme.clips.split.split`."""
    return {"format": to_format, "fps": to_fps, "close": bool(close), **options}
