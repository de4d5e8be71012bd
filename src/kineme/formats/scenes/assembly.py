"""Combine the transforms of a scene's nodes into a motion in metres with y up.

The transform of a node relative to its parent is a translation, a rotation and a scale::

    x -> t + R S x

A motion has no scales, so they are multiplied out. Usually each node has one constant, positive
scale: then rotations stay unchanged and bone lengths are scaled. Otherwise positions and axes come
from the products of the matrices. Sheared axes are made orthogonal, keeping the first one, and
joints get varying offsets.

Scales are inherited as in FBX. The names of its modes state in which order rotation (R, r) and
scale (S, s) of parent and child are applied: "RSrs" multiplies the matrices, "RrSs" scales along
the child's axes, "Rrs" ignores the parent's own scale.

Source: Autodesk, FBX SDK, sample "Transformations".
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from typing import Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray

from kineme._util import rotations as rot
from kineme._util.arrays import Floats
from kineme._util.checks import join_names, make_unique
from kineme._util.rotations import from_matrices, to_matrices
from kineme.formats.files import MAX_EXPANSION, FileContent
from kineme.formats.scenes.characters import SceneNode, list_ancestors
from kineme.formats.skeletons.placing import BYTES_PER_JOINT, build_motion, require_frame_memory
from kineme.formats.units import iterate_blocks, to_metres
from kineme.recordings import Motion, Note, Provenance, Skeleton
from kineme.recordings.rig import UNIFORM, Rig

Inheritance = Literal["RrSs", "RSrs", "Rrs"]
World = tuple[Floats, Floats, Floats]
"""A node's axes (frames, 3, 3), full matrix (frames, 3, 3) and world position (frames, 3)."""

Local = tuple[Floats, Floats, dict[int, Floats]]
"""Rotations (frames, joints, 4), offsets (joints, 3) and slides (frames, 3) by joint.

They are relative to the parent, those of the root to the world. The root slides, and so do joints
whose translation varies.
"""

DEFAULT_RATE = 30.0
"""Frames per second of files that state no rate and whose keys are not evenly spaced."""
MIN_RATE, MAX_RATE = 0.01, 100_000.0
"""Frames per second that are accepted as a rate."""
MAX_FRAMES = 1e12
SLACK = 0.05
"""Fraction of the time between frames by which a key may miss its frame."""
EVEN = 0.02
"""Fraction of their mean by which steps between evenly spaced keys may differ."""
TOLERANCE = 2e-6
"""Fraction by which a length or scale may vary and still count as constant."""
MIN_FRAME_MEMORY = 1 << 28
"""Bytes that any motion may use, however small its file is: a few keys define many frames."""


class Transform(NamedTuple):
    """Transform of a node relative to its parent: one for all frames, or one for each.

    ``translation`` is (3,) or (frames, 3), ``rotation`` (4,) or (frames, 4), unit quaternions
    (w, x, y, z), ``scale`` (3,) or (frames, 3).
    """

    translation: Floats
    rotation: Floats
    scale: Floats
    inheritance: Inheritance = "RSrs"


