"""Read the objects of an FBX file, their connections, and the transforms of its models.

Objects have a number, a name, a class and properties; defaults are in the template of the class.
Connections make one object part of another, or let it drive a property of the other. An animation
stack (a take) has layers. A layer has curve nodes, each of which drives a property of a model by a
curve for each axis::

    AnimationStack <- AnimationLayer <- AnimationCurveNode <- AnimationCurve
                                        AnimationCurveNode -> Model, "Lcl Rotation"

The transform of a model relative to its parent is the product::

    T Roff Rp Rpre R Rpost^-1 Rp^-1 Soff Sp S Sp^-1

of translation, rotation offset and pivot, pre-rotation, rotation, post-rotation, scaling offset
and pivot, and scaling. Rotations are Euler angles in degrees: the rotation in the order of the
model (``RotationOrder``), pre- and post-rotation about x, then y, then z.

Layers above the first are added to it or replace it, according to their weight. The layer states
whether rotations are added per axis or multiplied.

Source: Autodesk, FBX SDK, "Computing transformation matrices", and `FbxAnimLayer`.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from math import isfinite
from typing import Any

import numpy as np
from numpy.typing import NDArray

from kineme._util import rotations as rot
from kineme._util.arrays import Floats
from kineme.formats.files import FileContent
from kineme.formats.scenes.assembly import Inheritance, Transform, compose, decompose
from kineme.formats.scenes.characters import SceneNode, is_end
from kineme.formats.scenes.fbx_curves import Curve, CurveReader, Sampler
from kineme.formats.scenes.fbx_file import FBXNode
from kineme.formats.skeletons.placing import order_depth_first
from kineme.formats.units import iterate_blocks

BONES = frozenset({"LimbNode", "Limb", "Root", "Effector", "IKEffector", "FKEffector"})
GEOMETRY = frozenset({"Mesh", "Camera", "CameraSwitcher", "Light", "Nurbs", "NurbsCurve", "Line"})

TRANSLATION, ROTATION, SCALING = "Lcl Translation", "Lcl Rotation", "Lcl Scaling"

# Axes from left to right in the product of rotations; the last one is applied first.
_ORDERS = ("zyx", "yzx", "xzy", "zxy", "yxz", "xyz", "zyx")
INHERITANCE: tuple[Inheritance, ...] = ("RrSs", "RSrs", "Rrs")
# Values of BlendMode, ScaleAccumulationMode and RotationAccumulationMode.
_OVERRIDE, _PASS_THROUGH = 1, 2
_MULTIPLY, _BY_CHANNEL = 0, 1
_MAX_VALUE = 1e100  # larger numbers are damage

Properties = dict[str, list[object]]


@dataclass(frozen=True)
class Take:
    """An animation stack: the numbers of its layers, the base first, and its span in ticks.

    The span is 0 to 0 if the file does not state it.
    """

    name: str
    layers: list[int]
    start: float
    stop: float


REST_TAKE = Take("", [], 0.0, 0.0)
"""A take that moves nothing."""


@dataclass(frozen=True)
class Model:
    """A node of the scene with its number and properties."""

    number: int
    name: str
    kind: str
    parent: int
    properties: Properties


class FBXScene:
    """Models, takes and settings of a file."""

    def __init__(self, content: FileContent, root: FBXNode) -> None:
        self.content = content
        self.objects: dict[int, FBXNode] = {}
        for group in root.all("Objects"):
            for node in group.children:
                if node.values and isinstance(node.values[0], int):
                    self.objects[node.values[0]] = node
        self._reader = CurveReader(content)
        self.settings = _read_properties(root.child("GlobalSettings"))
        self._templates = _read_templates(root)
        self._parts: dict[int, list[int]] = {}
        self._driven: dict[int, list[tuple[int, str]]] = {}
        self._driving: dict[int, list[tuple[int, str]]] = {}
        for group in root.all("Connections"):
            for link in group.children:
                self._connect(link)
        self.bones = self._find_bones()
        self.binds = self._read_binds()
        self.models = self._order_models()
        self.takes = self._read_takes(root)

    def _connect(self, link: FBXNode) -> None:
        """Store a connection of an object to another one (OO), or to a property of it (OP)."""
        part, parent = link.number(1, -1), link.number(2, -1)
        if not (isinstance(part, int) and isinstance(parent, int)):
            return
        if link.text(0) == "OO":
            self._parts.setdefault(parent, []).append(part)
        elif link.text(0) == "OP":
            self._driven.setdefault(part, []).append((parent, link.text(3)))
            self._driving.setdefault(parent, []).append((part, link.text(3)))

    def _find_bones(self) -> set[int]:
        """Return the numbers of the models that are bones, by kind or by being part of a skin."""
        bones: set[int] = set()
        for number, node in self.objects.items():
            if node.name == "Model" and node.text(2) in BONES:
                bones.add(number)
            elif node.name == "Deformer" and node.text(2) == "Cluster":
                # Models connected to the cluster of a skin are bones.
                bones |= {part for part in self._parts.get(number, ()) if self._is(part, "Model")}
        return bones

    def _read_binds(self) -> dict[int, Floats]:
        """Return the world matrix of each model in the bind pose.

        Matrices of skin clusters override those of poses.
        """
        matrices: dict[int, Floats] = {}
        for number, node in self.objects.items():
            found: list[tuple[float, NDArray[Any] | None]] = []
            if node.name == "Pose":
                for entry in node.all("PoseNode"):
                    if reference := entry.child("Node"):
                        matrix = entry.array("Matrix")
                        found.append((reference.number(0, -1), matrix))
            elif node.name == "Deformer" and node.text(2) == "Cluster":
                matrix = node.array("TransformLink")
                found += [(part, matrix) for part in self._parts.get(number, ())]
            for model, matrix in found:
                if matrix is not None and len(matrix) == 16 and np.isfinite(matrix).all():
                    # The file stores columns first.
                    matrices[int(model)] = matrix.reshape(4, 4).T.astype(np.float64)
        return matrices

    def _order_models(self) -> list[Model]:
        """Return all models, parents before their children, without cycles."""
        models: list[Model] = []
        children = {part for parent in self.objects for part in self._parts.get(parent, ())}
        tops = dict.fromkeys(self._parts.get(0, []))
        # Models without parent are at the top, whether connected to the scene or not.
        tops |= dict.fromkeys(number for number in self.objects if number not in children)

        def select_models(numbers: Iterable[int]) -> list[int]:
            return [number for number in numbers if self._is(number, "Model")]

        for number, parent in order_depth_first(
            select_models(tops), lambda number: select_models(self._parts.get(number, ()))
        ):
            node = self.objects[number]
            name = _strip_class(node.text(1)) or "joint"
            properties = {**self._templates.get("Model", {}), **_read_properties(node)}
            models.append(Model(number, name, node.text(2), parent, properties))
        return models

    def _read_takes(self, root: FBXNode) -> list[Take]:
        """Return the takes with their layers and spans in ticks."""
        spans = _read_spans(root)
        takes = []
        for number, node in self.objects.items():
            if node.name != "AnimationStack":
                continue
            name = _strip_class(node.text(1)) or "take"
            layers = [p for p in self._parts.get(number, ()) if self._is(p, "AnimationLayer")]
            properties = _read_properties(node)
            span = spans.get(name, (0.0, 0.0))
            # The local span has priority over the reference span.
            for kind in ("Reference", "Local"):
                start = _get_number(properties, f"{kind}Start", 0)
                stop = _get_number(properties, f"{kind}Stop", 0)
                span = (start, stop) if stop > start else span
            takes.append(Take(name, layers, *span))
        return takes

    def _is(self, number: int, name: str) -> bool:
        node = self.objects.get(number)
        return node is not None and node.name == name

    def make_nodes(self, moved: set[int]) -> list[SceneNode]:
        """Return the models as nodes of a scene; ``moved`` are the numbers of animated ones."""
        return [
            SceneNode(
                each.name,
                each.parent,
                bone=each.number in self.bones,
                geometry=each.kind in GEOMETRY,
                animated=each.number in moved,
                end=is_end(each.name),
            )
            for each in self.models
        ]

    def find_moved(self, take: Take) -> set[int]:
        """Return the numbers of the models that a take drives."""
        return {model for model, _ in self._iterate_curves(take)}

    def iterate_key_times(self, take: Take, models: list[int]) -> Iterator[Floats]:
        """Yield the times in ticks of the keys of each curve that moves one of these models."""
        numbers = set(models)
        for model, number in self._iterate_curves(take):
            if model in numbers and (curve := self._reader.read(self.objects[number])):
                yield curve.times

    def _iterate_curves(self, take: Take) -> Iterator[tuple[int, int]]:
        """Yield the numbers of each model that a take drives and of the curve that drives it."""
        for (model, property_name), tracks in self.find_tracks(take).items():
            if property_name in (TRANSLATION, ROTATION, SCALING):
                for _, part in tracks:
                    for number, _ in self._driving.get(part, ()):
                        if self._is(number, "AnimationCurve"):
                            yield model, number

    def find_tracks(self, take: Take) -> dict[tuple[int, str], list[tuple[int, int]]]:
        """Return layers and curve nodes of each model and property, the base layer first."""
        tracks: dict[tuple[int, str], list[tuple[int, int]]] = {}
        for layer in take.layers:
            for part in self._parts.get(layer, ()):
                if self._is(part, "AnimationCurveNode"):
                    for driven in self._driven.get(part, ()):
                        tracks.setdefault(driven, []).append((layer, part))
        return tracks

    def read_curves(self, number: int) -> dict[str, Curve]:
        """Return the curves of a curve node by axis, ``d|X`` and so on."""
        curves = {}
        for part, axis in self._driving.get(number, ()):
            if self._is(part, "AnimationCurve") and (
                curve := self._reader.read(self.objects[part])
            ):
                curves[axis] = curve
        return curves

    def get_setting(self, name: str, default: float) -> float:
        """Return a number in the file's global settings."""
        return _get_number(self.settings, name, default)

    def get_properties(self, number: int) -> Properties:
        return _read_properties(self.objects.get(number))


