"""Read FBX: scenes of animation programs, from version 7.0 on, binary or text.

The skeleton of one character and one of its takes are read at the file's frame rate (``TimeMode``).
``fps=`` samples the curves at another rate and does not change their speed. Unit and axes are the
file's (``UnitScaleFactor``, ``UpAxis``). Meshes, cameras, lights and constraints are ignored: a rig
that they move must be baked to keys on export.

`kineme.formats.scenes.characters` defines characters, `kineme.formats.scenes.fbx_scene` transforms
of joints, `kineme.formats.scenes.fbx_writer` what is written.
"""

from __future__ import annotations

import numpy as np

from kineme._util.arrays import Floats
from kineme._util.checks import make_unique
from kineme._util.rotations import from_matrices
from kineme.formats.files import FileContent
from kineme.formats.options import ReadOptions
from kineme.formats.registry import Format
from kineme.formats.scenes.assembly import (
    MIN_FRAME_MEMORY,
    assemble,
    count_frames,
    find_rate,
)
from kineme.formats.scenes.characters import choose_take, find_character, find_moving_takes
from kineme.formats.scenes.fbx_curves import CUSTOM, RATES, TICKS, Sampler
from kineme.formats.scenes.fbx_file import MAGIC, TEXT, parse_fbx
from kineme.formats.scenes.fbx_scene import REST_TAKE, FBXScene, Pose, Take
from kineme.formats.scenes.fbx_writer import CENTIMETRE, copy_takes, write_fbx, write_takes
from kineme.formats.skeletons.placing import BYTES_PER_JOINT
from kineme.formats.units import make_up_rotation
from kineme.recordings import Motion, Note

_EVEN_KEYS = 8  # minimum number of steps between keys to infer a rate
_ROUNDED = 1e-3  # frames by which the end of a take may miss its last frame


def read_fbx(content: FileContent, options: ReadOptions) -> Motion:
    """Return the motion of a character in an FBX file."""
    version, root = parse_fbx(content)
    scene = FBXScene(content, root)
    moved_models = [scene.find_moved(take) for take in scene.takes]
    animated = find_moving_takes(moved_models, scene.bones)
    names = make_unique(take.name for take in scene.takes)
    number, notes = choose_take(content, names, animated, options.take)
    take, nodes = scene.takes[number], scene.make_nodes(moved_models[number])
    character = find_character(content, nodes, options.person)
    joints = [scene.models[j].number for j in character.joints]
    fps, rate_notes = _find_rate(scene, take, joints, options)
    frame_times = _compute_frame_times(scene, take, joints, fps)
    turn, turn_notes = _find_turn(scene, options)
    factor = scene.get_setting("UnitScaleFactor", 1.0)  # centimetres per unit
    sampler = Sampler(frame_times)
    notes = [f"FBX {version // 1000}.{version % 1000 // 100}", *notes, *character.notes]
    return assemble(
        content,
        nodes,
        character.joints,
        Pose(scene, take, sampler).compute_transform,
        Pose(scene, REST_TAKE, sampler).compute_bind_transform,
        len(frame_times),
        fps,
        unit=options.unit or CENTIMETRE * (factor if factor > 0 else 1.0),
        turn=turn,
        provenance=content.provenance("FBX", [*notes, *rate_notes, *turn_notes])
        .of_take(names[number], (names[moving] for moving in animated))
        .of_person(character.name, character.people),
        numbers=[model.number for model in scene.models],
    )


def _find_rate(
    scene: FBXScene, take: Take, joints: list[int], options: ReadOptions
) -> tuple[float, list[Note | str]]:
    """Return frames per second, and notes."""
    mode = int(scene.get_setting("TimeMode", 0))
    fps = RATES.get(mode, 0.0) if mode != CUSTOM else scene.get_setting("CustomFrameRate", 0.0)
    times = max(scene.iterate_key_times(take, joints), key=len, default=np.empty(0))
    # A few keys are set by hand, whatever their distance.
    return find_rate(options.fps, fps, times / TICKS if len(times) > _EVEN_KEYS else np.empty(0))


def _compute_frame_times(scene: FBXScene, take: Take, joints: list[int], fps: float) -> Floats:
    """Return the ticks of each frame, from start to end of the take or of its keys."""
    start, stop = take.start, take.stop
    count = (stop - start) / TICKS * fps + 1
    memory_limit = max(MIN_FRAME_MEMORY, scene.content.memory_limit)
    # If the span of the take is missing or absurdly long, use that of its keys.
    if stop <= start or count * BYTES_PER_JOINT * len(joints) > memory_limit:
        ends = [(times[0], times[-1]) for times in scene.iterate_key_times(take, joints)]
        start = min((first for first, _ in ends), default=0.0)
        stop = max((last for _, last in ends), default=0.0)
        count = (stop - start) / TICKS * fps + 1
    # The end of the take may miss its last frame by rounding.
    n_frames = count_frames(scene.content, len(joints), count + _ROUNDED)
    return np.asarray(start + np.arange(n_frames) * (TICKS / fps), np.float64)


def _find_turn(scene: FBXScene, options: ReadOptions) -> tuple[Floats, list[str]]:
    """Return the rotation to axes with y up, and notes.

    The file states which of its axes point to the right, upwards and to the front.
    """
    if options.up is not None:
        return make_up_rotation(options.up), []
    # Rows are the file's axes to the right, upwards and to the front.
    rows = np.zeros((3, 3))
    for row, (name, default) in enumerate((("Coord", 0), ("Up", 1), ("Front", 2))):
        axis = int(scene.get_setting(f"{name}Axis", default))
        sign = -1.0 if scene.get_setting(f"{name}AxisSign", 1) < 0 else 1.0
        if 0 <= axis < 3:
            rows[row, axis] = sign
    up = int(np.abs(rows[1]).argmax())
    name = ("-" if rows[1, up] < 0 else "") + "xyz"[up]
    notes: list[str] = [] if name == "y" else [f"turned upright: {name} is up in the file"]
    # The determinant is 1 for a rotation, -1 for left-handed axes, 0 for dependent ones.
    if np.linalg.det(rows) > 0.5:
        return from_matrices(rows[None]).reshape(4), notes
    remark = (
        "the file's axes are left-handed or invalid: read as right-handed with the same up axis"
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
