"""Options for shaping, naming and writing clips, and presets for target programs."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from os import PathLike
from typing import TypedDict

from kineme._util.checks import check_path, is_one_of
from kineme.clips import RootMotionMode, TargetName
from kineme.clips.names import check_template
from kineme.clips.shaping import Shape
from kineme.errors import ParameterError
from kineme.formats.registry import Format, find_writer, supported_formats


@dataclass(frozen=True)
class Target:
    """Default options for a target program; explicit options override them.

    FBX is in centimetres with y up, GLB in metres with y up: programs convert both to their own
    axes and unit on import.

    Parameters
    ----------
    format : str
        Suffix of the files in a folder.
    root_motion : {"keep", "extract", "in-place"}
    close : bool
        Whether a loop ends with its first pose.
    separate : bool
        Whether each clip has its own file, even if the format can hold several.
    name : str
        Template of names.
    """

    format: str | None
    root_motion: RootMotionMode
    close: bool
    separate: bool
    name: str | None


TARGETS: Mapping[TargetName, Target] = {
    # The prefix of animation sequences in Epic's naming conventions.
    "unreal": Target("fbx", "extract", True, True, "AS_{name}_{label}_{n:02}"),
    # A file "model@clip" is a clip of that model.
    "unity": Target("fbx", "extract", True, True, "{name}@{label}_{n:02}"),
    "blender": Target("glb", "keep", False, False, "{name}_{label}_{n:02}"),
    # Animations whose names end with "loop" are looped on import.
    "godot": Target("glb", "extract", True, False, "{name}_{label}_{n:02}_{loop}"),
}


class ClipOptions(TypedDict, total=False):
    """Options of `kineme.clips.split.split`, which documents them."""

    loops: bool
    format: str | None
    best: int | None
    root_motion: RootMotionMode | None
    straight: bool
    mirror: bool
    close: bool
    fps: float | None
    name: str | None
    target: TargetName | None
    sheet: str | PathLike[str] | None
    motion_matching: str | PathLike[str] | None


@dataclass(frozen=True)
class Chosen:
    """Options of clips, completed with defaults of the target program.

    Parameters
    ----------
    shape : Shape
    suffix : str, optional
        Suffix of files, without the dot.
    format : Format, optional
        Format with one file for all clips of a recording; None if each clip has its own.
    given : ClipOptions
        Options as passed by the caller.
    name : str, optional
        Template of names.
    """

    shape: Shape
    suffix: str | None
    format: Format | None
    given: ClipOptions
    name: str | None


def resolve_options(options: ClipOptions) -> Chosen:
    """Return options completed with defaults of the target; raise ParameterError if invalid."""
    unknown = options.keys() - ClipOptions.__annotations__.keys()
    if unknown:
        raise TypeError(f"split() got an unexpected keyword argument {min(unknown)!r}")
    target_name, loops = options.get("target"), options.get("loops", False)
    if target_name is not None and not is_one_of(target_name, TARGETS):
        raise ParameterError(f"target is {target_name!r:.60}: choose from {', '.join(TARGETS)}")
    target = (
        Target(None, "keep", False, False, None) if target_name is None else TARGETS[target_name]
    )
    shape = Shape(
        loops,
        options.get("best"),
        options.get("root_motion") or target.root_motion,
        options.get("straight", False),
        options.get("mirror", False),
        options.get("close", False) or (target.close and bool(loops)),
        options.get("fps"),
    )
    name = target.name if options.get("name") is None else options.get("name")
    if name is not None:
        check_template(name)
    for path in (options.get("sheet"), options.get("motion_matching")):
        if path is not None:
            check_path(path, "split")
    suffix = target.format if options.get("format") is None else options.get("format")
    writer = _find_format(suffix)
    several = writer is not None and writer.write_animations is not None and not target.separate
    return Chosen(shape, suffix, writer if several else None, options, name)


def _find_format(suffix: str | None) -> Format | None:
    """Return the format of a suffix; raise ParameterError if it cannot write motions."""
    if suffix is None:
        return None
    writer = find_writer(f".{suffix}")
    if writer is None:
        suffixes = sorted(s for each in supported_formats() if each.write for s in each.suffixes)
        names = ", ".join(name.removeprefix(".") for name in suffixes)
        raise ParameterError(f"format is {suffix!r:.60}: motions are written as {names}")
    return writer
