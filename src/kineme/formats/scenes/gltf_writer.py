"""Write glTF 2.0: a new file with a skeleton and animations, or a copy with other animations.

The nodes of a new file are those of the motion's rig, with its rest pose. Without a rig each joint
is a node at its offset, below a node named after the file. A mesh with a thin bone for each joint
makes programs recognise the skeleton: without it Blender imports empties, and Godot nothing.
Rotations have a key in each frame, translations only if they change. Numbers have 32 bits, a
precision of a thousandth of a millimetre.

``asset.extras.kineme.fps`` stores the frame rate, which the format lacks; ``end_site`` in the
extras of a node marks end sites.

The JSON consists of a few dictionaries and needs no package. The benchmarks check it with Khronos'
validator.

A copy keeps meshes, skins, materials and everything else. Nodes, meshes and accessors keep their
numbers, since extensions may refer to them. New animations reuse the numbers freed by the old ones.
Bytes used only by old animations are dropped. Nodes that are not joints of the character are at
rest in the new animations.

Source: Khronos Group, "glTF 2.0 specification", sections 3.7.3 and 3.11.
"""

from __future__ import annotations

import base64
import json
from collections.abc import Mapping, Sequence
from mimetypes import guess_type
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from kineme._util.arrays import Floats
from kineme._util.checks import warn
from kineme._util.files import atomic_write, translate_read_errors
from kineme._util.json import decode_json
from kineme._version import __version__
from kineme.errors import ReadError, WriteError
from kineme.formats.files import clean_names, load
from kineme.formats.scenes.assembly import compose
from kineme.formats.scenes.characters import check_animations, check_copy
from kineme.formats.scenes.gltf_file import BYTES, CHUNK, HEADER, JSON, MAGIC, GLTFFile
from kineme.formats.skeletons.placing import RIGID
from kineme.recordings import Motion, Skeleton
from kineme.recordings.posing import get_rig, pose_rig
from kineme.recordings.rig import Rig

EXTRAS = "kineme"
"""Key of kineme's data in the extras of a file."""
BONE_WIDTH = 0.08
"""Width of a bone of the mesh as a fraction of its length."""
LEAF_LENGTH = 0.05
"""Metres: length of a drawn bone without children."""
_FLOAT, _BYTE, _SHORT, _INT = 5126, 5121, 5123, 5125
_KEYS, _VERTICES, _INDICES = None, 34962, 34963
_TYPES = {1: "SCALAR", 3: "VEC3", 4: "VEC4", 16: "MAT4"}
_RING = ((1, 0), (0, 1), (-1, 0), (0, -1))


def write_gltf(motion: Motion, path: Path) -> None:
    """Write a motion to a GLB, or to a ``.gltf`` with an embedded buffer."""
    write_animations({path.stem: motion}, path)


def write_animations(motions: Mapping[str, Motion], path: Path) -> None:
    """Write one or more motions of one skeleton to a file, each as an animation of its name.

    A ``.gltf`` gets an embedded buffer.
    """
    file = _SceneWriter(check_animations(motions, path, "a glTF"), path)
    for name, motion in motions.items():
        file.animate(name, motion)
    save_gltf(file.tree, bytes(file.data), path)


def copy_animations(motions: Mapping[str, Motion], source: Path, path: Path) -> None:
    """Write a copy of ``source``, the file of the motions, with the motions as its animations."""
    skeleton = check_copy(motions, source, path)
    rig = get_rig(skeleton)
    with translate_read_errors(source):
        file = GLTFFile(load(source))
        tree: dict[str, Any] = decode_json(file.text, source, dict)
    numbers = list(rig.numbers)
    if max(numbers) >= len(tree["nodes"]):
        raise WriteError(path, f"{source.name} has changed since it was read")
    if "EXT_meshopt_compression" in tree.get("extensionsUsed", ()):
        reason = "are compressed by meshopt: export it without compression"
        raise WriteError(path, f"the buffers of {source.name} {reason}")
    copy = Animator(skeleton, rig, numbers[rig.above :], tree)
    _drop_animations(copy, file)
    if numbers[rig.above] < 0:  # `add_root` added it, so the file has no such node
        copy.numbers = [_add_root(copy, file, rig), *numbers[rig.above + 1 :]]
    _embed_images(copy, file)
    for name, motion in motions.items():
        copy.animate(name, motion)
    _close_number_gaps(copy)
    save_gltf(tree, bytes(copy.data), path)


