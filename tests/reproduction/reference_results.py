"""The reference results of the benchmark as labellings, for the golden tests."""

from __future__ import annotations

import json
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np

from kineme.evaluation import TRANSITION, Labelling

TRIALS = ("86_01", "86_09", "86_10", "86_11", "86_14")
CONFIGURATIONS = (
    "2014_paper",
    "2014_program_e75",
    "2017_plain",
    "2017_evaluation_1",
    "2017_evaluation_2",
    "2017_mirrored",
    "2017_bundled",
    "2017_bundled_mirrored",
    "2017_program_defaults",
)


def reference(data_dir: Path, configuration: str, trial: str) -> dict[str, Any]:
    path = data_dir / "cmu86" / "reference" / f"{configuration}_{trial}.json"
    return json.loads(path.read_text())


def from_one(cuts: list[int], frames: int, labels: list[object] | None = None) -> Labelling:
    """Cuts counted from 1 at 30 Hz, as the reference files have them."""
    return Labelling.from_cuts(np.array(cuts, np.int64) - 1, labels, frames=frames, fps=30.0)


def activities(result: dict[str, Any]) -> Labelling:
    """Activities as the authors' programs find them, each with a label of its own.

    What lies between a forward and the next backward cut is called a
    transition where it is shorter than 1 s.
    """
    cuts = result["activity_cuts"]
    labels = [
        TRANSITION if short else str(i) for i, (_, _, short) in enumerate(_activity_spans(result))
    ]
    return from_one(cuts, result["frames"], labels)


def clusters(result: dict[str, Any]) -> Labelling:
    """Clusters as the authors' programs find them.

    Transitions: as above, and what is alone in its cluster and shorter than 2 s.
    """
    borders = [1, *result["all_cuts"], result["frames"]]
    numbers = result["clusters"]
    labels = []
    for number, start, stop in zip(numbers, borders, borders[1:]):
        between = any(a <= start and stop <= b and short for a, b, short in _activity_spans(result))
        alone = numbers.count(number) == 1 and stop - start < 60
        labels.append(TRANSITION if between or alone else str(number))
    return from_one(result["all_cuts"], result["frames"], labels)


def _activity_spans(result: dict[str, Any]) -> list[tuple[int, int, bool]]:
    borders = [1, *result["activity_cuts"], result["frames"]]
    forward, backward = set(result["forward_cuts"]), set(result["backward_cuts"])
    return [
        (start, stop, start in forward and stop in backward and stop - start < 30)
        for start, stop in pairwise(borders)
    ]
