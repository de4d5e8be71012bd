"""Writing FBX 7.4, binary: a skeleton at rest, its bind pose, and one take or several.

Lengths are centimetres, y is up. The nodes are those of the rig that the motion came from: those
above the joints are nulls, joints are limb nodes. The rotation at rest is the pre-rotation of a
limb node, so that all its angles are 0 at rest. A take is an animation stack with one layer and a
key in each frame. There is no mesh.

Source: as for `kineme.formats.scenes.fbx_file` and `kineme.formats.scenes.fbx_scene`; identifier
and footer are those that Blender writes, which depend on the time of creation alone.
"""

from __future__ import annotations

import struct
import zlib
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from itertools import count
from pathlib import Path
from typing import Any

import numpy as np

from kineme._util import rotations as rot
from kineme._util.arrays import Floats
from kineme._util.files import atomic_write
from kineme._version import __version__
from kineme.formats.files import spell_names
from kineme.formats.scenes.assembly import compose
from kineme.formats.scenes.fbx_curves import CUSTOM, LINEAR, RATES, TICKS
from kineme.formats.scenes.fbx_file import MAGIC
from kineme.formats.scenes.fbx_nodes import FBXNode
from kineme.formats.scenes.fbx_scene import ROTATION, SCALING, TRANSLATION
from kineme.formats.scenes.gltf_writer import check_animations
from kineme.formats.skeletons.bvh_writer import RIGID
from kineme.recordings import Motion
from kineme.recordings.posing import get_rig, pose_rig

VERSION = 7400
CENTIMETRE = 0.01

_CREATED = "1970-01-01 10:00:00:000"
_FILE_ID = bytes.fromhex("28b32aebb624ccc2bfc8b02aa92bfcf1")
_FOOTER_ID = bytes.fromhex("fabcab09d0c8d466b176fb831cf7267e")
_LAST = bytes.fromhex("f85a8c6adef5d97eece90ce3758f290b")
_HEAD = struct.Struct("<IIIB")
_CODES = {"<f4": b"f", "<f8": b"d", "<i8": b"l", "<i4": b"i"}
_KEY_VERSION = 4008


def write_fbx(motion: Motion, path: Path) -> None:
    """Leave ``motion`` in an FBX file."""
    write_takes({path.stem: motion}, path)


def write_takes(motions: Mapping[str, Motion], path: Path) -> None:
    """Leave motions of one skeleton, one at least, in an FBX file, each as a take of its name."""
    scene = _Scene(check_animations(motions, path, "an FBX"), path)
    for name, motion in motions.items():
        scene.animate(name, motion)
    with atomic_write(path) as draft:
        draft.write_bytes(_binary(scene.file()))


