"""Options for shaping, naming and writing clips, and presets for target programs.

Clips and their files are named ``RECORDING_NUMBER_TEXT``. ``NUMBER`` has at least four digits and
is unique within a run; it continues over the recordings. Segments left out by ``best`` keep their
numbers, so that names do not depend on this option.

Words of the text that look like such a number get the prefix ``n``. So the last ``_NUMBER_`` of a
name is its number, and names are unique even if case is ignored.

A template such as ``{take}_{label}_{n:02}`` overrides this; then duplicate names are an error.

Names of clips survive import in Blender, Unreal, Unity, Godot and three.js: ASCII letters, digits
and ``_``, starting with a letter, at most 63 characters. File names keep other letters.
"""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Container, Mapping
from dataclasses import dataclass
from itertools import chain, count
from os import PathLike
from string import Formatter
from typing import TypedDict

from kineme._util.checks import check_path, is_one_of
from kineme.clips import RootMotionMode, TargetName
from kineme.clips.shaping import Shape
from kineme.errors import ParameterError
from kineme.formats.registry import Format, find_writer, list_motion_suffixes

LONGEST = 63
"""Longest name in characters, the limit of Blender."""
LONGEST_TEXT = 24
"""Longest label in a name, in characters."""
LONGEST_IN_FILE = 80
"""Longest recording name or label in a file name, in bytes."""
FIELDS = ("name", "take", "label", "n", "cluster", "level", "direction", "loop")
"""Fields of templates; ``n`` and ``cluster`` are numbers, the others texts."""


def make_clip_name(stem: str, number: int, text: str) -> str:
    """Return the name of a clip from recording, number and label, in portable characters.

    Examples
    --------
    >>> make_clip_name("Take 1.final", 3, "Äpfel pflücken")
    'Take_1_final_0003_Apfel_pflucken'
    >>> make_clip_name("86_01", 12, "walk 2024")
    'clip_86_01_0012_walk_n2024'
    """
    middle = f"_{number:04d}_"
    # A label may have no portable characters.
    label = _protect_numbers(_to_ascii(text))[:LONGEST_TEXT].strip("_") or "clip"
    # Shorten the recording's name, since number and label identify the clip.
    first = _begin_with_letter(_to_ascii(stem))[: LONGEST - len(middle) - len(label)].rstrip("_")
    return f"{first}{middle}{label}"


def make_file_name(stem: str, number: int, text: str) -> str:
    """Return the file name of a clip without suffix, with letters of all scripts.

    Examples
    --------
    >>> make_file_name("Take 1", 3, "Äpfel/Birnen")
    'Take_1_0003_Äpfel_Birnen'
    """
    return f"{clean_name(stem)}_{number:04d}_{clean_name(_protect_numbers(_replace_special(text)))}"


def make_unique_name(stem: str, first: int, others: Container[str]) -> str:
    """Return a unique name for the file with all clips of a recording.

    If the recording's name is among ``others`` (lower case), append a number from ``first`` on.

    Examples
    --------
    >>> make_unique_name("Take 1", 12, {"take_1"})
    'Take_1_0012'
    """
    names = chain(
        [clean_name(stem)], (f"{clean_name(stem)}_{number:04d}" for number in count(first))
    )
    # Compare without case, since file systems may ignore it.
    return next(name for name in names if name.casefold() not in others)


def check_template(template: str) -> None:
    """Raise ParameterError if a template has unknown fields or cannot be filled in."""
    try:
        fields = [field for _, field, _, _ in Formatter().parse(template) if field is not None]
        unknown = [field for field in fields if field not in FIELDS]
        if not unknown:
            fill_template(template, dict.fromkeys(FIELDS, "") | {"n": 0, "cluster": 0})
    except (ValueError, AttributeError, TypeError) as error:
        raise ParameterError(f"name is {template!r:.60}, which is not valid: {error}") from error
    if unknown or not fields:
        names = ", ".join(f"{{{field}}}" for field in FIELDS)
        raise ParameterError(f"name is {template!r:.60}: give a text with some of {names} in it")


