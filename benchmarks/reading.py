"""How long reading takes, kinematics included, beside the bare split into words.

    python benchmarks/reading.py [FOLDER OF RECORDINGS]

Prints the median of nine runs per file. The last column is the ratio to
``bytes.split`` on the same data in the same run, which does not depend on the
machine as seconds do.
"""

from __future__ import annotations

import os
import sys
import warnings
from collections.abc import Callable
from pathlib import Path
from statistics import median
from time import perf_counter

from kineme.formats import read

FILES = ("cmu86/86_10.amc", "cmu_formats/49_02.bvh", "formats/aitviewer_sample.bvh")
RUNS = 9


def seconds(work: Callable[[], object]) -> float:
    def once() -> float:
        start = perf_counter()
        work()
        return perf_counter() - start

    once()
    return median(once() for _ in range(RUNS))


def main() -> None:
    beside = Path(__file__).resolve().parents[2] / "shared" / "data"
    folder = Path(sys.argv[1] if len(sys.argv) > 1 else os.environ.get("KINEME_DATA", beside))
    print(f"{'file':30} {'MB':>5} {'frames':>7} {'seconds':>8} {'MB/s':>6} {'x split':>8}")
    for name in FILES:
        path = folder / name
        data = path.read_bytes()
        size = len(data) / 1e6
        took, bare = seconds(lambda path=path: read(path)), seconds(data.split)
        frames = read(path).n_frames
        print(
            f"{name:30} {size:5.1f} {frames:7d} {took:8.3f} {size / took:6.1f} {took / bare:8.1f}"
        )


if __name__ == "__main__":
    warnings.simplefilter("ignore")
    main()
