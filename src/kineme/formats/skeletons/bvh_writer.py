"""Write BVH: rotations as Z Y X in degrees, in units and axes of the original BVH.

Recordings of other formats are written in centimetres with y up and the rest pose of their rig. A
BVH has no rotations at rest, so these become part of the rotations of each frame.

Joints whose offset varies get six channels, others three; roots always get six. An end site that
moves or has children becomes a joint. A BVH has no names for end sites: reading names them
``PARENT_end``.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from kineme._util import rotations as rot
from kineme._util.arrays import Floats
from kineme.formats.files import clean_names, format_table, require_rotations, save
from kineme.recordings import Motion, Skeleton
from kineme.recordings.kinematics import compute_local_translations
from kineme.recordings.posing import align_to_rest

UNIT = 0.01
"""Metres per unit for recordings from other formats."""
RIGID = 5e-7
"""Metres by which a bone may differ from its offset and still count as rigid.

Single-precision animations differ this much from the rest pose of their file. Along twenty bones it
adds up to 0.01 mm.
"""


def write_bvh(motion: Motion, path: Path) -> None:
    """Write a motion to a BVH file."""
    skeleton = motion.skeleton
    turns, translations, offsets, slides = compute_local_pose(motion, path, "a BVH")
    slides |= np.array(skeleton.parents) < 0
    unit, inverse = UNIT, rot.IDENTITY
    is_from_bvh = motion.provenance.format == "BVH"
    if is_from_bvh and skeleton.rig is not None and skeleton.rig.is_plain:
        # Convert the axes of both the world and the joints back to the file's.
        unit, inverse = skeleton.rig.unit, rot.conjugate(skeleton.rig.turn)
        turns = rot.multiply(rot.multiply(inverse, turns), skeleton.rig.turn)
    translations, offsets = (rot.rotate(inverse, each) / unit for each in (translations, offsets))
    angles = np.degrees(rot.to_euler_zyx(turns))
    fixed_ends = {j for j in skeleton.end_sites if not slides[j]}
    order = list(_order_depth_first(motion))
    columns: list[Floats] = []
    for j in order:
        if j in fixed_ends:
            continue
        if slides[j]:
            columns.append(translations[:, j])
        columns.append(angles[:, j])
    head = "\n".join(
        _format_hierarchy(skeleton, offsets, order, slides, _name_joints(motion, fixed_ends, path))
    )
    timing = f"MOTION\nFrames: {motion.n_frames}\nFrame Time: {1 / motion.fps!r}\n"
    save(path, [head, "\n", timing, *format_table(np.concatenate(columns, axis=1))])


def compute_local_pose(
    motion: Motion, path: Path, what: str
) -> tuple[Floats, Floats, Floats, NDArray[np.bool_]]:
    """Return rotations and translations for a format without rotations at rest.

    Returns
    -------
    rotations, translations : ndarray of shape (frames, joints, 4), (frames, joints, 3)
        Relative to the parent; metres.
    offsets : ndarray of shape (joints, 3)
        The translations at rest.
    slides : ndarray of shape (joints,)
        Whether the translation of a joint varies.

    Raises
    ------
    WriteError
        The motion has no rotations, which ``what`` needs.
    """
    require_rotations(motion, path, what)
    aligned = align_to_rest(motion)
    turns, offsets = require_rotations(aligned, path, what), aligned.skeleton.offsets
    translations = compute_local_translations(aligned.skeleton, motion.positions, turns)
    return turns, translations, offsets, np.abs(translations - offsets).max(axis=(0, 2)) > RIGID


def _name_joints(motion: Motion, ends: set[int], path: Path) -> dict[int, str]:
    """Return the names of joints that a line can hold; end sites have none."""
    named = [j for j in range(motion.skeleton.n_joints) if j not in ends]
    return dict(
        zip(
            named,
            clean_names(path, [motion.skeleton.names[j] for j in named], _clean_name),
            strict=True,
        )
    )


def _clean_name(name: str) -> str:
    """Return a name without braces, and without the text that starts the motion section."""
    plain = re.sub(r"[{}\s]+", " ", name).strip()
    return re.sub(r"(\bmotion frames) ?:", r"\1", plain, flags=re.IGNORECASE)


def _format_hierarchy(
    skeleton: Skeleton,
    offsets: Floats,
    order: list[int],
    slides: NDArray[np.bool_],
    names: dict[int, str],
) -> Iterator[str]:
    depths: dict[int, int] = {-1: -1}
    open_joints: list[int] = []
    yield "HIERARCHY"
    for j in order:
        # Close joints until the one that is open is the parent.
        while open_joints and open_joints[-1] != skeleton.parents[j]:
            yield "\t" * depths[open_joints.pop()] + "}"
        depths[j] = depth = depths[skeleton.parents[j]] + 1
        open_joints.append(j)
        kind = "ROOT" if skeleton.parents[j] < 0 else "JOINT"
        tab = "\t" * depth
        yield tab + (f"{kind} {names[j]}" if j in names else "End Site")
        yield tab + "{"
        yield f"{tab}\tOFFSET " + " ".join(f"{x:.9f}" for x in offsets[j])
        if j in names:
            places = "6 Xposition Yposition Zposition" if slides[j] else "3"
            yield f"{tab}\tCHANNELS {places} Zrotation Yrotation Xrotation"
    while open_joints:
        yield "\t" * depths[open_joints.pop()] + "}"


def _order_depth_first(motion: Motion) -> Iterator[int]:
    children = motion.skeleton.children
    # Reversed, since the stack pops the last one first.
    waiting = [j for j, parent in enumerate(motion.skeleton.parents) if parent < 0][::-1]
    while waiting:
        joint = waiting.pop()
        yield joint
        waiting.extend(reversed(children[joint]))
