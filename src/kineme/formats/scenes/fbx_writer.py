"""Write binary FBX: a new file with a skeleton and its takes, or a copy of a file with other takes.

A new file has version 7.4, the skeleton at rest, its bind pose, and one or more takes. Lengths are
centimetres, y is up. The nodes are those of the motion's rig: nodes above the joints become nulls,
joints limb nodes. The rotation at rest is the pre-rotation of a limb node, so all its angles are 0
at rest. A take is an animation stack with one layer and a key in each frame. There is no mesh.

A copy keeps meshes, skins, materials and everything else. The source is copied byte for byte,
except its animation stacks, layers, curve nodes and curves, the nodes that count or name them, the
frame rate and the time span. Each model keeps its pre- and post-rotation, pivots and offsets; its
keys compensate for them. Models that are not joints of the character are at rest in the new takes.

Source: as for `kineme.formats.scenes.fbx_file` and `kineme.formats.scenes.fbx_scene`; identifier
and footer are those written by Blender, which depend only on the time of creation.
"""

from __future__ import annotations

import struct
import zlib
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from itertools import count
from pathlib import Path
from typing import Any

import numpy as np

from kineme._util import rotations as rot
from kineme._util.arrays import Floats
from kineme._util.checks import warn
from kineme._util.files import atomic_write, translate_read_errors
from kineme._version import __version__
from kineme.errors import WriteError
from kineme.formats.files import clean_names, load
from kineme.formats.scenes.assembly import Transform, compose, stack_transforms
from kineme.formats.scenes.characters import check_animations, check_copy, make_uneven_error
from kineme.formats.scenes.fbx_curves import CUSTOM, LINEAR, RATES, TICKS, Sampler
from kineme.formats.scenes.fbx_file import MAGIC, START, FBXNode, get_head_struct, parse_fbx
from kineme.formats.scenes.fbx_scene import (
    INHERITANCE,
    REST_TAKE,
    ROTATION,
    SCALING,
    TRANSLATION,
    FBXScene,
    Pose,
    invert_transform,
    to_angles,
)
from kineme.formats.skeletons.placing import RIGID
from kineme.recordings import Motion
from kineme.recordings.posing import get_rig, pose_rig
from kineme.recordings.rig import Rig

VERSION = 7400
CENTIMETRE = 0.01
_START = MAGIC + b"\x1a\x00" + struct.pack("<I", VERSION)
_CREATED = "1970-01-01 10:00:00:000"
_FILE_ID = bytes.fromhex("28b32aebb624ccc2bfc8b02aa92bfcf1")
FOOTER = bytes.fromhex("fabcab09d0c8d466b176fb831cf7267e")
_LAST = bytes.fromhex("f85a8c6adef5d97eece90ce3758f290b")
_CODES = {"<f4": b"f", "<f8": b"d", "<i8": b"l", "<i4": b"i"}
_KEY_VERSION = 4008
_AXES = (("Coord", 0), ("Up", 1), ("Front", 2))
_ANIMATION = {"AnimationStack", "AnimationLayer", "AnimationCurveNode", "AnimationCurve"}
_HOLDERS = {"GlobalSettings", "Documents", "Document", "Properties70"}


def write_fbx(motion: Motion, path: Path) -> None:
    """Write a motion to an FBX file."""
    write_takes({path.stem: motion}, path)


def write_takes(motions: Mapping[str, Motion], path: Path) -> None:
    """Write one or more motions of one skeleton to an FBX file, each as a take of its name."""
    scene = _SceneWriter(check_animations(motions, path, "an FBX"), path)
    for name, motion in motions.items():
        scene.animate(name, motion)
    with atomic_write(path) as draft:
        draft.write_bytes(encode_fbx(scene.make_nodes(), _START, FOOTER))


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


def _warn_of_textures(scene: FBXScene, source: Path, path: Path) -> None:
    """Warn of textures next to the source that the copy will not find."""
    for node in scene.objects.values():
        filename, embedded = node.child("RelativeFilename"), node.child("Content")
        is_embedded = embedded and embedded.values and embedded.values[0]
        if node.name != "Video" or not filename or is_embedded:
            continue
        texture = filename.text(0).replace("\\", "/")
        if (source.parent / texture).is_file() and not (path.parent / texture).is_file():
            warn(
                f"{path.name} needs the texture {texture!r:.60}: copy it from the folder of "
                f"{source.name}"
            )


