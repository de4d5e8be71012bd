"""Read and write AMC, the motion part of the Acclaim format, with its ASF.

A frame is a line with its number, followed by a line per bone with its name and a value for each of
its degrees of freedom. With C the bone's frame (its ``axis`` in the ASF) and R the product of its
rotations about fixed axes, the first one applied first, its rotation relative to the parent is C R
C^-1. The root's angles are applied after its preset orientation, its translation is added to its
preset position.

Bones may be in any order, and without values if the ASF gives them no degree of freedom. An AMC
states neither its skeleton nor its frame rate: see `find_skeleton`; 120 Hz, the rate of the CMU
database, is assumed.

Motion and skeleton are written as a pair of files with the same name. A motion of an AMC gets a
copy of its ASF, unless it needs degrees of freedom that this lacks. A new ASF has lengths in CMU's
unit (1/0.45 inch), angles in degrees, and the frame of each bone is that of its rig at rest. The
root is always called ``root``. A bone can carry children only at its tip. If the children of a
joint have different positions, or those of the root are not at its origin, each gets a rigid parent
bone called ``PARENT-CHILD``. A joint with varying offset also gets translations. A comment stores
the frame rate for `read`.

Source: Acclaim Advanced Technologies, ASF/AMC definition.
"""

from __future__ import annotations

import re
import sys
from array import array
from collections.abc import Iterator
from dataclasses import dataclass, field
from itertools import compress
from math import radians
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from kineme._util import rotations as rot
from kineme._util.arrays import Floats
from kineme._util.checks import warn
from kineme.errors import ReadError, WriteError
from kineme.formats.files import (
    FileContent,
    clean_names,
    decode_text,
    format_table,
    load,
    parse_numbers,
    save,
)
from kineme.formats.options import ReadOptions
from kineme.formats.registry import Format
from kineme.formats.skeletons.asf import ROOT, Figure, read_asf
from kineme.formats.skeletons.bvh import compute_local_pose
from kineme.formats.skeletons.placing import RIGID, build_motion, require_frame_memory
from kineme.formats.units import UNITS, iterate_blocks
from kineme.recordings import Motion, Skeleton
from kineme.recordings.posing import get_rig

Frame = dict[str, list[float]]
"""Values of each bone, in the order of the file."""
FPS = 120.0
"""Default frame rate, that of the CMU database."""
ROWS = 1024
"""Frames that are parsed at once."""
UNIT = UNITS["cmu"]
FIT = 1e-7
"""Largest 1 - cos of half the angle by which a bone may be turned on its own ASF: 0.05 degrees."""

_FPS_COMMENT = re.compile(rb"^# fps ([0-9.e+-]+)\s*$", re.MULTILINE)
_KEYWORD = re.compile(rb"^[ \t]*:(FULLY-SPECIFIED|DEGREES|RADIANS)\b", re.MULTILINE | re.IGNORECASE)
_FRAME = re.compile(rb"^[ \t]*\d+[ \t]*\r?$", re.MULTILINE)


def read_amc(content: FileContent, options: ReadOptions) -> Motion:
    """Return the motion of an AMC file on the skeleton of its ASF."""
    asf = load(options.skeleton or find_skeleton(content.path))
    figure = read_asf(asf)
    head = _find_head(content)
    keywords = [word.lower() for word in _KEYWORD.findall(head)]
    angle_unit = radians(1) if b"degrees" in keywords else figure.angle_unit
    if b"radians" in keywords:
        angle_unit = 1.0
    values = _read_frames(content, len(head), figure)
    notes = [f"skeleton from {asf.path}"]
    fps = content.choose_rate(options.fps, _parse_rate_comment(head))
    if not fps:
        fps = FPS
        notes.append(f"frame rate {FPS:g} Hz assumed: AMC files do not store one")
    require_frame_memory(content, figure.skeleton.n_joints, len(values[ROOT]))
    provenance = content.provenance("AMC", notes)
    content.release()
    rotations, slides = _compute_local(values, figure, angle_unit)
    del values  # release them before positions are computed
    return build_motion(
        figure.skeleton,
        rotations,
        slides,
        fps,
        unit=options.unit or figure.scale,
        up=options.up or "y",
        provenance=provenance,
        frames=_collect_bone_frames(figure),
        asf=asf.text,
    )


def _find_head(content: FileContent) -> bytes:
    """Return the bytes before the first frame."""
    start = _FRAME.search(content.data)
    if start is None:
        raise content.error("no frame found: an AMC has a line with a number before each frame")
    return content.data[: start.start()]


