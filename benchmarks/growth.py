"""How time and memory grow with the length of a recording.

    python benchmarks/growth.py [--hours 1 4] [--everywhere]

Features of the five trials, end to end over and over with a little noise, so
that no hour is like another. With ``max_lag`` 10 s unless ``--everywhere``.
Every size runs in a process of its own, first on a minute so that compiled
code is loaded; peak memory is the whole process's.
"""

from __future__ import annotations

import argparse
import os
import resource
import subprocess
import sys
import warnings
from pathlib import Path
from time import perf_counter

import numpy as np

import kineme
from _measure import verdict
from kineme.methods.presets import DEFAULT, PRESETS, PUBLISHED
from kineme.methods.recurrence.preset import RecurrencePreset
from kineme.segmentation.bodies import motion_features

DATA = Path(os.environ.get("KINEME_DATA", Path(__file__).resolve().parents[2] / "shared" / "data"))
TRIALS = ("86_01", "86_09", "86_10", "86_11", "86_14")
NOISE = 0.02  # of the spread of the features


def one(name: str, hours: float, max_lag: float | None) -> None:
    """Prints seconds and peak memory in GB of one run; meant for a process of its own."""
    preset = PRESETS[name].replace(max_lag=max_lag)
    once = np.concatenate(
        [motion_features(kineme.read(DATA / "cmu86" / f"{trial}.amc"), preset) for trial in TRIALS]
    )
    frames = round(hours * 3600 * preset.working_fps)
    features = np.resize(once, (frames, once.shape[1]))
    noise = np.random.default_rng(0)
    for part in np.array_split(features, max(1, frames // 10_000)):
        part[:] += noise.normal(0, NOISE * once.std(), part.shape)
    if isinstance(preset, RecurrencePreset):
        from kineme.methods.recurrence.analysis import analyze_actions as analyze_regions
    else:
        from kineme.methods.region_growing.analysis import analyze_regions as analyze
    analyze(features[: round(60 * preset.working_fps)], preset)
    start = perf_counter()
    found = analyze_regions(features, preset)
    took = perf_counter() - start
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1e6
    print(took, peak)
    stages = ", ".join(f"{stage} {seconds:.1f}" for stage, seconds in found.timings.items())
    print(stages, file=sys.stderr)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--hours", type=float, nargs="+", default=[1, 4])
    parser.add_argument("--presets", nargs="+", choices=PRESETS, default=[DEFAULT, *PUBLISHED])
    parser.add_argument("--everywhere", action="store_true", help="without max_lag")
    parser.add_argument("--one", action="store_true", help=argparse.SUPPRESS)
    options = parser.parse_args()
    if options.one:
        one(options.presets[0], options.hours[0], None if options.everywhere else 10.0)
        return
    for name in options.presets:
        first = None
        for hours in options.hours:
            command = [sys.executable, __file__, "--one", "--presets", name, "--hours", str(hours)]
            command += ["--everywhere"] * options.everywhere
            done = subprocess.run(command, check=True, capture_output=True, text=True)
            took, peak = map(float, done.stdout.split())
            line = f"{name:12} {hours:g} h: {took:.1f} s, {peak:.2f} GB"
            if first is None and hours == 1 and not options.everywhere:
                line += f"; s {verdict(took, 10)}, GB {verdict(peak, 1.5)}"
            if first is not None:
                line += f"; {took / first[1]:.2f} times {first[0]:g} h"
            if hours == 4 and first and first[0] == 1:
                line += f", {verdict(took / first[1], 4.5)}"
            first = first or (hours, took)
            print(line)
            print(f"  of which {done.stderr.strip()}")


if __name__ == "__main__":
    warnings.simplefilter("ignore")
    main()
