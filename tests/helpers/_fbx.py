"""Build FBX files for tests: nodes, written as binary or as text."""

from __future__ import annotations

import struct
import zlib
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from itertools import count
from typing import Any

import numpy as np

from kineme._util.rotations import to_euler
from kineme.recordings import Motion
from kineme.recordings.kinematics import compute_local_translations

TICKS = 46_186_158_000
CODES = {"<f4": "f", "<f8": "d", "<i8": "l", "<i4": "i"}
LINEAR, CONSTANT, CUBIC = 0x4, 0x2, 0x8


@dataclass(frozen=True)
class Name:
    """An object's name and its class."""

    name: str
    kind: str


@dataclass
class Node:
    name: str
    values: tuple[Any, ...] = ()
    children: list[Node] = field(default_factory=list)


def make_node(name: str, *values: Any, children: Iterable[Node] = ()) -> Node:
    return Node(name, values, list(children))


def encode_binary(nodes: Sequence[Node], version: int = 7400, *, packed: bool = True) -> bytes:
    wide = version >= 7500
    head = b"Kaydara FBX Binary  \x00\x1a\x00" + struct.pack("<I", version)
    body = b"".join
    data = head
    for each in nodes:
        data += _encode_node(each, len(data), wide, packed)
    return body([data, bytes(25 if wide else 13), bytes(160)])


def _encode_node(each: Node, at: int, wide: bool, packed: bool) -> bytes:
    head = struct.Struct("<QQQB" if wide else "<IIIB")
    name = each.name.encode()
    values = b"".join(_encode_value(value, packed) for value in each.values)
    start = at + head.size + len(name) + len(values)
    inside = bytearray()
    for child in each.children:
        inside += _encode_node(child, start + len(inside), wide, packed)
    if each.children:
        inside += bytes(head.size)
    end = start + len(inside)
    return head.pack(end, len(each.values), len(values), len(name)) + name + values + inside


def _encode_value(value: Any, packed: bool) -> bytes:
    if isinstance(value, np.ndarray):
        raw = value.astype(value.dtype.newbyteorder("<")).tobytes()
        code = CODES[value.dtype.newbyteorder("<").str]
        stored = zlib.compress(raw) if packed else raw
        return code.encode() + struct.pack("<III", len(value), packed, len(stored)) + stored
    if isinstance(value, Name):
        value = f"{value.name}\x00\x01{value.kind}"
    if isinstance(value, str):
        return b"S" + struct.pack("<I", len(value.encode())) + value.encode()
    if isinstance(value, bool):
        return b"C" + struct.pack("<b", value)
    if isinstance(value, int):
        return b"L" + struct.pack("<q", value)
    return b"D" + struct.pack("<d", value)


def format_text(nodes: Sequence[Node], version: int = 7400) -> bytes:
    lines = [f"; FBX {version // 1000}.{version % 1000 // 100}.0 project file", "; ----", ""]
    for each in nodes:
        lines += _format_node(each, "")
    return ("\n".join(lines) + "\n").encode()


def _format_node(each: Node, tab: str) -> Iterable[str]:
    if len(each.values) == 1 and isinstance(each.values[0], np.ndarray):
        array = each.values[0]
        yield f"{tab}{each.name}: *{len(array)} {{"
        yield f"{tab}\ta: " + ",".join(map(repr, _list_numbers(array, each.name)))
        yield f"{tab}}}"
        return
    said = ", ".join(_format_value(value) for value in each.values)
    opened = " {" if each.children or not each.values else ""
    yield f"{tab}{each.name}: {said}{opened}"
    for child in each.children:
        yield from _format_node(child, tab + "\t")
    if opened:
        yield f"{tab}}}"


def _list_numbers(array: np.ndarray, name: str) -> list[Any]:
    """Return the numbers of a text file: packed weights of keys are whole numbers."""
    numbers = array.tolist()
    if name == "KeyAttrDataFloat":
        bits = array.astype("<f4").view("<u4")
        numbers[2::4] = [int(b) for b in bits[2::4]]
    return numbers


def _format_value(value: Any) -> str:
    if isinstance(value, Name):
        return f'"{value.kind}::{value.name}"'
    if isinstance(value, str):
        return '"' + value.replace('"', "&quot;") + '"'
    if isinstance(value, bool):
        return "Y" if value else "N"
    return repr(value)