class Pose:
    """Transforms of models at the frames of a take."""

    def __init__(self, scene: FBXScene, take: Take, sampler: Sampler) -> None:
        self.scene, self.sampler = scene, sampler
        self.tracks = scene.find_tracks(take)
        self.layers = {number: scene.get_properties(number) for number in take.layers}

    def compute_bind_transform(self, index: int) -> Transform:
        """Return the transform of a model in the bind pose, or in this pose if it has none."""
        model = self.scene.models[index]
        if model.number not in self.scene.binds:
            return self.compute_transform(index)
        # Bind poses are in the world: solve for the transform relative to the parent.
        local = np.linalg.solve(
            self._compute_bind_matrix(model.parent), self._compute_bind_matrix(index)
        )
        return decompose(np.asarray(local, np.float64))

    def _compute_bind_matrix(self, index: int) -> Floats:
        """Return the world matrix of a model in the bind pose; index -1 is the ground."""
        if index < 0:
            return np.eye(4)
        model = self.scene.models[index]
        if (bind := self.scene.binds.get(model.number)) is not None:
            return bind
        local = [part[None] for part in self.compute_transform(index)[:3]]
        return np.asarray(self._compute_bind_matrix(model.parent) @ compose(*local)[0], np.float64)

    def compute_transform(self, index: int) -> Transform:
        """Return the transform of the model at an index of the scene, relative to its parent."""
        model = self.scene.models[index]
        properties = model.properties
        order = _ORDERS[_get_choice(properties, "RotationOrder", len(_ORDERS))]
        turn = self._compute_rotation(model, order)
        pre_rotation, post_rotation = (
            _get_vector(properties, f"{kind}Rotation") for kind in ("Pre", "Post")
        )
        if pre_rotation.any():
            turn = rot.multiply(_to_rotation(pre_rotation, "zyx"), turn)
        if post_rotation.any():
            turn = rot.multiply(turn, rot.conjugate(_to_rotation(post_rotation, "zyx")))
        scale = self._combine_layers(model, SCALING, 1.0)
        shift = self._combine_layers(model, TRANSLATION, 0.0)
        shift = _add_pivots(properties, shift, turn, scale)
        inheritance = INHERITANCE[_get_choice(properties, "InheritType", len(INHERITANCE))]
        return Transform(shift, turn, scale, inheritance)

    def _compute_rotation(self, model: Model, order: str) -> Floats:
        """Return the rotation of a model, (4,) or (frames, 4)."""
        angles = _get_vector(model.properties, ROTATION)
        turn: Floats | None = None  # replaces the angles once layers were multiplied
        for value, weight, properties in self._sample_layers(model, ROTATION, angles):
            # A weight of None replaces all previous layers.
            if weight is None:
                angles, turn = value, None
            elif _get_choice(properties, "RotationAccumulationMode", 2) == _BY_CHANNEL:
                # Layers are added per axis, so convert a product back to angles.
                angles = angles if turn is None else to_angles(turn, order)
                angles = angles * _weigh_previous(weight, properties) + value * weight
                turn = None
            else:
                turn = _to_rotation(angles, order) if turn is None else turn
                layer = _to_rotation(value, order)
                if _replaces(properties):
                    # Rotation from the previous layers to this one.
                    layer = rot.multiply(rot.conjugate(turn), layer)
                # The weight scales the angle of the rotation.
                turn = rot.multiply(
                    turn, rot.from_rotation_vectors(weight * rot.to_rotation_vectors(layer))
                )
        return _to_rotation(angles, order) if turn is None else turn

    def _combine_layers(self, model: Model, property_name: str, default: float) -> Floats:
        """Return a property of a model combined from all layers, (3,) or (frames, 3)."""
        # Values without animation, which axes without a curve keep.
        result = _get_vector(model.properties, property_name, default)
        for value, weight, properties in self._sample_layers(model, property_name, result):
            # A weight of None replaces all previous layers.
            if weight is None:
                result = value
                continue
            previous_weight = _weigh_previous(weight, properties)
            mode = _get_choice(properties, "ScaleAccumulationMode", 2)
            if property_name == SCALING and mode == _MULTIPLY:  # weights are exponents
                result = np.abs(result) ** previous_weight * np.abs(value) ** weight
            else:
                result = result * previous_weight + value * weight
        return result

    def _sample_layers(
        self, model: Model, property_name: str, default: Floats
    ) -> Iterator[tuple[Floats, Floats | float | None, Properties]]:
        """Yield value, weight (None: replaces all others) and properties of each layer.

        The base layer, the first, is never blended: its values replace those without animation.
        """
        base = next(iter(self.layers), None)
        for layer, part in self.tracks.get((model.number, property_name), ()):
            table = self.layers[layer]
            if layer == base:
                yield self._sample_curve(part, default), None, table
            elif not _get_number(table, "Mute", 0):
                # Axes without a curve add nothing: 0, or a scale of 1.
                rest = np.full(3, 1.0 if property_name == SCALING else 0.0)
                overrides = _get_choice(table, "BlendMode", 3) == _OVERRIDE
                weight = None if overrides else self._sample_weight(layer)
                yield self._sample_curve(part, rest), weight, table

    def _sample_weight(self, layer: int) -> Floats | float:
        """Return the weight of a layer as a number or (frames, 1)."""
        table = self.layers[layer]
        for _, part in self.tracks.get((layer, "Weight"), ()):
            for curve in self.scene.read_curves(part).values():
                # Weights are stored in percent.
                sampled = np.clip(np.asarray(self.sampler.sample(curve)) / 100, 0, 1)
                return sampled[:, None] if sampled.ndim else float(sampled)
        return min(max(_get_number(table, "Weight", 100.0) / 100, 0.0), 1.0)

    def _sample_curve(self, part: int, defaults: Floats) -> Floats:
        """Return the values of a curve node for the three axes, (3,) or (frames, 3)."""
        curves, table = self.scene.read_curves(part), self.scene.get_properties(part)
        axes = []
        for letter, default in zip("XYZ", defaults.tolist(), strict=True):
            curve = curves.get(f"d|{letter}")
            constant = np.float64(_get_number(table, f"d|{letter}", default))
            axes.append(constant if curve is None else self.sampler.sample(curve))
        return np.stack(np.broadcast_arrays(*axes)).T  # each axis is contiguous


