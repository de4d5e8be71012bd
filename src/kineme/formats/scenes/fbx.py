"""FBX: the scenes of animators' programs, from version 7.0 on, binary or text.

What is read is the skeleton of one character and one of its takes, at the file's frame rate
(``TimeMode``). A curve says more than its values at frames: ``fps=`` samples it at other times,
and does not play it faster. Unit and axes are those of the file (``UnitScaleFactor``, ``UpAxis``).
Meshes, cameras, lights and constraints are passed over: a rig that is moved by these is baked to
keys when it is exported.

What is written is described in `kineme.formats.scenes.fbx_writer`, a copy with other takes in
`kineme.formats.scenes.fbx_copy`.

See `kineme.formats.scenes.characters` for what counts as a character,
`kineme.formats.scenes.fbx_scene` for how its joints are placed.
"""

from __future__ import annotations

import numpy as np

from kineme._util.arrays import Floats
from kineme._util.checks import make_unique
from kineme._util.rotations import from_matrices
from kineme.formats.files import FileContent
from kineme.formats.options import ReadOptions
from kineme.formats.registry import Format
from kineme.formats.scenes.assembly import MOST_SAMPLED, assemble, require_frame_memory
from kineme.formats.scenes.characters import choose_take, find_character, find_moving_takes
from kineme.formats.scenes.fbx_copy import copy_takes
from kineme.formats.scenes.fbx_curves import CUSTOM, RATES, SLACK, TICKS, Sampler
from kineme.formats.scenes.fbx_file import MAGIC, parse_fbx
from kineme.formats.scenes.fbx_scene import FBXScene, Pose, Take
from kineme.formats.scenes.fbx_text import TEXT
from kineme.formats.scenes.fbx_writer import write_fbx, write_takes
from kineme.formats.skeletons.placing import BYTES_PER_JOINT
from kineme.formats.units import make_up_rotation
from kineme.recordings import Motion, Note

USUAL_RATE = 30.0
"""Of files that tell none, and have no keys that do."""

CENTIMETRE = 0.01

SLOWEST, FASTEST = 0.01, 100_000.0
"""Frames per second that are taken for a rate."""

_EVEN_KEYS = 8  # fewer tell no rate
_ROUNDED = 1e-3  # of a frame, by which the end of a take misses it
_MOST_FRAMES = 1e12


def read_fbx(content: FileContent, options: ReadOptions) -> Motion:
    """Return the motion of a character in an FBX file."""
    version, root = parse_fbx(content)
    scene = FBXScene(content, root)
    moved = [scene.moved(take) for take in scene.takes]
    animated = find_moving_takes(moved, scene.bones)
    names = make_unique(take.name for take in scene.takes)
    number, notes = choose_take(content, names, animated, options.take)
    take, nodes = scene.takes[number], scene.nodes(moved[number])
    character = find_character(content, nodes, options.person)
    joints = [scene.models[j].number for j in character.joints]
    fps, rated = _find_rate(scene, take, joints, options)
    at = _compute_frame_times(scene, take, joints, fps)
    turn, turned = _find_turn(scene, options)
    pose = Pose(scene, take, Sampler(at))
    notes = [f"FBX {version // 1000}.{version % 1000 // 100}", *notes, *character.notes]
    return assemble(
        content,
        nodes,
        character.joints,
        pose.transform,
        pose.rest,
        len(at),
        fps,
        unit=options.unit or _find_unit(scene),
        turn=turn,
        provenance=content.provenance("FBX", [*notes, *rated, *turned])
        .of_take(names[number], (names[each] for each in animated))
        .of_person(character.name, character.people),
        numbers=[model.number for model in scene.models],
    )


