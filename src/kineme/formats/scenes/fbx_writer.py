"""Write binary FBX 7.4: a skeleton at rest, its bind pose, and one or more takes.

Lengths are centimetres, y is up. The nodes are those of the motion's rig: nodes above the joints
become nulls, joints limb nodes. The rotation at rest is the pre-rotation of a limb node, so all its
angles are 0 at rest. A take is an animation stack with one layer and a key in each frame. There
is no mesh.

Source: as for `kineme.formats.scenes.fbx_file` and `kineme.formats.scenes.fbx_scene`; identifier
and footer are those written by Blender, which depend only on the time of creation.
"""

from __future__ import annotations

import struct
import zlib
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from itertools import count
from pathlib import Path
from typing import Any

import numpy as np

from kineme._util import rotations as rot
from kineme._util.arrays import Floats
from kineme._util.files import atomic_write
from kineme._version import __version__
from kineme.formats.files import clean_names
from kineme.formats.scenes.assembly import Transform, compose
from kineme.formats.scenes.fbx_curves import CUSTOM, LINEAR, RATES, TICKS
from kineme.formats.scenes.fbx_file import MAGIC, get_head_struct
from kineme.formats.scenes.fbx_nodes import FBXNode
from kineme.formats.scenes.fbx_scene import INHERITANCE, ROTATION, SCALING, TRANSLATION
from kineme.formats.scenes.gltf_writer import check_animations
from kineme.formats.skeletons.bvh_writer import RIGID
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
        rig = self.rig
        kind = "Null" if node < rig.above else "LimbNode"
        flags = "Null" if node < rig.above else "Skeleton"
        attribute = self._add(
            "NodeAttribute", name, "NodeAttribute", kind, make_node("TypeFlags", flags)
        )
        model = self._add(
            "Model",
            name,
            "Model",
            kind,
            make_node("Version", 232),
            _make_properties(
                ("RotationActive", "bool", "", 1),
                ("InheritType", "enum", "", INHERITANCE.index(rest.inheritance)),
                ("PreRotation", "Vector3D", "Vector", *_to_angles(rest.rotation)),
                (TRANSLATION, TRANSLATION, "", *rest.translation.tolist()),
                (ROTATION, ROTATION, "", 0.0, 0.0, 0.0),
                (SCALING, SCALING, "", *rest.scale.tolist()),
            ),
            make_node("Shading", True),
            make_node("Culling", "CullingOff"),
        )
        self._link(attribute, model)
        parent = rig.parents[node]
        self._link(model, self.models[parent] if parent >= 0 else 0)
        return model

    def _make_bind_pose(self) -> list[FBXNode]:
        """Return the world matrix of each model at rest."""
        return [
            FBXNode(
                "PoseNode",
                children=[
                    make_node("Node", np.int64(model)),
                    # The file stores columns first.
                    make_node("Matrix", np.ascontiguousarray(matrix.T).ravel()),
                ],
            )
            for model, matrix in zip(self.models, compose(*self.rig.world), strict=True)
        ]

    def animate(self, name: str, motion: Motion) -> None:
        """Add a motion of the same skeleton as a take."""
        rig, skeleton = self.rig, motion.skeleton
        times = np.round(np.arange(motion.n_frames) * (TICKS / motion.fps)).astype("<i8")
        stop = np.int64(times[-1])
        self.stops[name] = int(stop)
        span = [
            (f"{kind}{end}", "KTime", "Time", np.int64(0) if end == "Start" else stop)
            for kind in ("Local", "Reference")
            for end in ("Start", "Stop")
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
                # Avoid jumps of 360 degrees, which would spin the joint between frames.
                angles = np.unwrap(angles, period=360.0, axis=0)
                self._add_curves(layer, node, ROTATION, "R", times, angles)

    def find_values(
        self, node: int, shifts: Floats, turns: Floats
    ) -> tuple[Floats, Floats, Floats]:
        """Return translations and angles that move a node like this, and its rest translation."""
        local_rotations = rot.multiply(rot.conjugate(self.rig.rotations[node]), turns)
        angles = np.degrees(rot.to_euler_zyx(local_rotations))[:, ::-1]
        return shifts, angles, self.rig.translations[node]

    def _add_curves(
        self, layer: int, model: int, property_name: str, short: str, times: Any, values: Floats
    ) -> None:
        start = [
            (f"d|{axis}", "Number", "", x)
            for axis, x in zip("XYZ", values[0].tolist(), strict=True)
        ]
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
        creator = f"kineme {__version__}"
        return [
            FBXNode(
                "FBXHeaderExtension",
                children=[
                    make_node("FBXHeaderVersion", 1003),
                    make_node("FBXVersion", VERSION),
                    make_node("Creator", creator),
                ],
            ),
            make_node("FileId", _FILE_ID),
            make_node("CreationTime", _CREATED),
            make_node("Creator", creator),
            FBXNode(
                "GlobalSettings",
                children=[
                    make_node("Version", 1000),
                    _make_properties(
                        *((f"{name}Axis", "int", "Integer", axis) for name, axis in _AXES),
                        *((f"{name}AxisSign", "int", "Integer", 1) for name, _ in _AXES),
                        ("UnitScaleFactor", "double", "Number", 1.0),
                        ("OriginalUnitScaleFactor", "double", "Number", 1.0),
                        *self.make_time_settings(),
                    ),
                ],
            ),
            FBXNode(
                "Documents",
                children=[
                    make_node("Count", 1),
                    FBXNode(
                        "Document", [np.int64(1), "", "Scene"], [make_node("RootNode", np.int64(0))]
                    ),
                ],
            ),
            FBXNode("References"),
            FBXNode(
                "Definitions",
                children=[make_node("Version", 100), make_node("Count", len(kinds)), *counted],
            ),
            FBXNode("Objects", children=self.objects),
            FBXNode("Connections", children=self.links),
        ]


_AXES = (("Coord", 0), ("Up", 1), ("Front", 2))


def make_node(name: str, value: Any) -> FBXNode:
    """Return a node with one value."""
    return FBXNode(name, [value])


def _make_properties(*entries: Sequence[Any]) -> FBXNode:
    """Return a table of properties from name, type, label and values of each."""
    animated = (TRANSLATION, ROTATION, SCALING, "Number")
    return FBXNode(
        "Properties70",
        children=[
            FBXNode("P", [name, kind, label, "A" if kind in animated else "", *values])
            for name, kind, label, *values in entries
        ],
    )


def _to_angles(rotation: Floats) -> list[float]:
    """Return the angles about x, y and z in degrees, applied in this order."""
    angles: list[float] = np.degrees(rot.to_euler_zyx(rotation))[::-1].tolist()
    return angles


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
