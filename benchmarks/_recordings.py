"""Recordings with a truth for the benchmarks: subject 86, HDM05 sequences, synthetic ones.

All are `Case`s: a motion, and what people or the maker say of it.
"""

from __future__ import annotations

import csv
from collections import Counter, defaultdict
from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import cache
from pathlib import Path

import numpy as np

import kineme
from _options import DATA, few, needed
from _sequences import Exercise, join_exercises
from kineme.datasets import ACTIONS, Action, synthesize
from kineme.evaluation import Truth, make_labelling
from kineme.recordings import Motion
from kineme.segments.segmentation import Segmentation
from kineme_reproduction.trials import find_folder, load_trials

TRIALS = ("86_01", "86_09", "86_10", "86_11", "86_14")

ACTORS = ("bd", "bk", "dg")
# HDM05 names the repetitions in the class, steps singly: four of them are two double steps.
REPETITIONS = {"jogLeftCircle4StepsRstart": 2}

EXERCISES = [name for name in ACTIONS if name not in ("walk", "stand")]
SMALL = ("wave", "punch")
CONDITIONS = ("as it is", "speed", "size", "noise", "one hand", "all")


@dataclass(frozen=True)
class Case:
    """A recording and its truth; where the maker knows them, every repetition, too."""

    name: str
    motion: Motion
    truth: Truth
    made: Segmentation | None = None
    """The truth as a segmentation, repetitions and all, where it was made."""


def subject_86() -> list[Case]:
    """The five trials of the benchmark; two, where it shall be quick."""
    needed("cmu86")
    trials = load_trials(find_folder(DATA), few(TRIALS, TRIALS[:2]))
    return [Case(trial.name, trial.motion, trial.truth) for trial in trials]


def hdm05(
    seeds: int, *, first: int = 0, runs: int = 8, repeats: tuple[int, int] = (3, 6)
) -> Iterator[Case]:
    """Sequences of HDM05 exercises, actors in turn; one short one, where it shall be quick."""
    runs = few(runs, 4)
    for seed in range(first, first + few(seeds, 1)):
        actor = ACTORS[seed % len(ACTORS)]
        made = join_exercises(drawn(exercises(actor), seed, runs, repeats))
        yield Case(f"{actor} {seed}", made.motion, annotation(made.truth), made.truth)


def drawn(
    takes: list[Exercise], seed: int, runs: int, repeats: tuple[int, int], actions: int = 5
) -> list[Exercise]:
    """Runs of an actor's exercises in random order; no action follows itself."""
    of_name: dict[str, list[Exercise]] = {}
    for exercise in takes:
        of_name.setdefault(exercise.name, []).append(exercise)
    rng = np.random.default_rng(seed)
    # Sorted first, so that the draw does not depend on the order of the files.
    names = rng.permutation(sorted(of_name))[:actions].tolist()
    order: list[str] = []
    while len(order) < runs:
        again = rng.permutation(names).tolist()
        if order and again[0] == order[-1]:
            again.append(again.pop(0))
        order += again
    parts = []
    for name in order[:runs]:
        count, found = int(rng.integers(repeats[0], repeats[1] + 1)), of_name[name]
        # None twice before each came once.
        places = rng.permutation(len(found))
        parts += [found[places[i % len(found)]] for i in range(count)]
    return parts


@cache
def exercises(actor: str) -> list[Exercise]:
    """What one actor of HDM05 did."""
    return [
        Exercise(kind, motion, REPETITIONS.get(kind, 1)) for _, kind, motion in cuts_of_hdm05(actor)
    ]


def cuts_of_hdm05(actor: str, *, every: int = 1) -> Iterator[tuple[str, str, Motion]]:
    """Name, class and motion of each ``HDM_<actor>_<class>_<number>_120.amc``."""
    folder = needed("hdm05")
    skeleton = folder / "asf" / f"HDM_{actor}.asf"
    for path in sorted((folder / "amc").glob(f"HDM_{actor}_*_120.amc"))[::every]:
        yield path.name, path.stem.split("_")[2], kineme.read(path, skeleton=skeleton)


def synthetic(condition: str, seeds: int) -> Iterator[Case]:
    """Walking between exercises, three to eight repetitions each, under a condition.

    ``speed``: each action at half to twice its speed; ``size``: bodies half to
    twice as large; ``noise``: every joint shakes by up to 2 cm; ``one hand``:
    waves and punches at half to full size are among the exercises. One seed, where it
    shall be quick.
    """
    for seed in range(few(seeds, 1)):
        rng = np.random.default_rng(seed)
        varied = {c: condition in (c, "all") for c in CONDITIONS}
        chosen = rng.permutation(EXERCISES)[:3].tolist()
        if varied["one hand"]:
            chosen = [*SMALL, next(name for name in chosen if name not in SMALL)]
        sequence = []
        for name in (name for exercise in chosen for name in ("walk", exercise)):
            small = varied["one hand"] and name in SMALL
            sequence.append(
                Action(
                    name,
                    int(rng.integers(3, 9)),
                    speed=_factor(rng) if varied["speed"] else 1.0,
                    amplitude=float(rng.uniform(0.5, 1)) if small else 1,
                    side=("left", "right")[rng.integers(2)],
                )
            )
        size = _factor(rng) if varied["size"] else 1.0
        noise = float(rng.uniform(0, 0.02)) if varied["noise"] else 0
        made = synthesize(sequence, fps=60, size=1.75 * size, noise=noise, seed=seed)
        yield Case(f"{condition} {seed}", made.motion, annotation(made.truth), made.truth)


def _factor(rng: np.random.Generator) -> float:
    """From a half to two, either way as likely."""
    return float(2 ** rng.uniform(-1, 1))


def annotation(truth: Segmentation) -> Truth:
    """A known truth in the form in which people's are: transitions are uncertain borders."""
    rows = truth.activities
    units = Counter(truth.primitives.activity.tolist())
    marks = Truth.from_labelling(make_labelling(rows, fps=truth.fps))
    counts = [units[row.activity] for row in rows if row.kind == "activity"]
    return replace(marks, counts=tuple(counts))


def by_recording(path: Path) -> dict[str, list[dict[str, str]]]:
    """Rows of a table by recording; none where there is no such table."""
    rows: dict[str, list[dict[str, str]]] = defaultdict(list)
    if path.exists():
        with path.open(encoding="utf-8", newline="") as file:
            for row in csv.DictReader(file):
                rows[row["recording"]].append(row)
    return rows
