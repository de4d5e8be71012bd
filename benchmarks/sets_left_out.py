"""Constants of the method for sensors, chosen with each set of recordings left out.

    python benchmarks/sets_left_out.py [--only CONSTANT ...] [--together] [--every N]

One constant after the other, or all values of all of them ``--together``: the mean of MoF, Edit
and F1@50 of each value on each set. Then, for each set, the value that is best in the mean of
all others, and what the set loses with it: in that mean, and in the figure that loses most. The
value shown is in the middle of those within 0.3 of the best. ``--every N`` takes every so manieth
recording of HuGaDB.
"""

from __future__ import annotations

import warnings
from collections.abc import Mapping, Sequence
from concurrent.futures import ProcessPoolExecutor
from functools import partial
from itertools import product
from multiprocessing import get_context
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from _options import DATA, command_line, few, needed
from _plateau import middle_of_best
from kineme.evaluation.comparison import Comparison, compare
from kineme.evaluation.recordings import recordings_below
from kineme.evaluation.score import over_all, scores
from kineme.labels.collections import LabelSource, labels_of
from kineme.methods.hierarchy.preset import SENSORS
from kineme.segmentation.segmenter import segment
from sets import READING, SETS

VALUES: dict[str, tuple[float, ...]] = {
    "segment_cost": (0.1, 0.125, 0.15, 0.175, 0.2),
    "cluster_cost": (0.54, 0.6, 0.66, 0.72, 0.78),
    "cluster_growth": (0.1, 0.15, 0.2, 0.25, 0.3),
    "spread_share": (0.25, 0.4, 0.5, 0.6, 0.75),
    "border_shift": (0.0, 0.3, 0.4, 0.5, 0.7),
}
TRIED = few(list(VALUES), ["segment_cost"])
JUDGED = ("mof", "edit", "f1@50")
PLATEAU = 0.3

Floats = NDArray[np.float64]
Changed = Mapping[str, float]
Source = tuple[Path, LabelSource]


def compared(source: Source, changed: Sequence[Changed]) -> list[Comparison]:
    """A recording by each choice of constants, and its truth."""
    warnings.simplefilter("ignore")
    path, labels = source
    recording = READING.read(path)
    truth = labels.of(n_frames=recording.n_frames, fps=recording.fps)
    return [compare(truth, segment(recording, preset=SENSORS.replace(**each))) for each in changed]


def judged(found: Sequence[Comparison]) -> list[float]:
    """What is judged, of a set, in percent."""
    return [100 * over_all([scores()[key].function(one) for one in found]) for key in JUDGED]


def show(tried: Sequence[Changed], figures: Floats) -> None:
    """Of figures (sets, values, judged): the table, and what each set loses when left out."""
    means = figures.mean(axis=2)
    shipped = next(
        i for i, each in enumerate(tried) if all(getattr(SENSORS, k) == v for k, v in each.items())
    )
    print("\n" + " ".join(f"{name:>15}" for name in tried[0]) + "".join(map("{:>10}".format, SETS)))
    for each, row in zip(tried, means.T, strict=True):
        values = " ".join(f"{value:15g}" for value in each.values())
        print(values + "".join(f"{cell:10.1f}" for cell in row) + f"{row.mean():10.1f}")
    for i, name in enumerate(SETS):
        at = middle_of_best(np.delete(means, i, axis=0).mean(axis=0).tolist(), PLATEAU)
        lost = figures[i, shipped] - figures[i, at]
        chosen = ", ".join(f"{key} {value:g}" for key, value in tried[at].items())
        print(
            f"without {name}: {chosen}; it loses {lost.mean():.1f} in the mean, "
            f"{lost.max():.1f} of {JUDGED[int(lost.argmax())]}",
            flush=True,
        )


def main() -> None:
    parser = command_line(__doc__)
    parser.add_argument("--only", nargs="+", choices=VALUES, default=TRIED)
    parser.add_argument("--together", action="store_true", help="all values of all of them")
    parser.add_argument("--every", type=int, default=1, help="recordings of HuGaDB")
    parser.add_argument("--processes", type=int, default=few(2, 1))
    parser.add_argument("--data", type=Path, default=DATA)
    options = parser.parse_args()
    sources = []
    for name in SETS:
        folder = needed(f"sets/{name}", options.data)
        labels = labels_of(recordings_below(folder / "recordings"), folder / "labels.csv")
        every = options.every if name == "hugadb" else 1
        sources.append(list(labels.items())[::every][: few(None, 1)])
    groups = [options.only] if options.together else [[name] for name in options.only]
    with ProcessPoolExecutor(options.processes, mp_context=get_context("spawn")) as pool:
        for group in groups:
            chosen = product(*(VALUES[name] for name in group))
            tried = [dict(zip(group, values, strict=True)) for values in chosen]
            work = partial(compared, changed=tried)
            found = [list(pool.map(work, of_set)) for of_set in sources]
            figures = [[judged(of_value) for of_value in zip(*each, strict=True)] for each in found]
            show(tried, np.array(figures))


if __name__ == "__main__":
    main()
