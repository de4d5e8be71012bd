"""From the transforms of a scene's nodes to a motion in metres with y up.

A node's transform in its parent's frame is a translation, a rotation and a scale::

    x -> t + R S x

A motion has no scales: they are multiplied out. Where they are one constant, positive number
for each node, which is nearly always so, the rotations of the nodes are those of the motion, and
bones become as much longer. Else positions and axes are those of the products of the matrices
(a sheared one's are made orthogonal, the first axis kept), and joints slide.

How scales are inherited is that of FBX, whose names say in which order rotation (R, r) and
scale (S, s) of parent and child are applied: "RSrs" multiplies the matrices, "RrSs" scales along
the child's axes, "Rrs" leaves the parent's own scale out.

Source: Autodesk, FBX SDK, sample "Transformations".
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from typing import Literal, NamedTuple

import numpy as np

from kineme._util import rotations as rot
from kineme._util.arrays import Floats
from kineme._util.checks import join_names, make_unique
from kineme._util.rotations import from_matrices, to_matrices
from kineme.formats.files import MAX_EXPANSION, FileContent
from kineme.formats.scenes.characters import SceneNode, list_ancestors
from kineme.formats.skeletons.placing import BYTES_PER_JOINT, build_motion
from kineme.formats.units import iterate_blocks, to_metres
from kineme.recordings import Motion, Note, Provenance, Skeleton
from kineme.recordings.rig import UNIFORM, Rig

Inheritance = Literal["RrSs", "RSrs", "Rrs"]

STILL = 2e-6
"""Share of its size by which a length or scale may change and still count as constant."""

MOST_SAMPLED = 1 << 28
"""Bytes that a motion may take however small its file is: few keys make many frames."""


class Transform(NamedTuple):
    """A node's transform in its parent's frame: one for all frames, or one for each.

    ``translation`` is (3,) or (frames, 3), ``rotation`` (4,) or (frames, 4), unit quaternions
    (w, x, y, z), ``scale`` (3,) or (frames, 3).
    """

    translation: Floats
    rotation: Floats
    scale: Floats
    inheritance: Inheritance = "RSrs"


class Local(NamedTuple):
    """Rotations and positions of joints relative to their parents, as `build_motion` takes them."""

    rotations: Floats
    offsets: Floats
    slides: dict[int, Floats]


def require_frame_memory(
    content: FileContent, joints: int, frames: int, *, beside: int = 0
) -> None:
    """ReadError where so many frames are more than a file of this size can honestly have.

    ``beside`` are the bytes of other files that belong to it.
    """
    size = BYTES_PER_JOINT * joints * frames
    if size > max(MOST_SAMPLED, MAX_EXPANSION * beside):
        content.require_memory(size, f"{joints} joints in {frames} frames")


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
    """Return the motion of a character, whose joints are nodes, parents first.

    ``transform`` has the transform of a node by its number, ``rest`` that of its rest pose;
    ``unit`` is that of the scene's lengths, ``turn`` the rotation of its axes to those with y up,
    ``numbers`` what the file counts the nodes by, ``binds`` the matrices of nodes that a skin has
    elsewhere than they are at rest. The content is let go once all transforms are
    known.
    """
    # Numbers of nodes become numbers of joints; a parent that is no joint is -1.
    number_of = {node: j for j, node in enumerate(joints)}
    parents = [number_of.get(nodes[node].parent, -1) for node in joints]
    above = list_ancestors(nodes, joints[0])[::-1]  # topmost first
    found = _apply_scale(above, joints, parents, transform, n_frames, turn)
    if found is None:
        found = _multiply_matrices(above, joints, parents, transform, n_frames, turn)
        if any(
            _find_uniform_scale(transform(node).scale, UNIFORM) is None
            for node in (*above, *joints)
        ):
            remark = "its bones are scaled unevenly or over time: in clips joints slide instead"
            provenance = provenance.noted(Note(remark, "warning"))
    rig = _build_rig(nodes, [*above, *joints], len(joints), rest, to_metres(unit), turn, numbers)
    if rig is None:
        remark = "its bones are mirrored or scaled unevenly at rest: clips get another rest pose"
        provenance = provenance.noted(Note(remark, "warning"))
    elif binds:
        rig = replace(rig, binds=_compute_binds(rig, [*above, *joints], binds))
    content.release()
    rotations, offsets, slides = found
    # Leaves that never turn and do not slide become end sites, which have no rotation.
    inner = set(parents)
    ends = [
        j
        for j, node in enumerate(joints)
        if j not in inner
        and j not in slides
        and nodes[node].end
        and np.ptp(rotations[:, j], axis=0).max() < STILL
    ]
    rotations[:, ends] = rot.IDENTITY
    given = [nodes[node].name for node in joints]
    names = tuple(make_unique(given))
    if others := [new for new, old in zip(names, given, strict=True) if new != old]:
        remark = f"several bones have one name: they are read as {join_names(others)}"
        provenance = provenance.noted(Note(remark, "warning"))
    skeleton = Skeleton(names, tuple(parents), offsets, frozenset(ends), rig)
    return build_motion(skeleton, rotations, slides, fps, unit=unit, up="y", provenance=provenance)


def _build_rig(
    nodes: Sequence[SceneNode],
    chosen: Sequence[int],
    n_joints: int,
    rest: Callable[[int], Transform],
    unit: float,
    turn: Floats,
    numbers: Sequence[int],
) -> Rig | None:
    """Return the rig of these nodes, parents first; None where a scale is not one number."""
    places = {node: place for place, node in enumerate(chosen)}
    parents = tuple(places.get(nodes[node].parent, -1) for node in chosen)
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


def _compute_binds(rig: Rig, chosen: Sequence[int], binds: Mapping[int, Floats]) -> Floats | None:
    """Return where a skin has the joints (joints, 4, 4), None where that is as at rest."""
    rest = compose(rig.translations, rig.rotations, rig.scales)
    local, bound = np.array(rest), np.tile(np.eye(4), (len(rest), 1, 1))
    for node in range(rig.above, len(rest)):
        parent = rig.parents[node]
        if parent >= 0 and {chosen[node], chosen[parent]} <= binds.keys():
            local[node] = np.linalg.solve(binds[chosen[parent]], binds[chosen[node]])
        bound[node] = bound[parent] @ local[node] if parent >= 0 else local[node]
    return None if np.allclose(local, rest, rtol=1e-3, atol=1e-4) else bound[rig.above :]


def stack_transforms(
    found: Sequence[Transform], parents: Sequence[int]
) -> tuple[Floats, Floats, Floats] | None:
    """Return translations, rotations and scales of a rig's nodes; None where one is uneven."""
    if any(_find_uniform_scale(each.scale, UNIFORM) is None for each in found):
        return None
    scales = np.array([each.scale for each in found])
    for here, (each, parent) in enumerate(zip(found, parents, strict=True)):
        if each.inheritance == "Rrs" and parent >= 0:
            # A rig's nodes inherit their parent's scale, so it is divided out.
            scales[here] /= _find_uniform_scale(found[parent].scale, UNIFORM) or 1.0
    moved = np.array([each.translation for each in found])
    return moved, np.array([each.rotation for each in found]), scales