class _Scene:
    """Gathers objects and their connections."""

    def __init__(self, motion: Motion, path: Path) -> None:
        skeleton = motion.skeleton
        rig = get_rig(skeleton).to_metres()
        self.rig = replace(rig, translations=rig.translations / CENTIMETRE, unit=CENTIMETRE)
        self.fps, self.longest = motion.fps, 0
        self.objects: list[FBXNode] = []
        self.links: list[FBXNode] = []
        self._numbers = count(1_000_000)
        above = self.rig.above
        names = spell_names(path, [*rig.names[:above], *skeleton.names], str.strip)
        self.models: list[int] = []
        for node, name in enumerate(names):
            self.models.append(self._add_model(node, name))
        self._add_bind_pose()

    def _add(self, kind: str, name: str, label: str, sub: str, *children: FBXNode) -> int:
        """Keep an object; its number."""
        number = next(self._numbers)
        values = [np.int64(number), f"{name}\0\1{label}", sub]
        self.objects.append(FBXNode(kind, values, list(children)))
        return number

    def _link(self, part: int, parent: int, what: str | None = None) -> None:
        kind, end = ("OO", []) if what is None else ("OP", [what])
        self.links.append(FBXNode("C", [kind, np.int64(part), np.int64(parent), *end]))

    def _add_model(self, node: int, name: str) -> int:
        rig = self.rig
        kind = "Null" if node < rig.above else "LimbNode"
        flags = "Null" if node < rig.above else "Skeleton"
        attribute = self._add(
            "NodeAttribute", name, "NodeAttribute", kind, _one("TypeFlags", flags)
        )
        model = self._add(
            "Model",
            name,
            "Model",
            kind,
            _one("Version", 232),
            _properties(
                ("RotationActive", "bool", "", 1),
                # A child inherits the rotation and scale of its parent as a product of matrices.
                ("InheritType", "enum", "", 1),
                ("PreRotation", "Vector3D", "Vector", *_angles(rig.rotations[node])),
                (TRANSLATION, TRANSLATION, "", *rig.translations[node].tolist()),
                (ROTATION, ROTATION, "", 0.0, 0.0, 0.0),
                (SCALING, SCALING, "", *rig.scales[node].tolist()),
            ),
            _one("Shading", True),
            _one("Culling", "CullingOff"),
        )
        self._link(attribute, model)
        parent = rig.parents[node]
        self._link(model, self.models[parent] if parent >= 0 else 0)
        return model

    def _add_bind_pose(self) -> None:
        world = compose(*self.rig.world)
        entries = [
            FBXNode(
                "PoseNode",
                children=[
                    _one("Node", np.int64(model)),
                    # Columns are stored one after another.
                    _one("Matrix", np.ascontiguousarray(matrix.T).ravel()),
                ],
            )
            for model, matrix in zip(self.models, world, strict=True)
        ]
        head = [_one("Type", "BindPose"), _one("Version", 100), _one("NbPoseNodes", len(entries))]
        self._add("Pose", "rest", "Pose", "BindPose", *head, *entries)

    def animate(self, name: str, motion: Motion) -> None:
        """Add a motion of the same skeleton as a take."""
        rig, skeleton = self.rig, motion.skeleton
        times = np.round(np.arange(motion.n_frames) * (TICKS / motion.fps)).astype("<i8")
        stop = np.int64(times[-1])
        self.longest = max(self.longest, int(stop))
        span = [
            (f"{kind}{end}", "KTime", "Time", np.int64(0) if end == "Start" else stop)
            for kind in ("Local", "Reference")
            for end in ("Start", "Stop")
        ]
        stack = self._add("AnimationStack", name, "AnimStack", "", _properties(*span))
        layer = self._add("AnimationLayer", name, "AnimLayer", "")
        self._link(layer, stack)
        shifts, turns = pose_rig(motion, rig)
        back = rot.conjugate(rig.rotations[rig.above :])
        angles = np.degrees(rot.to_euler_zyx(rot.multiply(back, turns)))[..., ::-1]
        # Successive keys stay near each other, so that nothing spins between frames.
        angles = np.unwrap(angles, period=360.0, axis=0)
        for joint in range(skeleton.n_joints):
            rest = rig.translations[rig.above + joint]
            size = rig.parent_world(rig.above + joint, *rig.world)[2] * CENTIMETRE
            away = size * np.abs(shifts[:, joint] - rest).max()
            if away > RIGID or skeleton.parents[joint] < 0:
                self._add_curves(layer, joint, TRANSLATION, "T", times, shifts[:, joint])
            if joint not in skeleton.end_sites:
                self._add_curves(layer, joint, ROTATION, "R", times, angles[:, joint])

    def _add_curves(
        self, layer: int, joint: int, what: str, short: str, times: Any, values: Floats
    ) -> None:
        start = [
            (f"d|{axis}", "Number", "", x)
            for axis, x in zip("XYZ", values[0].tolist(), strict=True)
        ]
        node = self._add("AnimationCurveNode", short, "AnimCurveNode", "", _properties(*start))
        self._link(node, layer)
        self._link(node, self.models[self.rig.above + joint], what)
        for axis, column in zip("XYZ", values.T.astype("<f4"), strict=True):
            # A curve that never changes needs one key.
            n = 1 if np.ptp(column) == 0 else len(column)
            curve = self._add(
                "AnimationCurve",
                "",
                "AnimCurve",
                "",
                _one("Default", float(column[0])),
                _one("KeyVer", _KEY_VERSION),
                _one("KeyTime", times[:n]),
                _one("KeyValueFloat", column[:n]),
                _one("KeyAttrFlags", np.array([LINEAR], "<i4")),
                _one("KeyAttrDataFloat", np.zeros(4, "<f4")),
                _one("KeyAttrRefCount", np.array([n], "<i4")),
            )
            self._link(curve, node, f"d|{axis}")

    def file(self) -> list[FBXNode]:
        """Return the nodes of the file."""
        mode = next((mode for mode, fps in RATES.items() if abs(fps - self.fps) < 1e-9), CUSTOM)
        kinds = [node.name for node in self.objects]
        counted = [
            FBXNode("ObjectType", [kind], [_one("Count", kinds.count(kind))])
            for kind in dict.fromkeys(kinds)
        ]
        creator = f"kineme {__version__}"
        return [
            FBXNode(
                "FBXHeaderExtension",
                children=[
                    _one("FBXHeaderVersion", 1003),
                    _one("FBXVersion", VERSION),
                    _one("Creator", creator),
                ],
            ),
            _one("FileId", _FILE_ID),
            _one("CreationTime", _CREATED),
            _one("Creator", creator),
            FBXNode(
                "GlobalSettings",
                children=[
                    _one("Version", 1000),
                    _properties(
                        *((f"{name}Axis", "int", "Integer", axis) for name, axis in _AXES),
                        *((f"{name}AxisSign", "int", "Integer", 1) for name, _ in _AXES),
                        ("UnitScaleFactor", "double", "Number", 1.0),
                        ("OriginalUnitScaleFactor", "double", "Number", 1.0),
                        ("TimeMode", "enum", "", mode),
                        ("CustomFrameRate", "double", "Number", self.fps),
                        ("TimeSpanStart", "KTime", "Time", np.int64(0)),
                        ("TimeSpanStop", "KTime", "Time", np.int64(self.longest)),
                    ),
                ],
            ),
            FBXNode(
                "Documents",
                children=[
                    _one("Count", 1),
                    FBXNode(
                        "Document", [np.int64(1), "", "Scene"], [_one("RootNode", np.int64(0))]
                    ),
                ],
            ),
            FBXNode("References"),
            FBXNode(
                "Definitions",
                children=[_one("Version", 100), _one("Count", len(kinds)), *counted],
            ),
            FBXNode("Objects", children=self.objects),
            FBXNode("Connections", children=self.links),
        ]