def _find_rate(
    scene: FBXScene, take: Take, joints: list[int], options: ReadOptions
) -> tuple[float, list[str]]:
    """Frames per second, and what to say of them."""
    if options.fps is not None:
        return options.fps, [f"sampled {options.fps:g} times a second, as asked for"]
    mode = int(scene.setting("TimeMode", 0))
    fps = RATES.get(mode, 0.0) if mode != CUSTOM else scene.setting("CustomFrameRate", 0.0)
    keys = _infer_rate(scene, take, joints)
    if not SLOWEST <= fps <= FASTEST:
        if keys:
            return keys, [f"frame rate {keys:g} Hz: the file tells none, its keys are so far apart"]
        remark = f"the file tells no frame rate: {USUAL_RATE:g} Hz assumed; give fps= (--fps)"
        return USUAL_RATE, [Note(remark, "warning")]
    # Keys closer together than frames: sampling at the file's rate drops some of them.
    if keys > 1.5 * fps:
        return fps, [f"{keys:g} keys a second are sampled at the file's {fps:g} Hz: fps= asks more"]
    return fps, []


def _infer_rate(scene: FBXScene, take: Take, joints: list[int]) -> float:
    """How many keys a second the first curve with evenly spaced ones has; 0 where none has."""
    for times in scene.key_times(take, joints):
        steps = np.diff(times)
        if len(steps) < _EVEN_KEYS:
            continue
        usual = float(np.median(steps))
        # Evenly spaced, up to the rounding of ticks or a thousandth of the step.
        even = np.abs(steps - usual) <= max(2 * SLACK, 1e-3 * usual)
        fps = TICKS / usual
        if even.mean() > 0.9 and SLOWEST <= fps <= FASTEST:
            return round(fps, 3)
        return 0.0
    return 0.0


def _compute_frame_times(scene: FBXScene, take: Take, joints: list[int], fps: float) -> Floats:
    """Ticks of each frame: from the start of the take to its end, or of its keys."""
    start, stop = take.start, take.stop
    count = (stop - start) / TICKS * fps + 1
    room = max(MOST_SAMPLED, scene.content.memory_limit)
    # The span of the take is missing, or absurdly long: the keys tell it.
    if stop <= start or count * BYTES_PER_JOINT * len(joints) > room:
        ends = [(times[0], times[-1]) for times in scene.key_times(take, joints)]
        start = min((first for first, _ in ends), default=0.0)
        stop = max((last for _, last in ends), default=0.0)
        count = (stop - start) / TICKS * fps + 1
    # The end of the take may miss its last frame by rounding.
    n_frames = int(min(count + _ROUNDED, _MOST_FRAMES))
    require_frame_memory(scene.content, len(joints), n_frames)
    return np.asarray(start + np.arange(n_frames) * (TICKS / fps), np.float64)


def _find_unit(scene: FBXScene) -> float:
    """Return the metres in one unit of the file, which counts in centimetres."""
    factor = scene.setting("UnitScaleFactor", 1.0)
    return CENTIMETRE * (factor if factor > 0 else 1.0)


def _find_turn(scene: FBXScene, options: ReadOptions) -> tuple[Floats, list[str]]:
    """Return the rotation to axes with y up, and what to say of it.

    The file tells which of its axes are those to the right, up and to the front.
    """
    if options.up is not None:
        return make_up_rotation(options.up), []
    # Rows are the file's axes to the right, up and to the front.
    rows = np.zeros((3, 3))
    for row, (name, usual) in enumerate((("Coord", 0), ("Up", 1), ("Front", 2))):
        axis = int(scene.setting(f"{name}Axis", usual))
        sign = -1.0 if scene.setting(f"{name}AxisSign", 1) < 0 else 1.0
        if 0 <= axis < 3:
            rows[row, axis] = sign
    up = int(np.abs(rows[1]).argmax())
    name = ("-" if rows[1, up] < 0 else "") + "xyz"[up]
    notes: list[str] = [] if name == "y" else [f"turned: {name} is up in the file"]
    # A proper rotation has determinant 1; -1 is left-handed, 0 is no set of axes.
    if np.linalg.det(rows) > 0.5:
        return from_matrices(rows[None]).reshape(4), notes
    remark = (
        "the file's axes are left-handed or no axes: read as right-handed ones with the same up"
    )
    return make_up_rotation(name), [*notes, Note(remark, "warning")]


FORMAT = Format(
    "FBX",
    (".fbx",),
    lambda head: head.startswith(MAGIC) or TEXT.search(head) is not None,
    read_fbx,
    write_fbx,
    write_animations=write_takes,
    copy_animations=copy_takes,
)