def find_skeleton(path: Path) -> Path:
    """Return the ASF that belongs to an AMC.

    Its name is the AMC's up to the end or up to an underscore, the longest first (``86_10.amc``:
    ``86_10.asf``, ``86.asf``). Otherwise it is the only ASF. The folders searched are the AMC's,
    then ``asf`` inside it, then ``asf`` next to it.
    """
    parts = path.stem.split("_")
    # Try the whole name first, then without its last part, and so on.
    stems = ["_".join(parts[:n]).lower() for n in range(len(parts), 0, -1)]
    candidates: list[Path] = []
    for folder in (path.parent, path.parent / "asf", path.parent.parent / "asf"):
        asf_files = sorted(
            p for p in folder.glob("*") if p.suffix.lower() == ".asf" and p.is_file()
        )
        by_stem = {p.stem.lower(): p for p in asf_files}
        for stem in stems:
            if stem in by_stem:
                return by_stem[stem]
        if len(asf_files) == 1:
            return asf_files[0]
        candidates += asf_files
    problem = (
        f"none of the {len(candidates)} ASF files next to it has its name"
        if candidates
        else "no ASF skeleton found next to it"
    )
    raise ReadError(path, f"{problem}: give one with skeleton= (--skeleton)")


def _parse_rate_comment(head: bytes) -> float | None:
    """Return the frame rate in the comment written by `write_amc`, if it exists."""
    comment = _FPS_COMMENT.search(head)
    try:
        return parse_numbers([comment.group(1)])[0] if comment else None
    except ValueError:
        return None


def _collect_bone_frames(figure: Figure) -> Floats:
    """Return the frame of each joint (joints, 4): none of the root, an end site has its bone's."""
    skeleton = figure.skeleton
    frames = np.tile(rot.IDENTITY, (skeleton.n_joints, 1))
    for joint, parent in enumerate(skeleton.parents):
        if joint in skeleton.end_sites:
            frames[joint] = frames[parent]
        elif parent >= 0:
            frames[joint] = figure.bones[skeleton.names[joint]].frame
    return frames


def _compute_local(
    values: dict[str, Floats], figure: Figure, angle_unit: float
) -> tuple[Floats, dict[int, Floats]]:
    """Return rotations (frames, joints, 4), and translations (frames, 3) if they vary."""
    skeleton = figure.skeleton
    n = len(values[ROOT])
    rotations = np.empty((n, skeleton.n_joints, 4))
    for span in iterate_blocks(n):
        block_rotations = np.zeros((skeleton.n_joints, 4, span.stop - span.start))
        block_rotations[:, 0] = 1.0
        for name, bone in figure.bones.items():
            # The axis named first is applied first, so it is the last factor of the product.
            turns = [i for i, dof in enumerate(bone.dof) if dof[0] == "r"][::-1]
            axes = "".join(bone.dof[i][1] for i in turns)
            local = rot.from_euler(angle_unit * values[name][span][:, turns], axes)
            # The preset orientation is applied first.
            local = rot.multiply(local, bone.frame if name == ROOT else rot.conjugate(bone.frame))
            if name != ROOT:  # C R C^-1, with C the frame of the bone
                local = rot.multiply(bone.frame, local)
            block_rotations[skeleton.joint(name)] = local.T
        rotations[span] = block_rotations.transpose(2, 0, 1)
    slides = {}
    for name, bone in figure.bones.items():
        shift = np.zeros((n, 3))
        for i, dof in enumerate(bone.dof):
            if dof[0] == "t":
                shift[:, "xyz".index(dof[1])] = values[name][:, i]
        j = skeleton.joint(name)
        if name == ROOT:
            slides[j] = bone.position + shift
        elif shift.any():
            # Translations are relative to the axes of the bone's frame.
            slides[j] = skeleton.offsets[j] + rot.rotate(bone.frame, shift)
    return rotations, slides