def assemble(
    content: FileContent,
    nodes: Sequence[SceneNode],
    joints: Sequence[int],
    transform: Callable[[int], Transform],
    rest: Callable[[int], Transform],
    n_frames: int,
    fps: float,
    *,
    unit: str | float,
    turn: Floats,
    provenance: Provenance,
    numbers: Sequence[int] = (),
    binds: Mapping[int, Floats] | None = None,
) -> Motion:
    """Return the motion of a character, whose joints are the given nodes, parents first.

    ``transform`` and ``rest`` return the transform of a node by its number, animated or at rest.
    ``unit`` is the unit of lengths, ``turn`` the rotation of the scene's axes to y up, ``numbers``
    are the file's numbers of the nodes, ``binds`` the matrices of nodes whose bind pose is not
    the rest pose. The bytes of the content are released once all transforms are known.
    """
    # Convert numbers of nodes to numbers of joints; the parent of the root is -1.
    joint_numbers = {node: j for j, node in enumerate(joints)}
    parents = [joint_numbers.get(nodes[node].parent, -1) for node in joints]
    ancestors = list_ancestors(nodes, joints[0])[::-1]  # topmost first
    chain = [*ancestors, *joints]
    local = _apply_scale(ancestors, joints, parents, transform, n_frames, turn)
    if local is None:
        transforms = list(map(transform, chain))
        local = _multiply_matrices(transforms, parents, n_frames, turn)
        if any(_find_uniform_scale(each.scale, UNIFORM) is None for each in transforms):
            remark = "its bones are scaled unevenly or over time: joints slide in clips instead"
            provenance = provenance.noted(Note(remark, "warning"))
    if moving := [nodes[node].name for node in ancestors if _is_moving(transform(node))]:
        root = nodes[joints[0]].name
        remark = f"motion of {join_names(moving)}, above the bones, is that of {root} in clips"
        provenance = provenance.noted(remark)
    rig = _build_rig(nodes, chain, len(joints), rest, to_metres(unit), turn, numbers)
    if rig is None:
        remark = "its bones are mirrored or scaled unevenly at rest: clips have another rest pose"
        provenance = provenance.noted(Note(remark, "warning"))
    elif binds:
        rig = replace(rig, binds=_compute_binds(rig, chain, binds))
    content.release()
    rotations, offsets, slides = local
    # Leaves with constant rotation and offset become end sites, which have no rotation.
    parent_joints = set(parents)
    ends = [
        j
        for j, node in enumerate(joints)
        if j not in parent_joints
        and j not in slides
        and nodes[node].end
        and np.ptp(rotations[:, j], axis=0).max() < TOLERANCE
    ]
    rotations[:, ends] = rot.IDENTITY
    node_names = [nodes[node].name for node in joints]
    names = tuple(make_unique(node_names))
    if renamed := [new for new, old in zip(names, node_names, strict=True) if new != old]:
        remark = f"several bones have the same name: renamed to {join_names(renamed)}"
        provenance = provenance.noted(Note(remark, "warning"))
    skeleton = Skeleton(names, tuple(parents), offsets, frozenset(ends), rig)
    return build_motion(skeleton, rotations, slides, fps, unit=unit, up="y", provenance=provenance)


def _apply_scale(
    ancestors: Sequence[int],
    joints: Sequence[int],
    parents: Sequence[int],
    transform: Callable[[int], Transform],
    n_frames: int,
    turn: Floats,
) -> Local | None:
    """Multiply offsets by the scale above them, and keep rotations; None if one is not uniform.

    ``ancestors`` are the nodes above the root, topmost first, ``joints`` those of the joints, root
    first, ``parents`` the indices of joints. ``turn`` is the rotation of the scene's axes to y up.
    """
    # The transforms of the nodes above the root become part of the root.
    position, rotation, world, node_scale = np.zeros(3), turn, 1.0, 1.0
    for node in (*ancestors, joints[0]):
        current = transform(node)
        factor = _find_uniform_scale(current.scale)
        if factor is None:
            return None
        position = position + world * rot.rotate(rotation, current.translation)
        rotation = rot.multiply(rotation, current.rotation)
        world, node_scale = _multiply_scale(world, node_scale, factor, current.inheritance), factor
    rotations = np.empty((n_frames, len(joints), 4))
    rotations[:, 0] = rotation
    offsets = np.zeros((len(joints), 3))
    slides = {0: np.array(np.broadcast_to(position, (n_frames, 3)))}
    scales = [(world, node_scale)]
    for j in range(1, len(joints)):
        current = transform(joints[j])
        factor = _find_uniform_scale(current.scale)
        if factor is None:
            return None
        # The parent's scale in the world scales the bone.
        world, parent_scale = scales[parents[j]]
        rotations[:, j] = current.rotation
        scales.append((_multiply_scale(world, parent_scale, factor, current.inheritance), factor))
        _store_shift(j, world * current.translation, offsets, slides)
    return rotations, offsets, slides


def _is_moving(transform: Transform) -> bool:
    curves = np.atleast_2d(transform.translation), np.atleast_2d(transform.rotation)
    return any(np.ptp(curve, axis=0).max() > TOLERANCE for curve in curves)


