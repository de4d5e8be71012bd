"""Read and write USD: skeletons and their animations (UsdSkel).

One skeleton and one of its animations are read, by default the one bound to it, else one that moves
its joints. Unit, up axis and rate are the stage's; the rate is time codes per second divided by the
time codes between samples. USD interpolates between samples, also for ``fps=``. Joints that the
animation does not move are at rest. Needs ``usd-core``.

The file is read in a separate process, since the library may crash, hang or print on damaged files.
A layer includes others by sublayers, references and payloads. Only files in the folder of the main
file are allowed. References to prims with references multiply, so their number is checked before a
stage is composed.

Written lengths are metres, y is up. A time code is a frame, and time codes per second are the frame
rate. The rest pose is that of the motion's rig. ``jointNames`` hold the original names; in paths
they are reduced to letters, digits and ``_``. The custom data of the skeleton list the end sites.

Source: Pixar, "UsdSkel: schemas and API", OpenUSD documentation.
"""

from __future__ import annotations

import os
import pickle
import re
import subprocess
import sys
from collections.abc import Sequence
from contextlib import suppress
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from kineme._util import rotations as rot
from kineme._util.arrays import Floats
from kineme._util.checks import make_unique, require_extra
from kineme._util.files import atomic_write, translate_read_errors
from kineme.errors import KinemeError, ReadError, WriteError
from kineme.formats.files import (
    MAX_EXPANSION,
    FileContent,
    clean_names,
    find_sibling,
    load,
    require_rotations,
)
from kineme.formats.options import ReadOptions
from kineme.formats.plausibility import warn_of_gaps
from kineme.formats.registry import Format
from kineme.formats.scenes.assembly import (
    Transform,
    assemble,
    compose,
    count_frames,
    decompose,
    find_rate,
    is_even,
)
from kineme.formats.scenes.characters import SceneNode, choose_take, find_character, is_end
from kineme.formats.units import make_up_rotation
from kineme.recordings import Motion, Note
from kineme.recordings.posing import get_rig, pose_rig

END_SITES = "kineme:endSites"
"""Key of the names of end sites in the custom data of a skeleton."""
SUFFIXES = (".usda", ".usdc", ".usd")
HEADS = (b"#usda ", b"PXR-USDC")
CENTIMETRE = 0.01
"""Metres: the default unit of stages."""
MAX_REFERENCES = 100_000
"""Maximum number of prims included by references; this many take a second and 200 MB."""
MAX_SUBLAYERS = 1000
MIN_STAGE_MEMORY = 1 << 30
"""Bytes of memory that composing any stage may use."""
TIMEOUT_S = 300.0
"""Seconds that reading a file may take."""

_ROUNDED = 0.1  # frames by which the last sample may miss its frame
_PROGRAM = """
import pickle, sys
sys.path[:] = pickle.load(sys.stdin.buffer)
from kineme.formats.scenes.usd import serve
serve()
"""
# Threads would use memory before anything is read.
_SINGLE_THREADED = {"PXR_WORK_THREAD_LIMIT": "1", "OPENBLAS_NUM_THREADS": "1"}
_MESSAGE = re.compile(r"^Warning: in .* -- (.*)", re.MULTILINE)


def read_usd(content: FileContent, options: ReadOptions) -> Motion:
    """Return the motion of a skeleton in a USD file."""
    with require_extra("usd-core", "usd"):
        import pxr  # noqa: F401
    request = pickle.dumps(sys.path) + pickle.dumps((content.path, options))
    try:
        process = subprocess.run(  # noqa: S603
            [sys.executable, "-I", "-c", _PROGRAM],
            input=request,
            capture_output=True,
            timeout=TIMEOUT_S,
            env=os.environ | _SINGLE_THREADED,
            check=False,
        )
    except subprocess.TimeoutExpired:
        raise content.error(
            f"was not read by the USD library within {TIMEOUT_S:.0f} s: flatten it"
        ) from None
    if process.returncode:
        raise content.error(
            "the USD library crashed or ran out of memory on it: it is damaged, or nested too deep"
        )
    answer = pickle.loads(process.stdout)  # noqa: S301 (written by `serve`)
    warnings = _summarize_warnings(process.stderr)
    if isinstance(answer, Motion):
        return replace(answer, provenance=answer.provenance.noted(*warnings))
    if type(answer) is ReadError:
        answer = content.error("; ".join([answer.reason, *warnings]))
    raise answer


