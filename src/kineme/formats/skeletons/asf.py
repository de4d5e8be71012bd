"""Read ASF: the skeleton part of the Acclaim format.

Lengths are in ``1 / length`` inches, with ``length`` from ``:units`` (CMU: 0.45, so one unit is
5.64 cm); angles are in degrees or radians. A bone extends from its parent's tip along ``direction``
for ``length``. ``axis`` rotates the frame of its rotations (angles about x, y and z, applied in the
order of its letters). ``dof`` lists its values in the motion file. Rotations are about fixed axes,
the first one applied first: with ``axis ... XYZ`` the frame is C = Rz Ry Rx.

A bone becomes a joint of the same name at the bone's start; its offset is the parent bone. The tip
of a leaf bone becomes the end site ``NAME_end``. The tip of ``ltibia`` (the ankle) is thus the
joint ``lfoot``.

Source: Acclaim Advanced Technologies, ASF/AMC definition; Vicon, "Acclaim Format - ASF line
details", for the meaning of ``order``, ``axis``, ``dof``.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from math import radians

import numpy as np

from kineme._util import rotations as rot
from kineme._util.arrays import Floats
from kineme.formats.files import FileContent, parse_numbers
from kineme.formats.skeletons.placing import order_depth_first
from kineme.formats.units import INCH
from kineme.recordings import Skeleton

Line = tuple[int, list[str]]
ROOT = "root"
_BLANKS = str.maketrans("(),", "   ")


@dataclass
class Figure:
    """Content of an ASF file.

    ``bones`` start with the root, parents first; lengths are in the file's unit of ``scale``
    metres; ``angle_unit`` is radians per unit of angle.
    """

    bones: dict[str, Bone]
    skeleton: Skeleton
    scale: float
    angle_unit: float


@dataclass
class Bone:
    """A bone in the file's length unit and radians."""

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


def read_asf(content: FileContent) -> Figure:
    """Return the figure in an ASF file."""
    sections = _split_sections(content)
    for needed in ("root", "bonedata", "hierarchy"):
        if needed not in sections:
            raise content.error(f"no :{needed} section, so this is not a complete ASF file")
    units = {words[0].lower(): (n, words[1:]) for n, words in sections.get("units", [])}
    angle = "".join(units.get("angle", (0, ["deg"]))[1][:1]).lower()
    angle_unit = 1.0 if angle.startswith("rad") else radians(1)
    scale = INCH  # `length` divides it
    if "length" in units:
        line, words = units["length"]
        scale /= read_values(content, line, words, 1, positive=True)[0]
    bones = {ROOT: read_root(content, sections["root"], angle_unit)}
    for block in _split_blocks(content, sections["bonedata"]):
        bone = read_bone(content, block, angle_unit)
        if bone.name in bones:
            raise content.error(f"a second bone is called {bone.name!r}", bone.line)
        bones[bone.name] = bone
    children = _parse_children(content, sections["hierarchy"], bones)
    order = list(order_depth_first([ROOT], children.__getitem__))
    ordered = {name: bones[name] for name, _ in order}
    # Bones in a cycle are never reached from the root.
    if lost := [name for name in bones if name not in ordered]:
        raise content.error(
            f"bone {lost[0]!r} is not connected to the root: its line in :hierarchy is "
            "missing or circular"
        )
    return Figure(ordered, _build_skeleton(order, children, bones), scale, angle_unit)


def _split_sections(content: FileContent) -> dict[str, list[Line]]:
    """Return the lines of each section as words, without comments and blank lines."""
    sections: dict[str, list[Line]] = {}
    current: list[Line] = []
    for number, line in enumerate(content.text.splitlines(), 1):
        # Parentheses and commas of `limits` count as blanks.
        words = line.split("#")[0].translate(_BLANKS).split()
        if not words:
            continue
        if words[0].startswith(":"):
            current = sections.setdefault(words[0][1:].lower(), [])
            words = words[1:]
        if words:
            current.append((number, words))
    return sections


def read_root(content: FileContent, lines: list[Line], angle_unit: float) -> Bone:
    """Return the root from the lines of its section."""
    entries = {words[0].lower(): (n, words[1:]) for n, words in lines}
    root = Bone(ROOT, dof=("tx", "ty", "tz", "rx", "ry", "rz"))
    if "order" in entries:
        root.dof = _parse_dof(content, *entries["order"])
    if "position" in entries:
        root.position = np.array(read_values(content, *entries["position"], 3))
    if "orientation" in entries:
        line, words = entries["orientation"]
        letters = entries.get("axis", (0, ["xyz"]))[1]
        root.frame = _parse_frame(content, line, words[:3] + letters, angle_unit)
    return root