def _multiply_scale(world: float, parent: float, factor: float, inheritance: Inheritance) -> float:
    """Return the world scale of a node from that of its parent and its own factor."""
    # Divide out the parent's own factor, which is part of the world scale.
    return world / parent * factor if inheritance == "Rrs" else world * factor


def _find_uniform_scale(scale: Floats, tolerance: float = TOLERANCE) -> float | None:
    """Return the single value of a scale in all axes and frames, or None.

    ``tolerance`` is the fraction by which it may vary.
    """
    least, most = float(scale.min()), float(scale.max())
    if not (least > 0 and most - least <= tolerance * most):
        return None
    return (least + most) / 2


def _multiply_matrices(
    chain: Sequence[Transform], parents: Sequence[int], n_frames: int, turn: Floats
) -> Local:
    """Return rotations and translations from the products of matrices.

    ``chain`` holds the transforms of the ancestors, topmost first, then those of the joints.
    """
    # Number 0 is the ground, followed by the chain: each ancestor is the parent of the next node.
    transforms = [Transform(np.zeros(3), turn, np.ones(3)), *chain]
    root = len(transforms) - len(parents)
    links = [*range(root), *(root + parent for parent in parents[1:])]
    rotations = np.empty((n_frames, len(parents), 4))
    shifts = np.empty((len(parents), n_frames, 3))
    # Process blocks, since matrices of all frames need much memory.
    for span in iterate_blocks(n_frames):
        n = span.stop - span.start
        ground = np.broadcast_to(to_matrices(turn), (n, 3, 3))
        worlds = [(ground, ground, np.zeros((n, 3)))]
        for node, parent in zip(chain, links, strict=True):
            worlds.append(_multiply_transform(worlds[parent], node, transforms[parent].scale, span))
        world_rotations = [from_matrices(axes) for axes, _, _ in worlds[root:]]
        rotations[span, 0], shifts[0, span] = world_rotations[0], worlds[root][2]
        for j, parent in enumerate(parents[1:], 1):
            # Express the joint relative to the parent's axes.
            inverse = rot.conjugate(world_rotations[parent])
            rotations[span, j] = rot.multiply(inverse, world_rotations[j])
            shifts[j, span] = rot.rotate(inverse, worlds[root + j][2] - worlds[root + parent][2])
    offsets = np.zeros((len(parents), 3))
    slides = {0: shifts[0]}
    for j in range(1, len(parents)):
        _store_shift(j, shifts[j], offsets, slides)
    return rotations, offsets, slides


def _multiply_transform(
    parent: World, transform: Transform, parent_scale: Floats, span: slice
) -> World:
    """Return a node's world transform; ``parent_scale`` is the scale of its parent alone."""
    axes, matrix, position = parent
    turn = to_matrices(_select_frames(transform.rotation, span))
    # The parent's scale and shear in its own axes.
    inherited = axes.transpose(0, 2, 1) @ matrix
    if transform.inheritance == "RSrs":
        product = matrix @ turn
    else:
        if transform.inheritance == "Rrs":
            # Divide out the parent's own scale.
            divisor = _select_frames(parent_scale, span)
            inherited = inherited / np.where(divisor == 0, 1, divisor)[:, None, :]
        product = axes @ turn @ inherited
    # Scale the columns, which are the axes.
    product = product * _select_frames(transform.scale, span)[:, None, :]
    shift = _select_frames(transform.translation, span)
    return orthogonalize(product), product, position + np.einsum("fij,fj->fi", matrix, shift)


def _select_frames(values: Floats, span: slice) -> Floats:
    """Return the values of these frames (frames, ...)."""
    if values.ndim > 1:
        return values[span]
    return np.broadcast_to(values, (span.stop - span.start, len(values)))


def _store_shift(j: int, shift: Floats, offsets: Floats, slides: dict[int, Floats]) -> None:
    """Store the translation of a joint relative to its parent: constant, or one per frame."""
    if shift.ndim == 1:
        offsets[j] = shift
        return
    # The median is the offset; a joint that leaves it has varying translations.
    offsets[j] = np.median(shift, axis=0)
    if np.abs(shift - offsets[j]).max() > TOLERANCE * np.abs(offsets[j]).max():
        slides[j] = shift