def serve() -> None:
    """Answer a request of `read_usd` from standard input with a motion or an error."""
    # Send the answer to standard output, and everything the library prints to standard error.
    answer = os.fdopen(os.dup(1), "wb")
    os.dup2(2, 1)
    path, options = pickle.load(sys.stdin.buffer)  # noqa: S301 (written by `read_usd`)
    with answer:
        pickle.dump(_try_read(path, options), answer)


def _try_read(path: Path, options: ReadOptions) -> Motion | KinemeError:
    """Return the motion, or the error of reading it."""
    from pxr import Tf

    try:
        with translate_read_errors(path):
            content = load(path)
            try:
                return _read(content, options)
            except Tf.ErrorException as error:
                raise content.error("is not a complete USD file: truncated or damaged") from error
            except ReadError as error:
                if content.remarks and type(error) is ReadError:  # not SeveralPeopleError
                    raise content.error("; ".join([error.reason, *content.remarks])) from error
                raise
    except KinemeError as error:
        return error


def _summarize_warnings(printed: bytes) -> list[Note]:
    """Return a warning with the first message of the library, and the number of others."""
    texts = dict.fromkeys(_MESSAGE.findall(printed.decode(errors="replace")))
    if not texts:
        return []
    first = "".join(letter for letter in next(iter(texts)) if letter.isprintable())
    more = f", and {len(texts) - 1} more" if len(texts) > 1 else ""
    return [Note(f"the USD library warns: {first:.160}{more}", "warning")]


def _read(content: FileContent, options: ReadOptions) -> Motion:
    """Return the motion of a character in a stage, in one of its animations."""
    from pxr import UsdGeom, UsdSkel

    stage, size_of_layers = open_stage(content)
    skeletons = [_Skeleton(prim) for prim in stage.Traverse() if prim.IsA(UsdSkel.Skeleton)]
    nodes = _list_nodes(skeletons)
    character = find_character(content, nodes, options.person)
    # The joints of a skeleton follow its carrier.
    skeleton = [each for each in skeletons if each.carrier < character.joints[0]][-1]
    animations = [
        UsdSkel.Animation(prim) for prim in stage.Traverse() if prim.IsA(UsdSkel.Animation)
    ]
    candidates = skeleton.find_animations(animations)
    names = make_unique(candidate.GetPrim().GetName() for candidate in candidates)
    number, notes = choose_take(content, names, range(len(candidates)), options.take)
    fps, codes, rate_notes = _find_frames(
        content, stage, candidates[number], len(nodes), options, size_of_layers
    )
    carrier = UsdGeom.Xformable(skeleton.prim)
    pose = [_sample_carrier(carrier, codes), *skeleton.sample_pose(candidates[number], codes)]
    rest = [_sample_carrier(carrier, codes[:1]), *skeleton.rest_pose]
    up = options.up or ("z" if UsdGeom.GetStageUpAxis(stage) == UsdGeom.Tokens.z else "y")
    return assemble(
        content,
        nodes,
        character.joints,
        lambda node: pose[node - skeleton.carrier],
        lambda node: rest[node - skeleton.carrier],
        len(codes),
        fps,
        unit=options.unit or max(UsdGeom.GetStageMetersPerUnit(stage), 0.0) or CENTIMETRE,
        turn=make_up_rotation(up),
        provenance=content.provenance("USD", [*notes, *character.notes, *rate_notes])
        .of_take(names[number], names)
        .of_person(character.name, character.people),
    )


