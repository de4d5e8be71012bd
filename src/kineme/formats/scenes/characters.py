"""Find the joints of a character in a scene, and choose and check its animations.

A scene is a tree of nodes. Bones are the nodes that the file marks as such, or if there are none,
animated nodes without geometry. Nodes between two bones belong to the skeleton, too, and so do
childless nodes without geometry below a bone: they are the ends of limbs. Nodes above the topmost
bone carry the whole body and are part of its root.

Each topmost bone starts a skeleton. Skeletons with less than a quarter of the joints of the largest
one, and those that stand still while others move, are props.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from kineme._util.checks import join_names, make_unique
from kineme.errors import WriteError
from kineme.formats.files import FileContent, require_rotations
from kineme.formats.options import choose_person
from kineme.formats.plausibility import warn_of_gaps
from kineme.formats.skeletons.placing import RIGID
from kineme.recordings import Motion, Note, Skeleton

MIN_SIZE_RATIO = 0.25
"""Fraction of the joints of the largest skeleton below which another one is a prop."""

_END = re.compile(
    r"(?:(?:^|[\s_.:-])(?i:end|nub|tip)|(?<=[a-z\d])(?:End|Nub|Tip))"
    r"(?:[\s_.-]?(?i:site|effector))?[\s_.-]?\d*$"
)


@dataclass(frozen=True)
class SceneNode:
    """One node of a scene."""

    name: str
    parent: int  # -1 for none; parents come before their children
    bone: bool = False  # whether the file marks it as a bone
    geometry: bool = False  # whether it carries a mesh, a camera or a light
    animated: bool = False  # whether the chosen animation moves it
    end: bool = False  # whether it ends a limb if it is a leaf without rotations


@dataclass(frozen=True)
class Character:
    """A skeleton in a scene: its nodes, parents first, starting with the root.

    ``notes`` state what was left out; ``people`` are the names of all candidates.
    """

    joints: list[int]
    notes: list[str]
    name: str
    people: Sequence[str]


def find_character(
    content: FileContent, nodes: Sequence[SceneNode], person: str | None
) -> Character:
    """Return the only skeleton that moves, or the one of the requested person."""
    skeletons = _find_skeletons(nodes)
    if not skeletons:
        raise content.error(
            "has no skeleton (bones or animated nodes): export the armature with its animation"
        )
    largest = max(map(len, skeletons))
    bodies = [joints for joints in skeletons if len(joints) >= MIN_SIZE_RATIO * largest]
    moving = [joints for joints in bodies if any(nodes[j].animated for j in joints)]
    bodies = moving or bodies  # if nothing moves, all skeletons are candidates
    people = dict(zip(_name_bodies(nodes, bodies), bodies, strict=True))
    shown = [f"{name} ({len(joints)} joints)" for name, joints in people.items()]
    name = choose_person(content.path, people, person, "characters", shown)
    notes = [f"person {name} of {len(people)}"] if len(people) > 1 else []
    props = _find_props(nodes, list(people.values()))
    if props:
        notes.append(f"left out as props: {join_names([nodes[j].name for j in props])}")
    large = [
        nodes[j].name
        for j, n_animated in props.items()
        if n_animated >= max(MIN_SIZE_RATIO * largest, 2)
    ]
    if large:
        remark = (
            "left out, since the nodes are not bones (perhaps another character): "
            f"{join_names(large)}; bind a skin to them, or export it alone"
        )
        notes.append(Note(remark, "warning"))
    return Character(people[name], notes, name, [*people])


def list_ancestors(nodes: Sequence[SceneNode], node: int) -> list[int]:
    """Return the ancestors of a node, from its parent up."""
    ancestors = []
    while (node := nodes[node].parent) >= 0:
        ancestors.append(node)
    return ancestors


def find_moving_takes(moved_nodes: Sequence[set[int]], bones: set[int]) -> list[int]:
    """Return the animations that move a bone, or anything if there are no bones."""
    return [
        number for number, moved in enumerate(moved_nodes) if (moved & bones if bones else moved)
    ]


def choose_take(
    content: FileContent, names: Sequence[str], moving: Sequence[int], name: str | None
) -> tuple[int, list[str]]:
    """Return the number of the animation with this name or number, and notes.

    Without a name it is the first of ``moving``, the animations that move a skeleton.
    """
    if name is not None:
        number = _find_take(names, name)
        if number is None:
            shown = join_names(names) or "none"
            raise content.error(f"there is no take {name!r}: choose from {shown}")
        return number, [f"take {names[number]} of {len(names)}"]
    if not moving:
        raise content.error(
            "holds no animation of its skeleton: export it with its animation, or baked"
        )
    first = moving[0]
    if len(moving) == 1:
        return first, [f"take {names[first]}"]
    others = join_names([names[number] for number in moving[1:]])
    remark = (
        f"{len(moving)} takes are in it and {names[first]!r} is read: choose another with "
        f"take= (--take): {others}"
    )
    return first, [Note(remark, "warning")]


def _find_take(names: Sequence[str], name: str) -> int | None:
    """Return the number of a take, given its name, the part after the armature's, or its number."""
    if name in names:
        return names.index(name)
    # Blender writes armature and action as `armature|action`.
    short_names = [name.rpartition("|")[2] for name in names]
    if short_names.count(name) == 1:
        return short_names.index(name)
    if name.isdecimal() and len(name) < 10 and int(name) < len(names):
        return int(name)
    return None