def _build_rig(
    nodes: Sequence[SceneNode],
    chosen: Sequence[int],
    n_joints: int,
    rest: Callable[[int], Transform],
    unit: float,
    turn: Floats,
    numbers: Sequence[int],
) -> Rig | None:
    """Return the rig of these nodes, parents first; None if a scale is not uniform."""
    indices = {node: index for index, node in enumerate(chosen)}
    parents = tuple(indices.get(nodes[node].parent, -1) for node in chosen)
    parts = stack_transforms([rest(node) for node in chosen], parents)
    if parts is None:
        return None
    return Rig(
        tuple(nodes[node].name for node in chosen),
        parents,
        *parts,
        np.tile(rot.IDENTITY, (n_joints, 1)),
        unit,
        turn,
        tuple(numbers[node] for node in chosen) if numbers else (-1,) * len(chosen),
    )


def stack_transforms(
    transforms: Sequence[Transform], parents: Sequence[int]
) -> tuple[Floats, Floats, Floats] | None:
    """Return translations, rotations and scales of a rig's nodes; None if a scale is uneven."""
    if any(_find_uniform_scale(transform.scale, UNIFORM) is None for transform in transforms):
        return None
    scales = np.array([transform.scale for transform in transforms])
    for node, (transform, parent) in enumerate(zip(transforms, parents, strict=True)):
        if transform.inheritance == "Rrs" and parent >= 0:
            # Nodes of a rig inherit the parent's scale, so divide it out.
            scales[node] /= _find_uniform_scale(transforms[parent].scale, UNIFORM) or 1.0
    translations = np.array([transform.translation for transform in transforms])
    return translations, np.array([transform.rotation for transform in transforms]), scales


def _compute_binds(rig: Rig, chosen: Sequence[int], binds: Mapping[int, Floats]) -> Floats | None:
    """Return the bind matrices of the joints (joints, 4, 4), None if they equal the rest pose."""
    rest = compose(rig.translations, rig.rotations, rig.scales)
    local, bound = np.array(rest), np.tile(np.eye(4), (len(rest), 1, 1))
    for node in range(rig.above, len(rest)):
        parent = rig.parents[node]
        if parent >= 0 and {chosen[node], chosen[parent]} <= binds.keys():
            local[node] = np.linalg.solve(binds[chosen[parent]], binds[chosen[node]])
        bound[node] = bound[parent] @ local[node] if parent >= 0 else local[node]
    return None if np.allclose(local, rest, rtol=1e-3, atol=1e-4) else bound[rig.above :]


def compose(translations: Floats, rotations: Floats, scales: Floats) -> Floats:
    """Return matrices (nodes, 4, 4) for column vectors; scales are (nodes, 3) or (nodes,)."""
    result = np.tile(np.eye(4), (len(translations), 1, 1))
    scales = scales.reshape(len(translations), 1, -1)
    result[:, :3, :3] = to_matrices(rotations) * scales
    result[:, :3, 3] = translations
    return result


def decompose(matrices: Floats) -> Transform:
    """Return the transform without shear of a matrix for column vectors, or of one per frame."""
    stack = matrices.reshape(-1, 4, 4)
    axes = stack[:, :3, :3]
    scales = np.linalg.norm(axes, axis=1)
    # Put a reflection into the scale, so that the axes are a rotation.
    scales = np.where(np.linalg.det(axes)[:, None] < 0, -scales, scales)
    turns = from_matrices(orthogonalize(axes / np.where(scales == 0, 1, scales)[:, None]))
    parts = stack[:, :3, 3], turns, scales
    return Transform(*(parts if matrices.ndim == 3 else (part[0] for part in parts)))


def orthogonalize(matrices: Floats) -> Floats:
    """Return right-handed orthonormal axes (frames, 3, 3); the first keeps its direction."""
    # Gram-Schmidt; axes without length are replaced.
    first = _normalize(matrices[:, :, 0], np.array([1.0, 0.0, 0.0]))
    second = matrices[:, :, 1]
    second = second - first * np.einsum("fi,fi->f", first, second)[:, None]
    # Any vector that is not parallel to the first axis.
    fallback = np.cross(first, np.roll(first, 1, axis=1) + np.array([0.1, 0.2, 0.4]))
    second = _normalize(second, fallback)
    return np.stack([first, second, np.cross(first, second)], axis=2)