class TakeWriter:
    """Collect the objects of takes and their connections.

    ``models`` are the numbers of the rig's nodes, ``stops`` the ticks at which each take ends.
    """

    def __init__(self, rig: Rig, fps: float, numbers: Iterator[int]) -> None:
        self.rig, self.fps, self._numbers = rig, fps, numbers
        self.objects: list[FBXNode] = []
        self.links: list[FBXNode] = []
        self.models: list[int] = []
        self.stops: dict[str, int] = {}

    def _add(self, kind: str, name: str, label: str, sub: str, *children: FBXNode) -> int:
        """Add an object and return its number."""
        number = next(self._numbers)
        values = [np.int64(number), f"{name}\0\1{label}", sub]
        self.objects.append(FBXNode(kind, values, list(children)))
        return number

    def _link(self, part: int, parent: int, property_name: str | None = None) -> None:
        kind, end = ("OO", []) if property_name is None else ("OP", [property_name])
        self.links.append(FBXNode("C", [kind, np.int64(part), np.int64(parent), *end]))

    def _add_model(self, node: int, name: str, rest: Transform) -> int:
        """Add a node of the rig as a model, at rest; return its number."""
        rig = self.rig
        kind, flags = ("Null", "Null") if node < rig.above else ("LimbNode", "Skeleton")
        type_flags = make_node("TypeFlags", flags)
        attribute = self._add("NodeAttribute", name, "NodeAttribute", kind, type_flags)
        properties = _make_properties(
            ("RotationActive", "bool", "", 1),
            ("InheritType", "enum", "", INHERITANCE.index(rest.inheritance)),
            ("PreRotation", "Vector3D", "Vector", *to_angles(rest.rotation, "zyx").tolist()),
            (TRANSLATION, TRANSLATION, "", *rest.translation.tolist()),
            (ROTATION, ROTATION, "", 0.0, 0.0, 0.0),
            (SCALING, SCALING, "", *rest.scale.tolist()),
        )
        shading = make_node("Shading", True), make_node("Culling", "CullingOff")
        model = self._add(
            "Model", name, "Model", kind, make_node("Version", 232), properties, *shading
        )
        self._link(attribute, model)
        parent = rig.parents[node]
        self._link(model, self.models[parent] if parent >= 0 else 0)
        return model

    def _make_bind_pose(self) -> list[FBXNode]:
        """Return the world matrix of each model at rest."""
        columns = compose(*self.rig.world).transpose(0, 2, 1)  # the file stores columns first
        return [
            make_group(
                "PoseNode", make_node("Node", np.int64(model)), make_node("Matrix", matrix.ravel())
            )
            for model, matrix in zip(self.models, columns, strict=True)
        ]

    def animate(self, name: str, motion: Motion) -> None:
        """Add a motion of the same skeleton as a take."""
        rig, skeleton = self.rig, motion.skeleton
        times = np.round(np.arange(motion.n_frames) * (TICKS / motion.fps)).astype("<i8")
        stop = np.int64(times[-1])
        self.stops[name] = int(stop)
        span = [
            (f"{kind}{end}", "KTime", "Time", ticks)
            for kind in ("Local", "Reference")
            for end, ticks in (("Start", np.int64(0)), ("Stop", stop))
        ]
        stack = self._add("AnimationStack", name, "AnimStack", "", _make_properties(*span))
        layer = self._add("AnimationLayer", name, "AnimLayer", "")
        self._link(layer, stack)
        shifts, turns = pose_rig(motion, rig)
        for joint in range(skeleton.n_joints):
            node = rig.above + joint
            translations, angles, rest = self.find_values(node, shifts[:, joint], turns[:, joint])
            # Metres per unit of the node's translation.
            size = rig.parent_world(node, *rig.world)[2] * rig.unit
            distance = size * np.abs(translations - rest).max()
            if distance > RIGID or skeleton.parents[joint] < 0:
                self._add_curves(layer, node, TRANSLATION, "T", times, translations)
            if joint not in skeleton.end_sites:
                self._add_curves(layer, node, ROTATION, "R", times, angles)

    def find_values(
        self, node: int, shifts: Floats, turns: Floats
    ) -> tuple[Floats, Floats, Floats]:
        """Return translations and angles that move a node like this, and its rest translation."""
        turns = rot.multiply(rot.conjugate(self.rig.rotations[node]), turns)
        return shifts, to_angles(turns, "zyx", unwrapped=True), self.rig.translations[node]

    def _add_curves(
        self, layer: int, model: int, property_name: str, short: str, times: Any, values: Floats
    ) -> None:
        """Add the three curves of a property of a model to a layer."""
        start = [(f"d|{axis}", "Number", "", x) for axis, x in zip("XYZ", values[0], strict=True)]
        node = self._add("AnimationCurveNode", short, "AnimCurveNode", "", _make_properties(*start))
        self._link(node, layer)
        self._link(node, self.models[model], property_name)
        for axis, column in zip("XYZ", values.T.astype("<f4"), strict=True):
            # A constant curve needs one key.
            n = 1 if np.ptp(column) == 0 else len(column)
            curve = self._add(
                "AnimationCurve",
                "",
                "AnimCurve",
                "",
                make_node("Default", float(column[0])),
                make_node("KeyVer", _KEY_VERSION),
                make_node("KeyTime", times[:n]),
                make_node("KeyValueFloat", column[:n]),
                make_node("KeyAttrFlags", np.array([LINEAR], "<i4")),
                make_node("KeyAttrDataFloat", np.zeros(4, "<f4")),
                make_node("KeyAttrRefCount", np.array([n], "<i4")),
            )
            self._link(curve, node, f"d|{axis}")

    def make_time_settings(self) -> list[tuple[str, str, str, Any]]:
        """Return name, type, label and value of the settings for frame rate and time span."""
        mode = next((mode for mode, fps in RATES.items() if abs(fps - self.fps) < 1e-9), CUSTOM)
        return [
            ("TimeMode", "enum", "", mode),
            ("CustomFrameRate", "double", "Number", self.fps),
            ("TimeSpanStart", "KTime", "Time", np.int64(0)),
            ("TimeSpanStop", "KTime", "Time", np.int64(max(self.stops.values()))),
        ]