class _Skeleton:
    """A skeleton of a stage; ``carrier`` is the number of the node above its joints."""

    def __init__(self, prim: Any) -> None:
        from pxr import UsdSkel

        self.prim, self.carrier = prim, 0
        schema = UsdSkel.Skeleton(prim)
        self.joints = _list_joints(schema)
        joint_names = list(map(str, schema.GetJointNamesAttr().Get() or ()))
        default_names = [joint.rpartition("/")[2] for joint in self.joints]
        self.names = joint_names if len(joint_names) == len(default_names) else default_names
        self.parents = list(UsdSkel.Topology(self.joints).GetParentIndices())
        self.ends = prim.GetCustomDataByKey(END_SITES)
        self.bound = UsdSkel.BindingAPI(prim).GetInheritedAnimationSource()
        rest = schema.GetRestTransformsAttr().Get()
        is_complete = rest is not None and len(rest) == len(self.joints)
        matrices = np.array(rest, np.float64) if is_complete else [np.eye(4)] * len(self.joints)
        self.rest_pose = [decompose(matrix.T) for matrix in matrices]  # USD has row vectors

    def is_end(self, j: int) -> bool:
        if self.ends is not None:
            return self.names[j] in list(self.ends)
        return is_end(self.names[j])

    def find_animations(self, animations: Sequence[Any]) -> list[Any]:
        """Return the animations that move joints of it, the one bound to it first."""
        joints = set(self.joints)
        matching = [each for each in animations if joints.intersection(_list_joints(each))]
        # False sorts before True: the bound animation comes first.
        return sorted(matching, key=lambda each: each.GetPrim() != self.bound)

    def sample_pose(self, animation: Any, codes: Floats) -> list[Transform]:
        """Return the transform of each joint at these time codes."""
        animated = _list_joints(animation)
        columns = {joint: number for number, joint in enumerate(animated)}
        shifts = _sample_values(animation.GetTranslationsAttr(), codes, len(animated), 3)
        turns = _sample_values(animation.GetRotationsAttr(), codes, len(animated), 4)
        scales = _sample_values(animation.GetScalesAttr(), codes, len(animated), 3)
        transforms = []
        for joint, rest in zip(self.joints, self.rest_pose, strict=True):
            shift, turn, scale = rest[:3]
            if (column := columns.get(joint)) is not None:
                shift = shift if shifts is None else shifts[:, column]
                # Missing parts of the animation are at rest.
                turn = turn if turns is None else rot.normalize(turns[:, column])
                scale = scale if scales is None else scales[:, column]
            transforms.append(Transform(shift, turn, scale))
        return transforms


def _list_nodes(skeletons: Sequence[_Skeleton]) -> list[SceneNode]:
    """Return all skeletons as nodes: a carrier, followed by the joints."""
    nodes: list[SceneNode] = []
    for skeleton in skeletons:
        skeleton.carrier = len(nodes)
        name = skeleton.prim.GetParent().GetName() or skeleton.prim.GetName()
        nodes.append(SceneNode(name, -1))
        for j, (joint, parent) in enumerate(zip(skeleton.names, skeleton.parents, strict=True)):
            # Parents are relative to the first joint; -1 is the carrier.
            above, end = skeleton.carrier + 1 + parent, skeleton.is_end(j)
            is_bound = bool(skeleton.bound)
            nodes.append(SceneNode(joint, above, bone=True, animated=is_bound, end=end))
    return nodes


def _find_frames(
    content: FileContent,
    stage: Any,
    animation: Any,
    joints: int,
    options: ReadOptions,
    external_size: int,
) -> tuple[float, Floats, list[Note | str]]:
    """Return frames per second, the time code of each frame, and notes."""
    attributes = (
        animation.GetTranslationsAttr(), animation.GetRotationsAttr(), animation.GetScalesAttr(),
    )  # fmt: skip
    # Use the times of the property with most samples.
    samples = max((each.GetTimeSamples() for each in attributes), key=len)
    codes_per_second = stage.GetTimeCodesPerSecond()
    times = np.array(samples or [0.0], np.float64)
    if not (np.isfinite(times).all() and 0 < codes_per_second < np.inf):
        raise content.error("states no valid frame rate: give fps= (--fps)")
    even = is_even(times)
    step = float(np.median(np.diff(times))) if even and len(times) > 1 else 1.0
    fps, notes = find_rate(options.fps, codes_per_second / step, times / codes_per_second)
    if options.fps is None and not even:
        remark = f"its samples are not evenly spaced: one is read per time code, {fps:g} Hz"
        notes = [Note(remark, "warning")]
    step = codes_per_second / fps
    count = (times[-1] - times[0]) / step + 1 + _ROUNDED
    n_frames = count_frames(content, joints, count, external_size=external_size)
    return fps, times[0] + step * np.arange(n_frames), notes