def _normalize(vectors: Floats, fallback: Floats) -> Floats:
    """Return the vectors with unit length, ``fallback`` instead of vectors without length."""
    length = np.linalg.norm(vectors, axis=1, keepdims=True)
    is_zero = length < 1e-12
    unit_fallback = fallback / np.linalg.norm(fallback, axis=-1, keepdims=True)
    return np.where(is_zero, unit_fallback, vectors / np.where(is_zero, 1, length))


def find_keys(times: Floats, frame_times: Floats, slack: float) -> tuple[NDArray[np.intp], Floats]:
    """Return the key before each frame, and the fraction of the interval to the next key.

    Before the first key the fraction is 0, after the last one 1. ``slack`` is the time by which a
    key may miss its frame.
    """
    # The slack includes a key just after its frame.
    previous = np.searchsorted(times, frame_times + slack, "right") - 1
    # Use the last interval for times after the last key.
    index = np.clip(previous, 0, len(times) - 2)
    elapsed = frame_times - times[index]
    share = elapsed / np.diff(times)[index]
    # Near a key use exactly its value.
    share[np.abs(elapsed) <= slack] = 0.0
    share[np.abs(frame_times - times[index + 1]) <= slack] = 1.0
    return index, np.clip(share, 0.0, 1.0)


def evaluate_bezier(
    start: Floats | float, out: Floats, into: Floats, stop: Floats | float, parameter: Floats
) -> Floats:
    """Return values of cubic Bézier curves, whose inner points are ``out`` and ``into``."""
    rest = 1 - parameter
    value = rest**3 * start + 3 * rest**2 * parameter * out
    return np.asarray(value + 3 * rest * parameter**2 * into + parameter**3 * stop, np.float64)


def is_even(times: Floats) -> bool:
    """Return whether keys at these times are evenly spaced."""
    steps = np.diff(times)
    return len(steps) == 0 or bool(np.abs(steps / steps.mean() - 1).max() <= EVEN)


def find_rate(
    requested: float | None, stated: float, times: Floats
) -> tuple[float, list[Note | str]]:
    """Return frames per second and notes: as requested, else stated, else of evenly spaced keys.

    ``stated`` is the file's rate, or 0. ``times`` are the seconds of the keys of a curve that has
    many: these show uneven spacing best.
    """
    if requested is not None:
        return requested, [f"sampled {requested:g} times per second, as requested"]
    keys = 0.0
    if len(times) > 2 and is_even(times):
        n_steps = len(times) - 1
        keys = n_steps / float(times[-1] - times[0])
        # Round to an integer rate if it does not miss the last key by more than the slack.
        is_near = abs(keys / max(round(keys), 1) - 1) * n_steps <= SLACK
        keys = float(round(keys)) if is_near else round(keys, 3)
    if MIN_RATE <= stated <= MAX_RATE:
        # Sampling at the stated rate drops some of the keys.
        note = f"{keys:g} keys a second are sampled at the file's {stated:g} Hz; fps= raises this"
        return stated, [note] if keys > 1.5 * stated else []
    if MIN_RATE <= keys <= MAX_RATE:
        return keys, [f"frame rate {keys:g} Hz, from its keys"]
    remark = (
        "it states no frame rate, and its keys are not evenly spaced: "
        f"{DEFAULT_RATE:g} Hz assumed; give fps= (--fps)"
    )
    return DEFAULT_RATE, [Note(remark, "warning")]


def count_frames(
    content: FileContent, joints: int, frames: float, *, external_size: int = 0
) -> int:
    """Return the number of frames, rounded down, after checking that the file may need the memory.

    A motion of up to `MIN_FRAME_MEMORY` bytes is always accepted, because a few keys define many
    frames. A larger one raises ReadError if it is out of proportion to the size of the file.
    ``external_size`` is the size in bytes of other files that belong to this one, such as buffers.
    """
    n_frames = int(min(frames, MAX_FRAMES))
    if BYTES_PER_JOINT * joints * n_frames > max(MIN_FRAME_MEMORY, MAX_EXPANSION * external_size):
        require_frame_memory(content, joints, n_frames)
    return n_frames