def invert_transform(
    model: Model, shifts: Floats, turns: Floats, scale: Floats
) -> tuple[Floats, Floats]:
    """Return the translations and angles that give a model these transforms.

    All are (frames, 3), except ``turns`` (frames, 4); ``scale`` (3,) is the model's own.
    """
    properties = model.properties
    order = _ORDERS[_get_choice(properties, "RotationOrder", len(_ORDERS))]
    pre_rotation, post_rotation = (
        _to_rotation(_get_vector(properties, f"{kind}Rotation"), "zyx") for kind in ("Pre", "Post")
    )
    own_turns = rot.multiply(rot.multiply(rot.conjugate(pre_rotation), turns), post_rotation)
    # The contribution of pivots does not depend on the translation.
    shifts = shifts - _add_pivots(properties, np.zeros(3), turns, scale)
    return shifts, to_angles(own_turns, order, unwrapped=True)


def _replaces(properties: Properties) -> bool:
    """Return whether a layer replaces the previous ones according to its weight."""
    return _get_choice(properties, "BlendMode", 3) == _PASS_THROUGH


def _weigh_previous(weight: Floats | float, properties: Properties) -> Floats | float:
    """Return the weight of the previous layers under a layer of this weight."""
    return 1 - weight if _replaces(properties) else 1.0