def check_animations(motions: Mapping[str, Motion], path: Path, what: str) -> Motion:
    """Return the first of the motions to be written as animations of one skeleton.

    Raise WriteError if one has no rotations or another skeleton.
    """
    first = next(iter(motions.values()))
    for motion in motions.values():
        require_rotations(motion, path, what)
        if motion.skeleton is not first.skeleton and not _is_same_skeleton(
            motion.skeleton, first.skeleton
        ):
            raise WriteError(path, "its animations have different skeletons: write several files")
    warn_of_gaps(motions.values(), path)
    return first


def _is_same_skeleton(first: Skeleton, second: Skeleton) -> bool:
    """Return whether skeletons of two takes are equal, apart from rounding."""
    if first.names != second.names or first.parents != second.parents:
        return False
    if first.rig is None or second.rig is None or not first.rig.numbers:
        return np.allclose(first.offsets, second.offsets, atol=RIGID)
    # Offsets of joints with translations depend on the take, so compare the rest poses.
    if first.rig.numbers != second.rig.numbers:
        return False
    first_rest, second_rest = (
        np.hstack([rig.translations, rig.rotations, rig.scales]) for rig in (first.rig, second.rig)
    )
    return np.allclose(first_rest, second_rest, atol=RIGID)


def check_copy(motions: Mapping[str, Motion], source: Path, path: Path) -> Skeleton:
    """Return the skeleton of motions to be written as animations in a copy of their file.

    Raise WriteError if the rig does not match the file, or like `check_animations`.
    """
    skeleton = check_animations(motions, path, f"a copy of {source.name}").skeleton
    if skeleton.rig is None or not skeleton.rig.numbers:
        raise make_uneven_error(source, path)
    return skeleton


def make_uneven_error(source: Path, path: Path) -> WriteError:
    """Return the error for a rest pose that a rig cannot represent."""
    return WriteError(path, f"the bones of {source.name} are mirrored or scaled unevenly at rest")


def is_end(name: str) -> bool:
    """Return whether a leaf of this name ends a limb, like ``Head_end`` and ``HeadNub``."""
    return _END.search(name) is not None


def _find_skeletons(nodes: Sequence[SceneNode]) -> list[list[int]]:
    """Return the joints of each skeleton, parents first."""
    bones = [node.bone for node in nodes]
    if not any(bones):
        bones = [node.animated and not node.geometry for node in nodes]
    has_bone_below, has_no_geometry = list(bones), [not node.geometry for node in nodes]
    # Process children before parents.
    for j in range(len(nodes) - 1, -1, -1):
        if (parent := nodes[j].parent) >= 0:
            has_bone_below[parent] |= has_bone_below[j]
            has_no_geometry[parent] &= has_no_geometry[j]
    skeletons: list[list[int]] = []
    skeleton_of: dict[int, list[int]] = {}
    for j, node in enumerate(nodes):
        # Below a joint, nodes between two bones and the ends of limbs are joints as well.
        skeleton = skeleton_of.get(node.parent)
        if bones[j] or (skeleton is not None and (has_bone_below[j] or has_no_geometry[j])):
            if skeleton is None:
                skeletons.append(skeleton := [])
            skeleton.append(j)
            skeleton_of[j] = skeleton
    return skeletons


def _name_bodies(nodes: Sequence[SceneNode], bodies: list[list[int]]) -> list[str]:
    """Return a name for each body: its only parent's, its namespace, or its root's."""
    carriers = [nodes[joints[0]].parent for joints in bodies]
    names = []
    for joints, carrier in zip(bodies, carriers, strict=True):
        root = nodes[joints[0]].name
        namespace = root.rpartition(":")[0]
        is_only_child = carrier >= 0 and carriers.count(carrier) == 1
        names.append(nodes[carrier].name if is_only_child else namespace or root)
    return make_unique(names)


def _find_props(nodes: Sequence[SceneNode], bodies: list[list[int]]) -> dict[int, int]:
    """Return the topmost node of each prop, with its number of animated nodes.

    A prop begins at a node that is a bone or animated, and neither in a body nor above one. Nodes
    that are bones or carry geometry are not counted.
    """
    body = {joint for joints in bodies for joint in joints}
    body.update(above for joints in bodies for above in list_ancestors(nodes, joints[0]))
    n_animated: dict[int, int] = {}
    tops: dict[int, int] = {}
    for number, node in enumerate(nodes):
        if number in body:
            continue
        if node.parent in tops:
            tops[number] = tops[node.parent]
        elif node.bone or node.animated:
            tops[number] = number
        if number in tops:
            is_counted = node.animated and not (node.geometry or node.bone)
            n_animated[tops[number]] = n_animated.get(tops[number], 0) + is_counted
    return n_animated
