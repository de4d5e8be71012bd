"""Writing glTF 2.0: a skeleton, a mesh on it, and one animation or several.

The nodes are those of the rig that the motion came from, at rest as there; of a motion without a
rig each joint is a node at its offset, and all hang on one that is called as the file. A mesh of a
slim bone for each joint makes programs see a skeleton: without one Blender imports empties, and
Godot nothing. Rotations have a key at each frame, translations where a joint slides. All numbers
are of 32 bits: a thousandth of a millimetre.

``asset.extras.kineme.fps`` is the frame rate, which the format has no place for; ``end_site``
among the extras of a node says that it is one.

The JSON is written by hand: it is a few dictionaries, and packages for it bring no check that
Khronos' validator, which the benchmarks run, does not make better.

Source: Khronos Group, "glTF 2.0 specification", sections 3.7.3 and 3.11.
"""

from __future__ import annotations

import base64
import json
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from kineme._util.arrays import Floats
from kineme._util.files import atomic_write
from kineme._version import __version__
from kineme.errors import WriteError
from kineme.formats.files import clean_names, require_rotations
from kineme.formats.gaps import warn_of_gaps
from kineme.formats.scenes.assembly import compose
from kineme.formats.scenes.gltf_file import BYTES, CHUNK, HEADER, JSON, MAGIC
from kineme.formats.skeletons.bvh_writer import RIGID
from kineme.recordings import Motion, Skeleton
from kineme.recordings.posing import get_rig, pose_rig
from kineme.recordings.rig import Rig

EXTRAS = "kineme"
"""Name of what kineme adds to the extras of a file."""

THICK = 0.08
"""Share of its length that a bone of the mesh is wide."""

SHORT = 0.05
"""Metres: how long a bone without a child is drawn."""

_FLOAT, _BYTE, _SHORT, _INT = 5126, 5121, 5123, 5125
_KEYS, _VERTICES, _INDICES = None, 34962, 34963
_TYPES = {1: "SCALAR", 3: "VEC3", 4: "VEC4", 16: "MAT4"}
_RING = ((1, 0), (0, 1), (-1, 0), (0, -1))


def write_gltf(motion: Motion, path: Path) -> None:
    """Leave ``motion`` in a GLB, or in a ``.gltf`` with its buffer in it."""
    write_animations({path.stem: motion}, path)


def write_animations(motions: Mapping[str, Motion], path: Path) -> None:
    """Leave motions of one skeleton, one at least, in a file, each as an animation of its name.

    A ``.gltf`` has its buffer in it.
    """
    file = _Writer(check_animations(motions, path), path)
    for name, motion in motions.items():
        file.animate(name, motion)
    save_gltf(file.tree, bytes(file.data), path)


def check_animations(motions: Mapping[str, Motion], path: Path, what: str = "a glTF") -> Motion:
    """Return the first of motions that are to be written as animations of one skeleton.

    WriteError where one has no rotations or another skeleton.
    """
    first = next(iter(motions.values()))
    for motion in motions.values():
        require_rotations(motion, path, what)
        if motion.skeleton is not first.skeleton and not _is_same_skeleton(
            motion.skeleton, first.skeleton
        ):
            raise WriteError(path, "its animations are of different skeletons: write several files")
    warn_of_gaps(motions.values(), path)
    return first


def check_copy(motions: Mapping[str, Motion], source: Path, path: Path) -> Skeleton:
    """Return the skeleton of motions that are to be animations in a copy of their file.

    WriteError where its bones cannot be placed in that file, or as for `check_animations`.
    """
    skeleton = check_animations(motions, path, f"a copy of {source.name}").skeleton
    if skeleton.rig is None or not skeleton.rig.numbers:
        raise make_uneven_error(source, path)
    return skeleton


def make_uneven_error(source: Path, path: Path) -> WriteError:
    """Return the error for bones whose rest no rig can have."""
    return WriteError(path, f"the bones of {source.name} are mirrored or scaled unevenly at rest")


