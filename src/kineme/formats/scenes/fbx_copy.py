"""Copy an FBX file with other takes, keeping meshes, skins, materials and everything else.

The source is copied byte for byte, except its animation stacks, layers, curve nodes and curves, the
nodes that count or name them, the frame rate and the time span. Each model keeps its pre- and
post-rotation, pivots and offsets; its keys compensate for them. Models that are not joints of the
character are at rest in the new takes.

Source: as for `kineme.formats.scenes.fbx_scene` and `kineme.formats.scenes.fbx_writer`.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import replace
from itertools import count
from pathlib import Path
from typing import Any

import numpy as np

from kineme._util.arrays import Floats
from kineme._util.checks import warn
from kineme._util.files import atomic_write, translate_read_errors
from kineme.errors import WriteError
from kineme.formats.files import load
from kineme.formats.scenes.assembly import Transform, stack_transforms
from kineme.formats.scenes.fbx_curves import Sampler
from kineme.formats.scenes.fbx_file import MAGIC, START, get_head_struct, parse_fbx
from kineme.formats.scenes.fbx_nodes import FBXNode
from kineme.formats.scenes.fbx_scene import REST_TAKE, FBXScene, Pose, invert_transform
from kineme.formats.scenes.fbx_writer import FOOTER, TakeWriter, encode_fbx, make_node, write_takes
from kineme.formats.scenes.gltf_writer import check_copy, make_uneven_error
from kineme.recordings import Motion
from kineme.recordings.posing import get_rig

_ANIMATION = {"AnimationStack", "AnimationLayer", "AnimationCurveNode", "AnimationCurve"}
_HOLDERS = {"GlobalSettings", "Documents", "Document", "Properties70"}


def copy_takes(motions: Mapping[str, Motion], source: Path, path: Path) -> None:
    """Write a copy of ``source``, the file of the motions, with the motions as its takes.

    A source in text form is not copied: only the skeleton is written, with a warning.
    """
    check_copy(motions, source, path)
    with translate_read_errors(source):
        content = load(source)
        version, root = parse_fbx(content)
        if not content.data.startswith(MAGIC):
            reason = f"is a text FBX, so {path.name} has no mesh: export the source as binary FBX"
            warn(f"{source.name} {reason}")
            write_takes(motions, path)
            return
        scene = FBXScene(content, root)
        copy = _CopyWriter(scene, next(iter(motions.values())), source, path)
    for name, motion in motions.items():
        copy.animate(name, motion)
    _warn_of_textures(scene, source, path)
    data = content.data
    stop = root.children[-1].stop + get_head_struct(version).size
    # Keep the source's footer, which depends on its time of creation.
    footer = data[stop : stop + len(FOOTER)].ljust(len(FOOTER), b"\0")
    with atomic_write(path) as draft:
        draft.write_bytes(encode_fbx(copy.rebuild(root), data[:START], footer, data))


class _CopyWriter(TakeWriter):
    """Collect takes for the models of a file, whose rest is their transform without animation."""

    def __init__(self, scene: FBXScene, motion: Motion, source: Path, path: Path) -> None:
        rig = get_rig(motion.skeleton)
        indices = {model.number: index for index, model in enumerate(scene.models)}
        if not {*rig.numbers} - {-1} <= indices.keys():
            raise WriteError(path, f"{source.name} has changed since it was read")
        self._places = [indices.get(number, -1) for number in rig.numbers]
        pose = Pose(scene, REST_TAKE, Sampler(np.zeros(1)))
        self._rest = [pose.compute_transform(max(index, 0)) for index in self._places]
        if -1 in self._places:
            # Clips may have an additional root bone; its children keep their inheritance of scale.
            root, below = rig.above, self._rest[rig.above + 1]
            root_rest = rig.translations[root], rig.rotations[root], rig.scales[root]
            self._rest[root] = Transform(*root_rest, below.inheritance)
        parts = stack_transforms(self._rest, rig.parents)
        if parts is None:
            raise make_uneven_error(source, path)
        rig = replace(rig, translations=parts[0], rotations=parts[1], scales=parts[2])
        # New objects get numbers that the source does not use.
        numbers = (number for number in count(1_000_000) if number not in scene.objects)
        super().__init__(rig, motion.fps, numbers)
        self.scene, self.moved = scene, set[int]()
        for node, number in enumerate(rig.numbers):
            self.models.append(number if number >= 0 else self._add_root(node))

    def _add_root(self, node: int) -> int:
        """Add the rig's root bone and connect its children to it instead of their parents."""
        rig = self.rig
        root = self._add_model(node, rig.names[node], self._rest[node])
        children = (child for child, parent in enumerate(rig.parents) if parent == node)
        self.moved = {rig.numbers[child] for child in children}
        for child in self.moved:
            self._link(child, root)
        return root

    def find_values(
        self, node: int, shifts: Floats, turns: Floats
    ) -> tuple[Floats, Floats, Floats]:
        """Return translations and angles that move a node like this, and its rest translation."""
        if self._places[node] < 0:
            return super().find_values(node, shifts, turns)
        model, rest = self.scene.models[self._places[node]], self._rest[node]
        rest_translation, _ = invert_transform(
            model, rest.translation, rest.rotation[None], rest.scale
        )
        return *invert_transform(model, shifts, turns, rest.scale), rest_translation[0]

    def rebuild(self, root: FBXNode) -> Iterator[FBXNode]:
        """Yield the nodes of the source with the new takes instead of its own."""
        names, objects = list(self.stops), self.scene.objects
        dropped = {number for number, node in objects.items() if node.name in _ANIMATION}
        kept_nodes = [node for number, node in objects.items() if number not in dropped]
        counts = dict.fromkeys(_ANIMATION, 0) | Counter(
            each.name for each in kept_nodes + self.objects
        )
        change = len(self.objects) - len(dropped)
        ancestors = {0, *self.models[: self.rig.above]}
        settings = {name: value for name, *_, value in self.make_time_settings()}
        for node in root.children:
            if node.name == "Objects":
                kept_nodes = [each for each in node.children if each.name not in _ANIMATION]
                kept_nodes = [self._extend_pose(each) for each in kept_nodes]
                yield _replace_children(node, [*kept_nodes, *self.objects])
            elif node.name == "Connections":
                kept_nodes = [
                    each for each in node.children if self._is_kept(each, dropped, ancestors)
                ]
                yield _replace_children(node, [*kept_nodes, *self.links])
            elif node.name == "Definitions":
                yield _replace_children(node, _count_objects(node, counts, change))
            elif node.name == "Takes":
                yield _replace_children(node, [make_node("Current", names[0]), *self._make_takes()])
            else:
                yield _set_properties(node, {**settings, "ActiveAnimStackName": names[0]})

    def _is_kept(self, link: FBXNode, dropped: set[int], above: set[int]) -> bool:
        part, parent = link.number(1, -1), link.number(2, -1)
        # Connections of removed animation objects are removed as well.
        if part in dropped or parent in dropped:
            return False
        # Children of the new root lose their other parents.
        return not (link.text(0) == "OO" and part in self.moved and parent in above)

    def _extend_pose(self, node: FBXNode) -> FBXNode:
        """Return a bind pose with the new root if it contains the root's children."""
        entries = [entry.child("Node") for entry in node.all("PoseNode")]
        if not self.moved & {int(each.number(0, -1)) for each in entries if each}:
            return node
        others = (child for child in node.children if child.name != "NbPoseNodes")
        new = self._make_bind_pose()[self.rig.above]
        return _replace_children(node, [make_node("NbPoseNodes", len(entries) + 1), *others, new])

    def _make_takes(self) -> Iterator[FBXNode]:
        """Yield the takes in the form of older programs."""
        for name, stop in self.stops.items():
            span = [np.int64(0), np.int64(stop)]
            ends = [FBXNode(f"{kind}Time", span) for kind in ("Local", "Reference")]
            yield FBXNode("Take", [name], [make_node("FileName", f"{name}.tak"), *ends])


