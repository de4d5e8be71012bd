"""Bones of an ASF: what each line of one says, in the unit and frame of the file."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from kineme import _rotations as rot
from kineme.formats.files import FileContent, numbers

Floats = NDArray[np.float64]
Line = tuple[int, list[str]]

ROOT = "root"


@dataclass
class Bone:
    """A bone as its file has it, in the file's length unit and in radians."""

    name: str
    direction: Floats = field(default_factory=lambda: np.zeros(3))
    length: float = 0.0
    frame: Floats = field(default_factory=lambda: rot.IDENTITY)
    dof: tuple[str, ...] = ()
    position: Floats = field(default_factory=lambda: np.zeros(3))
    line: int = 0

    @property
    def tip(self) -> Floats:
        return self.direction * self.length


def read_bone(content: FileContent, block: list[Line], turn: float) -> Bone:
    """A bone from its lines, ``begin`` and ``end`` apart; ``turn``: radians per unit of angle."""
    entries = {words[0].lower(): (n, words[1:]) for n, words in block}
    first = block[0][0]
    for needed in ("name", "direction", "length"):
        if needed not in entries:
            raise content.error(f"a bone without {needed!r}", first)
    line, words = entries["name"]
    if len(words) != 1:
        raise content.error("a bone's name must be one word", line)
    bone = Bone(words[0], line=line)
    bone.direction = np.array(read_values(content, *entries["direction"], 3))
    bone.length = read_values(content, *entries["length"], 1)[0]
    if "axis" in entries:
        bone.frame = _frame(content, *entries["axis"], turn)
    if "dof" in entries:
        bone.dof = _dof(content, *entries["dof"])
    return bone


def read_root(content: FileContent, lines: list[Line], turn: float) -> Bone:
    """The root from the lines of its section."""
    entries = {words[0].lower(): (n, words[1:]) for n, words in lines}
    root = Bone(ROOT, dof=("tx", "ty", "tz", "rx", "ry", "rz"))
    if "order" in entries:
        root.dof = _dof(content, *entries["order"])
    if "position" in entries:
        root.position = np.array(read_values(content, *entries["position"], 3))
    if "orientation" in entries:
        line, words = entries["orientation"]
        letters = entries.get("axis", (0, ["xyz"]))[1]
        root.frame = _frame(content, line, words[:3] + letters, turn)
    return root


def _frame(content: FileContent, line: int, words: list[str], turn: float) -> Floats:
    letters = (words[3] if len(words) > 3 else "xyz").lower()
    if sorted(letters) != ["x", "y", "z"]:
        raise content.error(f"axis order {letters!r} is not made of X, Y and Z", line)
    angles = dict(zip("xyz", read_values(content, line, words[:3], 3), strict=True))
    inner_first = letters[::-1]
    turns = np.array([[turn * angles[letter] for letter in inner_first]])
    frame: Floats = rot.from_euler(turns, inner_first)[0]
    return frame


def _dof(content: FileContent, line: int, words: list[str]) -> tuple[str, ...]:
    dof = tuple(word.lower() for word in words)
    for word in dof:
        if word not in ("tx", "ty", "tz", "rx", "ry", "rz"):
            raise content.error(f"degree of freedom {word!r} is not one of tx ty tz rx ry rz", line)
    if len(set(dof)) != len(dof):
        raise content.error("a degree of freedom is named twice", line)
    return dof


def read_values(
    content: FileContent, line: int, words: list[str], count: int, *, positive: bool = False
) -> list[float]:
    """So many numbers from the words of a line; an error that names the line where they are not."""
    try:
        values = numbers(words)
    except ValueError as error:
        raise content.error(str(error), line) from None
    if len(values) != count or (positive and min(values) <= 0):
        kind = "positive " if positive else ""
        raise content.error(f"{count} {kind}number(s) expected, found {' '.join(words)!r}", line)
    return values
