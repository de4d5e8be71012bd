"""Constants of the method for bodies, chosen with each source of recordings left out.

    python benchmarks/left_out.py [--every 4] [--only CONSTANT ...]

Each constant of `VALUES` by itself: mean of one-to-one accuracy and border F1 (and of the share
of counts that are exact, where counts are known) of each value on subject 86, HDM05 sequences,
synthetic recordings at different speeds, and short exercises back to back and with somebody
standing between them; and mean of recall and precision of sparse events. Then, for each source,
the value that is best on all others, and what the source loses with it. The values shown as chosen
are in the middle of those within 0.005 of the best.
"""

from __future__ import annotations

import warnings
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

import short_exercises
from _options import command_line, few
from _plateau import middle_of_best
from _recordings import Case, hdm05, subject_86, synthetic
from _sparse_recordings import SparseCase, sparse_events
from kineme.evaluation import evaluate_segmentation
from kineme.methods.recurrence.preset import KINEME, RecurrencePreset
from kineme.recordings.operations import resample
from kineme.segmentation.segmenter import segment
from sensitivity import at_working_rate
from sparse_events import found_units, matches

VALUES = {
    "narrow_share": (0.45, 0.5, 0.55, 0.6, 0.65, 0.7),
    "distinct_share": (0.5, 0.6, 0.65, 0.7, 0.8),
    "link_gap": (0.15, 0.2, 0.25, 0.3, 0.4),
    "sure_pace": (0.0, 0.75, 0.8, 0.9, 1.0),
    "min_periodic": (0.35, 0.5, 0.55, 0.6, 0.75),
    "link_common": (0.25, 0.3, 0.35, 0.4, 0.45),
    "pair_factor": (1.0, 1.5, 2.0, 2.5, 3.0),
    "max_stand": (1.0, 1.5, 2.0, 3.0, 4.0),
    "whole_share": (0.1, 0.2, 0.3, 0.4, 0.5),
    "few_activities": (2, 3, 4, 5, 6),
    "end_scatter": (1.0, 1.5, 2.0, 3.0, 4.0),
    "uneven_cost": (0.0, 0.1, 0.2, 0.3, 0.4),
}
TRIED = few(list(VALUES), ["narrow_share"])
JUDGED = ("one_to_one", "border_f1", "count_exact")
PLATEAU = 0.005
EVENTS = "sparse events"


def goodness(cases: Sequence[Case], preset: RecurrencePreset) -> float:
    """Mean of what is judged, where it is known."""
    rows = [
        evaluate_segmentation(case.truth, segment(case.motion, preset=preset)) for case in cases
    ]
    return float(np.mean([[row[name] for name in JUDGED if name in row] for row in rows]))


def eventfulness(cases: Sequence[SparseCase], preset: RecurrencePreset) -> float:
    """Mean of recall and precision of events."""
    events = found = inside = 0
    for case in cases:
        right, told = matches(case, found_units(segment(case.motion, preset=preset)))
        events, found, inside = events + len(case.events), found + right, inside + told
    return (found / events + found / max(inside, 1)) / 2


def slowly(case: SparseCase) -> SparseCase:
    """The same with the frames that the preset looks at."""
    motion = resample(case.motion, KINEME.working_fps)
    ratio = case.motion.fps / motion.fps
    events = tuple(
        replace(e, start=round(e.start / ratio), stop=round(e.stop / ratio)) for e in case.events
    )
    return replace(case, motion=motion, events=events)


def main() -> None:
    parser = command_line(__doc__)
    parser.add_argument("--every", type=int, default=1, help="one in so many seeds")
    parser.add_argument("--only", nargs="+", choices=VALUES, default=TRIED)
    options = parser.parse_args()
    every = options.every
    back_to_back, standing = short_exercises.CONDITIONS
    sources = {
        "subject 86": subject_86(),
        "HDM05": hdm05(24 // every),
        "synthetic": synthetic("speed", 24 // every),
        back_to_back: short_exercises.cases(back_to_back, 24 // every),
        standing: short_exercises.cases(standing, 24 // every),
    }
    recordings = {name: at_working_rate(cases) for name, cases in sources.items()}
    sparse = [slowly(case) for case in sparse_events(24 // every)]

    def judged(preset: RecurrencePreset) -> list[float]:
        """Of each source."""
        return [
            *(goodness(cases, preset) for cases in recordings.values()),
            eventfulness(sparse, preset),
        ]

    for constant in options.only:
        values = VALUES[constant]
        table = np.array([judged(KINEME.replace(**{constant: value})) for value in values]).T
        print(f"\n{constant:18}" + "".join(f"{value:8g}" for value in values) + "  left out: loss")
        for row, name in enumerate([*recordings, EVENTS]):
            others = np.delete(table, row, axis=0).mean(axis=0)
            chosen = middle_of_best(others.tolist(), PLATEAU)
            loss = table[row, values.index(getattr(KINEME, constant))] - table[row, chosen]
            cells = "".join(f"{score:8.3f}" for score in table[row])
            print(f"{name:18}{cells}  {values[chosen]:g}: {loss:+.3f}")
        print(f"{'mean':18}" + "".join(f"{score:8.3f}" for score in table.mean(axis=0)), flush=True)


if __name__ == "__main__":
    warnings.simplefilter("ignore")
    main()
