"""USD: skeletons and their animations (UsdSkel) in ``.usda``, ``.usdc`` and ``.usd``.

What is read is one skeleton and one of the animations that fit it: the one bound to it first, then
others that move joints of its. Unit and up axis are the stage's, and so is the rate: the time codes
in a second, over those between two samples. Between samples USD itself interpolates, which is what
``fps=`` asks it for. Joints that the animation does not move are as at rest. Needs ``usd-core``.

The file is read in a process of its own: the library can crash, hang or print on damaged files.

Source: Pixar, "UsdSkel: schemas and API", OpenUSD documentation.
"""

from __future__ import annotations

import os
import pickle
import re
import subprocess
import sys
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from kineme._util import rotations as rot
from kineme._util.arrays import Floats
from kineme._util.checks import make_unique, require_extra
from kineme._util.files import translate_read_errors
from kineme._util.rotations import from_matrices
from kineme.errors import KinemeError, ReadError
from kineme.formats.files import FileContent, load
from kineme.formats.options import ReadOptions
from kineme.formats.registry import Format
from kineme.formats.scenes.assembly import (
    Transform,
    assemble,
    orthogonalize,
    require_frame_memory,
)
from kineme.formats.scenes.characters import SceneNode, choose_take, find_character, is_end
from kineme.formats.scenes.usd_layers import LONGEST, SUFFIXES, open_stage
from kineme.formats.scenes.usd_writer import END_SITES, write_usd
from kineme.formats.units import make_up_rotation
from kineme.recordings import Motion, Note

CENTIMETRE = 0.01
"""Metres: the unit of stages that tell none."""

HEADS = (b"#usda ", b"PXR-USDC")
_EVEN = 0.02  # share of their median by which steps between samples may differ from it
_ROUNDED = 0.1  # of a frame, by which the last sample may miss it
_MOST_FRAMES = 1e12

_PROGRAM = """
import pickle, sys
sys.path[:] = pickle.load(sys.stdin.buffer)
from kineme.formats.scenes.usd import serve
serve()
"""
# Threads would take memory before anything is read.
_SINGLE_THREADED = {"PXR_WORK_THREAD_LIMIT": "1", "OPENBLAS_NUM_THREADS": "1"}
_MESSAGE = re.compile(r"^Warning: in .* -- (.*)", re.MULTILINE)


def read_usd(content: FileContent, options: ReadOptions) -> Motion:
    """Read the motion of a skeleton in a USD file."""
    with require_extra("usd-core", "usd"):
        import pxr  # noqa: F401
    request = pickle.dumps(sys.path) + pickle.dumps((content.path, options))
    try:
        done = subprocess.run(  # noqa: S603
            [sys.executable, "-I", "-c", _PROGRAM],
            input=request,
            capture_output=True,
            timeout=LONGEST,
            env=os.environ | _SINGLE_THREADED,
            check=False,
        )
    except subprocess.TimeoutExpired:
        raise content.error(
            f"takes the USD library more than {LONGEST:.0f} s: flatten it"
        ) from None
    if done.returncode:
        raise content.error(
            "the USD library crashed or ran out of memory on it: it is damaged, or nested too deep"
        )
    found = pickle.loads(done.stdout)  # noqa: S301 (written by `serve`)
    complaints = _summarize_warnings(done.stderr)
    if isinstance(found, Motion):
        return replace(found, provenance=found.provenance.noted(*complaints))
    if type(found) is ReadError:
        found = content.error("; ".join([found.reason, *complaints]))
    raise found


def serve() -> None:
    """Answer `read_usd`, from standard input to standard output: a motion or an error."""
    # The answer goes to the real standard output, and what the library prints to standard error.
    answer = os.fdopen(os.dup(1), "wb")
    os.dup2(2, 1)  # what the library prints
    path, options = pickle.load(sys.stdin.buffer)  # noqa: S301 (written by `read_usd`)
    with answer:
        pickle.dump(_try_read(path, options), answer)


def _try_read(path: Path, options: ReadOptions) -> Motion | KinemeError:
    from pxr import Tf

    try:
        with translate_read_errors(path):
            content = load(path)
            try:
                return _read(content, options)
            except Tf.ErrorException as error:
                raise content.error("is no whole USD file: truncated or damaged") from error
            except ReadError as error:
                if content.remarks and type(error) is ReadError:  # none that lists people
                    raise content.error("; ".join([error.reason, *content.remarks])) from error
                raise
    except KinemeError as error:
        return error


