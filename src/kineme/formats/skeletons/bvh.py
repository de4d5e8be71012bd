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
from array import array

import numpy as np
from numpy.typing import NDArray

from kineme import _rotations as rot
from kineme.errors import ReadError
from kineme.formats.files import FileContent, numbers
from kineme.formats.options import ReadOptions
from kineme.formats.registry import Format
from kineme.formats.skeletons.bvh_hierarchy import Joint, read_joints
from kineme.formats.skeletons.bvh_writer import write_bvh
from kineme.formats.units import BYTES_PER_JOINT, place, rate_from_period
from kineme.recordings import Motion, Skeleton

Floats = NDArray[np.float64]

_HIERARCHY = re.compile(rb"^(\xef\xbb\xbf)?\s*HIERARCHY\s", re.IGNORECASE | re.MULTILINE)
_MOTION = re.compile(rb"\bMOTION\s+Frames\s*:", re.IGNORECASE)
_GLUED = re.compile(rb"(?<=[0-9.])-")
_HEADER = re.compile(rb"[ \t]*(\d{1,18})\s+Frame\s*Time\s*:[ \t]*(\S*)[^\r\n]*", re.IGNORECASE)


def read_bvh(content: FileContent, options: ReadOptions) -> Motion:
    """The motion of a BVH file."""
    split = _MOTION.search(content.data)
    if split is None:
        raise content.error("no MOTION section with 'Frames:', so this is not a whole BVH file")
    joints = read_joints(content, split.start())
    line = content.line_at(split.end() - 1)
    header = _HEADER.match(content.data, split.end())
    if header is None:
        raise content.error("'Frames:' is not followed by a number and 'Frame Time:'", line)
    declared = int(header.group(1))
    notes: list[str] = []
    fps = options.fps
    if fps is None:
        fps, note = _rate(content, header.group(2), content.line_at(header.start(2)))
        notes += [note] if note else []
    values = _frames(content, header.end(), sum(len(joint.channels) for joint in joints), declared)
    if len(values) != declared:
        content.warn(f"{declared} frames declared, {len(values)} found and kept", line)
    content.claim(
        BYTES_PER_JOINT * len(joints) * len(values), f"{len(joints)} joints in {len(values)} frames"
    )
    return place(
        _skeleton(joints),
        *_local(joints, values),
        fps,
        unit=options.unit,
        up=options.up,
        provenance=content.provenance("BVH", notes),
    )


def _skeleton(joints: list[Joint]) -> Skeleton:
    parents = tuple(joint.parent for joint in joints)
    inner = set(parents)
    return Skeleton(
        tuple(joint.name for joint in joints),
        parents,
        np.array([joint.offset for joint in joints]),
        frozenset(i for i, joint in enumerate(joints) if joint.end and i not in inner),
    )


def _local(joints: list[Joint], values: Floats) -> tuple[Floats, Floats]:
    """Rotations (frames, joints, 4) and translations (frames, joints, 3), file units."""
    columns = np.ascontiguousarray(values.T)
    n = columns.shape[1]
    rotations = np.zeros((len(joints), 4, n))
    rotations[:, 0] = 1.0
    translations = np.empty((len(joints), 3, n))
    at = 0
    for j, joint in enumerate(joints):
        translations[j] = np.array(joint.offset)[:, None]
        turns, axes = [], ""
        for axis, kind in joint.channels:
            if kind == "position":
                translations[j, "xyz".index(axis)] = columns[at]
            else:
                turns.append(at)
                axes += axis
            at += 1
        rotations[j] = rot.from_euler(np.radians(columns[turns]).T, axes).T
    return rotations.transpose(2, 0, 1), translations.transpose(2, 0, 1)


def _rate(content: FileContent, word: bytes, line: int) -> tuple[float, str | None]:
    try:
        (period,) = numbers([word])
    except ValueError as error:
        raise content.error(f"Frame Time: {error}; give fps= (--fps)", line) from None
    if not 1e-6 < period < 1e6:
        raise content.error(f"Frame Time is {period:g} s: give fps= (--fps)", line)
    return rate_from_period(word.decode())


def _frames(content: FileContent, start: int, width: int, declared: int) -> Floats:
    """Channel values, (frames, width).

    Nearly every file has one line per frame; its last may break off, which is
    warned about. Lines laid out otherwise are taken as one stream of numbers,
    if exactly the declared frames come of it.
    """
    if width == 0:
        raise content.error("no joint has a channel, so there is no motion")
    first = content.line_at(start)
    lines = content.data[start:].rstrip().splitlines()
    last = first + len(lines) - 1
    values = array("d")
    odd: list[tuple[int, int]] = []
    fault: ReadError | None = None
    glued = 0
    for number, line in enumerate(lines, first):
        try:
            row, apart = _row(line)
            glued += apart
        except ValueError as error:
            fault = content.error(str(error), number)
            if number < last:
                raise fault from None
            break
        values.extend(row)
        if row and len(row) != width:
            odd.append((number, len(row)))
    if odd and (fault or len(values) != width * declared):
        number, found = odd[0]
        fault = content.error(f"{found} values, but the hierarchy has {width} channels", number)
        if number < last or found > width:
            raise fault
        del values[-found:]
    if not values:
        raise fault or content.error("the file ends before its first frame: there is no motion")
    if fault is not None:
        content.warn(f"{fault.reason}: the last frame is truncated and left out", fault.line)
    if glued:
        content.warn(f"blanks before minus signs are missing in {glued} frames: put there")
    return np.array(values).reshape(-1, width)


def _row(line: bytes) -> tuple[list[float], bool]:
    """The numbers of a line, and whether some were not apart (``0.0-7.5``, as SlimeVR wrote)."""
    try:
        return numbers(line.split()), False
    except ValueError:
        apart = _GLUED.sub(b" -", line)
        if apart == line:
            raise
        return numbers(apart.split()), True


FORMAT = Format(
    "BVH", (".bvh",), lambda head: _HIERARCHY.search(head) is not None, read_bvh, write_bvh
)
