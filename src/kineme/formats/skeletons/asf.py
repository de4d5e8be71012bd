"""ASF: the skeleton half of the Acclaim format.

Lengths are in ``1 / length`` inches, where ``length`` stands under ``:units``
(CMU: 0.45, so one unit is 5.64 cm); angles in degrees or radians. A bone runs
from its parent's tip along ``direction`` for ``length``; ``axis`` turns the
frame in which its rotations are counted (by x, y and z degrees in the order of
its letters), ``dof`` names the values it has in the motion file. Rotations are
about fixed axes, the first named first: with ``axis ... XYZ`` the frame is
C = Rz Ry Rx.

A bone becomes a joint of the same name at the bone's start; its offset is the
parent bone, and the tip of a leaf bone becomes the end site ``NAME_end``. The
tip of ``ltibia`` (the ankle) is thus the joint ``lfoot``.

Source: Acclaim Advanced Technologies, ASF/AMC definition; Vicon, "Acclaim
Format - ASF line details", for the meaning of ``order``, ``axis``, ``dof``.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from math import radians

import numpy as np

from kineme.formats.files import FileContent
from kineme.formats.skeletons.asf_bones import (
    ROOT,
    Bone,
    Floats,
    Line,
    read_bone,
    read_root,
    read_values,
)
from kineme.formats.units import INCH
from kineme.recordings import Skeleton

_BLANKS = str.maketrans("(),", "   ")


@dataclass
class Figure:
    """All an AMC needs to know of its ASF.

    ``bones`` run from the root, parents first; ``skeleton`` is in metres;
    ``scale`` is metres per file unit; ``turn`` radians per unit of angle.
    """

    bones: dict[str, Bone]
    skeleton: Skeleton
    scale: float
    turn: float


def read_asf(content: FileContent, scale: float | None = None) -> Figure:
    """The figure in an ASF file; ``scale`` overrides its metres per unit."""
    sections = _sections(content)
    for needed in ("root", "bonedata", "hierarchy"):
        if needed not in sections:
            raise content.error(f"no :{needed} section, so this is not a whole ASF file")
    units = {words[0].lower(): (n, words[1:]) for n, words in sections.get("units", [])}
    turn = 1.0 if units.get("angle", (0, ["deg"]))[1][:1] == ["rad"] else radians(1)
    if scale is None:
        scale = INCH
        if "length" in units:
            line, words = units["length"]
            scale /= read_values(content, line, words, 1, positive=True)[0]
    bones = {ROOT: read_root(content, sections["root"], turn)}
    for block in _blocks(content, sections["bonedata"]):
        bone = read_bone(content, block, turn)
        if bone.name in bones:
            raise content.error(f"a second bone is called {bone.name!r}", bone.line)
        bones[bone.name] = bone
    parents = _parents(content, sections["hierarchy"], bones)
    order = _from_root(content, parents, bones)
    return Figure(
        {name: bones[name] for name in order}, _skeleton(order, parents, bones, scale), scale, turn
    )


def _skeleton(
    order: list[str], parents: dict[str, str], bones: dict[str, Bone], scale: float
) -> Skeleton:
    names: list[str] = []
    at: dict[str, int] = {}
    above: list[int] = []
    offsets: list[Floats] = []
    ends = []
    inner = set(parents.values())
    for name in order:
        parent = parents.get(name)
        above.append(-1 if parent is None else at[parent])
        offsets.append(np.zeros(3) if parent is None else bones[parent].tip)
        at[name] = len(names)
        names.append(name)
        if name not in inner and bones[name].tip.any():
            above.append(len(names) - 1)
            offsets.append(bones[name].tip)
            ends.append(len(names))
            names.append(f"{name}_end")
    return Skeleton(tuple(names), tuple(above), scale * np.array(offsets), frozenset(ends))


def _sections(content: FileContent) -> dict[str, list[Line]]:
    """The lines of each section as words, comments and blank lines left out."""
    sections: dict[str, list[Line]] = {}
    current: list[Line] = []
    for number, line in enumerate(content.text.splitlines(), 1):
        words = line.split("#")[0].translate(_BLANKS).split()
        if not words:
            continue
        if words[0].startswith(":"):
            current = sections.setdefault(words[0][1:].lower(), [])
            words = words[1:]
        if words:
            current.append((number, words))
    return sections


def _blocks(content: FileContent, lines: list[Line]) -> Iterator[list[Line]]:
    """The lines between each ``begin`` and ``end``."""
    block: list[Line] | None = None
    for number, words in lines:
        key = words[0].lower()
        if key == "begin":
            if block is not None:
                raise content.error("'begin' inside a bone: an 'end' is missing", number)
            block = []
        elif block is None:
            raise content.error(f"{words[0]!r} stands outside 'begin' and 'end'", number)
        elif key == "end":
            if block:
                yield block
            block = None
        else:
            block.append((number, words))
    if block is not None:
        raise content.error("the last bone has no 'end': the file is truncated", lines[-1][0])


def _parents(content: FileContent, lines: list[Line], bones: dict[str, Bone]) -> dict[str, str]:
    parents: dict[str, str] = {}
    for number, (parent, *children) in lines:
        if not children and parent.lower() in ("begin", "end"):
            continue
        for name in (parent, *children):
            if name not in bones:
                raise content.error(f"bone {name!r} is not in :bonedata", number)
        for name in children:
            if name in parents or name == ROOT:
                raise content.error(f"bone {name!r} has a second parent, {parent!r}", number)
            parents[name] = parent
    return parents


def _from_root(content: FileContent, parents: dict[str, str], bones: dict[str, Bone]) -> list[str]:
    """Bones depth first, siblings in the order of the hierarchy."""
    children: dict[str, list[str]] = {name: [] for name in bones}
    for name, parent in parents.items():
        children[parent].append(name)
    order, waiting = [], [ROOT]
    while waiting:
        order.append(waiting.pop())
        waiting.extend(reversed(children[order[-1]]))
    reached = set(order)
    lost = [name for name in bones if name not in reached]
    if lost:
        raise content.error(
            f"bone {lost[0]!r} does not hang on the root: its line in :hierarchy is missing "
            "or runs in a circle"
        )
    return order
