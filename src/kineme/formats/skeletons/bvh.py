"""Read and write BVH, the Biovision hierarchy, in its many variants.

The file has a tree of joints with an offset and named channels each, then a line of channel values
per frame. A joint's rotation is the product of its rotation channels in the order of the file, in
degrees: ``Zrotation Yrotation Xrotation`` is Rz Ry Rx. Joints may have different channels; names
may contain blanks, dots and colons; braces and line breaks may be anywhere.

Position channels replace the joint's offset. In PyMO's ``AV_8Walk.bvh``, one of the files with
both, the hips have an offset 35.4 high and a first position 35.6 high (inches): replacing puts the
feet on the floor, adding would put them at the height of the hips.

A BVH has no unit and no up axis; `kineme.formats.units` infers them. A recording from a BVH is
written with its channels, in its units and axes; others in centimetres with y up and rotations Z Y
X. Angles are continuous over the frames. A BVH has no rotations at rest, so those of a rig become
part of the rotations of each frame.

Joints that did not come from a BVH get six channels if their offset varies or they are roots, else
three. Channels are added to a joint that cannot move as needed. An end site that moves or has
children becomes a joint. A BVH has no names for end sites: reading names them
``PARENT_end``.

Source: M. Meredith, S. Maddock, "Motion capture file formats explained", University of Sheffield
CS-01-11, 2001, section 3.
"""

from __future__ import annotations

import re
from array import array
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import accumulate, islice, pairwise
from math import ceil
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from kineme._util import rotations as rot
from kineme._util.arrays import Floats
from kineme._util.checks import format_count
from kineme.errors import ReadError
from kineme.formats.files import (
    FileContent,
    clean_names,
    format_table,
    parse_numbers,
    require_rotations,
    save,
)
from kineme.formats.options import ReadOptions
from kineme.formats.registry import Format, Sketch
from kineme.formats.scenes.characters import Character, SceneNode, find_character
from kineme.formats.skeletons.placing import (
    RIGID,
    build_motion,
    order_depth_first,
    require_frame_memory,
)
from kineme.formats.units import infer_rate, iterate_blocks
from kineme.recordings import Motion, Provenance, Skeleton
from kineme.recordings.joint_names import find_joints
from kineme.recordings.kinematics import compute_local_translations
from kineme.recordings.posing import align_to_rest
from kineme.recordings.rig import Channel

CHUNK = 1 << 20
"""Bytes of text that are split into words at a time."""
UNIT = 0.01
"""Metres per unit for recordings from other formats."""
POSITIONS: list[Channel] = [(axis, "position") for axis in "xyz"]
ROTATIONS: list[Channel] = [(axis, "rotation") for axis in "zyx"]
"""Channels of joints that did not come from a BVH."""

_HIERARCHY = re.compile(rb"^(\xef\xbb\xbf)?\s*HIERARCHY\s", re.IGNORECASE | re.MULTILINE)
_MOTION = re.compile(rb"\bMOTION\s+Frames\s*:", re.IGNORECASE)
_HEADER = re.compile(rb"[ \t]*(\d{1,18})\s+Frame\s*Time\s*:[ \t]*(\S*)[^\r\n]*", re.IGNORECASE)
_CHANNEL = re.compile(r"([xyz])(position|rotation)", re.IGNORECASE)
_JOINED = re.compile(rb"(?<=[0-9.])-")


def read_bvh(content: FileContent, options: ReadOptions) -> Motion:
    """Return the motion of a BVH file."""
    head = _parse_head(content, options)
    values = read_frames(content, head.start, head.width, head.declared)[:, head.columns]
    if len(values) != head.declared:
        content.warn(f"{head.declared} frames declared, {len(values)} found and kept", head.line)
    require_frame_memory(content, len(head.joints), len(values))
    provenance = content.provenance("BVH", head.notes)
    if len(head.character.people) > 1:
        provenance = provenance.of_person(head.character.name, head.character.people)
    content.release()
    local = _compute_local(head.joints, values)
    del values  # release them before positions are computed
    return _place_joints(head.joints, local, head.fps, options, provenance)


def sketch_bvh(content: FileContent, options: ReadOptions, most: int) -> Sketch | None:
    """Return at most ``most`` evenly spaced frames.

    None if the file has no more than those, or is not as long as its head states.
    """
    head = _parse_head(content, options)
    every = ceil(head.declared / most)
    values = sample_frames(content.data, head.start, head.width, every) if every > 1 else None
    if values is None or len(values) != ceil(head.declared / every):
        return None
    local = _compute_local(head.joints, values[:, head.columns])
    provenance = Provenance(str(content.path), "BVH")
    motion = _place_joints(head.joints, local, head.fps / every, options, provenance)
    return Sketch(motion, head.declared, head.fps)