def _count_objects(node: FBXNode, counts: Mapping[str, int], change: int) -> Iterator[FBXNode]:
    """Yield the children of the definitions with updated counts.

    ``counts`` are the new counts of kinds, ``change`` is added to the total.
    """
    kinds = {kind.text(0) for kind in node.all("ObjectType")}
    for child in node.children:
        if child.name == "Count":
            yield make_node("Count", int(child.number(0)) + change)
        elif child.name == "ObjectType" and child.text(0) in counts:
            others = (grandchild for grandchild in child.children if grandchild.name != "Count")
            yield _replace_children(child, [make_node("Count", counts[child.text(0)]), *others])
        else:
            yield child
    for kind in counts.keys() - kinds:
        yield FBXNode("ObjectType", [kind], [make_node("Count", counts[kind])])


def _set_properties(node: FBXNode, values: Mapping[str, Any]) -> FBXNode:
    """Return the node with these values of the properties that it has."""
    if node.name == "P" and node.text(0) in values:
        return FBXNode("P", [*node.values[:4], values[node.text(0)]])
    if node.name not in _HOLDERS:
        return node
    children = [_set_properties(child, values) for child in node.children]
    return node if children == node.children else _replace_children(node, children)


def _replace_children(node: FBXNode, children: Iterable[FBXNode]) -> FBXNode:
    """Return the node with other children; convert whole numbers among its values to 64 bits."""
    values = [np.int64(value) if isinstance(value, int) else value for value in node.values]
    return FBXNode(node.name, values, list(children))


def _warn_of_textures(scene: FBXScene, source: Path, path: Path) -> None:
    """Warn of textures next to the source that the copy will not find."""
    for node in scene.objects.values():
        filename, embedded = node.child("RelativeFilename"), node.child("Content")
        if (
            node.name != "Video"
            or not filename
            or (embedded and embedded.values and embedded.values[0])
        ):
            continue
        texture = filename.text(0).replace("\\", "/")
        if (source.parent / texture).is_file() and not (path.parent / texture).is_file():
            warn(
                f"{path.name} needs the texture {texture!r:.60}: copy it from the folder of "
                f"{source.name}"
            )
