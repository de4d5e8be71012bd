"""Provide recordings with known truth: subject 86, HDM05 sequences and synthetic recordings."""

from __future__ import annotations

import csv
from collections import Counter, defaultdict
from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import cache
from pathlib import Path

import numpy as np

import kineme
from _options import DATA, choose_size, find_data
from _sequences import Exercise, join_exercises
from kineme.datasets import ACTIONS, Action, synthesize
from kineme.evaluation import Truth, make_labelling
from kineme.recordings import Motion
from kineme.segments.segmentation import Segmentation
from kineme_reproduction.trials import find_folder, load_trials

TRIALS = ("86_01", "86_09", "86_10", "86_11", "86_14")

ACTORS = ("bd", "bk", "dg")
N_EXERCISES = 5
"""Number of exercises in a sequence."""
# HDM05 counts single steps in the class name: four steps are two repetitions.
REPETITIONS = {"jogLeftCircle4StepsRstart": 2}

EXERCISES = [name for name in ACTIONS if name not in ("walk", "stand")]
SMALL = ("wave", "punch")
CONDITIONS = ("as it is", "speed", "size", "noise", "one hand", "all")


@dataclass(frozen=True)
class Case:
    """A recording and its truth."""

    name: str
    motion: Motion
    truth: Truth
    made: Segmentation | None = None
    """The truth with all repetitions, if the recording was made from parts."""


def read_subject_86() -> list[Case]:
    """Read the five trials of the published benchmark (quick: two)."""
    find_data("cmu86")
    trials = load_trials(find_folder(DATA), choose_size(TRIALS, TRIALS[:2]))
    return [Case(trial.name, trial.motion, trial.truth) for trial in trials]


def join_hdm05(
    seeds: int, *, first: int = 0, runs: int = 8, repeats: tuple[int, int] = (3, 6)
) -> Iterator[Case]:
    """Join HDM05 exercises to sequences, actors in turn (quick: one short sequence)."""
    runs = choose_size(runs, 4)
    for seed in range(first, first + choose_size(seeds, 1)):
        actor = ACTORS[seed % len(ACTORS)]
        made = join_exercises(draw_exercises(read_exercises(actor), seed, runs, repeats))
        yield Case(f"{actor} {seed}", made.motion, make_truth(made.truth), made.truth)


def draw_exercises(
    takes: dict[str, list[Exercise]], seed: int, runs: int, repeats: tuple[int, int]
) -> list[Exercise]:
    """Draw runs of five exercises in random order; none follows itself."""
    rng = np.random.default_rng(seed)
    # Sorted, so that the result does not depend on the order of the files.
    names = rng.permutation(sorted(takes))[:N_EXERCISES].tolist()
    order: list[str] = []
    while len(order) < runs:
        again = rng.permutation(names).tolist()
        if order and again[0] == order[-1]:
            again.append(again.pop(0))
        order += again
    return [part for name in order[:runs] for part in draw_takes(takes[name], repeats, rng)]


def draw_takes(
    takes: list[Exercise], counts: tuple[int, int], rng: np.random.Generator
) -> list[Exercise]:
    """Draw some takes of one exercise; each is used once before any is used again."""
    count = int(rng.integers(counts[0], counts[1] + 1))
    order = rng.permutation(len(takes))
    return [takes[order[i % len(takes)]] for i in range(count)]


@cache
def read_exercises(actor: str) -> dict[str, list[Exercise]]:
    """Read the takes of each exercise of one actor of HDM05."""
    takes: dict[str, list[Exercise]] = {}
    for _, name, motion in read_hdm05(actor):
        exercise = Exercise(name, motion, REPETITIONS.get(name, 1))
        takes.setdefault(name, []).append(exercise)
    return takes


def read_hdm05(actor: str, *, every: int = 1) -> Iterator[tuple[str, str, Motion]]:
    """Yield name, class and motion of each ``HDM_<actor>_<class>_<number>_120.amc``."""
    folder = find_data("hdm05")
    skeleton = folder / "asf" / f"HDM_{actor}.asf"
    for path in sorted((folder / "amc").glob(f"HDM_{actor}_*_120.amc"))[::every]:
        yield path.name, path.stem.split("_")[2], kineme.read(path, skeleton=skeleton)


def synthesize_cases(condition: str, seeds: int) -> Iterator[Case]:
    """Synthesize exercises with walking between them, three to eight repetitions each.

    Conditions: ``speed`` varies each action's speed from half to twice; ``size`` the size of the
    body likewise; ``noise`` moves every joint by up to 2 cm; ``one hand`` adds waves and punches
    of half to full size; ``all`` combines these. Quick: one seed.
    """
    for seed in range(choose_size(seeds, 1)):
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
                    speed=_draw_factor(rng) if varied["speed"] else 1.0,
                    amplitude=float(rng.uniform(0.5, 1)) if small else 1,
                    side=("left", "right")[rng.integers(2)],
                )
            )
        size = _draw_factor(rng) if varied["size"] else 1.0
        noise = float(rng.uniform(0, 0.02)) if varied["noise"] else 0
        made = synthesize(sequence, fps=60, size=1.75 * size, noise=noise, seed=seed)
        yield Case(f"{condition} {seed}", made.motion, make_truth(made.truth), made.truth)


def _draw_factor(rng: np.random.Generator) -> float:
    """Draw a factor from 0.5 to 2, evenly on a logarithmic scale."""
    return float(2 ** rng.uniform(-1, 1))


def make_truth(truth: Segmentation) -> Truth:
    """Convert a known truth to the form of annotations: transitions become uncertain borders."""
    rows = truth.activities
    units = Counter(truth.primitives.activity.tolist())
    marks = Truth.from_labelling(make_labelling(rows, fps=truth.fps))
    counts = [units[row.activity] for row in rows if row.kind == "activity"]
    return replace(marks, counts=tuple(counts))


def read_rows(path: Path) -> dict[str, list[dict[str, str]]]:
    """Return the rows of a CSV by recording; empty if the file does not exist."""
    rows: dict[str, list[dict[str, str]]] = defaultdict(list)
    if path.exists():
        with path.open(encoding="utf-8", newline="") as file:
            for row in csv.DictReader(file):
                rows[row["recording"]].append(row)
    return rows