class _Head(NamedTuple):
    """Everything before the frames: the chosen character's joints and the columns of a frame."""

    joints: list[Joint]
    character: Character
    columns: slice
    width: int
    declared: int
    fps: float
    notes: list[str]
    line: int
    start: int


def _parse_head(content: FileContent, options: ReadOptions) -> _Head:
    """Return what precedes the values: joints, number of frames, rate."""
    split = _MOTION.search(content.data)
    if split is None:
        raise content.error("no MOTION section with 'Frames:', so this is not a complete BVH file")
    joints = _HierarchyParser(content, split.start()).joints
    character = _find_character(content, joints, options.person)
    first, stop = character.joints[0], character.joints[-1] + 1
    # Column of the first channel of each joint.
    columns = [0, *accumulate(len(joint.channels) for joint in joints)]
    chosen = joints[first:stop]
    for joint in chosen:
        joint.parent = max(joint.parent - first, -1)
    _name_end_sites(content, chosen)
    line = content.line_at(split.end() - 1)
    header = _HEADER.match(content.data, split.end())
    if header is None:
        raise content.error("'Frames:' is not followed by a number and 'Frame Time:'", line)
    note = None
    try:
        fps, note = _parse_rate(content, header.group(2), content.line_at(header.start(2)))
        fps = content.choose_rate(options.fps, fps)
    except ReadError:
        if options.fps is None:
            raise
        fps = options.fps
    notes = [*character.notes, *([note] if note and options.fps is None else [])]
    return _Head(
        chosen,
        character,
        columns=slice(columns[first], columns[stop]),
        width=columns[-1],
        declared=int(header.group(1)),
        fps=fps,
        notes=notes,
        line=line,
        start=header.end(),
    )


def _find_character(content: FileContent, joints: Sequence[Joint], person: str | None) -> Character:
    """Return the joints of one of several people; all joints if one tree at most has a pelvis."""
    roots = [i for i, joint in enumerate(joints) if joint.parent < 0]
    trees = [[joint.name for joint in joints[a:b]] for a, b in pairwise([*roots, len(joints)])]
    if sum(bool(find_joints(names, [("pelvis",)])) for names in trees) < 2:
        return Character([*range(len(joints))], [], "", [])
    nodes = [
        SceneNode(joint.name, joint.parent, bone=True, animated=bool(joint.channels))
        for joint in joints
    ]
    return find_character(content, nodes, person)


def _parse_rate(content: FileContent, word: bytes, line: int) -> tuple[float, str | None]:
    try:
        (period,) = parse_numbers([word])
    except ValueError as error:
        raise content.error(f"Frame Time: {error}; give fps= (--fps)", line) from None
    if not 1e-6 < period < 1e6:
        raise content.error(f"Frame Time is {period:g} s: give fps= (--fps)", line)
    return infer_rate(word.decode())


@dataclass
class Joint:
    """A joint in the file."""

    name: str
    parent: int
    line: int
    end: bool
    offset: list[float] = field(default_factory=lambda: [0.0, 0.0, 0.0])
    channels: list[Channel] = field(default_factory=list)


