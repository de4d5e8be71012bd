"""Read glTF 2.0, ``.glb`` and ``.gltf``: scenes of the web and of game engines.

The skeleton of one character and one of its animations are read. Lengths are metres, y is up. A
glTF has no frame rate: that of its keys is used if they are evenly spaced. Interpolation is
constant (STEP), linear or along the shorter arc (LINEAR), or cubic (CUBICSPLINE). ``fps=`` samples
the keys at another rate. Bones are the joints of skins, else all animated nodes.

`kineme.formats.scenes.gltf_writer` describes what is written.

Source: Khronos Group, "glTF 2.0 specification", section 3.11 and appendix C.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from contextlib import suppress
from typing import NamedTuple

import numpy as np

from kineme._util import rotations as rot
from kineme._util.arrays import Floats
from kineme._util.checks import make_unique
from kineme.errors import ReadError
from kineme.formats.files import FileContent
from kineme.formats.options import ReadOptions
from kineme.formats.registry import Format
from kineme.formats.scenes.assembly import (
    SLACK,
    Transform,
    assemble,
    count_frames,
    decompose,
    evaluate_bezier,
    find_keys,
    find_rate,
)
from kineme.formats.scenes.characters import (
    SceneNode,
    choose_take,
    find_character,
    find_moving_takes,
    is_end,
    list_ancestors,
)
from kineme.formats.scenes.gltf_file import MAGIC, Animation, GLTFFile, SceneObject
from kineme.formats.scenes.gltf_writer import EXTRAS, copy_animations, write_animations, write_gltf
from kineme.formats.skeletons.placing import order_depth_first
from kineme.formats.units import make_up_rotation
from kineme.recordings import Motion, Note

TRANSLATION, ROTATION, SCALE = "translation", "rotation", "scale"
_JSON = re.compile(rb'"asset"\s*:\s*\{')
_WIDTHS = {TRANSLATION: 3, ROTATION: 4, SCALE: 3}
_ROUNDED = 0.1  # frames by which the last key may miss its frame


class Keys(NamedTuple):
    """Times, values and interpolation of the keys of one property of a node."""

    times: Floats
    values: Floats
    interpolation: str


def read_gltf(content: FileContent, options: ReadOptions) -> Motion:
    """Return the motion of a character in a glTF file."""
    file = GLTFFile(content)
    order, parents = _order_nodes(file)
    objects = [file.tree.nodes[number] for number in order]
    bones = {joint for skin in file.tree.skins for joint in skin.joints}
    moved_nodes = [
        {
            # Morph weights of meshes do not move joints.
            target.node
            for target in (channel.target for channel in animation.channels)
            if target.path in _WIDTHS and target.node is not None
        }
        for animation in file.tree.animations
    ]
    animated = find_moving_takes(moved_nodes, bones)
    names = make_unique(animation.name or "animation" for animation in file.tree.animations)
    number, notes = choose_take(content, names, animated, options.take)
    nodes = _make_nodes(file, order, parents, bones, moved_nodes[number])
    character = find_character(content, nodes, options.person)
    joints = character.joints
    needed = {order[j] for j in (*joints, *list_ancestors(nodes, joints[0]))}
    keys = _read_keys(file, file.tree.animations[number], needed)
    fps, rate_notes = _find_rate(file, keys, options)
    start = min((float(track.times[0]) for track in keys.values()), default=0.0)
    stop = max((float(track.times[-1]) for track in keys.values()), default=0.0)
    n_frames = count_frames(
        content, len(joints), (stop - start) * fps + 1 + _ROUNDED, external_size=file.external_size
    )
    frame_times = start + np.arange(n_frames) / fps

    def transform(j: int) -> Transform:
        rest = _read_rest(objects[j])
        tracks = [keys.get((order[j], path)) for path in _WIDTHS]
        translation, rotation, scale = (
            part if track is None else _sample_channel(track, frame_times)
            for part, track in zip(rest[:3], tracks, strict=True)
        )
        return Transform(translation, rotation, scale)

    return assemble(
        content,
        nodes,
        joints,
        transform,
        lambda j: _read_rest(objects[j]),
        n_frames,
        fps,
        unit=options.unit or 1.0,
        turn=make_up_rotation(options.up or "y"),
        provenance=content.provenance("glTF", [*notes, *character.notes, *rate_notes])
        .of_take(names[number], (names[each] for each in animated))
        .of_person(character.name, character.people),
        numbers=order,
        binds=_read_binds(file, order, parents),
    )


def _read_binds(file: GLTFFile, order: Sequence[int], parents: Sequence[int]) -> dict[int, Floats]:
    """Return the bind matrices of nodes by their index in the tree, as Blender interprets them."""
    indices = {number: index for index, number in enumerate(order)}
    matrices: dict[int, Floats] = {}
    for skin in file.tree.skins:
        # Bind matrices are relative to the skin's skeleton node, or to its parent if it is a joint.
        top = indices.get(-1 if skin.skeleton is None else skin.skeleton, -1)
        matrices.setdefault(parents[top] if skin.skeleton in skin.joints else top, np.eye(4))
        if skin.inverse_bind_matrices is None:
            continue
        with suppress(ReadError, ValueError):  # ignore damaged skins
            # The file stores columns first.
            stored = file.read_array(skin.inverse_bind_matrices)
            inverse = stored.reshape(-1, 4, 4).transpose(0, 2, 1)
            for joint, matrix in zip(skin.joints, inverse, strict=False):
                if joint in indices and np.isfinite(matrix).all() and np.linalg.det(matrix) > 0:
                    matrices[indices[joint]] = np.asarray(np.linalg.inv(matrix), np.float64)
    return matrices


def _make_nodes(
    file: GLTFFile, order: list[int], parents: list[int], bones: set[int], moved: set[int]
) -> list[SceneNode]:
    """Return the nodes of the scene; kineme's own files mark end sites, others name them."""
    extras, nodes = file.tree.asset.extras, []
    is_own = isinstance(extras, dict) and EXTRAS in extras
    for number, parent in zip(order, parents, strict=True):
        node = file.tree.nodes[number]
        is_marked = isinstance(node.extras, dict) and node.extras.get("end_site") is True
        scene_node = SceneNode(
            node.name or f"node{number}",
            parent,
            bone=number in bones,
            geometry=node.mesh is not None or node.camera is not None,
            animated=number in moved,
            end=is_marked if is_own else is_end(node.name),
        )
        nodes.append(scene_node)
    return nodes


