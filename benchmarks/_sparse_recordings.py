"""Make recordings of exercises of HDM05 at irregular times among other movement.

Three exercises of one actor occur four to six times each, if possible in different takes. Between
them lie one to five seconds of other movement: walking (of subject 86, on the actor's skeleton),
standing, or a movement that occurs only once in the recording.
"""

from __future__ import annotations

from collections.abc import Iterator
from functools import cache
from typing import NamedTuple

import numpy as np
from scipy.optimize import linear_sum_assignment

from _options import choose_size
from _recordings import ACTORS, draw_takes, read_exercises, read_subject_86
from _sequences import join_recordings
from kineme.recordings import Motion
from kineme.recordings.operations import cut
from kineme.segments.segmentation import Segmentation
from kineme.segments.table import SegmentTable

LOCOMOTION = ("jogLeftCircle4StepsRstart", "sneak2StepsLStart")
TARGETS = 3
OCCURRENCES = (4, 6)
BETWEEN_S = (1.0, 5.0)
WALKING, STANDING = 0.5, 0.2
"""Shares of the movement between events; the rest occurs only once."""
SWAY = 0.02
"""Amplitude of swaying while standing, in radians."""
OVERLAP = 0.5
"""Intersection over union at which a primitive and an event count as the same."""


class Event(NamedTuple):
    """One occurrence of a target exercise: its name and frames [start, stop)."""

    name: str
    start: int
    stop: int


class SparseCase(NamedTuple):
    """A recording and its events."""

    name: str
    motion: Motion
    events: tuple[Event, ...]


def make_sparse_events(seeds: int) -> Iterator[SparseCase]:
    """Yield recordings with sparse events, actors in turn (quick: one)."""
    for seed in range(choose_size(seeds, 1)):
        actor = ACTORS[seed % len(ACTORS)]
        motion, events = _make_recording(actor, np.random.default_rng(seed))
        yield SparseCase(f"{actor} {seed}", motion, events)


def _make_recording(actor: str, rng: np.random.Generator) -> tuple[Motion, tuple[Event, ...]]:
    takes = read_exercises(actor)
    names = [name for name in sorted(takes) if name not in LOCOMOTION]
    targets = rng.permutation(names)[:TARGETS].tolist()
    drawn = [take for name in targets for take in draw_takes(takes[name], OCCURRENCES, rng)]
    untargeted = [takes[name][0].motion for name in sorted(takes) if name not in targets]
    others = _list_others(actor)
    singles = [untargeted[i] for i in rng.permutation(len(untargeted))]
    singles += [others[i] for i in rng.permutation(len(others))]
    parts = [_make_filler(actor, singles, rng)]
    marked = []
    for i in rng.permutation(len(drawn)).tolist():
        marked.append((len(parts), drawn[i].name))
        parts += [drawn[i].motion, _make_filler(actor, singles, rng)]
    motion, starts, _ = join_recordings(parts)
    events = (Event(name, int(starts[i]), int(starts[i + 1])) for i, name in marked)
    return motion, tuple(events)


def _make_filler(actor: str, singles: list[Motion], rng: np.random.Generator) -> Motion:
    """Return movement between events; movements that occur once are popped from the list."""
    kind, seconds = rng.random(), float(rng.uniform(*BETWEEN_S))
    if kind < WALKING or (kind >= WALKING + STANDING and not singles):
        walks = [motion for name, motion in _retarget_activities(actor) if name == "walk"]
        return _cut_randomly(walks[int(rng.integers(len(walks)))], seconds, rng)
    if kind < WALKING + STANDING:
        squats = read_exercises(actor)["squat1Reps"]
        return _make_standing(squats[int(rng.integers(len(squats)))].motion, seconds, rng)
    return _cut_randomly(singles.pop(), BETWEEN_S[1], rng)


def _cut_randomly(motion: Motion, seconds: float, rng: np.random.Generator) -> Motion:
    length = min(round(seconds * motion.fps), motion.n_frames)
    start = int(rng.integers(motion.n_frames - length + 1))
    return cut(motion, start, start + length)


def _make_standing(motion: Motion, seconds: float, rng: np.random.Generator) -> Motion:
    """Hold the first pose of a motion, with some swaying."""
    from scipy.spatial.transform import Rotation

    n = round(seconds * motion.fps)
    pose = np.array(motion.rotations)[0]
    rates, phases = rng.uniform(0.1, 0.5, (2, len(pose), 3)) * [[[1]], [[20]]]
    angles = SWAY * np.sin(2 * np.pi * rates * np.arange(n)[:, None, None] / motion.fps + phases)
    still = Rotation.from_quat(np.roll(np.tile(pose, (n, 1)), -1, -1))
    swaying = still * Rotation.from_rotvec(angles.reshape(-1, 3))
    rotations = np.roll(swaying.as_quat(), 1, -1).reshape(n, *pose.shape)
    root = np.repeat(motion.positions[:1, 0], n, axis=0)
    return Motion.from_rotations(motion.skeleton, rotations, motion.fps, root)


def _list_others(actor: str) -> list[Motion]:
    """Return one part of each activity of subject 86 except walking."""
    parts = {name: motion for name, motion in _retarget_activities(actor) if name != "walk"}
    return list(parts.values())


@cache
def _retarget_activities(actor: str) -> list[tuple[str, Motion]]:
    """Return names and motions of the activities of subject 86 on the skeleton of an actor."""
    actors_own = next(iter(read_exercises(actor).values()))[0].motion
    height = measure_root_height(actors_own)
    found = []
    for case in read_subject_86():
        motion, truth = case.motion, case.truth
        ratio = motion.fps / truth.fps
        starts = np.append(0, truth.latest) * ratio
        stops = np.append(truth.earliest, truth.frames) * ratio
        root = motion.positions[:, 0] * height / measure_root_height(motion)
        retargeted = Motion.from_rotations(actors_own.skeleton, motion.rotations, motion.fps, root)
        for name, start, stop in zip(truth.labels, starts, stops, strict=True):
            found.append((name, cut(retargeted, int(start), min(int(stop), retargeted.n_frames))))
    return found


def measure_root_height(motion: Motion) -> float:
    """Return the median height of the root in metres."""
    return float(np.median(motion.positions[:, 0, 1]))


def select_repetitions(found: Segmentation) -> SegmentTable:
    """Return the primitives that belong to a cluster."""
    rows = found.primitives
    return rows[(rows.kind == "primitive") & (rows.cluster >= 0)]


def match_events(case: SparseCase, rows: SegmentTable) -> tuple[int, int]:
    """Count the events that are found, and the primitives that lie mostly in events.

    Each exercise has the cluster that holds most of its events.
    """
    starts = np.array([event.start for event in case.events])
    stops = np.array([event.stop for event in case.events])
    shared = np.minimum(rows.stop_frame[:, None], stops) - np.maximum(
        rows.start_frame[:, None], starts
    )
    shared = np.maximum(shared, 0)
    lengths = rows.stop_frame - rows.start_frame
    fits = shared >= OVERLAP * (lengths[:, None] + (stops - starts) - shared)
    names = sorted({event.name for event in case.events})
    clusters = np.unique(rows.cluster)
    of_name = np.array([[event.name == name for event in case.events] for name in names])
    of_cluster = rows.cluster == clusters[:, None]
    table = of_cluster.astype(int) @ fits.astype(int) @ of_name.T.astype(int)
    best = linear_sum_assignment(table, maximize=True)
    inside = shared.sum(axis=1) >= 0.5 * lengths
    return int(table[best].sum()), int(inside.sum())
