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
import warnings
from math import radians
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from kineme import _rotations as rot
from kineme.errors import KinemeWarning, ReadError
from kineme.formats.asf import ROOT, Figure, read_asf
from kineme.formats.files import Source, load, numbers
from kineme.formats.registry import Format, ReadOptions
from kineme.formats.units import metres
from kineme.motion import Motion

Floats = NDArray[np.float64]

FPS = 120.0
_FPS_COMMENT = re.compile(rb"^#\s*fps:?\s+([0-9.eE+-]+)\s*$", re.MULTILINE)
_COMMENT = re.compile(rb"^[ \t]*#.*$", re.MULTILINE)
_FIRST_FRAME = re.compile(rb"^[ \t]*\d+[ \t]*\r?$", re.MULTILINE)


def read_amc(source: Source, options: ReadOptions) -> Motion:
    """The motion of an AMC file on the skeleton of its ASF."""
    asf = options.skeleton or find_skeleton(source.path)
    figure = read_asf(load(asf), None if options.unit is None else metres(options.unit))
    start = _FIRST_FRAME.search(source.data)
    if start is None:
        raise source.error("no frame found: an AMC has a line with a number before each")
    head = source.data[: start.start()]
    turn = figure.turn
    if re.search(rb"^\s*:RADIANS", head, re.MULTILINE | re.IGNORECASE):
        turn = 1.0
    elif re.search(rb"^\s*:DEGREES", head, re.MULTILINE | re.IGNORECASE):
        turn = radians(1)
    values = _quickly(source, start.start(), figure) or _line_by_line(
        source, start.start(), figure
    )
    rotations, translations = _local(values, figure, turn)
    notes = [f"skeleton from {asf}"]
    fps = options.fps
    if fps is None:
        fps = FPS
        notes.append(f"frame rate {FPS:g} Hz assumed: AMC files do not store one")
    return Motion.from_rotations(
        figure.skeleton,
        rotations,
        fps,
        translations=translations,
        provenance=source.provenance("AMC", notes),
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
        raise ReadError(path, "no ASF skeleton found beside it: name one with skeleton=")
    raise ReadError(
        path, f"none of the {len(seen)} ASF files beside it has its name: name one with skeleton="
    )


def _local(values: dict[str, Floats], figure: Figure, turn: float) -> tuple[Floats, Floats | None]:
    """Rotations (frames, joints, 4) and translations, or None where only the root slides."""
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
            rotations[j] = rot.multiply(rot.multiply(bone.frame, local), rot.conjugate(bone.frame)).T
        slides = np.zeros((n, 3))
        for i, dof in enumerate(bone.dof):
            if dof[0] == "t":
                slides[:, "xyz".index(dof[1])] = values[name][:, i]
        if name == ROOT:
            translations[j] = figure.scale * (bone.position + slides).T
        elif slides.any():
            translations[j] += figure.scale * rot.rotate(bone.frame, slides).T
    return rotations.transpose(2, 0, 1), translations.transpose(2, 0, 1)


def _quickly(source: Source, start: int, figure: Figure) -> dict[str, Floats] | None:
    """Each bone's values, (frames, dofs), if every frame is laid out as the first, else None."""
    body = source.data[start:]
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


def _line_by_line(source: Source, start: int, figure: Figure) -> dict[str, Floats]:
    """As `_quickly`, for any layout, and with an error that names the line.

    A fault in the very last line, or bones missing from the last frame, is
    what a truncated file looks like: that frame is left out with a warning.
    Anything else that cannot be understood is an error.
    """
    frames: list[dict[str, list[float]]] = []
    lines = source.data[start:].splitlines()
    while lines and not lines[-1].strip():
        lines.pop()
    first = source.data.count(b"\n", 0, start) + 1
    cut = None
    began = count = first
    for count, line in enumerate(lines, first):
        words = line.split()
        if not words or words[0].startswith(b"#"):
            continue
        if len(words) == 1 and words[0].isdigit():
            if frames:
                _check_complete(source, frames, began, figure)
            frames.append({})
            began = count
            continue
        try:
            _add_bone(frames[-1], words, figure)
        except ValueError as error:
            if count < first + len(lines) - 1:
                raise source.error(str(error), count) from None
            cut = str(error)
    if cut is None:
        try:
            _check_complete(source, frames, began, figure)
        except ReadError as error:
            cut = error.reason
    if cut is not None:
        frames.pop()
        if not frames:
            raise source.error(f"{cut}, in the only frame there is", count)
        warnings.warn(
            f"{source.path}: the last frame is truncated ({cut}); the {len(frames)} whole "
            "frames before it are kept",
            KinemeWarning,
            stacklevel=5,
        )
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
        raise ValueError(f"bone {name!r} has {len(values)} values, the skeleton asks for {len(dof)}")
    frame[name] = values


def _check_complete(
    source: Source, frames: list[dict[str, list[float]]], line: int, figure: Figure
) -> None:
    """ReadError if the newest frame lacks a bone that the first frame has.

    A bone absent from the first frame is absent everywhere, and at rest.
    """
    missing = [name for name in frames[0] if name not in frames[-1]]
    if missing or not frames[-1]:
        what = f"bone {missing[0]!r}" if missing else "all bones"
        raise source.error(f"a frame without {what}", line)


def _recognises(head: bytes) -> bool:
    return re.search(rb"^\s*:(FULLY-SPECIFIED|DEGREES|RADIANS)", head, re.M | re.I) is not None


FORMAT = Format("AMC", (".amc",), _recognises, read_amc)