def _order_nodes(file: GLTFFile) -> tuple[list[int], list[int]]:
    """Return the numbers of the nodes, parents first, and the index of each one's parent."""
    numbers = range(len(file.tree.nodes))
    # Damaged files may have invalid numbers.
    children = [[each for each in node.children if each in numbers] for node in file.tree.nodes]
    tops = {*numbers} - {child for group in children for child in group}
    pairs = list(order_depth_first(sorted(tops), children.__getitem__))
    return [number for number, _ in pairs], [parent for _, parent in pairs]


def _read_keys(
    file: GLTFFile, animation: Animation, nodes: set[int]
) -> dict[tuple[int, str], Keys]:
    """Return the keys of each node's properties."""
    keys: dict[tuple[int, str], Keys] = {}
    times: dict[int, Floats] = {}
    for channel in animation.channels:
        node, path = channel.target.node, channel.target.path
        if node is None or node not in nodes or path not in _WIDTHS:
            continue
        sampler = file.get_part(animation.samplers, channel.sampler, "sampler")
        if sampler.input not in times:
            times[sampler.input] = file.read_array(sampler.input)[:, 0]
            if (np.diff(times[sampler.input]) <= 0).any():
                raise file.content.error("the times of keys are not in order: damaged")
        values = file.read_array(sampler.output)
        # A cubic key has two tangents and a value.
        count = len(times[sampler.input]) * (3 if sampler.interpolation == "CUBICSPLINE" else 1)
        if values.shape != (count, _WIDTHS[path]):
            raise file.content.error(
                f"{path} of node {node} has different numbers of keys and times: damaged"
            )
        keys[node, path] = Keys(times[sampler.input], values, sampler.interpolation)
    return keys


def _find_rate(
    file: GLTFFile, keys: dict[tuple[int, str], Keys], options: ReadOptions
) -> tuple[float, list[Note | str]]:
    """Return frames per second, and notes; only files of kineme state a rate."""
    extras = file.tree.asset.extras
    settings = extras.get(EXTRAS) if isinstance(extras, dict) else None
    fps = settings.get("fps") if isinstance(settings, dict) else None
    times = max((track.times for track in keys.values()), key=len, default=np.empty(0))
    return find_rate(options.fps, float(fps) if isinstance(fps, int | float) else 0.0, times)


def _read_rest(node: SceneObject) -> Transform:
    """Return the transform of a node without animation."""
    if node.matrix is not None and len(node.matrix) == 16:
        # The file stores columns first.
        return decompose(np.array(node.matrix).reshape(4, 4).T)
    turn = np.roll(_to_array(node.rotation, [0.0, 0.0, 0.0, 1.0]), 1)
    norm = np.linalg.norm(turn)
    return Transform(
        _to_array(node.translation, [0.0] * 3),
        turn / norm if norm > 0 else rot.IDENTITY,
        _to_array(node.scale, [1.0] * 3),
    )


def _to_array(values: list[float] | None, default: list[float]) -> Floats:
    fits = values is not None and len(values) == len(default)
    return np.array(values if fits else default, np.float64)


def _sample_channel(keys: Keys, frame_times: Floats) -> Floats:
    """Return values at these seconds (frames, 3); rotations as (frames, 4), w first."""
    times, values = keys.times, keys.values
    cubic, is_rotation = keys.interpolation == "CUBICSPLINE", values.shape[1] == _WIDTHS[ROTATION]
    # (keys, 3, width): tangent into the key, value, tangent out of it.
    tangents = values.reshape(len(times), 3, -1) if cubic else values[:, None]
    if is_rotation:
        tangents = np.roll(tangents, 1, axis=-1)  # w first
    values = tangents[:, 1] if cubic else tangents[:, 0]
    if is_rotation:
        values = rot.normalize(values)
    slack = SLACK * (frame_times[1] - frame_times[0] if len(frame_times) > 1 else 1.0)
    if len(times) == 1:
        sampled = values[0]
    elif len(times) == len(frame_times) and np.abs(times - frame_times).max() <= slack:
        sampled = values
    else:
        index, share = find_keys(times, frame_times, slack)
        start, stop = values[index], values[index + 1]
        if keys.interpolation == "STEP":
            sampled = np.where(share[:, None] >= 1, stop, start)
        elif cubic:
            third = np.diff(times)[index, None] / 3
            # Outgoing tangent of the key before, incoming one of the key after.
            out, into = start + third * tangents[index, 2], stop - third * tangents[index + 1, 0]
            sampled = evaluate_bezier(start, out, into, stop, share[:, None])
        elif is_rotation:
            sampled = rot.slerp(start, stop, share[:, None])
        else:
            sampled = start + share[:, None] * (stop - start)
    return rot.normalize(sampled) if is_rotation else sampled


FORMAT = Format(
    "glTF",
    (".glb", ".gltf"),
    lambda head: head.startswith(MAGIC) or _JSON.search(head) is not None,
    read_gltf,
    write_gltf,
    write_animations=write_animations,
    copy_animations=copy_animations,
)
