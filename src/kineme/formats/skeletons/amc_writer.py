"""Write ASF/AMC: skeleton and motion as a pair of files with the same name.

Lengths are in CMU's unit (1/0.45 inch), angles in degrees. The frame of each bone is that of its
rig at rest. The root is always called ``root``.

A bone can carry children only at its tip. If the children of a joint have different positions, or
those of the root are not at its origin, each gets a rigid parent bone called ``PARENT-CHILD``. A
joint with varying offset also gets translations. A comment stores the frame rate for `read`.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from kineme._util import rotations as rot
from kineme._util.arrays import Floats
from kineme.errors import WriteError
from kineme.formats.files import clean_names, format_table, save
from kineme.formats.skeletons.asf import ROOT
from kineme.formats.skeletons.bvh_writer import RIGID, compute_local_pose
from kineme.formats.units import UNITS
from kineme.recordings import Motion, Skeleton
from kineme.recordings.posing import get_rig

UNIT = UNITS["cmu"]


@dataclass
class Bone:
    """A bone to be written; ``joint`` is None for a rigid one."""

    name: str
    parent: str
    tip: Floats
    joint: int | None
    slides: bool = False
    frame: Floats = field(default_factory=rot.IDENTITY.copy)

    @property
    def dof(self) -> str:
        return "tx ty tz rx ry rz" if self.slides else "rx ry rz"


def write_amc(motion: Motion, path: Path) -> None:
    """Write a motion to an AMC file and its skeleton to an ASF of the same name."""
    turns, translations, offsets, slides = compute_local_pose(motion, path, "an AMC")
    skeleton = motion.skeleton
    if sum(parent < 0 for parent in skeleton.parents) != 1:
        raise WriteError(path, "an AMC holds one figure, but this motion has several roots")
    moving = sorted(j for j in skeleton.end_sites if slides[j])
    if moving:
        raise WriteError(path, f"end site {skeleton.names[moving[0]]!r} moves on its bone")
    # The frame of a bone is the world rotation of its node at rest; the root has none.
    rig = get_rig(skeleton)
    frames = rot.multiply(rig.turn, rig.world[1][rig.above :])
    frames[0] = rot.IDENTITY
    inverse = rot.conjugate(frames)
    angles = np.degrees(rot.to_euler_zyx(rot.multiply(rot.multiply(inverse, turns), frames)))
    bones = _list_bones(skeleton, offsets, frames, slides, path)
    # Translations are added to the offsets; the root has no offset.
    shift = rot.rotate(inverse, translations - offsets) / UNIT
    shift[:, 0] = translations[:, 0] / UNIT
    blocks = []
    for bone in bones:
        if bone.joint is not None:
            # Reverse the columns z, y, x to `rx ry rz`.
            parts = [shift[:, bone.joint]] * bone.slides + [angles[:, bone.joint, ::-1]]
            rows = format_table(np.concatenate(parts, axis=1))
            blocks.append([f"{bone.name} {row}" for row in rows])
    save(path.with_suffix(".asf"), _format_asf(bones))
    head = f"# fps {motion.fps!r}\n:FULLY-SPECIFIED\n:DEGREES\n"
    lines = (f"{i}\n{''.join(each)}" for i, each in enumerate(zip(*blocks, strict=True), 1))
    save(path, [head, *lines])


def _list_bones(
    skeleton: Skeleton, all_offsets: Floats, frames: Floats, slides: NDArray[np.bool_], path: Path
) -> list[Bone]:
    """Return the root and all bones, parents first."""
    inner = [j for j in range(skeleton.n_joints) if j not in skeleton.end_sites]
    words = clean_names(path, [ROOT, *(skeleton.names[j] for j in inner[1:])], _to_word)
    names = dict(zip(inner, words, strict=True))
    bones: list[Bone] = []
    parent_names = {0: ROOT}
    for j in inner:
        offsets = all_offsets[list(skeleton.children[j])].reshape(-1, 3)
        # A bone can carry all children only if they have the same position.
        has_common_tip = j > 0 and len(offsets) > 0 and bool(np.ptp(offsets, axis=0).max() < RIGID)
        tip = offsets[0] if has_common_tip else np.zeros(3)
        parent = "" if j == 0 else parent_names[j]
        bones.append(Bone(names[j], parent, tip, j, j == 0 or bool(slides[j]), frames[j]))
        for child, offset in zip(skeleton.children[j], offsets, strict=True):
            parent_names[child] = names[j]
            if not has_common_tip and offset.any():
                parent_names[child] = f"{names[j]}-{_to_word(skeleton.names[child])}"
                bones.append(Bone(parent_names[child], names[j], offset, None))
    return bones


def _format_asf(bones: list[Bone]) -> Iterator[str]:
    yield ":version 1.10\n:name kineme\n:units\n  mass 1.0\n  length 0.45\n  angle deg\n"
    yield ":root\n  order TX TY TZ RX RY RZ\n  axis XYZ\n  position 0 0 0\n  orientation 0 0 0\n"
    yield ":bonedata\n"
    for number, bone in enumerate(bones[1:], 1):
        length = float(np.linalg.norm(bone.tip))
        direction = bone.tip / length if length > 0 else np.zeros(3)
        yield f"  begin\n    id {number}\n    name {bone.name}\n"
        yield "    direction " + " ".join(f"{x:.12f}" for x in direction) + "\n"
        turns = np.degrees(rot.to_euler_zyx(bone.frame))[::-1] + 0.0  # no minus before a zero
        axis = " ".join(f"{angle:.12g}" for angle in turns)
        yield f"    length {length / UNIT:.12f}\n    axis {axis} XYZ\n"
        if bone.joint is not None:
            yield f"    dof {bone.dof}\n"
        yield "  end\n"
    yield ":hierarchy\n  begin\n"
    children: dict[str, list[str]] = {}
    for bone in bones[1:]:
        children.setdefault(bone.parent, []).append(bone.name)
    for parent, names in children.items():
        yield f"    {parent} {' '.join(names)}\n"
    yield "  end\n"


def _to_word(name: str) -> str:
    """Return a name as one word that ASF does not take for a comment, keyword or number."""
    word = re.sub(r"[\s#:(),\0]+", "_", name)
    return f"_{word}" if word.isdigit() or word.lower() in ("begin", "end", "") else word
