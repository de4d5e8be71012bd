"""AMC: the motion half of the Acclaim format.

A frame is a line with its number and then a line per bone: its name and a
value for each of its degrees of freedom. With C the bone's frame (its
``axis`` in the ASF) and R the product of its rotations about fixed axes, the
first named first, its rotation to its parent is C R C^-1. The root's angles
act after its preset orientation, its translation adds to its preset position.

Bones may come in any order, and without values where the ASF gives them no
degree of freedom. An AMC names neither its skeleton nor its frame rate: see
`find_skeleton`; 120 Hz, the rate of the CMU database, is assumed.

Source: Acclaim Advanced Technologies, ASF/AMC definition.
"""

from __future__ import annotations

import re
from math import radians
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from kineme import _rotations as rot
from kineme.errors import ReadError
from kineme.formats.files import FileContent, load, numbers
from kineme.formats.options import ReadOptions
from kineme.formats.registry import Format
from kineme.formats.skeletons.amc_writer import write_amc
from kineme.formats.skeletons.asf import ROOT, Figure, read_asf
from kineme.formats.units import BYTES_PER_JOINT, metres, place
from kineme.recordings import Motion

Floats = NDArray[np.float64]

FPS = 120.0
_FPS_COMMENT = re.compile(rb"^# fps ([0-9.e+-]+)\s*$", re.MULTILINE)
_KEYWORD = re.compile(rb"^[ \t]*:(FULLY-SPECIFIED|DEGREES|RADIANS)\b", re.MULTILINE | re.IGNORECASE)
_COMMENT = re.compile(rb"^[ \t]*#.*$", re.MULTILINE)
_FIRST_FRAME = re.compile(rb"^[ \t]*\d+[ \t]*\r?$", re.MULTILINE)


def read_amc(content: FileContent, options: ReadOptions) -> Motion:
    """The motion of an AMC file on the skeleton of its ASF."""
    asf = options.skeleton or find_skeleton(content.path)
    figure = read_asf(load(asf), None if options.unit is None else metres(options.unit))
    start = _FIRST_FRAME.search(content.data)
    if start is None:
        raise content.error("no frame found: an AMC has a line with a number before each")
    head = content.data[: start.start()]
    said = [word.lower() for word in _KEYWORD.findall(head)]
    turn = 1.0 if b"radians" in said else radians(1) if b"degrees" in said else figure.turn
    values = _quickly(content, start.start(), figure) or _line_by_line(
        content, start.start(), figure
    )
    notes = [f"skeleton from {asf}"]
    fps = options.fps or _written_rate(head)
    if fps is None:
        fps = FPS
        notes.append(f"frame rate {FPS:g} Hz assumed: AMC files do not store one")
    n_frames, n_joints = len(next(iter(values.values()))), figure.skeleton.n_joints
    content.claim(BYTES_PER_JOINT * n_joints * n_frames, f"{n_joints} joints in {n_frames} frames")
    return place(
        figure.skeleton,
        *_local(values, figure, turn),
        fps,
        unit="m",
        up=options.up or "y",
        provenance=content.provenance("AMC", notes),
    )


def find_skeleton(path: Path) -> Path:
    """The ASF that belongs to an AMC.

    The one whose name is the AMC's up to the end or up to an underscore, the
    longest first (``86_10.amc``: ``86_10.asf``, ``86.asf``), else the only one
    there is; looked for in the AMC's folder, then in a folder ``asf`` inside
    or beside it.
    """
    parts = path.stem.split("_")
    stems = ["_".join(parts[:n]).lower() for n in range(len(parts), 0, -1)]
    seen: list[Path] = []
    for folder in (path.parent, path.parent / "asf", path.parent.parent / "asf"):
        found = sorted(p for p in folder.glob("*") if p.suffix.lower() == ".asf")
        by_stem = {p.stem.lower(): p for p in found}
        for stem in stems:
            if stem in by_stem:
                return by_stem[stem]
        if len(found) == 1:
            return found[0]
        seen += found
    if not seen:
        raise ReadError(
            path, "no ASF skeleton found beside it: name one with skeleton= (--skeleton)"
        )
    raise ReadError(
        path,
        f"none of the {len(seen)} ASF files beside it has its name: "
        f"name one with skeleton= (--skeleton)",
    )


def _written_rate(head: bytes) -> float | None:
    """The frame rate in the comment that `write_amc` leaves, if it is there."""
    said = _FPS_COMMENT.search(head)
    try:
        return numbers([said.group(1)])[0] if said else None
    except ValueError:
        return None


