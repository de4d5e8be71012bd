"""Seconds that feature bundling takes, and how far its result lies from the program's.

    python -m benchmarks bundling [--data ../shared/data]

Least of twenty runs per trial, all available cores. The promise is half a second
for 2,000 frames, at the rate of the slowest trial. Differences are Euclidean
over the 75 stacked features, in centimetres, to the program's own bundled
features. Exits with 1 if the promise is not kept.
"""

from __future__ import annotations

import sys
import time
from pathlib import Path

import numpy as np

import kineme
from _options import DATA, command_line, few, is_quick, needed
from agreement import TRIALS
from kineme.features.bundling import bundle
from kineme.methods.region_growing.preset import KRUEGER2017
from kineme.segmentation.bodies import motion_features

PROMISED_S = 0.5
PROMISED_FRAMES = 2000


def main() -> int:
    parser = command_line(__doc__)
    parser.add_argument("--data", type=Path, default=DATA)
    folder = needed("cmu86", parser.parse_args().data)
    print(f"{'trial':8}{'frames':>7}{'seconds':>9}{'moved':>8}{'median':>8}{'95 %':>7}{'most':>7}")
    slowest = 0.0
    for trial in few(TRIALS, TRIALS[:1]):
        features = 100 * motion_features(kineme.read(folder / f"{trial}.amc"), KRUEGER2017)
        seconds = []
        for _ in range(few(20, 2)):
            start = time.perf_counter()
            bundled = bundle(features)
            seconds.append(time.perf_counter() - start)
        with np.load(folder / "reference" / f"2017_bundled_{trial}.npz") as stored:
            apart = np.linalg.norm(bundled - stored["features"].T, axis=1)
        moved = np.linalg.norm(bundled - features, axis=1).mean()
        median, most_of, most = np.percentile(apart, [50, 95, 100])
        print(
            f"{trial:8}{len(features):7}{min(seconds):9.3f}{moved:8.2f}"
            f"{median:8.2f}{most_of:7.2f}{most:7.2f}"
        )
        slowest = max(slowest, min(seconds) / len(features) * PROMISED_FRAMES)
    kept = slowest <= PROMISED_S
    print(
        f"{PROMISED_FRAMES} frames: {slowest:.3f} s at most, promised {PROMISED_S:g} s, "
        f"{'kept' if kept else 'NOT KEPT'}"
    )
    return 0 if kept or is_quick() else 1


if __name__ == "__main__":
    sys.exit(main())