def save_gltf(tree: dict[str, Any], data: bytes, path: Path) -> None:
    """Leave the JSON and its only buffer in a GLB, or in a ``.gltf`` with the buffer in it."""
    buffer: dict[str, Any] = {"byteLength": len(data)}
    binary = path.suffix.lower() != ".gltf"
    if not binary:
        stored = base64.b64encode(data).decode()
        buffer["uri"] = f"data:application/octet-stream;base64,{stored}"
    text = json.dumps({**tree, "buffers": [buffer]}, ensure_ascii=False, separators=(",", ":"))
    with atomic_write(path) as draft:
        draft.write_bytes(_encode_glb(text.encode(), data) if binary else text.encode())


def _is_same_skeleton(one: Skeleton, other: Skeleton) -> bool:
    if one.names != other.names or one.parents != other.parents:
        return False
    if one.rig is None or other.rig is None or not one.rig.numbers:
        return np.allclose(one.offsets, other.offsets, atol=RIGID)
    # Offsets of joints that slide depend on the take; the nodes of one file at rest do not.
    rest, others = (
        np.hstack([rig.translations, rig.rotations, rig.scales]) for rig in (one.rig, other.rig)
    )
    same = one.rig.numbers == other.rig.numbers
    return same and np.allclose(rest, others, atol=RIGID)


class Animator:
    """Adds animations to the JSON and the buffer of a file.

    ``numbers`` are those of the nodes of the joints.
    """

    def __init__(
        self, skeleton: Skeleton, rig: Rig, numbers: Sequence[int], tree: dict[str, Any]
    ) -> None:
        self.skeleton, self.rig, self.numbers, self.tree = skeleton, rig, numbers, tree
        self.data = bytearray()
        self.free_views: list[int] = []
        self.free_accessors: list[int] = []

    def animate(self, name: str, motion: Motion) -> None:
        """Add a motion of the same skeleton."""
        skeleton, n, rig = self.skeleton, motion.n_frames, self.rig
        shifts, turns = pose_rig(motion, rig)
        # Joints that leave their place at rest; the size of each one's parent tells how far.
        away = np.abs(shifts - rig.translations[rig.above :]).max(axis=(0, 2))
        still = np.ptp(shifts, axis=0).max(axis=1)
        nodes = range(rig.above, len(rig.names))
        sizes = np.array([rig.parent_world(node, *rig.world)[2] for node in nodes])
        limit = RIGID / rig.unit / sizes
        seconds = self.accessor(np.arange(n)[:, None] / motion.fps, _KEYS, bounds=True)
        start = self.accessor(np.zeros((1, 1)), _KEYS, bounds=True) if n > 1 else seconds
        channels: list[dict[str, Any]] = []
        samplers: list[dict[str, Any]] = []

        def add(joint: int, what: str, values: Floats) -> None:
            target = {"node": self.numbers[joint], "path": what}
            channels.append({"sampler": len(samplers), "target": target})
            keys = {"input": start if len(values) == 1 else seconds}
            samplers.append({**keys, "output": self.accessor(values, _KEYS)})

        for j in range(skeleton.n_joints):
            if away[j] > limit[j] or skeleton.parents[j] < 0:
                # A place that is another than at rest, but always the same, needs one key.
                add(j, "translation", shifts[: 1 if still[j] < limit[j] else n, j])
            if j not in skeleton.end_sites:
                # The format has w last.
                add(j, "rotation", np.roll(_align_signs(turns[:, j]), -1, axis=1))
        self.tree["animations"].append({"name": name, "channels": channels, "samplers": samplers})

    def accessor(
        self, values: NDArray[Any], target: int | None, kind: int = _FLOAT, *, bounds: bool = False
    ) -> int:
        """Keep an array (elements, numbers of each); its number."""
        codes = {_FLOAT: "<f4", _BYTE: "<u1", _SHORT: "<u2", _INT: "<u4"}
        stored = np.ascontiguousarray(values, codes[kind])
        view = {"buffer": 0, "byteOffset": len(self.data), "byteLength": stored.nbytes}
        if target is not None:
            view["target"] = target
        self.data += stored.tobytes()
        # Accessors must begin at multiples of four bytes.
        self.data += bytes(-len(self.data) % 4)
        accessor: dict[str, Any] = {
            "bufferView": _store_part(self.tree["bufferViews"], view, self.free_views),
            "componentType": kind,
            "count": len(stored),
            "type": _TYPES[stored.shape[1]],
        }
        # The format demands the extent of times and positions.
        if bounds:
            accessor |= {"min": stored.min(axis=0).tolist(), "max": stored.max(axis=0).tolist()}
        return _store_part(self.tree["accessors"], accessor, self.free_accessors)