def _read_frames(content: FileContent, start: int, figure: Figure) -> dict[str, Floats]:
    """Return the values of each bone (frames, dofs) from the bytes after ``start``.

    A fault in the last line, or bones missing in the last frame, are signs of a truncated file:
    that frame is dropped with a warning. Other faults are errors.
    """
    first: Frame = {}
    order: list[str] = []
    parser: _FrameParser | None = None
    rows = array("d")
    label = n_frames = counted = 0
    line = 1
    head = _FRAME.search(content.data, start)
    while head:
        following = _FRAME.search(content.data, head.end())
        # Counting the lines from the start of the file for each frame would take long.
        line += content.data.count(b"\n", counted, head.start())
        counted = head.start()
        before, label = label, _parse_frame_number(content, head, line)
        if n_frames and label != before + 1:
            content.warn(f"frame {label} follows {before}", line)
        span = slice(head.end(), following.start() if following else None)
        row = parser.parse(content.data[span]) if parser else None
        if row is None:
            try:
                frame = _parse_lines(content, span, line, figure)
                _check_complete(content, frame, first, line)
            except ReadError as error:
                # Only a fault at the end of the file may be due to truncation.
                last_line = content.line_at(len(content.data.rstrip()))
                if following or error.line not in (line, last_line) or not n_frames:
                    raise
                reason = f"{error.reason}: the last frame is truncated and left out"
                content.warn(reason, error.line)
                break
            if not n_frames:
                first = frame
                order = [*first, *(name for name in figure.bones if name not in first)]
                is_complete = all(name in first or not figure.bones[name].dof for name in order)
                parser = _FrameParser(content, first) if is_complete else None
            row = [x for n in order for x in frame.get(n, [0.0] * len(figure.bones[n].dof))]
        rows.extend(row)
        n_frames, head = n_frames + 1, following
        # Loading numba would take longer than parsing without it.
        if parser and following and "numba" in sys.modules:
            block, stop = parser.parse_compiled(following.start() - 1, label)
            rows.frombytes(block.tobytes())
            n_frames, label = n_frames + len(block), label + len(block)
            head = _FRAME.search(content.data, stop)
    absent = [name for name, bone in figure.bones.items() if bone.dof and name not in first]
    if absent:
        content.warn(f"no values for {', '.join(absent)}: 0 used")
    stops = np.cumsum([len(figure.bones[name].dof) for name in order])
    columns = np.split(np.asarray(rows).reshape(n_frames, -1), stops[:-1], axis=1)
    return dict(zip(order, columns, strict=True))


def _parse_frame_number(content: FileContent, head: re.Match[bytes], line: int) -> int:
    word = head.group().strip()
    if len(word) > 18:
        raise content.error(f"{word[:18].decode()}... is not a frame number", line)
    return int(word)


class _FrameParser:
    """Parse frames whose bones are in the same order as in ``frame``."""

    def __init__(self, content: FileContent, frame: Frame) -> None:
        # Older files have names in Windows-1252, such as "Fuß".
        encoded = [(name.encode(), name.encode("cp1252", "replace")) for name in frame]
        self.names = [name if name in content.data else old for name, old in encoded]
        is_name = [i == 0 for values in frame.values() for i in range(1 + len(values))]
        self.is_name, self.is_value = is_name, [not each for each in is_name]
        # Arrays for the compiled parser, whose integers have 64 bits on every system.
        self.text = np.frombuffer(content.data, np.uint8)
        self.joined_names = np.frombuffer(b"".join(self.names), np.uint8)
        self.name_ends = np.cumsum([len(name) for name in self.names], dtype=np.int64)
        self.counts = np.array([len(values) for values in frame.values()], np.int64)
        self.rows = np.empty((ROWS, sum(self.is_value)))

    def parse(self, text: bytes) -> list[float] | None:
        """Return the values of a frame, None if it has another layout or an invalid number."""
        words = text.split()
        has_names = [*compress(words, self.is_name)] == self.names
        if len(words) != len(self.is_name) or not has_names:
            return None
        try:
            return parse_numbers([*compress(words, self.is_value)])
        except ValueError:
            return None

    def parse_compiled(self, start: int, label: int) -> tuple[Floats, int]:
        """Return the values of the next frames (frames, values), and the offset of the rest.

        ``start`` is the end of the line before them, ``label`` the number before theirs.
        """
        from kineme.formats.skeletons._amc_kernels import read_rows

        arrays = self.joined_names, self.name_ends, self.counts, self.rows
        n_frames, stop = read_rows(self.text, start, label, *arrays)
        return self.rows[:n_frames], stop


def _parse_lines(content: FileContent, span: slice, first_line: int, figure: Figure) -> Frame:
    """Return the values of a frame of any layout; errors state the line."""
    frame: Frame = {}
    for number, line in enumerate(content.data[span].splitlines(), first_line):
        words = line.split()
        if words and not words[0].startswith(b"#"):
            try:
                _add_bone(frame, words, figure)
            except ValueError as error:
                raise content.error(str(error), number) from None
    return frame