def _list_joints(schema: Any) -> list[str]:
    return list(map(str, schema.GetJointsAttr().Get() or ()))


def _sample_values(attribute: Any, codes: Floats, joints: int, width: int) -> Floats | None:
    """Return values (frames, joints, width) at these time codes, None if they do not fit."""
    first = attribute.Get(codes[0])
    if first is None or len(first) != joints:
        return None
    values = np.empty((len(codes), joints, width))
    for frame, code in enumerate(codes.tolist()):
        sample = attribute.Get(code)
        if sample is None or len(sample) != joints:
            return None
        values[frame] = np.asarray(sample)
    # USD's quaternions have w last in NumPy views.
    return np.roll(values, 1, axis=-1) if width == 4 else values


def _sample_carrier(xformable: Any, codes: Floats) -> Transform:
    """Return the world transform of a skeleton's prim."""
    matrices = np.array([xformable.ComputeLocalToWorldTransform(code) for code in codes.tolist()])
    is_constant = np.abs(matrices - matrices[0]).max() == 0
    return decompose(matrices[0].T if is_constant else matrices.transpose(0, 2, 1))


def open_stage(content: FileContent) -> tuple[Any, int]:
    """Open the stage of a file; return it and the size in bytes of the other layers.

    Raise ReadError if it includes a file outside its folder, or too much.
    """
    from pxr import Usd

    layers, other_size = _load_layers(content)
    _check_sublayers(content, layers)
    _check_growth(content, layers[0])
    return Usd.Stage.Open(layers[0]), other_size


def _load_layers(content: FileContent) -> tuple[list[Any], int]:
    """Load the layer of a file and all it includes; return them and the size of the others.

    Missing layers are removed with a warning, since the library would search elsewhere for them.
    """
    from pxr import Sdf

    layers: dict[str, Any] = {}
    waiting, size = [os.path.abspath(content.path)], 0  # noqa: PTH100 (links are kept)
    while waiting:
        path = waiting.pop()
        if path in layers:
            continue
        size += Path(path).stat().st_size
        _limit_process(size)
        layers[path] = layer = Sdf.Layer.FindOrOpen(path)
        for name in filter(None, layer.GetCompositionAssetDependencies()):
            plain, _ = Sdf.Layer.SplitIdentifier(name)
            # Like the library, resolve ".." in the text, regardless of links.
            target = os.path.normpath(Path(path).parent / plain)
            file = find_sibling(content, target)
            if file.is_file() and file.suffix.lower() in SUFFIXES:
                waiting.append(target)
            else:
                layer.UpdateCompositionAssetDependency(name, "")
                content.warn(f"the layer {name!r:.60} is missing or not USD, so it is left out")
    return list(layers.values()), size - len(content.data)


def _check_sublayers(content: FileContent, layers: list[Any]) -> None:
    """Raise ReadError if nested sublayers combine too many layers."""
    from pxr import Sdf

    for layer in layers:
        stack = [layer]
        # The list grows during the loop.
        for sublayer in stack:
            stack += [
                Sdf.Layer.FindRelativeToLayer(sublayer, name) for name in sublayer.subLayerPaths
            ]
            if len(stack) > MAX_SUBLAYERS:
                raise content.error(f"its sublayers expand to more than {MAX_SUBLAYERS}")


def _check_growth(content: FileContent, layer: Any) -> None:
    """Raise ReadError if references include too much, or values are in clips (other files)."""
    from pxr import Pcp, Sdf

    cache = Pcp.Cache(Pcp.LayerStackIdentifier(layer), "usd", True)
    waiting, n_included = [Sdf.Path.absoluteRootPath], 0
    while waiting:
        path = waiting.pop()
        if path.IsPrimPath():
            cache.RequestPayloads([path], [])
        index, _ = cache.ComputePrimIndex(path)
        if any(spec.HasInfo("clips") for spec in index.primStack):
            raise content.error("has its animation in value clips: flatten the stage first")
        nodes = list(index.rootNode.children)  # one per target of a reference
        while nodes:
            nodes += nodes.pop().children
            n_included += 1
            if n_included > MAX_REFERENCES:
                raise content.error(
                    f"its references expand to more than {MAX_REFERENCES} prims: export the "
                    "character by itself"
                )
        waiting += [path.AppendChild(name) for name in index.ComputePrimChildNames()[0]]