def _split_blocks(content: FileContent, lines: list[Line]) -> Iterator[list[Line]]:
    """Yield the lines between each ``begin`` and ``end``."""
    block: list[Line] | None = None
    for number, words in lines:
        key = words[0].lower()
        if key == "begin":
            if block is not None:
                raise content.error("'begin' inside a bone: an 'end' is missing", number)
            block = []
        elif block is None:
            raise content.error(f"{words[0]!r} is outside 'begin' and 'end'", number)
        elif key == "end":
            if block:
                yield block
            block = None
        else:
            block.append((number, words))
    if block is not None:
        raise content.error("the last bone has no 'end': the file is truncated", lines[-1][0])


def read_bone(content: FileContent, block: list[Line], angle_unit: float) -> Bone:
    """Return a bone from the lines between ``begin`` and ``end``."""
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
        bone.frame = _parse_frame(content, *entries["axis"], angle_unit)
    if "dof" in entries:
        bone.dof = _parse_dof(content, *entries["dof"])
    return bone


def _parse_frame(content: FileContent, line: int, words: list[str], angle_unit: float) -> Floats:
    letters = (words[3] if len(words) > 3 else "xyz").lower()
    if sorted(letters) != ["x", "y", "z"]:
        raise content.error(f"axis order {letters!r} is not made of X, Y and Z", line)
    angles = dict(zip("xyz", read_values(content, line, words[:3], 3), strict=True))
    # The first letter is applied first, so it is the last factor of the product.
    product_order = letters[::-1]
    turns = np.array([[angle_unit * angles[letter] for letter in product_order]])
    frame: Floats = rot.from_euler(turns, product_order)[0]
    return frame


def _parse_dof(content: FileContent, line: int, words: list[str]) -> tuple[str, ...]:
    dof = tuple(word.lower() for word in words)
    for word in dof:
        if word not in ("tx", "ty", "tz", "rx", "ry", "rz"):
            raise content.error(f"degree of freedom {word!r} is not one of tx ty tz rx ry rz", line)
    if len(set(dof)) != len(dof):
        raise content.error("a degree of freedom is listed twice", line)
    return dof


def read_values(
    content: FileContent, line: int, words: list[str], count: int, *, positive: bool = False
) -> list[float]:
    """Return ``count`` numbers from the words of a line; raise an error that states the line."""
    try:
        values = parse_numbers(words)
    except ValueError as error:
        raise content.error(str(error), line) from None
    if len(values) != count or (positive and min(values) <= 0):
        kind = "positive " if positive else ""
        raise content.error(f"{count} {kind}number(s) expected, found {' '.join(words)!r}", line)
    return values


def _parse_children(
    content: FileContent, lines: list[Line], bones: dict[str, Bone]
) -> dict[str, list[str]]:
    """Return the children of each bone from the section ``:hierarchy``."""
    children: dict[str, list[str]] = {name: [] for name in bones}
    placed = {ROOT}
    for number, (parent, *names) in lines:
        if not names and parent.lower() in ("begin", "end"):
            continue
        for name in (parent, *names):
            if name not in bones:
                raise content.error(f"bone {name!r} is not in :bonedata", number)
        for name in names:
            if name in placed:
                raise content.error(f"bone {name!r} has a second parent, {parent!r}", number)
            placed.add(name)
            children[parent].append(name)
    return children


def _build_skeleton(
    order: list[tuple[str, int]], children: dict[str, list[str]], bones: dict[str, Bone]
) -> Skeleton:
    """Return a joint at the start of each bone, and an end site at the tip of each leaf.

    ``order`` holds the bones, parents first, with the index of each one's parent.
    """
    names: list[str] = []
    parents: list[int] = []
    offsets: list[Floats] = []
    ends: list[int] = []
    joints: list[int] = []  # of the bones
    for name, parent in order:
        joints.append(len(names))
        names.append(name)
        parents.append(-1 if parent < 0 else joints[parent])
        offsets.append(np.zeros(3) if parent < 0 else bones[order[parent][0]].tip)
        # A leaf bone of non-zero length gets an end site.
        if not children[name] and bones[name].tip.any():
            ends.append(len(names))
            names.append(f"{name}_end")
            parents.append(joints[-1])
            offsets.append(bones[name].tip)
    return Skeleton(tuple(names), tuple(parents), np.array(offsets), frozenset(ends))
