"""Which joints of a scene are a character's, and which of its animations is read.

A scene is a tree of nodes. Bones are those that the file calls so; where it calls none so,
those that are animated and carry no geometry. What lies between two bones belongs to the
skeleton, too, and so do nodes below a bone that carry nothing: they are the ends of limbs.
What stands above the topmost bone carries the whole body, and is part of its root.

Each topmost bone is a skeleton of its own. Those with less than a quarter of the joints of the
largest, and those that stand still while others move, are props.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass

from kineme._util.checks import join_names, make_unique
from kineme.formats.files import FileContent
from kineme.formats.persons import choose_person
from kineme.recordings import Note

SMALLEST = 0.25
"""Share of the joints of the largest skeleton below which another one is a prop."""

_END = re.compile(
    r"(?:(?:^|[\s_.:-])(?i:end|nub|tip)|(?<=[a-z\d])(?:End|Nub|Tip))"
    r"(?:[\s_.-]?(?i:site|effector))?[\s_.-]?\d*$"
)


@dataclass(frozen=True)
class SceneNode:
    """One node of a scene.

    Parameters
    ----------
    name : str
    parent : int
        -1 for none; parents come before their children.
    bone : bool
        Whether the file calls it a bone.
    geometry : bool
        Whether it carries a mesh, a camera or a light.
    animated : bool
        Whether the animation that is read moves it.
    end : bool
        Whether it ends a limb, if it is a leaf without rotations.
    """

    name: str
    parent: int
    bone: bool
    geometry: bool
    animated: bool
    end: bool = False


@dataclass(frozen=True)
class Character:
    """A skeleton in a scene: its nodes, parents first, so that the root is the first one.

    The notes say what was left out; the name, who it is of the people who could have been.
    """

    joints: list[int]
    notes: list[str]
    name: str
    people: Sequence[str]


def find_character(
    content: FileContent, nodes: Sequence[SceneNode], person: str | None
) -> Character:
    """Return the only skeleton that moves, or the one of the person wanted."""
    skeletons = _find_skeletons(nodes)
    if not skeletons:
        raise content.error(
            "holds no skeleton, neither bones nor animated nodes: export the armature with its "
            "animation"
        )
    largest = max(map(len, skeletons))
    # Small skeletons are props.
    bodies = [joints for joints in skeletons if len(joints) >= SMALLEST * largest]
    moving = [joints for joints in bodies if any(nodes[j].animated for j in joints)]
    bodies = moving or bodies
    people = dict(zip(_name_bodies(nodes, bodies), bodies, strict=True))
    # A person may also be named by number.
    numbers = {str(number): name for number, name in enumerate(people)}
    name = person if person in people else numbers.get(person or "", person)
    shown = [f"{name} ({len(joints)} joints)" for name, joints in people.items()]
    name = choose_person(content.path, people, name, "characters", shown)
    notes = [f"person {name} of {len(people)}"] if len(people) > 1 else []
    props = _find_props(nodes, list(people.values()))
    if props:
        notes.append(f"left out as props: {join_names([nodes[j].name for j in props])}")
    large = [nodes[j].name for j, moved in props.items() if moved >= max(SMALLEST * largest, 2)]
    if large:
        remark = (
            f"perhaps another character, left out since its nodes are no bones: {join_names(large)}"
            "; bind a skin to them, or export it alone"
        )
        notes.append(Note(remark, "warning"))
    return Character(people[name], notes, name, [*people])


def list_ancestors(nodes: Sequence[SceneNode], node: int) -> list[int]:
    """Return the nodes that carry one, from its parent up."""
    found = []
    while (node := nodes[node].parent) >= 0:
        found.append(node)
    return found


def find_moving_takes(moved: Sequence[set[int]], bones: set[int]) -> list[int]:
    """Return the animations that move a bone, by what each moves.

    Anything where there are no bones.
    """
    return [number for number, nodes in enumerate(moved) if (nodes & bones if bones else nodes)]


def choose_take(
    content: FileContent, names: Sequence[str], lively: Sequence[int], name: str | None
) -> tuple[int, list[str]]:
    """Return the number of the animation that is read, by name or number, and what to say of it.

    Where none is wanted, it is the first of the lively ones, which move a skeleton.
    """
    if name is not None:
        number = _find_take(names, name)
        if number is None:
            shown = join_names(names) or "none"
            raise content.error(f"there is no take {name!r}: choose from {shown}")
        return number, [f"take {names[number]} of {len(names)}"]
    if not lively:
        raise content.error(
            "holds no animation of its skeleton: export it with its animation, or baked"
        )
    first = lively[0]
    if len(lively) == 1:
        return first, [f"take {names[first]}"]
    others = join_names([names[number] for number in lively[1:]])
    remark = (
        f"{len(lively)} takes are in it and {names[first]!r} is read: take= (--take) reads "
        f"another, of {others}"
    )
    return first, [Note(remark, "warning")]


def _find_take(names: Sequence[str], name: str) -> int | None:
    """Return number of a take, by its name, what follows the armature's in it, or its number."""
    if name in names:
        return names.index(name)
    # Blender writes armature and action as `armature|action`.
    short = [name.rpartition("|")[2] for name in names]
    if short.count(name) == 1:
        return short.index(name)
    if name.isdecimal() and len(name) < 10 and int(name) < len(names):
        return int(name)
    return None