class _SceneWriter(TakeWriter):
    """Collect the models of a skeleton and its takes."""

    def __init__(self, motion: Motion, path: Path) -> None:
        rig = get_rig(motion.skeleton).to_metres()
        rig = replace(rig, translations=rig.translations / CENTIMETRE, unit=CENTIMETRE)
        super().__init__(rig, motion.fps, count(1_000_000))
        above = [*rig.names[: rig.above]]
        names = clean_names(path, [*above, *motion.skeleton.names], str.strip)
        for node, name in enumerate(names):
            rest = Transform(rig.translations[node], rig.rotations[node], rig.scales[node])
            self.models.append(self._add_model(node, name, rest))
        entries = self._make_bind_pose()
        head = [make_node("Type", "BindPose"), make_node("Version", 100)]
        head.append(make_node("NbPoseNodes", len(entries)))
        self._add("Pose", "rest", "Pose", "BindPose", *head, *entries)

    def make_nodes(self) -> list[FBXNode]:
        """Return the top nodes of the file."""
        kinds = [node.name for node in self.objects]
        counted = [
            FBXNode("ObjectType", [kind], [make_node("Count", kinds.count(kind))])
            for kind in dict.fromkeys(kinds)
        ]
        creator = make_node("Creator", f"kineme {__version__}")
        versions = make_node("FBXHeaderVersion", 1003), make_node("FBXVersion", VERSION)
        settings = _make_properties(
            *((f"{name}Axis", "int", "Integer", axis) for name, axis in _AXES),
            *((f"{name}AxisSign", "int", "Integer", 1) for name, _ in _AXES),
            ("UnitScaleFactor", "double", "Number", 1.0),
            ("OriginalUnitScaleFactor", "double", "Number", 1.0),
            *self.make_time_settings(),
        )
        document = FBXNode(
            "Document", [np.int64(1), "", "Scene"], [make_node("RootNode", np.int64(0))]
        )
        return [
            make_group("FBXHeaderExtension", *versions, creator),
            make_node("FileId", _FILE_ID),
            make_node("CreationTime", _CREATED),
            creator,
            make_group("GlobalSettings", make_node("Version", 1000), settings),
            make_group("Documents", make_node("Count", 1), document),
            make_group("References"),
            make_group(
                "Definitions", make_node("Version", 100), make_node("Count", len(kinds)), *counted
            ),
            make_group("Objects", *self.objects),
            make_group("Connections", *self.links),
        ]


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
        kept_kinds = [node.name for node in objects.values() if node.name not in _ANIMATION]
        new_kinds = [node.name for node in self.objects]
        counts = dict.fromkeys(_ANIMATION, 0) | Counter(kept_kinds + new_kinds)
        change = len(self.objects) - len(dropped)
        ancestors = {0, *self.models[: self.rig.above]}
        settings = {name: value for name, *_, value in self.make_time_settings()}
        for node in root.children:
            if node.name == "Objects":
                kept = (each for each in node.children if each.name not in _ANIMATION)
                yield _replace_children(node, [*map(self._extend_pose, kept), *self.objects])
            elif node.name == "Connections":
                kept = (each for each in node.children if self._is_kept(each, dropped, ancestors))
                yield _replace_children(node, [*kept, *self.links])
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