class _HierarchyParser:
    """Joints of the HIERARCHY section, which ends at byte ``stop``; parents first."""

    def __init__(self, content: FileContent, stop: int):
        self.content = content
        text = FileContent(content.path, content.data[:stop]).text
        lines = enumerate(text.replace("{", " { ").replace("}", " } ").splitlines(), 1)
        self.words = [(word, number) for number, line in lines for word in line.split()]
        self.joints: list[Joint] = []
        open_joints: list[int] = []
        if not self.words or self.words[0][0].upper() != "HIERARCHY":
            raise content.error("a BVH file begins with the word HIERARCHY", 1)
        self.position = 1
        while self.position < len(self.words):
            word, line = self._take_word()
            key = word.upper()
            if key in ("ROOT", "JOINT", "END"):
                parent = open_joints[-1] if open_joints else -1
                if (key == "ROOT") != (parent < 0):
                    where = "outside" if parent < 0 else "inside"
                    raise content.error(f"{word} {where} a joint", line)
                open_joints.append(len(self.joints))
                self.joints.append(Joint(self._parse_name(line), parent, line, key == "END"))
            elif not open_joints:
                raise content.error(f"ROOT expected, found {word[:40]!r}", line)
            elif key == "}":
                open_joints.pop()
            elif key == "OFFSET":
                self.joints[open_joints[-1]].offset = self._parse_offset(line)
            elif key == "CHANNELS":
                self.joints[open_joints[-1]].channels = self._parse_channels(line)
            else:
                reason = f"OFFSET, CHANNELS, JOINT or '}}' expected, found {word[:40]!r}"
                raise content.error(reason, line)
        if not self.joints:
            raise content.error("the hierarchy has no ROOT")
        if open_joints:
            reason = f"the '}}' of joint {self.joints[open_joints[-1]].name!r} is missing"
            raise content.error(f"{reason} before MOTION", self.words[-1][1])

    def _take_word(self) -> tuple[str, int]:
        if self.position >= len(self.words):
            raise self.content.error("the hierarchy is truncated", self.words[-1][1])
        self.position += 1
        return self.words[self.position - 1]

    def _parse_name(self, line: int) -> str:
        """Return all words up to the brace, which must precede the next keyword."""
        words = []
        while (word := self._take_word())[0] != "{":
            if word[1] > line and word[0].upper() in ("OFFSET", "CHANNELS", "JOINT", "END"):
                raise self.content.error("'{' expected after a joint's name", word[1])
            words.append(word[0])
        if not words:
            raise self.content.error("a joint without a name", line)
        return " ".join(words)

    def _parse_offset(self, line: int) -> list[float]:
        words = [self._take_word()[0] for _ in range(3)]
        try:
            return parse_numbers(words)
        except ValueError as error:
            raise self.content.error(f"OFFSET: {error}", line) from None

    def _parse_channels(self, line: int) -> list[Channel]:
        """Return axis and kind (position or rotation) of each channel of a joint, in order."""
        declared = self._take_word()[0]
        if not declared.isdecimal() or len(declared) > 18:
            raise self.content.error(f"CHANNELS needs a number, found {declared[:40]!r}", line)
        channels = []
        for _ in range(int(declared)):
            word = self._take_word()[0]
            match = _CHANNEL.fullmatch(word)
            if match is None:
                raise self.content.error(f"unknown channel {word[:40]!r} of {declared}", line)
            channels.append((match.group(1).lower(), match.group(2).lower()))
        positions = [channel for channel in channels if channel[1] == "position"]
        if len(set(positions)) != len(positions):
            raise self.content.error("a position channel is listed twice", line)
        return channels


def _name_end_sites(content: FileContent, joints: list[Joint]) -> None:
    """Name end sites after their parent, and make all names unique."""
    names: set[str] = set()
    for joint in joints:
        joint.end = joint.end and not joint.channels
        if not joint.end:
            if joint.name in names:
                raise content.error(f"a second joint is called {joint.name!r}", joint.line)
            names.add(joint.name)
    tried: dict[str, int] = {}  # last number appended to each name
    for joint in joints:
        if joint.end:
            stem = joint.name = f"{joints[joint.parent].name}_end"
            while joint.name in names:
                tried[stem] = tried.get(stem, 1) + 1
                joint.name = f"{stem}{tried[stem]}"
            names.add(joint.name)


def read_frames(content: FileContent, start: int, width: int, declared: int) -> Floats:
    """Return the channel values (frames, width) from the bytes after ``start``.

    A truncated last line is dropped with a warning. If lines do not match frames, all numbers are
    read as one sequence, provided that it gives exactly the declared frames.
    """
    if width == 0:
        raise content.error("no joint has channels, so there is no motion")
    values = array("d")
    odd_lines: list[tuple[int, int]] = []  # number of the line, and of its values
    # A line that is not numbers is kept as the fault: raised if another line follows, otherwise
    # only warned of.
    fault: ReadError | None = None
    repaired = 0
    last = number = content.line_at(start)
    for number, line in _split_lines(content.data, start, last):
        last = number
        if fault is not None:
            raise fault
        try:
            row, is_repaired = _parse_row(line)
        except ValueError as error:
            fault = content.error(str(error), number)
            continue
        repaired += is_repaired
        values.extend(row)
        if len(row) != width:
            odd_lines.append((number, len(row)))
    # Lines of another width are allowed in two cases: frames are broken over lines (all numbers
    # together give exactly the declared frames), or the file ends within the last line.
    if odd_lines and (fault or len(values) != width * declared):
        fault = _drop_truncated_line(content, values, odd_lines[0], width, last)
    if not values:
        raise fault or content.error("the file ends before its first frame, so it has no motion")
    if fault is not None:
        content.warn(f"{fault.reason}: the last frame is truncated and left out", fault.line)
    if repaired:
        count_text = format_count(repaired, "frame")
        content.warn(f"spaces missing before minus signs added in {count_text}")
    return np.frombuffer(values).reshape(-1, width)