def save_gltf(tree: dict[str, Any], data: bytes, path: Path) -> None:
    """Write the JSON and its buffer to a GLB, or to a ``.gltf`` with an embedded buffer."""
    buffer: dict[str, Any] = {"byteLength": len(data)}
    is_binary = path.suffix.lower() != ".gltf"
    if not is_binary:
        stored = base64.b64encode(data).decode()
        buffer["uri"] = f"data:application/octet-stream;base64,{stored}"
    tree = {**tree, "buffers": [buffer]}
    text = json.dumps(tree, ensure_ascii=False, separators=(",", ":")).encode()
    if is_binary:
        text += b" " * (-len(text) % 4)  # chunks are multiples of four bytes, like the data
        chunks = CHUNK.pack(len(text), JSON) + text + CHUNK.pack(len(data), BYTES) + data
        text = HEADER.pack(MAGIC, 2, HEADER.size + len(chunks)) + chunks
    with atomic_write(path) as draft:
        draft.write_bytes(text)


class Animator:
    """Add animations to the JSON and the buffer of a file.

    ``numbers`` are the numbers of the joints' nodes.
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
        # Distance of each joint from rest; the parent's scale converts the limit to its units.
        distances = np.abs(shifts - rig.translations[rig.above :]).max(axis=(0, 2))
        ranges = np.ptp(shifts, axis=0).max(axis=1)
        nodes = range(rig.above, len(rig.names))
        sizes = np.array([rig.parent_world(node, *rig.world)[2] for node in nodes])
        limit = RIGID / rig.unit / sizes
        seconds = self.add_accessor(np.arange(n)[:, None] / motion.fps, _KEYS, bounds=True)
        start = self.add_accessor(np.zeros((1, 1)), _KEYS, bounds=True) if n > 1 else seconds
        channels: list[dict[str, Any]] = []
        samplers: list[dict[str, Any]] = []

        def add(joint: int, path: str, values: Floats) -> None:
            target = {"node": self.numbers[joint], "path": path}
            channels.append({"sampler": len(samplers), "target": target})
            keys = {"input": start if len(values) == 1 else seconds}
            samplers.append({**keys, "output": self.add_accessor(values, _KEYS)})

        for j in range(skeleton.n_joints):
            if distances[j] > limit[j] or skeleton.parents[j] < 0:
                # A constant translation that differs from rest needs one key.
                add(j, "translation", shifts[: 1 if ranges[j] < limit[j] else n, j])
            if j not in skeleton.end_sites:
                # glTF stores w last.
                add(j, "rotation", np.roll(_align_signs(turns[:, j]), -1, axis=1))
        self.tree["animations"].append({"name": name, "channels": channels, "samplers": samplers})

    def add_accessor(
        self, values: NDArray[Any], target: int | None, kind: int = _FLOAT, *, bounds: bool = False
    ) -> int:
        """Store an array (elements, components) and return the number of its accessor."""
        codes = {_FLOAT: "<f4", _BYTE: "<u1", _SHORT: "<u2", _INT: "<u4"}
        stored = np.ascontiguousarray(values, codes[kind])
        view = {"buffer": 0, "byteOffset": len(self.data), "byteLength": stored.nbytes}
        if target is not None:
            view["target"] = target
        self.data += stored.tobytes()
        # Accessors must start at multiples of four bytes.
        self.data += bytes(-len(self.data) % 4)
        accessor: dict[str, Any] = {
            "bufferView": _store_part(self.tree["bufferViews"], view, self.free_views),
            "componentType": kind,
            "count": len(stored),
            "type": _TYPES[stored.shape[1]],
        }
        # glTF requires the extent of times and positions.
        if bounds:
            accessor |= {"min": stored.min(axis=0).tolist(), "max": stored.max(axis=0).tolist()}
        return _store_part(self.tree["accessors"], accessor, self.free_accessors)


def _store_part(parts: list[Any], part: Any, free: list[int]) -> int:
    """Store a part in a list of the JSON, at a free number if possible; return its number."""
    if free:
        number = free.pop(0)
        parts[number] = part
        return number
    parts.append(part)
    return len(parts) - 1


def describe_transform(rig: Rig, node: int) -> dict[str, Any]:
    """Return the JSON of a node's rest transform, without defaults."""
    parts = {
        "translation": (rig.translations[node], np.zeros(3)),
        "rotation": (np.roll(rig.rotations[node], -1), np.array([0.0, 0.0, 0.0, 1.0])),
        "scale": (rig.scales[node], np.ones(3)),
    }
    return {
        name: part.tolist() for name, (part, default) in parts.items() if (part != default).any()
    }


def _align_signs(turns: Floats) -> Floats:
    """Return rotations with signs such that successive quaternions are close."""
    # With a negative dot product the next quaternion is nearer with opposite sign.
    flips = np.einsum("fc,fc->f", turns[1:], turns[:-1]) < 0
    # An odd number of flips so far inverts the sign.
    signs = np.r_[1.0, np.where(np.cumsum(flips) % 2, -1.0, 1.0)]
    return np.asarray(turns * signs[:, None], np.float64)