def _apply_scale(
    above: Sequence[int],
    joints: Sequence[int],
    parents: Sequence[int],
    transform: Callable[[int], Transform],
    n_frames: int,
    turn: Floats,
) -> Local | None:
    """Rotations as they are and bones as much longer; None where a scale is not one number."""
    # Down through the nodes above the root: their transforms become part of the root.
    position, rotation, world, node_scale = np.zeros(3), turn, 1.0, 1.0
    for node in above:
        found = transform(node)
        factor = _find_uniform_scale(found.scale)
        if factor is None:
            return None
        position = position + world * rot.rotate(rotation, found.translation)
        rotation = rot.multiply(rotation, found.rotation)
        world, node_scale = _multiply_scale(world, node_scale, factor, found.inheritance), factor
    rotations = np.empty((n_frames, len(joints), 4))
    offsets = np.zeros((len(joints), 3))
    slides: dict[int, Floats] = {}
    scales: list[tuple[float, float]] = []
    for j, (node, parent) in enumerate(zip(joints, parents, strict=True)):
        found = transform(node)
        factor = _find_uniform_scale(found.scale)
        if factor is None:
            return None
        if parent < 0:
            # The root's position in the world, in every frame.
            at = position + world * rot.rotate(rotation, found.translation)
            slides[j] = np.array(np.broadcast_to(at, (n_frames, 3)))
            rotations[:, j] = rot.multiply(rotation, found.rotation)
            scales.append((_multiply_scale(world, node_scale, factor, found.inheritance), factor))
            continue
        # The bone is as long as the parent's scale in the world makes it.
        scale, parent_factor = scales[parent]
        rotations[:, j] = found.rotation
        scales.append((_multiply_scale(scale, parent_factor, factor, found.inheritance), factor))
        _store_shift(j, scale * found.translation, offsets, slides)
    return Local(rotations, offsets, slides)