def fill_template(template: str, fields: Mapping[str, object]) -> tuple[str, str]:
    """Return the names of a clip and of its file, without suffix, from a template.

    Examples
    --------
    >>> fill_template("{take}@{label}_{n:02}", {"take": "Äpfel", "label": "walk", "n": 3})
    ('Apfel_walk_03', 'Äpfel@walk_03')
    """
    filled = template.format_map(fields)
    # Empty fields must not leave double underscores.
    file = re.sub(r"_{2,}", "_", _replace_special(filled, "@")).strip("_")
    name = _begin_with_letter(_to_ascii(filled))
    return name[:LONGEST].rstrip("_"), clean_name(file, "@") or "clip"


def clean_name(text: str, more: str = "") -> str:
    """Replace all but letters, digits, ``_``, ``-`` and ``more`` by ``_``; limit the length."""
    # Cut in bytes; decoding drops a partial letter at the end.
    cleaned = _replace_special(text, more).encode(errors="replace")[:LONGEST_IN_FILE]
    return cleaned.decode(errors="ignore")


def _replace_special(text: str, more: str = "") -> str:
    allowed = f"-_{more}"
    return "".join(letter if letter.isalnum() or letter in allowed else "_" for letter in text)


def _begin_with_letter(name: str) -> str:
    return name if name[:1].isalpha() else f"clip_{name}".rstrip("_")


def _protect_numbers(text: str) -> str:
    """Prefix words of four or more digits with ``n``."""
    return re.sub(r"(?<![^_])([0-9]{4,})(?![^_])", r"n\1", text)


def _to_ascii(text: str) -> str:
    """Return ASCII letters and digits without accents, with single ``_`` for everything else."""
    # NFKD separates accents from letters, which are then dropped; ß is not decomposed.
    decomposed = unicodedata.normalize("NFKD", text.replace("ß", "ss"))
    unaccented = "".join(letter for letter in decomposed if not unicodedata.combining(letter))
    words = "".join(each if each.isascii() and each.isalnum() else " " for each in unaccented)
    return "_".join(words.split())


@dataclass(frozen=True)
class Target:
    """Default options for a target program; explicit options override them.

    FBX is in centimetres with y up, GLB in metres with y up: programs convert both to their own
    axes and unit on import.

    Parameters
    ----------
    format : str, optional
        Suffix of the files in a folder.
    root_motion : {"keep", "extract", "in-place"}
    close : bool
        Whether a loop ends with its first pose.
    separate : bool
        Whether each clip has its own file, even if the format can hold several.
    name : str, optional
        Template of names.
    """

    format: str | None = None
    root_motion: RootMotionMode = "keep"
    close: bool = False
    separate: bool = False
    name: str | None = None


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
    """Options of clips, completed with defaults of the target program."""

    shape: Shape
    suffix: str | None
    """Suffix of files, without the dot."""
    format: Format | None
    """Format with one file for all clips of a recording; None if each clip has its own."""
    given: ClipOptions
    """Options as passed by the caller."""
    name: str | None
    """Template of names."""


def resolve_options(options: ClipOptions) -> Chosen:
    """Return options completed with defaults of the target; raise ParameterError if invalid."""
    unknown = options.keys() - ClipOptions.__annotations__.keys()
    if unknown:
        raise TypeError(f"split() got an unexpected keyword argument {min(unknown)!r}")
    target_name, loops = options.get("target"), options.get("loops", False)
    if target_name is not None and not is_one_of(target_name, TARGETS):
        raise ParameterError(f"target is {target_name!r:.60}: choose from {', '.join(TARGETS)}")
    target = Target() if target_name is None else TARGETS[target_name]
    shape = Shape(
        loops,
        options.get("best"),
        root_motion=options.get("root_motion") or target.root_motion,
        straight=options.get("straight", False),
        mirror=options.get("mirror", False),
        close=options.get("close", False) or (target.close and bool(loops)),
        fps=options.get("fps"),
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
        names = ", ".join(name.removeprefix(".") for name in list_motion_suffixes())
        raise ParameterError(f"format is {suffix!r:.60}: motions are written as {names}")
    return writer
