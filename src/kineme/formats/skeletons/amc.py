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
from kineme.formats.skeletons.amc_frames import read_frames
from kineme.formats.skeletons.amc_writer import write_amc
from kineme.formats.skeletons.asf import Figure, read_asf
from kineme.formats.skeletons.asf_bones import ROOT
from kineme.formats.skeletons.placing import BYTES_PER_JOINT, place
from kineme.formats.units import blocks, metres
from kineme.recordings import Motion

Floats = NDArray[np.float64]

FPS = 120.0
_FPS_COMMENT = re.compile(rb"^# fps ([0-9.e+-]+)\s*$", re.MULTILINE)
_KEYWORD = re.compile(rb"^[ \t]*:(FULLY-SPECIFIED|DEGREES|RADIANS)\b", re.MULTILINE | re.IGNORECASE)
_FIRST_FRAME = re.compile(rb"^[ \t]*\d+[ \t]*\r?$", re.MULTILINE)


def read_amc(content: FileContent, options: ReadOptions) -> Motion:
    """The motion of an AMC file on the skeleton of its ASF."""
    asf = options.skeleton or find_skeleton(content.path)
    figure = read_asf(load(asf), None if options.unit is None else metres(options.unit))
    head = _head(content)
    said = [word.lower() for word in _KEYWORD.findall(head)]
    turn = 1.0 if b"radians" in said else radians(1) if b"degrees" in said else figure.turn
    values = read_frames(content, len(head), figure)
    notes = [f"skeleton from {asf}"]
    fps = options.fps or _written_rate(head)
    if fps is None:
        fps = FPS
        notes.append(f"frame rate {FPS:g} Hz assumed: AMC files do not store one")
    n_frames, n_joints = len(next(iter(values.values()))), figure.skeleton.n_joints
    content.claim(BYTES_PER_JOINT * n_joints * n_frames, f"{n_joints} joints in {n_frames} frames")
    provenance = content.provenance("AMC", notes)
    content.let_go()
    rotations, slides = _local(values, figure, turn)
    del values  # before as much again is made of it
    return place(
        figure.skeleton,
        rotations,
        slides,
        fps,
        unit="m",
        up=options.up or "y",
        provenance=provenance,
    )


def _head(content: FileContent) -> bytes:
    """What stands before the first frame."""
    start = _FIRST_FRAME.search(content.data)
    if start is None:
        raise content.error("no frame found: an AMC has a line with a number before each")
    return content.data[: start.start()]


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


def _local(
    values: dict[str, Floats], figure: Figure, turn: float
) -> tuple[Floats, dict[int, Floats]]:
    """Rotations (frames, joints, 4); where joints slide, (frames, 3) each, metres."""
    skeleton = figure.skeleton
    n = len(next(iter(values.values())))
    rotations = np.empty((n, skeleton.n_joints, 4))
    for span in blocks(n):
        turned = np.zeros((skeleton.n_joints, 4, span.stop - span.start))
        turned[:, 0] = 1.0
        for name, bone in figure.bones.items():
            turns = [i for i, dof in enumerate(bone.dof) if dof[0] == "r"][::-1]
            axes = "".join(bone.dof[i][1] for i in turns)
            local = rot.from_euler(turn * values[name][span][:, turns], axes)
            if name == ROOT:
                local = rot.multiply(local, bone.frame)
            else:
                local = rot.multiply(rot.multiply(bone.frame, local), rot.conjugate(bone.frame))
            turned[skeleton.joint(name)] = local.T
        rotations[span] = turned.transpose(2, 0, 1)
    slides = {}
    for name, bone in figure.bones.items():
        slid = np.zeros((n, 3))
        for i, dof in enumerate(bone.dof):
            if dof[0] == "t":
                slid[:, "xyz".index(dof[1])] = values[name][:, i]
        j = skeleton.joint(name)
        if name == ROOT:
            slides[j] = figure.scale * (bone.position + slid)
        elif slid.any():
            slides[j] = skeleton.offsets[j] + figure.scale * rot.rotate(bone.frame, slid)
    return rotations, slides


def _recognises(head: bytes) -> bool:
    return _KEYWORD.search(head) is not None


def refuse_asf(content: FileContent, options: ReadOptions) -> Motion:  # noqa: ARG001
    """Nothing: a skeleton alone does not move."""
    raise content.error("is a skeleton without a motion: give the AMC file that belongs to it")


SKELETON = Format("ASF", (".asf",), lambda _: False, refuse_asf)
FORMAT = Format("AMC", (".amc",), _recognises, read_amc, write_amc)
