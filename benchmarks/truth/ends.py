"""Are the first and the last repetition of an activity as long as they are?

    python -m benchmarks ends [--seeds 50] [--record]

On synthetic recordings (see ``_recordings.synthetic``): by how much a repetition is
longer than the true one, as mean and standard deviation over all activities with
three repetitions or more that are counted right; the first and the last (the ends)
and the inner ones apart. Exits with 1 if the promise is not kept.
"""

from __future__ import annotations

import sys
import warnings
from collections import defaultdict

import numpy as np
from numpy.typing import NDArray

import kineme
from _figures import add_option, record
from _options import command_line, few, is_quick
from _recordings import synthetic
from kineme.segments.segmentation import Segmentation

PROMISED = 3, 6  # per cent: mean of the ends at most so far from 0, and their deviation
SHOWN = ("as it is", "all")
LEAST = 3

Floats = NDArray[np.float64]


def spans(found: Segmentation) -> list[Floats]:
    """First and last second of the repetitions of each activity."""
    rows = found.primitives.select(found.primitives.kind == "primitive")
    return [
        np.column_stack([rows.start_s, rows.stop_s])[rows.activity == activity]
        for activity in np.unique(rows.activity)
    ]


def excesses(truth: Segmentation, found: Segmentation) -> dict[str, list[float]]:
    """By which share repetitions are longer than the true ones, by their place in the activity."""
    true, by_place = spans(truth), defaultdict(list)
    for repetitions in spans(found):
        start, stop = repetitions[0, 0], repetitions[-1, 1]
        known = max(true, key=lambda each: min(each[-1, 1], stop) - max(each[0, 0], start))
        if not LEAST <= len(repetitions) == len(known):
            continue
        longer = np.diff(repetitions, axis=1)[:, 0] / np.diff(known, axis=1)[:, 0] - 1
        by_place["first"].append(longer[0])
        by_place["inner"] += longer[1:-1].tolist()
        by_place["last"].append(longer[-1])
    return by_place


def main() -> int:
    parser = command_line(__doc__)
    parser.add_argument("--seeds", type=int, default=few(50, 2))
    add_option(parser)
    seeds = parser.parse_args().seeds
    kept = True
    for condition in SHOWN:
        found: dict[str, list[float]] = defaultdict(list)
        for case in synthetic(condition, seeds):
            for place, values in excesses(case.made, kineme.segment(case.motion)).items():
                found[place] += values
        found = {"ends": found["first"] + found["last"], **found}
        for place in ("ends", "first", "last", "inner"):
            mean, deviation = (100 * f(found[place]) for f in (np.mean, np.std))
            print(
                f"{condition:9} {place:6} {mean:+5.1f} ± {deviation:4.1f} % of {len(found[place])}"
            )
            if place == "ends":
                kept &= abs(mean) <= PROMISED[0] and deviation <= PROMISED[1]
                name = f"ends.{condition.replace(' ', '_')}"
                record(f"{name}.mean", float(mean), unit="%")
                record(f"{name}.deviation", float(deviation), unit="%")
    promise = f"{-PROMISED[0]} to {PROMISED[0]} ± {PROMISED[1]} %"
    print(f"promised of the ends: {promise}: {'kept' if kept else 'NOT KEPT'}")
    return 0 if kept or is_quick() else 1


if __name__ == "__main__":
    warnings.simplefilter("ignore")
    sys.exit(main())
