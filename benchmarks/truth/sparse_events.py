"""Events that recur now and then: how many are found, beside what is promised.

    python -m benchmarks sparse_events [--seeds 50] [--record]

HDM05 exercises at irregular times among walking and other movement (see
``_sparse_recordings``). Each exercise has the cluster, on the primitive level,
that holds most of its events at an overlap (intersection over union) of a half.

- **recall**: share of the events found by the cluster of their exercise.
- **precision**: of the primitives that lie mostly in events, the share that are
  such finds.
- **false sets**: clusters of at least two primitives per minute, in the same
  recordings cut into blocks of half a second, shuffled, every other one reversed.
"""

from __future__ import annotations

import warnings
from collections import Counter

import numpy as np
from scipy.optimize import linear_sum_assignment

import kineme
from _figures import add_option, record
from _options import command_line, few
from _sparse_recordings import SparseCase, shuffled, sparse_events
from kineme.methods.presets import PRESETS
from kineme.segments.segmentation import Segmentation
from kineme.segments.table import SegmentTable

PROMISED = {"recall": 0.80, "precision": 0.90, "false sets per minute": 0.05}
OVERLAP = 0.5


def found_units(found: Segmentation) -> SegmentTable:
    """What the primitive level says recurs."""
    rows = found.primitives
    return rows[(rows.kind == "primitive") & (rows.cluster >= 0)]


def matches(case: SparseCase, rows: SegmentTable) -> tuple[int, int]:
    """Events that are found, and primitives that lie mostly in events."""
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


def false_sets(found: Segmentation) -> int:
    """Clusters of at least two primitives."""
    return sum(n > 1 for n in Counter(found_units(found).cluster.tolist()).values())


def main() -> None:
    parser = command_line(__doc__)
    parser.add_argument("--seeds", type=int, default=few(50, 1))
    add_option(parser)
    variants = {name: PRESETS[name] for name in ("kineme", "voegele2014", "krueger2017")}
    sums = {name: Counter[str]() for name in variants}
    for seed, case in enumerate(sparse_events(parser.parse_args().seeds)):
        noise = shuffled(case.motion, seed)
        for name, preset in variants.items():
            found = kineme.segment(case.motion, preset=preset)
            right, inside = matches(case, found_units(found))
            sums[name] += Counter(
                events=len(case.events),
                right=right,
                inside=inside,
                sets=false_sets(kineme.segment(noise, preset=preset)),
                frames=noise.n_frames,
            )
    print(f"{'':26}" + "".join(f"{name:>24}" for name in PROMISED))
    for name, total in sums.items():
        scores = {
            "recall": total["right"] / total["events"],
            "precision": total["right"] / max(total["inside"], 1),
            "false sets per minute": total["sets"] / (total["frames"] / 120 / 60),
        }
        print(f"{name:26}" + "".join(f"{value:24.3f}" for value in scores.values()))
        for measure, value in scores.items():
            record(f"sparse_events.{name}.{measure.replace(' ', '_')}", value)
    print(f"{'promised':26}" + "".join(f"{value:24.3f}" for value in PROMISED.values()))


if __name__ == "__main__":
    warnings.simplefilter("ignore")
    main()