def _summarize_warnings(printed: bytes) -> list[Note]:
    """Return what the library printed as one warning: its first message, and how many others."""
    texts = dict.fromkeys(_MESSAGE.findall(printed.decode(errors="replace")))
    if not texts:
        return []
    first = "".join(letter for letter in next(iter(texts)) if letter.isprintable())
    more = f", and {len(texts) - 1} more" if len(texts) > 1 else ""
    return [Note(f"the USD library warns: {first:.160}{more}", "warning")]


def _read(content: FileContent, options: ReadOptions) -> Motion:
    from pxr import UsdGeom, UsdSkel

    stage, beside = open_stage(content)
    skeletons = [_Skeleton(prim) for prim in stage.Traverse() if prim.IsA(UsdSkel.Skeleton)]
    nodes, homes = _list_nodes(skeletons)
    character = find_character(content, nodes, options.person)
    skeleton, first = homes[character.joints[0]]
    animations = [
        UsdSkel.Animation(prim) for prim in stage.Traverse() if prim.IsA(UsdSkel.Animation)
    ]
    fitting = skeleton.fitting(animations)
    names = make_unique(each.GetPrim().GetName() for each in fitting)
    number, notes = choose_take(content, names, range(len(fitting)), options.take)
    fps, codes, rated = _find_frames(content, stage, fitting[number], len(nodes), options, beside)
    pose = skeleton.pose(fitting[number], codes)
    up = options.up or ("z" if UsdGeom.GetStageUpAxis(stage) == UsdGeom.Tokens.z else "y")
    carrier, still = (
        _sample_carrier(UsdGeom.Xformable(skeleton.prim), at) for at in (codes, codes[:1])
    )
    return assemble(
        content,
        nodes,
        character.joints,
        lambda node: carrier if node < first else pose[node - first],
        lambda node: still if node < first else skeleton.rest_pose[node - first],
        len(codes),
        fps,
        unit=options.unit or max(UsdGeom.GetStageMetersPerUnit(stage), 0.0) or CENTIMETRE,
        turn=make_up_rotation(up),
        provenance=content.provenance("USD", [*notes, *character.notes, *rated])
        .of_take(names[number], names)
        .of_person(character.name, character.people),
    )


class _Skeleton:
    """A skeleton of a stage."""

    def __init__(self, prim: Any) -> None:
        from pxr import UsdSkel

        self.prim = prim
        schema = UsdSkel.Skeleton(prim)
        self.joints = list(map(str, schema.GetJointsAttr().Get() or ()))
        given = list(map(str, schema.GetJointNamesAttr().Get() or ()))
        usual = [joint.rpartition("/")[2] for joint in self.joints]
        self.names = given if len(given) == len(usual) else usual
        self.parents = list(UsdSkel.Topology(self.joints).GetParentIndices())
        self.ends = prim.GetCustomDataByKey(END_SITES)
        self.bound = UsdSkel.BindingAPI(prim).GetInheritedAnimationSource()
        rest = schema.GetRestTransformsAttr().Get()
        complete = rest is not None and len(rest) == len(self.joints)
        self.rest = (
            np.array(rest, np.float64) if complete else np.tile(np.eye(4), (len(usual), 1, 1))
        )
        found = (_to_transform(matrix[None]) for matrix in self.rest)
        self.rest_pose = [Transform(*(part[0] for part in each[:3])) for each in found]

    def is_end(self, j: int) -> bool:
        if self.ends is not None:
            return self.names[j] in list(self.ends)
        return is_end(self.names[j])

    def fitting(self, animations: Sequence[Any]) -> list[Any]:
        """Return the animations that move joints of it, the one bound to it first."""
        joints = set(self.joints)
        found = [each for each in animations if joints & set(map(str, _list_joints(each)))]
        # False sorts before True: the bound animation first; the others keep their order.
        return sorted(found, key=lambda each: each.GetPrim() != self.bound)

    def pose(self, animation: Any, codes: Floats) -> list[Transform]:
        """Return the transform of each joint at these time codes."""
        moved = list(map(str, _list_joints(animation)))
        places = {joint: number for number, joint in enumerate(moved)}
        shifts = _sample_values(animation.GetTranslationsAttr(), codes, len(moved), 3)
        turns = _sample_values(animation.GetRotationsAttr(), codes, len(moved), 4)
        scales = _sample_values(animation.GetScalesAttr(), codes, len(moved), 3)
        found = []
        for joint, rest in zip(self.joints, self.rest_pose, strict=True):
            shift, turn, scale = rest[:3]
            if (at := places.get(joint)) is not None:
                shift = shift if shifts is None else shifts[:, at]
                # Parts that the animation does not have are as at rest.
                turn = turn if turns is None else rot.normalize(turns[:, at])
                scale = scale if scales is None else scales[:, at]
            found.append(Transform(shift, turn, scale))
        return found