class _Writer(Animator):
    """Gathers the parts of a file."""

    def __init__(self, motion: Motion, path: Path) -> None:
        skeleton = motion.skeleton
        # Lengths are metres in a glTF, and y is up.
        rig = get_rig(skeleton).to_metres()
        tree: dict[str, Any] = {
            "asset": {
                "version": "2.0",
                "generator": f"kineme {__version__}",
                "extras": {EXTRAS: {"fps": motion.fps}},
            },
            "scene": 0,
            "bufferViews": [],
            "accessors": [],
            "animations": [],
        }
        # Those above the joints come behind them, so that a joint's number is that of its node.
        super().__init__(skeleton, rig, range(skeleton.n_joints), tree)
        self.tree["nodes"] = self._nodes(path)
        n = len(self.tree["nodes"])
        self.tree["nodes"].append({"name": f"{path.stem}_mesh", "mesh": 0, "skin": 0})
        carried = {child for node in self.tree["nodes"] for child in node.get("children", ())}
        self.tree["scenes"] = [{"nodes": [node for node in range(n + 1) if node not in carried]}]
        self._add_mesh()

    def _nodes(self, path: Path) -> list[dict[str, Any]]:
        """Return a node for each joint, then what carries them."""
        rig, skeleton = self.rig, self.skeleton
        order = [*range(rig.above, len(rig.names)), *range(rig.above)]
        numbers = {node: number for number, node in enumerate(order)}
        names = clean_names(path, [*skeleton.names, *rig.names[: rig.above]], str.strip)
        nodes: list[dict[str, Any]] = [{"name": name} for name in names]
        for number, node in enumerate(order):
            nodes[number] |= describe_transform(rig, node)
            if number in skeleton.end_sites:
                nodes[number]["extras"] = {"end_site": True}
        for node, parent in enumerate(rig.parents):
            if parent >= 0:
                nodes[numbers[parent]].setdefault("children", []).append(numbers[node])
        if rig.above == 0:
            roots = [j for j, parent in enumerate(skeleton.parents) if parent < 0]
            nodes.append({"name": path.stem, "children": roots})
        return nodes

    def _add_mesh(self) -> None:
        """Bones to look at, bound to the joints where they are at rest."""
        skeleton, rig = self.skeleton, self.rig
        places, turns, sizes = (part[rig.above :] for part in rig.world)
        vertices, faces, joints = _build_bone_mesh(skeleton, places)
        rest = compose(places, turns, sizes)
        binds = rest if rig.binds is None else rig.binds
        # Each vertex hangs on one joint, so it goes to where the skin has that joint.
        carry = (binds @ np.linalg.inv(rest))[joints]
        vertices = np.einsum("vij,vj->vi", carry[:, :3, :3], vertices) + carry[:, :3, 3]
        # As small an integer as holds the numbers of all joints.
        kind = np.uint8 if skeleton.n_joints <= 256 else np.uint16
        bound = np.zeros((len(vertices), 4), kind)
        # Up to four joints may carry a vertex; one is enough here, with all of the weight.
        bound[:, 0] = joints
        weights = np.zeros((len(vertices), 4))
        weights[:, 0] = 1.0
        # Columns are stored one after another.
        inverse = np.linalg.inv(binds).transpose(0, 2, 1)
        inverse[:, :, 3] = [0.0, 0.0, 0.0, 1.0]  # exactly, as the format demands
        code = _BYTE if kind is np.uint8 else _SHORT
        attributes = {
            "POSITION": self.accessor(vertices, _VERTICES, bounds=True),
            "JOINTS_0": self.accessor(bound, _VERTICES, code),
            "WEIGHTS_0": self.accessor(weights, _VERTICES),
        }
        indices = self.accessor(faces.reshape(-1, 1), _INDICES, _INT)
        inverses = self.accessor(inverse.reshape(-1, 16), _KEYS)
        self.tree["meshes"] = [
            {"name": "bones", "primitives": [{"attributes": attributes, "indices": indices}]}
        ]
        self.tree["skins"] = [
            {
                "joints": list(range(skeleton.n_joints)),
                "inverseBindMatrices": inverses,
            }
        ]
        if rig.binds is not None:
            # These are counted from the node above all joints.
            self.tree["skins"][0]["skeleton"] = skeleton.n_joints + max(rig.above, 1) - 1