def _to_rotation(angles: Floats, axes: str) -> Floats:
    """Return rotations (..., 4) for angles about x, y and z in degrees, multiplied in order."""
    order = ["xyz".index(axis) for axis in axes]
    if angles.ndim == 1:
        return rot.from_euler(np.radians(angles[None, order]), axes).reshape(4)
    rotations = np.empty((4, len(angles)))
    for span in iterate_blocks(len(angles)):
        rotations[:, span] = rot.from_euler(np.radians(angles[span].T[order]).T, axes).T
    return rotations.T


def to_angles(turns: Floats, axes: str, *, unwrapped: bool = False) -> Floats:
    """Return angles about x, y and z in degrees whose product in this order is the rotation.

    If ``unwrapped``, they are those nearest to the frame before, so that no joint spins between.
    """
    angles = rot.to_euler(turns, axes)
    if unwrapped:
        angles = rot.unwrap_euler(angles)
    return np.asarray(np.degrees(angles)[..., [axes.index(axis) for axis in "xyz"]])


def _add_pivots(properties: Properties, shift: Floats, turn: Floats, scale: Floats) -> Floats:
    """Return the translation including the contribution of pivots and their offsets.

    With pivots P, offsets O, rotation R and scale S, it is T + Or + Pr + R (Os - Pr + Ps - S Ps).
    """
    shift = shift + _get_vector(properties, "RotationOffset")
    pivot = _get_vector(properties, "RotationPivot")
    center = _get_vector(properties, "ScalingPivot")
    lever = _get_vector(properties, "ScalingOffset") - pivot
    if center.any():
        lever = lever + center - scale * center
    if pivot.any() or lever.any():
        shift = shift + pivot + rot.rotate(turn, lever)
    return np.asarray(shift, np.float64)


