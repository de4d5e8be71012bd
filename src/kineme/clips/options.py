"""How clips are shaped, named and written: the options, and what engines want of them."""

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
    """What a program wants of clips; options that are given come first.

    FBX is in centimetres with y up, GLB in metres with y up: the program turns and scales both to
    its own axes and unit when it imports them.

    Parameters
    ----------
    format : str
        Suffix of files in a folder.
    root_motion : {"keep", "extract", "in-place"}
    close : bool
        Whether the last key of a loop is to be its first pose again.
    separate : bool
        Whether each clip has a file of its own, where one could hold several.
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
    # Animations whose name ends in "loop" go round.
    "godot": Target("glb", "extract", True, False, "{name}_{label}_{n:02}_{loop}"),
}


class ClipOptions(TypedDict, total=False):
    """Options of `kineme.clips.split.split`, which says what they are."""

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
    """Options of clips, completed by those of the target program.

    Parameters
    ----------
    shape : Shape
    suffix : str, optional
        Of files, without a dot.
    format : Format, optional
        What is written with that suffix, one file for all clips of a recording; none where each
        has its own.
    given : ClipOptions
        The options as they were given.
    name : str, optional
        Template of names.
    """

    shape: Shape
    suffix: str | None
    format: Format | None
    given: ClipOptions
    name: str | None


def resolve_options(options: ClipOptions) -> Chosen:
    """Return the options, completed by those of the target; ParameterError for a bad one."""
    unknown = options.keys() - ClipOptions.__annotations__.keys()
    if unknown:
        raise TypeError(f"split() got an unexpected keyword argument {min(unknown)!r}")
    named, loops = options.get("target"), options.get("loops", False)
    if named is not None and not is_one_of(named, TARGETS):
        raise ParameterError(f"target is {named!r:.60}: choose from {', '.join(TARGETS)}")
    target = Target(None, "keep", False, False, None) if named is None else TARGETS[named]
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
    found = _find_format(suffix)
    several = found is not None and found.write_animations is not None and not target.separate
    return Chosen(shape, suffix, found if several else None, options, name)


def _find_format(suffix: str | None) -> Format | None:
    """Return the format of a suffix; ParameterError where no motions are written in it."""
    if suffix is None:
        return None
    found = find_writer(f".{suffix}")
    if found is None:
        suffixes = sorted(s for each in supported_formats() if each.write for s in each.suffixes)
        names = ", ".join(name.removeprefix(".") for name in suffixes)
        raise ParameterError(f"format is {suffix!r:.60}: motions are written as {names}")
    return found
