"""Score the preset ``series`` on time series that are mostly not movement.

    python -m benchmarks series [--preset NAME] [--record]

Uses half of TSSB and UTSA (Ermshaus, Schäfer and Leser 2023) with the scores of their authors:
*covering*, the best overlap of each true segment, weighted by its length, and the adjusted mutual
information of states. Published on all series: covering CLaP .85 and .84, BinSeg .59 and .66; AMI
CLaP .78 and .77.
"""

from __future__ import annotations

import warnings
from collections.abc import Iterator
from itertools import islice
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from sklearn.metrics import adjusted_mutual_info_score

import kineme
from _figures import add_option, record
from _options import choose_size, find_data, make_parser
from kineme.evaluation import Comparison, covering

Frames = NDArray[np.int64]
ARCHIVES = ("tssb", "utsa")


def read_series(folder: Path) -> Iterator[tuple[NDArray[np.float64], Frames, list[str]]]:
    """Yield the values, state borders and state names of each series."""
    states = {name: rest for name, *rest in split_lines(folder / "properties.txt")}
    for name, _, *changes in split_lines(folder / "desc.txt"):
        if (path := folder / f"{name}.txt").exists():
            values = np.loadtxt(path)
            # The states are the last columns.
            named = states[name][-len(changes) - 1 :]
            yield values, np.array([0, *map(int, changes), len(values)]), named


def split_lines(path: Path) -> Iterator[list[str]]:
    return (line.split(",") for line in path.read_text().split())


def main() -> None:
    parser = make_parser(__doc__)
    parser.add_argument("--preset", default="series")
    add_option(parser)
    options = parser.parse_args()
    print(f"{'':8}{'series':>8}{'covering':>10}{'AMI':>8}{'borders / true':>16}")
    for name in ARCHIVES:
        rows = []
        for values, ends, states in islice(
            read_series(find_data(f"timeseries/{name}")), choose_size(None, 1)
        ):
            table = kineme.segment(values, fps=1.0, preset=options.preset).activities
            numbers = np.unique(states, return_inverse=True)[1]
            true = np.repeat(numbers, np.diff(ends))
            clusters = np.repeat(table.cluster, table.stop_frame - table.start_frame)
            covered = covering(Comparison(true, clusters, 1.0))
            agreement = adjusted_mutual_info_score(true, clusters)
            rows.append((covered, agreement, len(table) / len(states)))
        means = np.mean(rows, axis=0)
        print(f"{name:8}{len(rows):8}{means[0]:10.3f}{means[1]:8.3f}{means[2]:16.2f}")
        record(f"series.{name}.covering", means[0])
        record(f"series.{name}.ami", means[1])


if __name__ == "__main__":
    warnings.simplefilter("ignore")
    main()
