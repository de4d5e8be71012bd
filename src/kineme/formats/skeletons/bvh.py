"""BVH: the Biovision hierarchy, as its many dialects have it.

A tree of joints with an offset and named channels each, then one line of
channel values per frame. A joint's rotation is the product of its rotation
channels in the order of the file, in degrees: ``Zrotation Yrotation
Xrotation`` is Rz Ry Rx. Joints may differ in their channels; names may hold
blanks, dots and colons; braces and line breaks may stand anywhere.

Position channels replace the joint's offset and do not add to it. In PyMO's
``AV_8Walk.bvh``, one of the files that give both, the hips have an offset 35.4
high and a first position 35.6 high (inches): replacing puts the feet on the
floor, adding puts them at the height of the hips.

A BVH has no unit and no up axis; see `kineme.formats.units` for how they are
found.

Source: M. Meredith, S. Maddock, "Motion capture file formats explained",
University of Sheffield CS-01-11, 2001, section 3.
"""

from __future__ import annotations

import re
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from kineme import _rotations as rot
from kineme.formats.files import FileContent, numbers
from kineme.formats.options import ReadOptions
from kineme.formats.registry import Format, Sketch
from kineme.formats.skeletons.bvh_frames import read_frames, read_some
from kineme.formats.skeletons.bvh_hierarchy import Joint, read_joints
from kineme.formats.skeletons.bvh_writer import write_bvh
from kineme.formats.skeletons.placing import BYTES_PER_JOINT, place
from kineme.formats.units import blocks, rate_from_period
from kineme.recordings import Motion, Provenance, Skeleton

Floats = NDArray[np.float64]

_HIERARCHY = re.compile(rb"^(\xef\xbb\xbf)?\s*HIERARCHY\s", re.IGNORECASE | re.MULTILINE)
_MOTION = re.compile(rb"\bMOTION\s+Frames\s*:", re.IGNORECASE)
_HEADER = re.compile(rb"[ \t]*(\d{1,18})\s+Frame\s*Time\s*:[ \t]*(\S*)[^\r\n]*", re.IGNORECASE)


def read_bvh(content: FileContent, options: ReadOptions) -> Motion:
    """The motion of a BVH file."""
    head = _head(content, options)
    values = read_frames(content, head.start, head.width, head.declared)
    n_joints = len(head.joints)
    if len(values) != head.declared:
        content.warn(f"{head.declared} frames declared, {len(values)} found and kept", head.line)
    content.claim(
        BYTES_PER_JOINT * n_joints * len(values), f"{n_joints} joints in {len(values)} frames"
    )
    provenance = content.provenance("BVH", head.notes)
    content.let_go()
    rotations, slides = _local(head.joints, values)
    del values  # before as much again is made of it
    return place(
        _skeleton(head.joints),
        rotations,
        slides,
        head.fps,
        unit=options.unit,
        up=options.up,
        provenance=provenance,
    )


def sketch_bvh(content: FileContent, options: ReadOptions, most: int) -> Sketch | None:
    """So many frames of a BVH file at most, evenly apart; None where it has no more than those."""
    head = _head(content, options)
    every = -(-head.declared // most)
    values = read_some(content.data, head.start, head.width, every) if every > 1 else None
    if values is None or len(values) != -(-head.declared // every):
        return None
    rotations, slides = _local(head.joints, values)
    motion = place(
        _skeleton(head.joints),
        rotations,
        slides,
        head.fps / every,
        unit=options.unit,
        up=options.up,
        provenance=Provenance(str(content.path), "BVH"),
    )
    return Sketch(motion, head.declared, head.fps)


class _Head(NamedTuple):
    """All that stands before the frames."""

    joints: list[Joint]
    declared: int
    fps: float
    notes: list[str]
    line: int
    start: int

    @property
    def width(self) -> int:
        return sum(len(joint.channels) for joint in self.joints)


def _head(content: FileContent, options: ReadOptions) -> _Head:
    split = _MOTION.search(content.data)
    if split is None:
        raise content.error("no MOTION section with 'Frames:', so this is not a whole BVH file")
    joints = read_joints(content, split.start())
    line = content.line_at(split.end() - 1)
    header = _HEADER.match(content.data, split.end())
    if header is None:
        raise content.error("'Frames:' is not followed by a number and 'Frame Time:'", line)
    notes: list[str] = []
    fps = options.fps
    if fps is None:
        fps, note = _rate(content, header.group(2), content.line_at(header.start(2)))
        notes += [note] if note else []
    return _Head(joints, int(header.group(1)), fps, notes, line, header.end())


def _skeleton(joints: list[Joint]) -> Skeleton:
    parents = tuple(joint.parent for joint in joints)
    inner = set(parents)
    return Skeleton(
        tuple(joint.name for joint in joints),
        parents,
        np.array([joint.offset for joint in joints]),
        frozenset(i for i, joint in enumerate(joints) if joint.end and i not in inner),
    )


def _local(joints: list[Joint], values: Floats) -> tuple[Floats, dict[int, Floats]]:
    """Rotations (frames, joints, 4); where joints slide, (frames, 3) each, file units."""
    rotations = np.empty((len(values), len(joints), 4))
    slides = {
        j: np.tile(joint.offset, (len(values), 1))
        for j, joint in enumerate(joints)
        if any(kind == "position" for _, kind in joint.channels)
    }
    for span in blocks(len(values)):
        columns = np.ascontiguousarray(values[span].T)
        turned = np.zeros((len(joints), 4, columns.shape[1]))
        turned[:, 0] = 1.0
        at = 0
        for j, joint in enumerate(joints):
            turns, axes = [], ""
            for axis, kind in joint.channels:
                if kind == "position":
                    slides[j][span, "xyz".index(axis)] = columns[at]
                else:
                    turns.append(at)
                    axes += axis
                at += 1
            if turns:
                turned[j] = rot.from_euler(np.radians(columns[turns]).T, axes).T
        rotations[span] = turned.transpose(2, 0, 1)
    return rotations, slides


def _rate(content: FileContent, word: bytes, line: int) -> tuple[float, str | None]:
    try:
        (period,) = numbers([word])
    except ValueError as error:
        raise content.error(f"Frame Time: {error}; give fps= (--fps)", line) from None
    if not 1e-6 < period < 1e6:
        raise content.error(f"Frame Time is {period:g} s: give fps= (--fps)", line)
    return rate_from_period(word.decode())


FORMAT = Format(
    "BVH",
    (".bvh",),
    lambda head: _HIERARCHY.search(head) is not None,
    read_bvh,
    write_bvh,
    sketch=sketch_bvh,
)