def _read_templates(root: FBXNode) -> dict[str, Properties]:
    """Return the default properties of each class of objects."""
    templates: dict[str, Properties] = {}
    for group in root.all("Definitions"):
        for kind in group.all("ObjectType"):
            for template in kind.all("PropertyTemplate"):
                templates.setdefault(kind.text(0), _read_properties(template))
    return templates


def _read_spans(root: FBXNode) -> dict[str, tuple[float, float]]:
    """Return the spans of takes by name, from the section for older programs."""
    spans = {}
    for group in root.all("Takes"):
        for take in group.all("Take"):
            for kind in ("ReferenceTime", "LocalTime"):
                span = take.child(kind)
                if span and span.number(1) > span.number(0):
                    spans[take.text(0)] = float(span.number(0)), float(span.number(1))
    return spans


def _read_properties(node: FBXNode | None) -> Properties:
    """Return the values of an object's properties by name."""
    table = node.child("Properties70") if node else None
    if table is None:
        return {}
    # Name, two types and flags precede the values.
    return {entry.text(0): entry.values[4:] for entry in table.all("P")}


def _get_number(properties: Properties, name: str, default: float) -> float:
    value = (properties.get(name) or [default])[0]
    if not isinstance(value, int | float) or not isfinite(value):
        return default
    return float(value)


def _get_choice(properties: Properties, name: str, count: int) -> int:
    """Return a property below ``count``, else 0."""
    value = _get_number(properties, name, 0)
    return int(value) if 0 <= value < count else 0


def _get_vector(properties: Properties, name: str, default: float = 0.0) -> Floats:
    values = properties.get(name) or []
    numbers = [v for v in values[:3] if isinstance(v, int | float) and abs(v) < _MAX_VALUE]
    return np.array(numbers, np.float64) if len(numbers) == 3 else np.full(3, default)


def _strip_class(name: str) -> str:
    """Return an object's name without its class."""
    # Binary files store `name\0\1class`, text files `class::name`.
    name = name.partition("\0\1")[0]
    head, mark, tail = name.partition("::")
    return tail if mark and head.isidentifier() else name
