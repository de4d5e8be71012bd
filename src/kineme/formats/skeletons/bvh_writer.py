"""Writing BVH: centimetres, y up, rotations as Z Y X in degrees.

Joints whose bone changes its length or direction get six channels, the others
three (roots always six). An end site that moves, or that has children,
becomes a joint. A BVH has no name for an end site: reading one calls it
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
from kineme.formats.files import rotations_of, save, spell_names, table
from kineme.recordings import Motion
from kineme.recordings.kinematics import local_translations

UNIT = 0.01
RIGID = 1e-9
"""Metres by which a bone may differ from its offset and still count as rigid."""


def write_bvh(motion: Motion, path: Path) -> None:
    """Leave ``motion`` in a BVH file in centimetres."""
    skeleton = motion.skeleton
    angles, translations, slides = euler_angles(motion, path, "a BVH")
    slides |= np.array(skeleton.parents) < 0
    ends = {j for j in skeleton.end_sites if not slides[j]}
    order = list(_depth_first(motion))
    columns: list[Floats] = []
    for j in order:
        if j in ends:
            continue
        if slides[j]:
            columns.append(translations[:, j] / UNIT)
        columns.append(angles[:, j])
    head = "\n".join(_hierarchy(motion, order, slides, _names(motion, ends, path)))
    timing = f"MOTION\nFrames: {motion.n_frames}\nFrame Time: {1 / motion.fps!r}\n"
    save(path, [head, "\n", timing, *table(np.concatenate(columns, axis=1))])


def euler_angles(motion: Motion, path: Path, what: str) -> tuple[Floats, Floats, NDArray[np.bool_]]:
    """Angles z, y, x in degrees, translations from the parent, and which joints slide.

    WriteError where a motion has no rotations for ``what`` is to be written.
    """
    rotations = rotations_of(motion, path, what)
    translations = local_translations(motion.skeleton, motion.positions, rotations)
    slides = np.abs(translations - motion.skeleton.offsets).max(axis=(0, 2)) > RIGID
    return np.degrees(rot.to_euler_zyx(rotations)), translations, slides


def _names(motion: Motion, ends: set[int], path: Path) -> dict[int, str]:
    """Return the names of joints as a line holds them; end sites have none."""
    named = [j for j in range(motion.skeleton.n_joints) if j not in ends]
    return dict(
        zip(named, spell_names(path, [motion.skeleton.names[j] for j in named], _line), strict=True)
    )


def _line(name: str) -> str:
    """No braces, and nothing that the motion begins with."""
    plain = re.sub(r"[{}\s]+", " ", name).strip()
    return re.sub(r"(\bmotion frames) ?:", r"\1", plain, flags=re.IGNORECASE)


def _hierarchy(
    motion: Motion, order: list[int], slides: NDArray[np.bool_], names: dict[int, str]
) -> Iterator[str]:
    skeleton = motion.skeleton
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
        yield f"{tab}\tOFFSET " + " ".join(f"{x / UNIT:.9f}" for x in skeleton.offsets[j])
        if j in names:
            places = "6 Xposition Yposition Zposition" if slides[j] else "3"
            yield f"{tab}\tCHANNELS {places} Zrotation Yrotation Xrotation"
    while open_joints:
        yield "\t" * depths[open_joints.pop()] + "}"


def _depth_first(motion: Motion) -> Iterator[int]:
    children = motion.skeleton.children
    # Reversed, since the last one is taken first.
    waiting = [j for j, parent in enumerate(motion.skeleton.parents) if parent < 0][::-1]
    while waiting:
        joint = waiting.pop()
        yield joint
        waiting.extend(reversed(children[joint]))