class _SceneWriter(Animator):
    """Collect the parts of a file."""

    def __init__(self, motion: Motion, path: Path) -> None:
        skeleton = motion.skeleton
        # A glTF has metres and y up.
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
        # Ancestors follow the joints, so that the number of a joint is that of its node.
        super().__init__(skeleton, rig, range(skeleton.n_joints), tree)
        self.tree["nodes"] = self._make_nodes(path)
        n = len(self.tree["nodes"])
        self.tree["nodes"].append({"name": f"{path.stem}_mesh", "mesh": 0, "skin": 0})
        carried = {child for node in self.tree["nodes"] for child in node.get("children", ())}
        self.tree["scenes"] = [{"nodes": [node for node in range(n + 1) if node not in carried]}]
        self._add_mesh()

    def _make_nodes(self, path: Path) -> list[dict[str, Any]]:
        """Return a node for each joint, followed by their ancestors."""
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
        """Add a mesh of bones, bound to the joints in the bind pose."""
        skeleton, rig = self.skeleton, self.rig
        positions, turns, sizes = (part[rig.above :] for part in rig.world)
        vertices, faces, joints = _build_bone_mesh(skeleton, positions)
        rest = compose(positions, turns, sizes)
        binds = rest if rig.binds is None else rig.binds
        # Move each vertex from the rest pose to the bind pose of its joint.
        to_bind = (binds @ np.linalg.inv(rest))[joints]
        vertices = np.einsum("vij,vj->vi", to_bind[:, :3, :3], vertices) + to_bind[:, :3, 3]
        # A vertex may have four joints; here the first has all the weight.
        joint_indices = np.zeros((len(vertices), 4), int)
        joint_indices[:, 0] = joints
        weights = np.zeros((len(vertices), 4))
        weights[:, 0] = 1.0
        # The file stores columns first.
        inverse = np.linalg.inv(binds).transpose(0, 2, 1)
        inverse[:, :, 3] = [0.0, 0.0, 0.0, 1.0]  # required exactly by glTF
        code = _BYTE if skeleton.n_joints <= 256 else _SHORT
        attributes = {
            "POSITION": self.add_accessor(vertices, _VERTICES, bounds=True),
            "JOINTS_0": self.add_accessor(joint_indices, _VERTICES, code),
            "WEIGHTS_0": self.add_accessor(weights, _VERTICES),
        }
        indices = self.add_accessor(faces.reshape(-1, 1), _INDICES, _INT)
        inverses = self.add_accessor(inverse.reshape(-1, 16), _KEYS)
        primitive = {"attributes": attributes, "indices": indices}
        self.tree["meshes"] = [{"name": "bones", "primitives": [primitive]}]
        skin = {"joints": [*range(skeleton.n_joints)], "inverseBindMatrices": inverses}
        if rig.binds is not None:
            # Bind matrices are relative to the node above all joints.
            skin["skeleton"] = skeleton.n_joints + max(rig.above, 1) - 1
        self.tree["skins"] = [skin]


def _build_bone_mesh(
    skeleton: Skeleton, positions: Floats
) -> tuple[Floats, NDArray[np.int64], NDArray[np.int64]]:
    """Return vertices (vertices, 3), faces (faces, 3) and the joint of each vertex."""
    vertices: list[Floats] = []
    faces: list[tuple[int, int, int]] = []
    joints: list[int] = []
    for j in range(skeleton.n_joints):
        tips = [positions[child] for child in skeleton.children[j]]
        # Draw a short bone for joints without children.
        if not tips and j not in skeleton.end_sites:
            tips = [positions[j] + [0.0, LEAF_LENGTH, 0.0]]
        for tip in tips:
            bone = tip - positions[j]
            length = float(np.linalg.norm(bone))
            if length < RIGID:
                continue
            # A vector perpendicular to the bone, from the axis least parallel to it.
            side = np.cross(bone, np.eye(3)[np.abs(bone).argmin()])
            side *= BONE_WIDTH * length / np.linalg.norm(side)
            second_side = np.cross(bone, side) / length
            # The widest part is at a fifth of the length, as in Blender.
            ring = [positions[j] + 0.2 * bone + x * side + y * second_side for x, y in _RING]
            start = len(vertices)
            vertices += [positions[j], *ring, tip]
            joints += [j] * 6
            # Triangles connect the joint to the ring, and the ring to the tip.
            for k in range(4):
                current, following = start + 1 + k, start + 1 + (k + 1) % 4
                faces += [(start, following, current), (start + 5, current, following)]
    if not vertices:  # all joints have the same position
        vertices = [positions[0] + LEAF_LENGTH * axis for axis in np.eye(3)]
        faces, joints = [(0, 1, 2)], [0] * 3
    return np.array(vertices), np.array(faces), np.array(joints)