def _add_bone(frame: Frame, words: list[bytes], figure: Figure) -> None:
    """Add the line of a bone to the values of a frame; ValueError if the skeleton differs."""
    name = decode_text(words[0])
    if name not in figure.bones:
        raise ValueError(f"bone {name[:40]!r} is not in the skeleton: give the matching ASF")
    if name in frame:
        raise ValueError(f"bone {name!r} appears twice in one frame")
    values = parse_numbers(words[1:])
    dof = figure.bones[name].dof
    if len(values) != len(dof):
        raise ValueError(
            f"bone {name!r} has {len(values)} values, but the skeleton needs {len(dof)}"
        )
    frame[name] = values


def _check_complete(content: FileContent, frame: Frame, first: Frame, line: int) -> None:
    """Raise ReadError if a frame is empty or lacks a bone of the first one."""
    missing = [name for name in first if name not in frame]
    if missing or not frame:
        bone = missing[0] if missing else "any bone"
        raise content.error(f"a frame has no values for {bone}", line)


def refuse_asf(content: FileContent, options: ReadOptions) -> Motion:  # noqa: ARG001
    """Raise ReadError: a skeleton alone has no motion."""
    raise content.error("is a skeleton without a motion: give the AMC file that belongs to it")


def write_amc(motion: Motion, path: Path) -> None:
    """Write a motion to an AMC file and its skeleton to an ASF of the same name."""
    values, angle_unit, asf = _fit_asf(motion, path) or _make_asf(motion, path)
    save(path.with_suffix(".asf"), asf)
    # `angle_unit` is the number of radians per unit.
    angle = "RADIANS" if angle_unit == 1.0 else "DEGREES"
    head = f"# fps {motion.fps!r}\n:FULLY-SPECIFIED\n:{angle}\n"
    blocks = [
        [f"{name} {row}" for row in format_table(rows)]
        for name, rows in values.items()
        if rows.size
    ]
    lines = (f"{i}\n{''.join(each)}" for i, each in enumerate(zip(*blocks, strict=True), 1))
    save(path, [head, *lines])


def _fit_asf(motion: Motion, path: Path) -> tuple[dict[str, Floats], float, list[str]] | None:
    """Return the values of each bone, the unit of angles and the text of the motion's own ASF.

    None if there is none, or if it lacks a degree of freedom that the motion needs.
    """
    rig = motion.skeleton.rig
    if rig is None or not rig.asf:
        return None
    figure = read_asf(FileContent(path, rig.asf.encode()))
    turns, translations, *_ = compute_local_pose(motion, path, "an AMC")
    back = rot.conjugate(rig.turn)
    turns = rot.multiply(rot.multiply(back, turns), rig.turn)
    translations = rot.rotate(back, translations) / rig.unit
    expected = np.repeat(figure.skeleton.offsets[None], motion.n_frames, axis=0)
    if motion.skeleton.names == figure.skeleton.names:
        values = _compute_values(figure, turns, translations)
        rotations, slides = _compute_local(values, figure, figure.angle_unit)
        for joint, moved in slides.items():
            expected[:, joint] = moved
        same = np.abs((rotations * turns).sum(axis=2)).min() > 1 - FIT
        if same and rig.unit * np.abs(expected - translations).max() < RIGID:
            return values, figure.angle_unit, [rig.asf]
    warn(f"{path.name}: new ASF, since its own lacks bones or degrees of freedom for this motion")
    return None


def _compute_values(figure: Figure, turns: Floats, translations: Floats) -> dict[str, Floats]:
    """Return the values (frames, dofs) of each bone; inverse of `_compute_local`."""
    values = {}
    for name, bone in figure.bones.items():
        joint, back = figure.skeleton.joint(name), rot.conjugate(bone.frame)
        if name == ROOT:
            local = rot.multiply(turns[:, joint], back)
            shift = translations[:, joint] - bone.position
        else:
            local = rot.multiply(rot.multiply(back, turns[:, joint]), bone.frame)
            shift = rot.rotate(back, translations[:, joint] - figure.skeleton.offsets[joint])
        axes = "".join(dof[1] for dof in bone.dof if dof[0] == "r")[::-1]
        angles = rot.unwrap_euler(rot.to_euler(local, axes)) / figure.angle_unit
        columns = [
            angles[:, axes.index(dof[1])] if dof[0] == "r" else shift[:, "xyz".index(dof[1])]
            for dof in bone.dof
        ]
        values[name] = np.stack(columns, axis=1) if columns else np.empty((len(turns), 0))
    return values