def _multiply_scale(world: float, parent: float, factor: float, inheritance: Inheritance) -> float:
    """Return a node's scale in the world, from that of its parent and its own factor."""
    # Without the parent's own factor, which is in the scale of the world.
    return world / parent * factor if inheritance == "Rrs" else world * factor


def _find_uniform_scale(scale: Floats, share: float = STILL) -> float | None:
    """Return the one number that a scale is in all axes and frames, or None.

    ``share`` is that by which it may change and still count as one.
    """
    least, most = float(scale.min()), float(scale.max())
    # Positive and the same in all axes and frames, up to rounding.
    if not (least > 0 and most - least <= share * most):
        return None
    return (least + most) / 2


def _store_shift(j: int, shift: Floats, offsets: Floats, slides: dict[int, Floats]) -> None:
    """Note where a joint is in its parent's frame: always the same, or over time."""
    if shift.ndim == 1:
        offsets[j] = shift
        return
    # The median is the usual place; a joint that leaves it slides.
    offsets[j] = np.median(shift, axis=0)
    if np.abs(shift - offsets[j]).max() > STILL * np.abs(offsets[j]).max():
        slides[j] = shift


def _multiply_matrices(
    above: Sequence[int],
    joints: Sequence[int],
    parents: Sequence[int],
    transform: Callable[[int], Transform],
    n_frames: int,
    turn: Floats,
) -> Local:
    """Positions and axes of the products of matrices."""
    # Carriers have negative numbers, the joints theirs from 0; the ground is one below all.
    carriers = range(-len(above), 0)
    chain = [*zip(carriers, [-len(above) - 1, *carriers], above, strict=False)]
    chain += [
        (j, parent if parent >= 0 else -1 if above else -len(above) - 1, node)
        for j, (node, parent) in enumerate(zip(joints, parents, strict=True))
    ]
    transforms = {number: transform(node) for number, _, node in chain}
    rotations = np.empty((n_frames, len(joints), 4))
    shifts = np.empty((len(joints), n_frames, 3))
    # In blocks, as matrices of all frames take much memory.
    for span in iterate_blocks(n_frames):
        n = span.stop - span.start
        ground = np.broadcast_to(to_matrices(turn), (n, 3, 3))
        worlds = {-len(above) - 1: (ground, ground, np.zeros((n, 3)))}
        turned: dict[int, Floats] = {}
        for number, parent, _ in chain:
            found = transforms[number]
            before = transforms.get(parent)
            worlds[number] = _multiply_transform(worlds[parent], found, before, span)
            if number < 0:
                continue
            axes, _, position = worlds[number]
            turned[number] = from_matrices(axes)
            if parents[number] < 0:
                rotations[span, number] = turned[number]
                shifts[number, span] = position
                continue
            # Relative to the parent's axes.
            back = rot.conjugate(turned[parent])
            rotations[span, number] = rot.multiply(back, turned[number])
            shifts[number, span] = rot.rotate(back, position - worlds[parent][2])
    offsets = np.zeros((len(joints), 3))
    slides: dict[int, Floats] = {}
    for j, parent in enumerate(parents):
        if parent < 0:
            slides[j] = shifts[j]
        else:
            _store_shift(j, shifts[j], offsets, slides)
    return Local(rotations, offsets, slides)


