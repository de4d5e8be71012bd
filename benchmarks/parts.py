"""Are repetitions told apart where one action holds two movements, and only there?

    python benchmarks/parts.py [--seeds 30] [--record]

- **two depths**: synthetic recordings with squats at full and at half depth.
  Where they are found to be one action: how often the repetitions are in two
  clusters by depth, one that lies in both apart.
- **one movement**: actions of four repetitions or more that are divided, of
  synthetic recordings as they are and under all conditions, and of subject 86.
- **HDM05**: the same. Its sequences hold takes of an exercise several times over,
  which then are clusters by right.
"""

from __future__ import annotations

import warnings
from collections import Counter
from collections.abc import Iterable, Iterator

import numpy as np
from scipy.optimize import linear_sum_assignment

import kineme
from _figures import add_option, record
from _options import command_line, few
from _recordings import Case, hdm05, subject_86, synthetic
from kineme.datasets import Action, SyntheticRecording, synthesize
from kineme.segments.segmentation import Segmentation

LEAST = 4

Names = list[str]


def depths(seeds: int) -> Iterator[SyntheticRecording]:
    """Deep squats and shallow ones, three to six of each, between walking."""
    for seed in range(seeds):
        rng = np.random.default_rng(seed)
        squats = [
            Action("squat", int(rng.integers(3, 7)), amplitude=float(size))
            for size in rng.permutation([0.5, 1.0])
        ]
        yield synthesize([Action("walk", 4), *squats, Action("walk", 4)], fps=60, seed=seed)


def actions(found: Segmentation, truth: Segmentation | None) -> Iterator[tuple[Names, list[int]]]:
    """Where the repetitions of each action truly are, and their clusters."""
    rows = found.primitives.select(found.primitives.kind == "activity")
    names = [""] * len(rows)
    if truth is not None:
        middles = (rows.start_frame + rows.stop_frame) // 2
        at = np.searchsorted(truth.activities.start_frame, middles, side="right") - 1
        names = [f"{truth.activities[row].label} {row}" for row in at.tolist()]
    for action in np.unique(rows.action):
        own = np.flatnonzero(rows.action == action)
        yield [names[row] for row in own], rows.cluster[own].tolist()


def agreeing(names: Names, clusters: list[int]) -> int:
    """Repetitions in the cluster of their own movement, each movement with another cluster."""
    pairs = Counter(zip(names, clusters, strict=True))
    kinds, found = sorted(set(names)), sorted(set(clusters))
    counts = np.array([[pairs[name, cluster] for cluster in found] for name in kinds])
    return int(counts[linear_sum_assignment(-counts)].sum())


def two_depths(seeds: int) -> None:
    right = total = divided = joined = 0
    for made in depths(seeds):
        for names, clusters in actions(kineme.segment(made.motion), made.truth):
            squats = [name for name in names if name.startswith("squat")]
            if len(set(squats)) > 1:
                joined += 1
                divided += len(set(clusters)) > 1
                right += agreeing(names, clusters)
                total += len(names)
    print(
        f"two depths in one action: {divided} of {joined} divided, {right} of {total} repetitions"
    )
    record("parts.depths.divided", f"{divided} of {joined}")
    record("parts.depths.repetitions", f"{right} of {total}")


def one_movement(name: str, cases: Iterable[Case]) -> None:
    found = [each for case in cases for each in actions(kineme.segment(case.motion), case.made)]
    counted = [clusters for _, clusters in found if len(clusters) >= LEAST]
    divided = sum(len(set(clusters)) > 1 for clusters in counted)
    print(f"{name}: {divided} of {len(counted)} actions divided")
    record(f"parts.{name.replace(' ', '_')}", f"{divided} of {len(counted)}")


def main() -> None:
    parser = command_line(__doc__)
    parser.add_argument("--seeds", type=int, default=few(30, 1))
    add_option(parser)
    seeds = parser.parse_args().seeds
    two_depths(seeds)
    one_movement("as it is", synthetic("as it is", seeds))
    one_movement("all", synthetic("all", seeds))
    one_movement("subject 86", subject_86())
    one_movement("HDM05", hdm05(seeds))


if __name__ == "__main__":
    warnings.simplefilter("ignore")
    main()