def _local(values: dict[str, Floats], figure: Figure, turn: float) -> tuple[Floats, Floats]:
    """Rotations (frames, joints, 4) and translations (frames, joints, 3), metres."""
    skeleton = figure.skeleton
    n = len(next(iter(values.values())))
    rotations = np.zeros((skeleton.n_joints, 4, n))
    rotations[:, 0] = 1.0
    translations = np.empty((skeleton.n_joints, 3, n))
    translations[:] = skeleton.offsets[:, :, None]
    for name, bone in figure.bones.items():
        j = skeleton.joint(name)
        turns = [i for i, dof in enumerate(bone.dof) if dof[0] == "r"][::-1]
        axes = "".join(bone.dof[i][1] for i in turns)
        local = rot.from_euler(turn * values[name][:, turns], axes)
        if name == ROOT:
            rotations[j] = rot.multiply(local, bone.frame).T
        else:
            rotations[j] = rot.multiply(
                rot.multiply(bone.frame, local), rot.conjugate(bone.frame)
            ).T
        slides = np.zeros((n, 3))
        for i, dof in enumerate(bone.dof):
            if dof[0] == "t":
                slides[:, "xyz".index(dof[1])] = values[name][:, i]
        if name == ROOT:
            translations[j] = figure.scale * (bone.position + slides).T
        elif slides.any():
            translations[j] += figure.scale * rot.rotate(bone.frame, slides).T
    return rotations.transpose(2, 0, 1), translations.transpose(2, 0, 1)


def _quickly(content: FileContent, start: int, figure: Figure) -> dict[str, Floats] | None:
    """Each bone's values, (frames, dofs), if every frame is laid out as the first, else None."""
    body = content.data[start:]
    words = (_COMMENT.sub(b"", body) if b"#" in body else body).split()
    columns: dict[str, int] = {}
    at = 1
    while at < len(words) and not words[at].isdigit():
        name = words[at].decode("utf-8", "replace")
        if name not in figure.bones or name in columns:
            return None
        columns[name] = at
        at += 1 + len(figure.bones[name].dof)
    period = at
    n, rest = divmod(len(words), period)
    if rest or any(len(figure.bones[name].dof) and name not in columns for name in figure.bones):
        return None
    values = {name: np.zeros((n, len(bone.dof))) for name, bone in figure.bones.items()}
    try:
        if list(map(int, words[::period])) != list(range(int(words[0]), int(words[0]) + n)):
            return None
        for name, at in columns.items():
            if words[at::period].count(words[at]) != n:
                return None
            for i in range(values[name].shape[1]):
                values[name][:, i] = list(map(float, words[at + 1 + i :: period]))
    except ValueError:
        return None
    finite = all(np.isfinite(block).all() for block in values.values())
    return values if finite else None


def _line_by_line(content: FileContent, start: int, figure: Figure) -> dict[str, Floats]:
    """As `_quickly`, for any layout, and with an error that names the line.

    A fault in the very last line, or bones missing from the last frame, is
    what a truncated file looks like: that frame is left out with a warning.
    Anything else that cannot be understood is an error.
    """
    frames: list[dict[str, list[float]]] = []
    first = content.line_at(start)
    lines = content.data[start:].rstrip().splitlines()
    last = first + len(lines) - 1
    began, label = first, 0
    fault: ReadError | None = None
    for number, line in enumerate(lines, first):
        words = line.split()
        if not words or words[0].startswith(b"#"):
            continue
        if len(words) == 1 and words[0].isdigit() and len(words[0]) < 19:
            if frames:
                _check_complete(content, frames, began)
                if int(words[0]) != label + 1:
                    content.warn(f"frame {int(words[0])} follows {label}", number)
            began, label = number, int(words[0])
            frames.append({})
            continue
        try:
            _add_bone(frames[-1], words, figure)
        except ValueError as error:
            fault = content.error(str(error), number)
            if number < last:
                raise fault from None
    try:
        _check_complete(content, frames, began)
    except ReadError as error:
        fault = fault or error
    if fault is not None:
        if len(frames) == 1:
            raise fault
        frames.pop()
        content.warn(f"{fault.reason}: the last frame is truncated and left out", fault.line)
    absent = [n for n, bone in figure.bones.items() if bone.dof and n not in frames[0]]
    if absent:
        content.warn(f"no values for {', '.join(absent)}: taken to be 0")
    return {
        name: np.array([frame.get(name, [0.0] * len(bone.dof)) for frame in frames])
        for name, bone in figure.bones.items()
    }


def _add_bone(frame: dict[str, list[float]], words: list[bytes], figure: Figure) -> None:
    name = words[0].decode("utf-8", "replace")
    if name not in figure.bones:
        raise ValueError(f"bone {name[:40]!r} is not in the skeleton: is it the wrong ASF?")
    if name in frame:
        raise ValueError(f"bone {name!r} stands twice in one frame")
    values = numbers(words[1:])
    dof = figure.bones[name].dof
    if len(values) != len(dof):
        raise ValueError(
            f"bone {name!r} has {len(values)} values, the skeleton asks for {len(dof)}"
        )
    frame[name] = values


def _check_complete(content: FileContent, frames: list[dict[str, list[float]]], line: int) -> None:
    """ReadError if the newest frame is empty or lacks a bone that the first one has."""
    missing = [name for name in frames[0] if name not in frames[-1]]
    if missing or not frames[-1]:
        raise content.error(f"a frame without {missing[0] if missing else 'any bone'}", line)


def _recognises(head: bytes) -> bool:
    return _KEYWORD.search(head) is not None


def refuse_asf(content: FileContent, options: ReadOptions) -> Motion:  # noqa: ARG001
    """Nothing: a skeleton alone does not move."""
    raise content.error("is a skeleton without a motion: give the AMC file that belongs to it")


SKELETON = Format("ASF", (".asf",), lambda _: False, refuse_asf)
FORMAT = Format("AMC", (".amc",), _recognises, read_amc, write_amc)