_AXES = (("Coord", 0), ("Up", 1), ("Front", 2))


def _one(name: str, value: Any) -> FBXNode:
    return FBXNode(name, [value])


def _properties(*entries: Sequence[Any]) -> FBXNode:
    """Return a table of properties: name, type, label, values of each."""
    animated = (TRANSLATION, ROTATION, SCALING, "Number")
    return FBXNode(
        "Properties70",
        children=[
            FBXNode("P", [name, kind, label, "A" if kind in animated else "", *values])
            for name, kind, label, *values in entries
        ],
    )


def _angles(rotation: Floats) -> list[float]:
    """Return the angles about x, y and z in degrees, the first applied first."""
    angles: list[float] = np.degrees(rot.to_euler_zyx(rotation))[::-1].tolist()
    return angles


def _binary(nodes: list[FBXNode]) -> bytes:
    data = bytearray(MAGIC + b"\x1a\x00" + struct.pack("<I", VERSION))
    for node in nodes:
        _write_node(data, node)
    data += bytes(_HEAD.size) + _FOOTER_ID + bytes(4)
    data += bytes(16 - len(data) % 16)
    return bytes(data + struct.pack("<I", VERSION) + bytes(120) + _LAST)


def _write_node(data: bytearray, node: FBXNode) -> None:
    """Add a node to the file; its head says where it ends, so that is filled in last."""
    at, name = len(data), node.name.encode()
    values = b"".join(_write_values(node.values))
    data += bytes(_HEAD.size) + name + values
    for child in node.children:
        _write_node(data, child)
    # An empty node ends those inside; a node without values has it, too.
    if node.children or not node.values:
        data += bytes(_HEAD.size)
    _HEAD.pack_into(data, at, len(data), len(node.values), len(values), len(name))


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