def _store_part(parts: list[Any], part: Any, free: list[int]) -> int:
    """Keep a part in a list of the JSON, at a number that is free; its number."""
    if free:
        number = free.pop(0)
        parts[number] = part
        return number
    parts.append(part)
    return len(parts) - 1


def describe_transform(rig: Rig, node: int) -> dict[str, Any]:
    """Return what the JSON says of a node at rest; nothing of what is as usual."""
    parts = {
        "translation": (rig.translations[node], np.zeros(3)),
        "rotation": (np.roll(rig.rotations[node], -1), np.array([0.0, 0.0, 0.0, 1.0])),
        "scale": (rig.scales[node], np.ones(3)),
    }
    return {what: part.tolist() for what, (part, usual) in parts.items() if (part != usual).any()}


def _align_signs(turns: Floats) -> Floats:
    """Rotations with the signs that keep successive quaternions near each other."""
    # A negative product: the next quaternion is nearer with its sign turned.
    flips = np.einsum("fc,fc->f", turns[1:], turns[:-1]) < 0
    # An odd number of turns so far turns the sign.
    signs = np.r_[1.0, np.where(np.cumsum(flips) % 2, -1.0, 1.0)]
    return np.asarray(turns * signs[:, None], np.float64)


def _build_bone_mesh(
    skeleton: Skeleton, places: Floats
) -> tuple[Floats, NDArray[np.int64], NDArray[np.int64]]:
    """Vertices (vertices, 3), faces (faces, 3) and the joint that each vertex hangs on."""
    vertices: list[Floats] = []
    faces: list[tuple[int, int, int]] = []
    joints: list[int] = []
    for j in range(skeleton.n_joints):
        tips = [places[child] for child in skeleton.children[j]]
        # A bone without a child gets a short one, so that it can be seen.
        if not tips and j not in skeleton.end_sites:
            tips = [places[j] + [0.0, SHORT, 0.0]]
        for tip in tips:
            bone = tip - places[j]
            length = float(np.linalg.norm(bone))
            if length < RIGID:
                continue
            # At right angles to the bone, from the axis that is least along it.
            side = np.cross(bone, np.eye(3)[np.abs(bone).argmin()])
            side *= THICK * length / np.linalg.norm(side)
            other = np.cross(bone, side) / length
            # The widest part lies at a fifth of the bone, as in Blender.
            ring = [places[j] + 0.2 * bone + x * side + y * other for x, y in _RING]
            start = len(vertices)
            vertices += [places[j], *ring, tip]
            joints += [j] * 6
            # Triangles from the joint to the ring, and from the ring to the tip.
            for k in range(4):
                here, after = start + 1 + k, start + 1 + (k + 1) % 4
                faces += [(start, after, here), (start + 5, here, after)]
    if not vertices:  # all joints are at one place
        vertices, faces, joints = (
            [places[0] + SHORT * axis for axis in np.eye(3)],
            [(0, 1, 2)],
            [0] * 3,
        )
    return np.array(vertices), np.array(faces), np.array(joints)


def _encode_glb(text: bytes, data: bytes) -> bytes:
    """Both as chunks, whose lengths are multiples of four."""
    text += b" " * (-len(text) % 4)
    chunks = [CHUNK.pack(len(text), JSON), text, CHUNK.pack(len(data), BYTES), data]
    length = HEADER.size + sum(map(len, chunks))
    return HEADER.pack(MAGIC, 2, length) + b"".join(chunks)