def _make_asf(motion: Motion, path: Path) -> tuple[dict[str, Floats], float, Iterator[str]]:
    """Return the values of each bone, the unit of angles and the text of a new ASF."""
    turns, translations, offsets, slides = compute_local_pose(motion, path, "an AMC")
    skeleton = motion.skeleton
    if sum(parent < 0 for parent in skeleton.parents) != 1:
        raise WriteError(path, "an AMC holds one figure, but this motion has several roots")
    for j in sorted(skeleton.end_sites):
        if slides[j]:
            raise WriteError(path, f"end site {skeleton.names[j]!r} moves on its bone")
    # The frame of a bone is the world rotation of its node at rest; the root has none.
    rig = get_rig(skeleton)
    frames = rot.multiply(rig.turn, rig.world[1][rig.above :])
    frames[0] = rot.IDENTITY
    inverse = rot.conjugate(frames)
    angles = rot.to_euler(rot.multiply(rot.multiply(inverse, turns), frames), "zyx")
    angles = np.degrees(rot.unwrap_euler(angles))
    bones = _list_bones(skeleton, offsets, frames, slides, path)
    # Translations are added to the offsets; the root has no offset.
    shift = rot.rotate(inverse, translations - offsets) / UNIT
    shift[:, 0] = translations[:, 0] / UNIT
    values = {}
    for bone in bones:
        if bone.joint is not None:
            # Reverse the columns z, y, x to `rx ry rz`.
            parts = [shift[:, bone.joint]] * bone.slides + [angles[:, bone.joint, ::-1]]
            values[bone.name] = np.concatenate(parts, axis=1)
    return values, radians(1), _format_asf(bones)


@dataclass
class Bone:
    """A bone to be written; ``joint`` is None for a rigid one."""

    name: str
    parent: str
    tip: Floats
    joint: int | None
    slides: bool = False
    frame: Floats = field(default_factory=rot.IDENTITY.copy)


def _list_bones(
    skeleton: Skeleton, all_offsets: Floats, frames: Floats, slides: NDArray[np.bool_], path: Path
) -> list[Bone]:
    """Return the root and all bones, parents first."""
    joints = [j for j in range(skeleton.n_joints) if j not in skeleton.end_sites]
    words = clean_names(path, [ROOT, *(skeleton.names[j] for j in joints[1:])], _to_word)
    names = dict(zip(joints, words, strict=True))
    bones: list[Bone] = []
    parent_names = {0: ROOT}
    for j in joints:
        offsets = all_offsets[list(skeleton.children[j])].reshape(-1, 3)
        # A bone can carry all children only if they have the same position.
        has_common_tip = j > 0 and len(offsets) > 0 and bool(np.ptp(offsets, axis=0).max() < RIGID)
        tip = offsets[0] if has_common_tip else np.zeros(3)
        parent = "" if j == 0 else parent_names[j]
        has_positions = j == 0 or bool(slides[j])
        bones.append(Bone(names[j], parent, tip, j, slides=has_positions, frame=frames[j]))
        for child, offset in zip(skeleton.children[j], offsets, strict=True):
            parent_names[child] = names[j]
            if not has_common_tip and offset.any():
                parent_names[child] = f"{names[j]}-{_to_word(skeleton.names[child])}"
                bones.append(Bone(parent_names[child], names[j], offset, None))
    return bones


def _format_asf(bones: list[Bone]) -> Iterator[str]:
    """Yield the text of a skeleton file, in degrees and the unit of length of CMU."""
    yield ":version 1.10\n:name kineme\n:units\n  mass 1.0\n  length 0.45\n  angle deg\n"
    yield ":root\n  order TX TY TZ RX RY RZ\n  axis XYZ\n  position 0 0 0\n  orientation 0 0 0\n"
    yield ":bonedata\n"
    for number, bone in enumerate(bones[1:], 1):
        length = float(np.linalg.norm(bone.tip))
        # Other programs normalise the direction, so it must not be 0.
        direction = bone.tip / length if length > 0 else np.array([0.0, 1.0, 0.0])
        yield f"  begin\n    id {number}\n    name {bone.name}\n"
        yield "    direction " + " ".join(f"{x:.12f}" for x in direction) + "\n"
        turns = np.degrees(rot.to_euler(bone.frame, "zyx"))[::-1] + 0.0  # no minus before a zero
        axis = " ".join(f"{angle:.12g}" for angle in turns)
        yield f"    length {length / UNIT:.12f}\n    axis {axis} XYZ\n"
        if bone.joint is not None:
            yield f"    dof {'tx ty tz ' if bone.slides else ''}rx ry rz\n"
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


SKELETON = Format("ASF", (".asf",), lambda _: False, refuse_asf)
FORMAT = Format(
    "AMC", (".amc",), lambda head: _KEYWORD.search(head) is not None, read_amc, write_amc
)