def find_scene_joints(
    parents: Sequence[int], bones: Sequence[bool], free: Sequence[bool]
) -> list[bool]:
    """Return which nodes are joints: bones, what is between two of them, and free ends below.

    A node is free if it carries no geometry.
    """
    joints = list(bones)
    above = [False] * len(parents)  # a bone is somewhere above
    for node, parent in enumerate(parents):
        above[node] = parent >= 0 and (above[parent] or bones[parent])
    holds_bone, bare = list(bones), list(free)
    # Children before parents.
    for node in range(len(parents) - 1, -1, -1):
        joints[node] = bones[node] or (above[node] and (holds_bone[node] or bare[node]))
        if (parent := parents[node]) >= 0:
            holds_bone[parent] |= holds_bone[node]
            bare[parent] &= bare[node]
    for node, parent in enumerate(parents):  # what hangs on what was left out
        joints[node] &= bones[node] or (parent >= 0 and joints[parent])
    return joints


def is_end(name: str) -> bool:
    """Return whether a leaf of this name ends a limb, as ``Head_end`` and ``HeadNub`` do."""
    return _END.search(name) is not None


def _find_skeletons(nodes: Sequence[SceneNode]) -> list[list[int]]:
    """Return the joints of each, parents first."""
    bones = [node.bone for node in nodes]
    if not any(bones):
        bones = [node.animated and not node.geometry for node in nodes]
    parents = [node.parent for node in nodes]
    joints = find_scene_joints(parents, bones, [not node.geometry for node in nodes])
    found: list[list[int]] = []
    home: dict[int, list[int]] = {}
    for j, joint in enumerate(joints):
        if not joint:
            continue
        if nodes[j].parent in home:
            home[j] = home[nodes[j].parent]
        else:
            home[j] = []
            found.append(home[j])
        home[j].append(j)
    return found


def _name_bodies(nodes: Sequence[SceneNode], bodies: list[list[int]]) -> list[str]:
    """What each body is called: as what carries it alone, by its namespace, or as its root."""
    carriers = [nodes[joints[0]].parent for joints in bodies]
    names = []
    for joints, carrier in zip(bodies, carriers, strict=True):
        root = nodes[joints[0]].name
        space = root.rpartition(":")[0]
        alone = carrier >= 0 and carriers.count(carrier) == 1
        names.append(nodes[carrier].name if alone else space or root)
    return make_unique(names)


def _find_props(nodes: Sequence[SceneNode], bodies: list[list[int]]) -> dict[int, int]:
    """Return the topmost nodes that are animated or bones, but neither in a body nor above one.

    With each goes how many animated nodes without geometry and bone there are from it down.
    """
    body = {joint for joints in bodies for joint in joints}
    body.update(above for joints in bodies for above in list_ancestors(nodes, joints[0]))
    moved: dict[int, int] = {}
    tops: dict[int, int] = {}
    for number, node in enumerate(nodes):
        if number in body:
            continue
        if node.parent in tops:
            tops[number] = tops[node.parent]
        elif node.bone or node.animated:
            tops[number] = number
        if number in tops:
            alive = node.animated and not (node.geometry or node.bone)
            moved[tops[number]] = moved.get(tops[number], 0) + alive
    return moved