World = tuple[Floats, Floats, Floats]
"""A node's axes, its whole matrix and its position: (frames, 3, 3) twice and (frames, 3)."""


def _multiply_transform(
    parent: World, found: Transform, before: Transform | None, span: slice
) -> World:
    """Return a node's world, from its parent's and the transforms of both."""
    axes, matrix, position = parent
    turn = to_matrices(_select_frames(found.rotation, span))
    scale = _select_frames(found.scale, span)
    # The parent's scale and shear, in its own axes.
    inherited = axes.transpose(0, 2, 1) @ matrix
    if found.inheritance == "RSrs":
        product = matrix @ turn
    else:
        if found.inheritance == "Rrs" and before is not None:
            # Without the scale that the parent itself has.
            scale = _select_frames(before.scale, span)
            inherited = inherited / np.where(scale == 0, 1, scale)[:, None, :]
        product = axes @ turn @ inherited
    # Columns of the matrix are the axes: each is scaled.
    product = product * scale[:, None, :]
    place = position + np.einsum("fij,fj->fi", matrix, _select_frames(found.translation, span))
    return orthogonalize(product), product, place


def _select_frames(values: Floats, span: slice) -> Floats:
    """Return the values of these frames, (frames, ...)."""
    if values.ndim > 1:
        return values[span]
    return np.broadcast_to(values, (span.stop - span.start, len(values)))


def orthogonalize(matrices: Floats) -> Floats:
    """Right-handed orthonormal axes (frames, 3, 3), the first along that of the matrix."""
    # Gram-Schmidt; where an axis has no length, another one stands in.
    first = _normalize(matrices[:, :, 0], np.array([1.0, 0.0, 0.0]))
    second = matrices[:, :, 1]
    second = second - first * np.einsum("fi,fi->f", first, second)[:, None]
    # Any vector that is not parallel to the first axis.
    spare = np.cross(first, np.roll(first, 1, axis=1) + np.array([0.1, 0.2, 0.4]))
    second = _normalize(second, spare)
    return np.stack([first, second, np.cross(first, second)], axis=2)


def _normalize(vectors: Floats, spare: Floats) -> Floats:
    """Return the vectors at length one; ``spare`` where they have none."""
    length = np.linalg.norm(vectors, axis=1, keepdims=True)
    flat = length < 1e-12
    instead = spare / np.linalg.norm(spare, axis=-1, keepdims=True)
    return np.where(flat, instead, vectors / np.where(flat, 1, length))


def compose(translations: Floats, rotations: Floats, scales: Floats) -> Floats:
    """Return matrices (nodes, 4, 4) that multiply columns; scales are (nodes, 3) or (nodes,)."""
    found = np.tile(np.eye(4), (len(translations), 1, 1))
    scales = scales.reshape(len(translations), 1, -1)
    found[:, :3, :3] = to_matrices(rotations) * scales
    found[:, :3, 3] = translations
    return found


def decompose(matrix: Floats) -> Transform:
    """Return the transform of a matrix (4, 4) that multiplies columns; shear is left out."""
    axes = matrix[:3, :3]
    scale = np.linalg.norm(axes, axis=0)
    # A reflection: it belongs to the scale, so that the axes are a rotation.
    if np.linalg.det(axes) < 0:
        scale = -scale
    turn = from_matrices(orthogonalize((axes / np.where(scale == 0, 1, scale))[None]))[0]
    return Transform(matrix[:3, 3], turn, scale)