def _drop_truncated_line(
    content: FileContent, values: array[float], odd_line: tuple[int, int], width: int, last: int
) -> ReadError:
    """Remove the values of a truncated last line, and return its fault.

    Raise the fault if the first line of another width is not the last line, or is too long.
    """
    number, count = odd_line
    fault = content.error(f"{count} values, but the hierarchy has {width} channels", number)
    if number < last or count > width:
        raise fault
    del values[-count:]
    return fault


def sample_frames(data: bytes, start: int, width: int, every: int) -> Floats | None:
    """Return the values of every ``every``-th frame; None if lines do not match frames."""
    lines = islice(_split_lines(data, start), 0, None, every)
    try:
        rows = [parse_numbers(line.split()) for _, line in lines]
    except ValueError:
        return None
    return np.array(rows) if rows and all(len(row) == width for row in rows) else None


def _split_lines(data: bytes, start: int, number: int = 0) -> Iterator[tuple[int, bytes]]:
    """Yield number and text of the lines from ``start`` on that are not blank, in chunks."""
    while start < len(data):
        # Cut after a line break to keep lines whole.
        cut = data.find(b"\n", start + CHUNK) + 1 or len(data)
        for line in data[start:cut].splitlines():
            if line and not line.isspace():
                yield number, line
            number += 1
        start = cut


def _parse_row(line: bytes) -> tuple[list[float], bool]:
    """Return the numbers of a line, and whether blanks were missing (``0.0-7.5``, from SlimeVR)."""
    try:
        return parse_numbers(line.split()), False
    except ValueError:
        repaired = _JOINED.sub(b" -", line)
        if repaired == line:
            raise
        return parse_numbers(repaired.split()), True


def _compute_local(joints: list[Joint], values: Floats) -> tuple[Floats, dict[int, Floats]]:
    """Return quaternions (frames, joints, 4), and translations of joints with position channels.

    Translations (frames, 3) are by the number of the joint, in file units.
    """
    rotations = np.empty((len(values), len(joints), 4))
    translations = {
        # Position channels replace the offset per axis.
        j: np.tile(joint.offset, (len(values), 1))
        for j, joint in enumerate(joints)
        if any(kind == "position" for _, kind in joint.channels)
    }
    for span in iterate_blocks(len(values)):
        # One contiguous row per channel.
        columns = np.ascontiguousarray(values[span].T)
        block_rotations = np.zeros((len(joints), 4, columns.shape[1]))
        block_rotations[:, 0] = 1.0
        column = 0
        # Columns are in the order of the joints' channels.
        for j, joint in enumerate(joints):
            rotation_columns, axes = [], ""
            for axis, kind in joint.channels:
                if kind == "position":
                    translations[j][span, "xyz".index(axis)] = columns[column]
                else:
                    rotation_columns.append(column)
                    axes += axis
                column += 1
            if rotation_columns:
                block_rotations[j] = rot.from_euler(np.radians(columns[rotation_columns]).T, axes).T
        rotations[span] = block_rotations.transpose(2, 0, 1)
    return rotations, translations


def _place_joints(
    joints: list[Joint],
    local: tuple[Floats, dict[int, Floats]],
    fps: float,
    options: ReadOptions,
    provenance: Provenance,
) -> Motion:
    """Return the motion of joints from the result of `_compute_local`."""
    parents = tuple(joint.parent for joint in joints)
    with_children = {*parents}
    skeleton = Skeleton(
        tuple(joint.name for joint in joints),
        parents,
        np.array([joint.offset for joint in joints]),
        frozenset(i for i, joint in enumerate(joints) if joint.end and i not in with_children),
    )
    return build_motion(
        skeleton,
        *local,
        fps,
        unit=options.unit,
        up=options.up,
        provenance=provenance,
        channels={joint.name: joint.channels for joint in joints if joint.channels},
    )