@dataclass
class Keys:
    """Keys of a curve: seconds, values and interpolation flags."""

    times: Sequence[float]
    values: Sequence[float]
    flags: Sequence[int] | int = LINEAR
    details: Sequence[Sequence[float]] = ()
    weights: Sequence[tuple[float, float]] = ()

    def nodes(self) -> list[Node]:
        n = len(self.times)
        alike = isinstance(self.flags, int) and not self.details and not self.weights
        rows = 1 if alike else n  # attributes that all keys share are stored once
        flags = [self.flags] * rows if isinstance(self.flags, int) else list(self.flags)
        details = np.zeros((rows, 4), "<f4")
        if self.details:
            details[:, : len(self.details[0])] = self.details
        if self.weights:
            packed = [round(r * 1e4) | round(b * 1e4) << 16 for r, b in self.weights]
            details[:, 2] = np.array(packed, "<u4").view("<f4")
        return [
            make_node("Default", 0.0),
            make_node("KeyVer", 4009),
            make_node("KeyTime", np.round(np.array(self.times) * TICKS).astype("<i8")),
            make_node("KeyValueFloat", np.array(self.values, "<f4")),
            make_node("KeyAttrFlags", np.array(flags, "<i4")),
            make_node("KeyAttrDataFloat", details.ravel()),
            make_node("KeyAttrRefCount", np.full(rows, n // rows, "<i4")),
        ]


def make_property(name: str, *values: Any) -> Node:
    kinds = {bool: "bool", int: "int", str: "KString"}
    kind = kinds.get(type(values[0]), "double")
    kind = {"TimeMode": "enum", "LocalStart": "KTime", "LocalStop": "KTime"}.get(name, kind)
    if name.startswith("Lcl"):
        kind = name
    elif len(values) == 3:
        kind = "Vector3D"
    elif name in ("RotationOrder", "InheritType", "BlendMode"):
        kind = "enum"
    return make_node("P", name, kind, "", "A", *values)


class Scene:
    """Build a file of models, takes with layers and curves, and settings."""

    def __init__(self, **settings: Any) -> None:
        self.ids = count(1000)
        self.objects: list[Node] = []
        self.links: list[Node] = []
        self.settings = {
            "UpAxis": 1, "UpAxisSign": 1, "FrontAxis": 2, "FrontAxisSign": 1, "CoordAxis": 0,
            "CoordAxisSign": 1, "UnitScaleFactor": 1.0, "TimeMode": 6, **settings,
        }  # fmt: skip

    def _object(self, kind: str, name: Name, sort: str, said: dict[str, Any], *more: Node) -> int:
        number = next(self.ids)
        props = [
            make_property(key, *np.atleast_1d(np.array(value, object)))
            for key, value in said.items()
        ]
        held = [make_node("Properties70", children=props)] if props else []
        self.objects.append(make_node(kind, number, name, sort, children=[*held, *more]))
        return number

    def link(self, kind: str, part: int, whole: int, *what: str) -> None:
        self.links.append(make_node("C", kind, part, whole, *what))

    def model(self, name: str, parent: int = 0, kind: str = "LimbNode", **said: Any) -> int:
        said = {key.replace("Lcl", "Lcl "): value for key, value in said.items()}
        number = self._object(
            "Model",
            Name(name, "Model"),
            kind,
            said,
            make_node("Version", 232),
            make_node("Culling", "CullingOff"),
        )
        if kind in ("LimbNode", "Null", "Root"):
            attribute = self._object("NodeAttribute", Name(name, "NodeAttribute"), kind, {})
            self.link("OO", attribute, number)
        self.link("OO", number, parent)
        return number

    def take(self, name: str, start: float = 0.0, stop: float = 0.0) -> int:
        span = {"LocalStart": round(start * TICKS), "LocalStop": round(stop * TICKS)}
        return self._object(
            "AnimationStack", Name(name, "AnimStack"), "", span if stop > start else {}
        )

    def layer(self, take: int, name: str = "BaseLayer", **said: Any) -> int:
        number = self._object("AnimationLayer", Name(name, "AnimLayer"), "", said)
        self.link("OO", number, take)
        return number

    def animate(
        self, layer: int, model: int, what: str, rest: Sequence[float] = (0, 0, 0), **axes: Keys
    ) -> int:
        """Animate "T", "R", "S" or a named property; ``rest`` applies to axes without keys."""
        full = {"T": "Lcl Translation", "R": "Lcl Rotation", "S": "Lcl Scaling"}.get(what, what)
        said = {f"d|{axis}": float(value) for axis, value in zip("XYZ", rest, strict=True)}
        part = self._object("AnimationCurveNode", Name(what, "AnimCurveNode"), "", said)
        self.link("OO", part, layer)
        self.link("OP", part, model, full)
        for axis, keys in axes.items():
            curve = self._object("AnimationCurve", Name("", "AnimCurve"), "", {}, *keys.nodes())
            self.link("OP", curve, part, f"d|{axis}")
        return part

    def nodes(self, version: int = 7400) -> list[Node]:
        settings = [make_property(name, value) for name, value in self.settings.items()]
        kinds = sorted({each.name for each in self.objects})
        types = [make_node("ObjectType", kind, children=[make_node("Count", 1)]) for kind in kinds]
        document = make_node("Document", 99, "", "Scene", children=[make_node("RootNode", 0)])
        header = [make_node("FBXHeaderVersion", 1003), make_node("FBXVersion", version)]
        return [
            make_node("FBXHeaderExtension", children=header),
            make_node("GlobalSettings", children=[make_node("Properties70", children=settings)]),
            make_node("Documents", children=[make_node("Count", 1), document]),
            make_node("Definitions", children=[make_node("Count", len(self.objects)), *types]),
            make_node("Objects", children=self.objects),
            make_node("Connections", children=self.links),
        ]

    def binary(self, version: int = 7400, *, packed: bool = True) -> bytes:
        return encode_binary(self.nodes(version), version, packed=packed)

    def text(self, version: int = 7400) -> bytes:
        return format_text(self.nodes(version), version)


def make_walker(**settings: Any) -> Scene:
    """Return a small body that walks in one take and bends in another, and a prop."""
    scene = Scene(**{"TimeMode": 3, **settings})
    walk, bow = scene.take("walk", 0.0, 2.0), scene.take("bow", 0.5, 1.0)
    layers = scene.layer(walk), scene.layer(bow)
    body = scene.model("Body", 0, "Null")
    hips = scene.model("Hips", body, LclTranslation=[0.0, 95.0, 0.0])
    spine = scene.model("Spine", hips, LclTranslation=[0.0, 20.0, 0.0], PreRotation=[0.0, 0.0, 9.0])
    head = scene.model("Head", spine, LclTranslation=[0.0, 45.0, 0.0])
    scene.model("Head_end", head, LclTranslation=[0.0, 20.0, 0.0])
    box = scene.model("Box", 0, "Mesh")
    times = np.arange(0, 121) / 60
    for side, x in (("Left", 10.0), ("Right", -10.0)):
        thigh = scene.model(f"{side}UpLeg", hips, LclTranslation=[x, -5.0, 0.0], RotationOrder=2)
        foot = scene.model(f"{side}Foot", thigh, LclTranslation=[0.0, -85.0, 0.0])
        scene.model(f"{side}Toe_end", foot, "Null", LclTranslation=[0.0, -5.0, 15.0])
        arm = scene.model(f"{side}Arm", spine, LclTranslation=[2 * x, 40.0, 0.0])
        scene.model(f"{side}Hand", arm, LclTranslation=[5 * x, 0.0, 0.0])
        swing = 30 * np.sin(np.pi * times) * np.sign(x)
        scene.animate(layers[0], thigh, "R", X=Keys(times, swing), Y=Keys([0, 2], [0, 10]))
        scene.animate(layers[0], arm, "R", X=Keys(times, -swing))
    scene.animate(layers[0], hips, "T", (0, 95, 0), Z=Keys([0, 2], [0, 200]))
    scene.animate(layers[0], box, "T", X=Keys([0, 1], [0, 100]))
    scene.animate(layers[1], spine, "R", X=Keys([0.5, 1], [0, 60], CUBIC | 0x6100))
    return scene


def make_scene(motion: Motion) -> Scene:
    """Return a motion with rotations as a scene: bones, with a key at every frame."""
    if motion.rotations is None:
        raise ValueError("a scene needs rotations")
    scene = Scene(TimeMode=14, CustomFrameRate=float(motion.fps))
    skeleton, times = motion.skeleton, np.arange(motion.n_frames) / motion.fps
    layer = scene.layer(scene.take("motion", 0.0, float(times[-1])))
    shifts = 100 * compute_local_translations(skeleton, motion.positions, motion.rotations)
    angles = np.degrees(to_euler(motion.rotations, "zyx"))[..., ::-1]  # about x, first applied
    models: list[int] = []
    for j, parent in enumerate(skeleton.parents):
        rest = [float(x) for x in 100 * skeleton.offsets[j]]
        carrier = models[parent] if parent >= 0 else 0
        models.append(scene.model(skeleton.names[j], carrier, LclTranslation=rest))
        if j not in skeleton.end_sites:
            turns = np.unwrap(angles[:, j], axis=0, period=360)
            axes = {axis: Keys(times, turns[:, i]) for i, axis in enumerate("XYZ")}
            scene.animate(layer, models[j], "R", **axes)
        if parent < 0:
            axes = {axis: Keys(times, shifts[:, j, i]) for i, axis in enumerate("XYZ")}
            scene.animate(layer, models[j], "T", **axes)
    return scene