def make_node(name: str, value: Any) -> FBXNode:
    """Return a node with one value."""
    return FBXNode(name, [value])


def make_group(name: str, *children: FBXNode) -> FBXNode:
    """Return a node with children and no values."""
    return FBXNode(name, [], list(children))


def _make_properties(*entries: Sequence[Any]) -> FBXNode:
    """Return a table of properties from name, type, label and values of each."""
    animated = (TRANSLATION, ROTATION, SCALING, "Number")
    rows = (
        FBXNode("P", [name, kind, label, "A" if kind in animated else "", *values])
        for name, kind, label, *values in entries
    )
    return make_group("Properties70", *rows)


def encode_fbx(nodes: Iterable[FBXNode], start: bytes, footer: bytes, source: bytes = b"") -> bytes:
    """Return a file of these nodes; nodes that were read from ``source`` are copied from it.

    The last four bytes of ``start`` are the version; ``footer`` depends on the time of creation.
    """
    data, version = bytearray(start), start[-4:]
    head = get_head_struct(int.from_bytes(version, "little"))
    for node in nodes:
        _write_node(data, node, head, source)
    data += bytes(head.size) + footer + bytes(4)
    data += bytes(16 - len(data) % 16)
    return bytes(data + version + bytes(120) + _LAST)


def _write_node(data: bytearray, node: FBXNode, head: struct.Struct, source: bytes) -> None:
    """Append a node to the file; its head states the end, so it is filled in last."""
    at, name = len(data), node.name.encode()
    if node.stop:
        # Copied nodes keep their bytes, but the ends in their heads move.
        shift = at - node.start
        data += source[node.start : node.stop]
        # The next head follows the values of this one, whether of a child or a sibling.
        while at < len(data):
            end, n_values, size, length = head.unpack_from(data, at)
            if end:
                head.pack_into(data, at, end + shift, n_values, size, length)
            at += head.size + length + size
        return
    values = b"".join(_write_values(node.values))
    data += bytes(head.size) + name + values
    for child in node.children:
        _write_node(data, child, head, source)
    # An empty node ends the children; nodes without values and layers need it, too.
    if node.children or not node.values or node.name == "AnimationLayer":
        data += bytes(head.size)
    head.pack_into(data, at, len(data), len(node.values), len(values), len(name))


def _write_values(values: list[Any]) -> Iterator[bytes]:
    """Yield the values of a node: type, and bytes; arrays are compressed."""
    for value in values:
        if isinstance(value, np.ndarray):
            packed = zlib.compress(value.tobytes(), 1)
            yield _CODES[value.dtype.newbyteorder("<").str]
            yield struct.pack("<III", len(value), 1, len(packed)) + packed
        elif isinstance(value, str | bytes):
            raw = value.encode() if isinstance(value, str) else value
            yield (b"S" if isinstance(value, str) else b"R") + struct.pack("<I", len(raw)) + raw
        elif isinstance(value, bool):
            yield b"C" + struct.pack("<?", value)
        elif isinstance(value, np.int64):
            yield b"L" + struct.pack("<q", value)
        elif isinstance(value, int):
            yield b"I" + struct.pack("<i", value)
        else:
            yield b"D" + struct.pack("<d", value)