def write_bvh(motion: Motion, path: Path) -> None:
    """Write a motion to a BVH file."""
    skeleton = motion.skeleton
    turns, translations, offsets, slides = compute_local_pose(motion, path, "a BVH")
    unit, inverse = UNIT, rot.IDENTITY
    known: Mapping[str, Sequence[Channel]] = {}
    if skeleton.rig is not None and skeleton.rig.channels and skeleton.rig.is_plain:
        unit, known = skeleton.rig.unit, skeleton.rig.channels
        inverse = rot.conjugate(skeleton.rig.turn)
        # Convert the axes of both the world and the joints back to the file's.
        turns = rot.multiply(rot.multiply(inverse, turns), skeleton.rig.turn)
    translations, offsets = (rot.rotate(inverse, each) / unit for each in (translations, offsets))
    fixed_ends = {j for j in skeleton.end_sites if not slides[j]}
    roots = (j for j, parent in enumerate(skeleton.parents) if parent < 0)
    order = [j for j, _ in order_depth_first(roots, skeleton.children.__getitem__)]
    channels: dict[int, list[Channel]] = {}
    columns: list[Floats] = []
    for j in order:
        if j not in fixed_ends:
            default = POSITIONS * (skeleton.parents[j] < 0) + ROTATIONS
            given = known.get(skeleton.names[j], default)
            channels[j] = _complete_channels(given, turns[:, j], slides=slides[j])
            axes = "".join(axis for axis, kind in channels[j] if kind == "rotation")
            angles = np.degrees(rot.unwrap_euler(rot.to_euler(turns[:, j], axes)))
            columns += [
                translations[:, j, "xyz".index(axis)]
                if kind == "position"
                else angles[:, axes.index(axis)]
                for axis, kind in channels[j]
            ]
    named = [j for j in range(skeleton.n_joints) if j not in fixed_ends]
    clean = clean_names(path, [skeleton.names[j] for j in named], _clean_name)
    names = dict(zip(named, clean, strict=True))
    head = "\n".join(_format_hierarchy(skeleton, offsets, order, channels, names))
    timing = f"MOTION\nFrames: {motion.n_frames}\nFrame Time: {1 / motion.fps!r}\n"
    save(path, [head, "\n", timing, *format_table(np.stack(columns, axis=1))])


def _complete_channels(given: Sequence[Channel], turns: Floats, *, slides: bool) -> list[Channel]:
    """Return the channels of a joint, with those added that its motion needs."""
    positions = [channel for channel in given if channel[1] == "position"]
    axes = "".join(axis for axis, kind in given if kind == "rotation")
    is_complete = len({*axes}) == len(axes)
    if is_complete and len(axes) < len(ROTATIONS):
        again = rot.from_euler(rot.to_euler(turns, axes), axes)
        is_complete = bool(np.abs((again * turns).sum(axis=1)).min() > 1 - 1e-12)
    if not is_complete:
        given = [*positions, *ROTATIONS]
    if slides and len(positions) < len(POSITIONS):
        given = [*POSITIONS, *(channel for channel in given if channel[1] == "rotation")]
    return list(given)


def compute_local_pose(
    motion: Motion, path: Path, what: str
) -> tuple[Floats, Floats, Floats, NDArray[np.bool_]]:
    """Return the pose of each frame for a format without rotations at rest.

    These are rotations (frames, joints, 4) and translations (frames, joints, 3) relative to the
    parent, offsets (joints, 3) at rest, and whether the translation of each joint varies. Raise
    WriteError if the motion has no rotations, which ``what`` needs.
    """
    aligned = align_to_rest(motion)
    turns, offsets = require_rotations(aligned, path, what), aligned.skeleton.offsets
    translations = compute_local_translations(aligned.skeleton, motion.positions, turns)
    return turns, translations, offsets, np.abs(translations - offsets).max(axis=(0, 2)) > RIGID


def _clean_name(name: str) -> str:
    """Return a name without line breaks, braces and the text that starts the motion section."""
    plain = re.sub(r"[{}\s]+", " ", name).strip()
    return re.sub(r"(\bmotion frames) ?:", r"\1", plain, flags=re.IGNORECASE)


def _format_hierarchy(
    skeleton: Skeleton,
    offsets: Floats,
    order: list[int],
    channels: dict[int, list[Channel]],
    names: dict[int, str],
) -> Iterator[str]:
    """Yield the lines of the hierarchy; joints without an entry in ``names`` are end sites."""
    depths: dict[int, int] = {-1: -1}  # the parent of a root is -1
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
            words = (f"{axis.upper()}{kind}" for axis, kind in channels[j])
            yield f"{tab}\tCHANNELS {len(channels[j])} {' '.join(words)}"
    while open_joints:
        yield "\t" * depths[open_joints.pop()] + "}"


FORMAT = Format(
    "BVH",
    (".bvh",),
    lambda head: _HIERARCHY.search(head) is not None,
    read_bvh,
    write_bvh,
    sketch=sketch_bvh,
)