def _limit_process(size: int) -> None:
    """Limit this process to the memory that layers of this size may use."""
    if sys.platform == "win32":
        return
    import resource

    memory = MIN_STAGE_MEMORY + MAX_EXPANSION * size
    # A limit of 0 for core files: none is written if the process crashes.
    for limit, most in ((resource.RLIMIT_DATA, memory), (resource.RLIMIT_CORE, 0)):
        soft, hard = resource.getrlimit(limit)
        wanted = most if soft == resource.RLIM_INFINITY else min(most, soft)
        with suppress(OSError, ValueError):  # some systems do not allow this limit
            resource.setrlimit(limit, (wanted, hard))


def write_usd(motion: Motion, path: Path) -> None:
    """Write a motion to a USD file."""
    require_rotations(motion, path, "a USD")
    with require_extra("usd-core", "usd"):
        from pxr import Sdf, Tf, Usd, UsdGeom, UsdSkel, Vt
    warn_of_gaps([motion], path)
    skeleton = motion.skeleton
    names = clean_names(path, skeleton.names, str.strip)
    # Paths need unique identifiers.
    words = make_unique(Tf.MakeValidIdentifier(name) for name in names)
    joints: list[str] = []
    for word, parent in zip(words, skeleton.parents, strict=True):
        joints.append(word if parent < 0 else f"{joints[parent]}/{word}")
    stage = Usd.Stage.CreateInMemory()
    # Programs interpret transforms above the skeleton differently, so merge them into the root.
    rig = get_rig(skeleton).join_root().to_metres()
    UsdGeom.SetStageUpAxis(stage, UsdGeom.Tokens.y)
    UsdGeom.SetStageMetersPerUnit(stage, 1.0)
    stage.SetTimeCodesPerSecond(motion.fps)
    stage.SetFramesPerSecond(motion.fps)
    stage.SetStartTimeCode(0)
    stage.SetEndTimeCode(motion.n_frames - 1)
    top = Sdf.Path(f"/{Tf.MakeValidIdentifier(path.stem)}")
    root = UsdSkel.Root.Define(stage, top)
    stage.SetDefaultPrim(root.GetPrim())
    bound = UsdSkel.Skeleton.Define(stage, top.AppendChild("Skeleton"))
    bound.CreateJointsAttr(joints)
    bound.CreateJointNamesAttr(names)
    # USD has row vectors.
    local, world = (
        Vt.Matrix4dArray.FromNumpy(np.ascontiguousarray(matrices.transpose(0, 2, 1)))
        for matrices in (compose(rig.translations, rig.rotations, rig.scales), compose(*rig.world))
    )
    bound.CreateRestTransformsAttr(local)
    bound.CreateBindTransformsAttr(world)
    ends = [names[j] for j in sorted(skeleton.end_sites)]
    bound.GetPrim().SetCustomDataByKey(END_SITES, Vt.StringArray(ends))
    animation = UsdSkel.Animation.Define(stage, bound.GetPath().AppendChild("Animation"))
    animation.CreateJointsAttr(joints)
    animation.CreateScalesAttr(Vt.Vec3hArray.FromNumpy(rig.scales.astype("f2")))
    shifts, turns = pose_rig(motion, rig)
    shifts, turns = shifts.astype("f4"), np.roll(turns, -1, axis=-1).astype("f4")  # w last
    translations, rotations = animation.CreateTranslationsAttr(), animation.CreateRotationsAttr()
    for frame in range(motion.n_frames):
        translations.Set(Vt.Vec3fArray.FromNumpy(np.ascontiguousarray(shifts[frame])), frame)
        rotations.Set(Vt.QuatfArray.FromNumpy(np.ascontiguousarray(turns[frame])), frame)
    binding = UsdSkel.BindingAPI.Apply(bound.GetPrim())
    binding.CreateAnimationSourceRel().SetTargets([animation.GetPath()])
    with atomic_write(path) as draft:
        try:
            stage.Export(str(draft), addSourceFileComment=False)
        except Tf.ErrorException as error:
            raise WriteError(path, "cannot be written as USD") from error


FORMAT = Format("USD", SUFFIXES, lambda head: head.startswith(HEADS), read_usd, write_usd)
