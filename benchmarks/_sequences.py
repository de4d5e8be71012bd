"""Join recorded exercises to sequences with known borders and repetitions.

At a join, the second motion is turned about the vertical and moved along the floor to the end of
the first. Rotations and translations are then blended while both motions continue, so that no
frame is lost. Between repetitions of one action the border is the middle of the join; between two
actions the join is a transition.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import groupby, pairwise

import numpy as np
from numpy.typing import NDArray

from kineme._util import rotations as rot
from kineme._util.arrays import Floats
from kineme.datasets.synthetic import Row, SyntheticRecording, make_segmentation
from kineme.recordings import Motion, Provenance
from kineme.recordings.kinematics import compute_local_translations
from kineme.recordings.operations import move, turn
from kineme.segments.segmentation import Segmentation


def join_recordings(
    motions: Sequence[Motion], join: float = 0.4
) -> tuple[Motion, NDArray[np.int64], list[int]]:
    """Return the joined motion, the first frame of each part and the end, and half-joins in frames.

    Motions need one skeleton, one frame rate, and rotations. A join is blended over ``join``
    seconds, at most a third of the shorter motion.
    """
    fps = motions[0].fps
    placed = [motions[0]]
    for motion in motions[1:]:
        placed.append(_move_after(placed[-1], motion))
    rotations = [np.array(motion.rotations) for motion in placed]
    translations = [
        compute_local_translations(motion.skeleton, motion.positions, motion.rotations)
        for motion in placed
    ]
    halves = []
    for before, after in pairwise(range(len(placed))):
        shorter = min(len(rotations[before]), len(rotations[after]))
        # At most a third of the shorter motion in all, so that joins do not meet.
        half = min(round(join * fps / 2), shorter // 6)
        _blend(rotations[before], rotations[after], translations[before], translations[after], half)
        halves.append(half)
    motion = Motion.from_rotations(
        placed[0].skeleton,
        np.concatenate(rotations),
        fps,
        translations=np.concatenate(translations),
    )
    return motion, np.cumsum([0, *map(len, rotations)]), halves


def _move_after(before: Motion, motion: Motion) -> Motion:
    """Turn and move a motion so that its root continues where the previous one ends."""
    # Rotation of the root where the first motion ends and the second begins.
    ended, begins = np.array(before.rotations)[-1, 0], np.array(motion.rotations)[0, 0]
    q = rot.multiply(ended, rot.conjugate(begins))
    # The part of the rotation about y: twice the angle between w and y.
    turned = turn(motion, 2 * float(np.arctan2(q[2], q[0])))
    step = before.positions[-1, 0] - turned.positions[0, 0]
    # Move along the floor only; the blend corrects heights.
    return move(turned, step * [1, 0, 1])


def _blend(a: Floats, b: Floats, a_shift: Floats, b_shift: Floats, half: int) -> None:
    """Blend the end of a and the start of b in place."""
    from scipy.spatial.transform import Rotation

    if half == 0:
        return
    x = (np.arange(2 * half) + 0.5) / (2 * half)
    share = (x * x * (3 - 2 * x))[:, None, None]
    # Smooth step from 0 to 1; the second motion gets the part after the join, from -0.5 to 0.
    share[half:] -= 1
    # The rotation from the end of the first motion to the start of the second.
    vectors = Rotation.from_quat(np.roll(rot.multiply(rot.conjugate(a[-1]), b[0]), -1, -1))
    angles = share * vectors.as_rotvec()
    bends = np.roll(Rotation.from_rotvec(angles.reshape(-1, 3)).as_quat(), 1, -1)
    bends = bends.reshape(*angles.shape[:2], 4)
    # Translations are blended linearly.
    shift = share * (b_shift[0] - a_shift[-1])
    a[-half:] = rot.multiply(a[-half:], bends[:half])
    b[:half] = rot.multiply(b[:half], bends[half:])
    a_shift[-half:] += shift[:half]
    b_shift[:half] += shift[half:]


@dataclass(frozen=True, eq=False)
class Exercise:
    """A recording of one exercise.

    Parameters
    ----------
    name : str
        Exercises of the same name are one action.
    motion : Motion
        With rotations.
    repetitions : int, optional
        How often it holds the exercise.
    """

    name: str
    motion: Motion
    repetitions: int = 1


def join_exercises(parts: Sequence[Exercise], *, join: float = 0.4) -> SyntheticRecording:
    """Join exercises of one person in order, and return the motion with its truth.

    Parameters
    ----------
    parts : sequence of Exercise
        Of one skeleton and one frame rate, two at least; neighbours of one name are one activity.
    join : float, optional
        Seconds over which a join is blended; at most a third of the shorter exercise.
    """
    motion, starts, halves = join_recordings([part.motion for part in parts], join)
    provenance = Provenance(format="sequence").noted(f"{len(parts)} exercises joined")
    truth = _make_truth(list(parts), starts, halves, motion.fps)
    return SyntheticRecording(replace(motion, provenance=provenance), truth)


def _make_truth(
    parts: list[Exercise], starts: NDArray[np.int64], halves: list[int], fps: float
) -> Segmentation:
    numbers = {name: i for i, name in enumerate(dict.fromkeys(part.name for part in parts))}
    halves = [0, *halves, 0]  # no join at the recording's own ends
    rows: list[Row] = []

    def add(level: str, kind: str, start: int, stop: int, name: str = "") -> None:
        if stop > start:
            rows.append((level, kind, start, stop, numbers.get(name, -1), name))

    for name, members in groupby(range(len(parts)), lambda i: parts[i].name):
        run = list(members)
        # First frames of the run's exercises, and the end of the last one.
        edges = starts[run[0] : run[-1] + 2].tolist()
        before, after = halves[run[0]], halves[run[-1] + 1]
        for level in ("activity", "primitive"):
            # Each transition is added once, by the action after it.
            add(level, "transition", edges[0] - before, edges[0] + before)
        edges[0], edges[-1] = edges[0] + before, edges[-1] - after
        add("activity", "activity", edges[0], edges[-1], name)
        for i, (start, stop) in zip(run, pairwise(edges), strict=True):
            # Assume that repetitions within an exercise have equal lengths.
            borders = np.linspace(start, stop, parts[i].repetitions + 1).astype(int).tolist()
            for a, b in pairwise(borders):
                add("primitive", "primitive", a, b, name)
    return make_segmentation(rows, int(starts[-1]), fps)
