"""Sequences of recorded exercises, of which every border and repetition is known.

Many collections hold single exercises, each cut out by people. Joined end to
end (see ``joining``) they make recordings as long and as varied as wanted, of
real movement and with a known truth.

The truth is a segmentation like any other (see ``synthetic``). Between two
repetitions of one action the border is the join's middle; between two actions
the join is a transition.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from itertools import groupby, pairwise

import numpy as np
from numpy.typing import NDArray

from kineme.datasets.joining import check_fit, join_recordings
from kineme.datasets.synthetic import SyntheticRecording
from kineme.datasets.timeline import Row, segments_of
from kineme.errors import ParameterError
from kineme.recordings import Motion, Provenance
from kineme.segments.segmentation import Segmentation


@dataclass(frozen=True, eq=False)
class Exercise:
    """A recording of one exercise and nothing else.

    Parameters
    ----------
    name : str
        What it is; exercises of one name are one action.
    motion : Motion
        With rotations.
    repetitions : int, optional
        How often it holds the exercise.

    Examples
    --------
    >>> from kineme.datasets import Action, Exercise, synthesize
    >>> motion = synthesize([Action("squat", 2)], fps=30).motion
    >>> Exercise("squat", motion, repetitions=2).name
    'squat'
    """

    name: str
    motion: Motion
    repetitions: int = 1

    def __post_init__(self) -> None:
        if self.repetitions < 1:
            raise ParameterError(f"repetitions must be at least 1, not {self.repetitions}")


def exercise_sequence(
    exercises: Iterable[Exercise],
    seed: int,
    *,
    actions: int = 5,
    runs: int = 8,
    repeats: tuple[int, int] = (3, 6),
    join: float = 0.4,
) -> SyntheticRecording:
    """Exercises of one person joined in random order, and where each begins and ends.

    Parameters
    ----------
    exercises : iterable of Exercise
        Of one skeleton and one frame rate.
    seed : int
        Of everything random; the same seed gives the same recording.
    actions : int, optional
        How many different ones are drawn; all, if there are fewer.
    runs : int, optional
        How many times an action is taken up; each comes once before any comes again, and never
        after itself.
    repeats : (int, int), optional
        Fewest and most exercises of a run, joined one after the other.
    join : float, optional
        Seconds over which a join is blended; at most a third of the shorter exercise.

    Raises
    ------
    ParameterError
        Fewer than two actions, exercises that do not fit together, or one without rotations.

    Examples
    --------
    >>> from kineme.datasets import Action, Exercise, exercise_sequence, synthesize
    >>> motions = {name: synthesize([Action(name, 1)], fps=30).motion for name in ("squat", "jump")}
    >>> exercises = [Exercise(name, motion) for name, motion in motions.items()]
    >>> exercise_sequence(exercises, 1, runs=3).truth.activities.label.tolist()
    ['jump', '', 'squat', '', 'jump']
    """
    of_name: dict[str, list[Exercise]] = {}
    for exercise in exercises:
        of_name.setdefault(exercise.name, []).append(exercise)
    if min(len(of_name), actions) < 2:
        raise ParameterError(f"at least two actions are needed, not {min(len(of_name), actions)}")
    if runs < 1 or not 1 <= repeats[0] <= repeats[1] or not join >= 0:
        raise ParameterError(
            f"runs must be at least 1, repeats rise from at least 1 and join not be negative, "
            f"not {runs}, {repeats} and {join}"
        )
    check_fit([exercise.motion for takes in of_name.values() for exercise in takes])
    rng = np.random.default_rng(seed)
    names = rng.permutation(sorted(of_name))[:actions].tolist()
    # Sorted first, so that the draw does not depend on the order of the input.
    order = _run_order(names, runs, rng)
    parts = [
        exercise
        for name in order
        for exercise in _draw(of_name[name], int(rng.integers(repeats[0], repeats[1] + 1)), rng)
    ]
    return join_exercises(parts, join=join, note=f"{len(parts)} exercises joined, seed {seed}")


def join_exercises(
    parts: Sequence[Exercise], *, join: float = 0.4, note: str = ""
) -> SyntheticRecording:
    """Exercises of one person joined in the order given, and where each begins and ends.

    Parameters
    ----------
    parts : sequence of Exercise
        Of one skeleton and one frame rate, two at least; neighbours of one name are one activity.
    join : float, optional
        Seconds over which a join is blended; at most a third of the shorter exercise.
    note : str, optional
        For the provenance; by default how many there are.

    Raises
    ------
    ParameterError
        Exercises that do not fit together, or one without rotations.

    Examples
    --------
    >>> from kineme.datasets import Action, Exercise, join_exercises, synthesize
    >>> motions = {name: synthesize([Action(name, 1)], fps=30).motion for name in ("squat", "jump")}
    >>> parts = [Exercise(name, motion) for name, motion in motions.items()]
    >>> join_exercises(parts).truth.activities.label.tolist()
    ['squat', '', 'jump']
    """
    motion, starts, halves = join_recordings([part.motion for part in parts], join)
    sentence = note or f"{len(parts)} exercises joined"
    provenance = Provenance(format="sequence").noted(sentence)
    truth = _truth(list(parts), starts, halves, motion.fps)
    return SyntheticRecording(replace(motion, provenance=provenance), truth)


def _run_order(names: list[str], runs: int, rng: np.random.Generator) -> list[str]:
    """Return every name once in random order, and again, without equal neighbours."""
    order: list[str] = []
    while len(order) < runs:
        again = rng.permutation(names).tolist()
        if order and again[0] == order[-1]:
            # No action follows itself.
            again.append(again.pop(0))
        order += again
    return order[:runs]


def _draw(takes: list[Exercise], count: int, rng: np.random.Generator) -> list[Exercise]:
    """So many of the takes, none twice before each came once."""
    order = rng.permutation(len(takes))
    return [takes[order[i % len(takes)]] for i in range(count)]


def _truth(
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
            # Repetitions within an exercise are taken to be equally long.
            borders = np.linspace(start, stop, parts[i].repetitions + 1).astype(int).tolist()
            for a, b in pairwise(borders):
                add("primitive", "primitive", a, b, name)
    return segments_of(rows, int(starts[-1]), fps)