def _list_nodes(
    skeletons: Sequence[_Skeleton],
) -> tuple[list[SceneNode], dict[int, tuple[_Skeleton, int]]]:
    """Return all skeletons as nodes, each below what carries it; for each node whose it is.

    That is its skeleton, and the node of its first joint.
    """
    nodes: list[SceneNode] = []
    homes: dict[int, tuple[_Skeleton, int]] = {}
    for skeleton in skeletons:
        carrier = len(nodes)
        name = skeleton.prim.GetParent().GetName() or skeleton.prim.GetName()
        nodes.append(SceneNode(name, -1, bone=False, geometry=False, animated=False))
        for j, (joint, parent) in enumerate(zip(skeleton.names, skeleton.parents, strict=True)):
            homes[len(nodes)] = skeleton, carrier + 1
            # Joints without a parent hang on the carrier; others are counted from the first joint.
            place = carrier if parent < 0 else carrier + 1 + parent
            bound = bool(skeleton.bound)
            nodes.append(SceneNode(joint, place, True, False, bound, skeleton.is_end(j)))
    return nodes, homes


def _find_frames(
    content: FileContent, stage: Any, animation: Any, joints: int, options: ReadOptions, beside: int
) -> tuple[float, Floats, list[str]]:
    """Frames per second, the time code of each frame, and what to say of them."""
    attributes = (
        animation.GetTranslationsAttr(), animation.GetRotationsAttr(), animation.GetScalesAttr(),
    )  # fmt: skip
    # The property with most samples tells when these are.
    samples = max((each.GetTimeSamples() for each in attributes), key=len)
    a_second = stage.GetTimeCodesPerSecond()
    times = np.array(samples or [0.0], np.float64)
    steps = np.diff(times)
    # Time codes between two samples.
    usual = float(np.median(steps)) if len(steps) else 1.0
    notes: list[str] = []
    if options.fps is not None:
        fps = options.fps
        notes.append(f"sampled {fps:g} times a second, as asked for")
    elif len(steps) and np.abs(steps / usual - 1).max() > _EVEN:
        fps = a_second
        remark = f"its samples are not evenly spaced: one for each time code, {fps:g} Hz"
        notes.append(Note(remark, "warning"))
    else:
        fps = a_second / usual
    if not (np.isfinite(times).all() and 0 < fps < np.inf and a_second > 0):
        raise content.error("tells no time that could be: give fps= (--fps)")
    step = a_second / fps
    count = min((times[-1] - times[0]) / step + 1 + _ROUNDED, _MOST_FRAMES)
    require_frame_memory(content, joints, int(count), beside=beside)
    return fps, times[0] + step * np.arange(int(count)), notes


def _list_joints(animation: Any) -> Sequence[Any]:
    return animation.GetJointsAttr().Get() or ()


def _sample_values(attribute: Any, codes: Floats, joints: int, width: int) -> Floats | None:
    """(frames, joints, width) at these time codes; None where there are none, or not so many."""
    first = attribute.Get(codes[0])
    if first is None or len(first) != joints:
        return None
    values = np.empty((len(codes), joints, width))
    for frame, code in enumerate(codes.tolist()):
        found = attribute.Get(code)
        if found is None or len(found) != joints:
            return None
        values[frame] = np.asarray(found)
    # NumPy views of USD's quaternions have w last.
    return np.roll(values, 1, axis=-1) if width == 4 else values


def _sample_carrier(xformable: Any, codes: Floats) -> Transform:
    """Return what carries a skeleton, in the world."""
    matrices = np.array([xformable.ComputeLocalToWorldTransform(code) for code in codes.tolist()])
    same = np.abs(matrices - matrices[0]).max() == 0
    found = _to_transform(matrices[:1] if same else matrices)
    shift, turn, scale = (part[0] if same else part for part in found[:3])
    return Transform(shift, turn, scale)


def _to_transform(matrices: Floats) -> Transform:
    """Of matrices (frames, 4, 4) that multiply rows, as USD's do."""
    # Rows become columns, as all other code has them.
    axes = matrices[:, :3, :3].transpose(0, 2, 1)
    scale = np.linalg.norm(axes, axis=1)
    # A reflection: it belongs to the scale, so that the axes are a rotation.
    scale = np.where(np.linalg.det(axes)[:, None] < 0, -scale, scale)
    turns = from_matrices(orthogonalize(axes / np.where(scale == 0, 1, scale)[:, None, :]))
    return Transform(matrices[:, 3, :3], turns, scale)


FORMAT = Format(
    "USD",
    SUFFIXES,
    lambda head: head.startswith(HEADS),
    read_usd,
    write_usd,
)
