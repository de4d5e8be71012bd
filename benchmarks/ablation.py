"""What each stage of `kineme` contributes: each switched off in turn, scored as in fairness.py.

    python benchmarks/ablation.py [--every 5]

A stage is switched off as closely as its constants allow, or by what it would
hand on if it had found nothing to do.
"""

from __future__ import annotations

import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any
from unittest.mock import patch

import numpy as np

from _options import command_line
from _recordings import hdm05, subject_86, synthetic
from fairness import show
from kineme.methods.recurrence import activities, change_points, transitions
from kineme.methods.recurrence.actions import Actions
from kineme.methods.recurrence.preset import KINEME
from kineme.methods.segments import by_first_appearance
from sensitivity import at_working_rate, scores


def not_refined(borders: Any, labels: Any, *_: Any, **__: Any) -> Actions:
    """The segments as they are, neighbours of one action as one."""
    first = np.concatenate([[True], labels[1:] != labels[:-1]])
    kept = by_first_appearance(labels[first])
    return Actions(np.append(borders[:-1][first], borders[-1]), kept, np.ones(len(kept)))


def not_slowest(_: Any, first: int, last: int) -> int:
    return (first + last) // 2


STAGES: dict[str, tuple[dict[str, Any], list[Any]]] = {
    "as it is": ({}, []),
    "one phase window": ({"phase_shares": (1.0,)}, []),
    "no phase window": ({"phase": 0.0}, []),
    "one scale for all": ({"min_scale": 0.12, "max_scale": 0.12}, []),
    "no narrow window": ({"narrow_share": 1.0, "distinct_share": 0.0}, []),
    "short ones not divided": ({"distinct_share": 0.0}, []),
    "parts not merged": (
        {},
        [patch.object(change_points, "merge_neighbors", lambda b, *_, **__: b)],
    ),
    "actions not linked": ({"link_similarity": 1.0}, []),
    "linked at one pace": ({"any_pace": False}, []),
    "samples not given anew": ({}, [patch.object(activities, "refine", not_refined)]),
    "no transitions at ends": ({"max_transition": 0.0}, []),
    "one vote on their length": ({"transition_spread": 0.0}, []),
    "not cut where slowest": ({}, [patch.object(transitions, "_slowest", not_slowest)]),
    "poses not stacked": ({"offsets": (0.0,)}, []),
}


@contextmanager
def without(patches: list[Any]) -> Iterator[None]:
    for change in patches:
        change.start()
    try:
        yield
    finally:
        for change in patches:
            change.stop()


def main() -> None:
    parser = command_line(__doc__)
    parser.add_argument("--every", type=int, default=1, help="one in so many seeds")
    every = parser.parse_args().every
    sets = {
        "subject 86": subject_86(),
        "HDM05": hdm05(50 // every),
        "synthetic, speed": synthetic("speed", 50 // every),
        "synthetic, all": synthetic("all", 50 // every),
    }
    for title, recordings in sets.items():
        cases = at_working_rate(recordings)
        rows = {}
        for stage, (constants, patches) in STAGES.items():
            with without(patches):
                rows[stage] = scores(cases, KINEME.replace(**constants))
        show(title, rows)


if __name__ == "__main__":
    warnings.simplefilter("ignore")
    main()
