"""How clips are shaped, named and written: what ``split`` and ``library split`` share."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

from kineme.cli.help import OUTPUT, option
from kineme.clips import RootMotionMode, TargetName

RootMotion = Annotated[
    RootMotionMode | None,
    option(OUTPUT, "keep, extract (to a root bone), in-place.", metavar="HOW", show_default="keep"),
]
Close = Annotated[bool, option(OUTPUT, "Repeat the first frame of loops at their end.", "--close")]
ToFormat = Annotated[
    str | None,
    option(OUTPUT, "Such as glb; by default bvh, or csv of points.", "--format", metavar="SUFFIX"),
]
ToFps = Annotated[
    float | None,
    option(OUTPUT, "Frames per second of the clips, such as 30.", "--to-fps", metavar="HZ"),
]
Name = Annotated[
    str | None,
    option(
        OUTPUT,
        "Names of clips, such as {take}_{label}_{n:02}; also {name}, {cluster}, {level}, "
        "{direction}, {loop}.",
        "--name",
        metavar="TEMPLATE",
    ),
]
ForTarget = Annotated[
    TargetName | None,
    option(
        OUTPUT,
        "Format, root bone and names for unreal, unity, blender or godot.",
        "--for",
        metavar="PROGRAM",
    ),
]
Sheet = Annotated[
    Path | None, option(OUTPUT, "Picture of all clips as stick figures.", "--sheet", metavar="PNG")
]
MotionMatching = Annotated[
    Path | None,
    option(
        OUTPUT,
        "Database for motion matching, .npz or .bin.",
        "--motion-matching",
        metavar="FILE",
    ),
]