def _drop_animations(copy: Animator, file: GLTFFile) -> None:
    """Remove the animations, and copy the bytes of all other data into one buffer.

    Numbers of accessors and views stay, as meshes and extensions refer to them: those of dropped
    ones become free.
    """
    tree = copy.tree
    tree.setdefault("bufferViews", [])
    tree.setdefault("accessors", [])
    samplers = [each for animation in tree.get("animations", ()) for each in animation["samplers"]]
    keyframe_accessors = {each[end] for each in samplers for end in ("input", "output")}
    # Accessors shared with skins or meshes must stay.
    keyframe_accessors -= {skin.get("inverseBindMatrices") for skin in tree.get("skins", ())}
    for mesh in tree.get("meshes", ()):
        for part in mesh["primitives"]:
            used = [part["attributes"], *part.get("targets", ())]
            keyframe_accessors -= {number for table in used for number in table.values()}
            keyframe_accessors.discard(part.get("indices"))
    needed: set[int] = set()
    dropped: set[int] = set()
    for number, accessor in enumerate(tree["accessors"]):
        sparse = accessor.get("sparse", {})
        parts = accessor, sparse.get("indices", {}), sparse.get("values", {})
        views = {part["bufferView"] for part in parts if "bufferView" in part}
        (dropped if number in keyframe_accessors else needed).update(views)
    # Views used only by the dropped accessors are free, too.
    copy.free_accessors, copy.free_views = sorted(keyframe_accessors), sorted(dropped - needed)
    for number, view in enumerate(tree["bufferViews"]):
        if number in copy.free_views:
            continue
        start = view.get("byteOffset", 0)
        stored = file.read_buffer(view["buffer"])[start : start + view["byteLength"]]
        if len(stored) < view["byteLength"]:
            raise ReadError(file.content.path, f"buffer view {number} is longer than its buffer")
        view |= {"buffer": 0, "byteOffset": len(copy.data)}
        # Views must start at multiples of four bytes.
        copy.data += stored + bytes(-len(stored) % 4)
    tree["animations"] = []


def _close_number_gaps(copy: Animator) -> None:
    """Drop unused numbers at the end, and put placeholders at unused numbers in between."""
    view = {"buffer": 0, "byteLength": 4}
    accessor = {"componentType": _FLOAT, "count": 1, "type": "SCALAR"}
    for name, free, part in (
        ("accessors", copy.free_accessors, accessor),
        ("bufferViews", copy.free_views, view),
    ):
        parts = copy.tree[name]
        # Numbers at the end can be dropped without changing others.
        while free and free[-1] == len(parts) - 1:
            parts.pop()
            free.pop()
        for number in free:
            parts[number] = dict(part)


def _add_root(copy: Animator, file: GLTFFile, rig: Rig) -> int:
    """Add the rig's root bone as a node and to the skins of its children; return its number."""
    tree, root = copy.tree, rig.above
    new = len(tree["nodes"])
    children = [rig.numbers[node] for node, parent in enumerate(rig.parents) if parent == root]
    if root:
        siblings = tree["nodes"][rig.numbers[root - 1]]["children"]
        siblings[:] = [*(each for each in siblings if each not in children), new]
    for scene in tree.get("scenes", ()) if not root else ():
        if {*scene.get("nodes", ())} & {*children}:
            scene["nodes"] = [*(each for each in scene["nodes"] if each not in children), new]
    tree["nodes"].append(
        {"name": rig.names[root], **describe_transform(rig, root), "children": children}
    )
    bind = np.linalg.inv(compose(*(part[root : root + 1] for part in rig.world)))[0]
    bind[3] = [0.0, 0.0, 0.0, 1.0]  # required exactly by glTF
    for skin in tree.get("skins", ()):
        if not {*skin["joints"]} & {*children}:
            continue
        skin["joints"].append(new)
        if "inverseBindMatrices" in skin:
            matrices = file.read_array(skin["inverseBindMatrices"])
            matrices = np.concatenate([matrices, bind.T.reshape(1, 16)])
            skin["inverseBindMatrices"] = copy.add_accessor(matrices, None)
    return new


def _embed_images(copy: Animator, file: GLTFFile) -> None:
    """Embed images that are files next to the source, since the copy may be in another folder."""
    for image in copy.tree.get("images", ()):
        uri = image.get("uri", "data:")
        if uri.startswith("data:"):
            continue
        try:
            stored = base64.b64encode(file.read_uri(uri)).decode()
        except ReadError:
            warn(f"{file.content.path.name}: the texture {uri!r:.60} is missing")
            continue
        image["uri"] = f"data:{guess_type(uri)[0] or 'image/png'};base64,{stored}"
