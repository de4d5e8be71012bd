"""Measure how time and memory grow with the length of a recording.

    python -m benchmarks growth [--hours 1 4] [--presets kineme ...] [--record]

The input is the features of the five trials, repeated with some noise, so that no two hours are
equal. The published methods with ``max_lag`` 10 s; `kineme` as it is.
Each length runs in its own process, first on one minute to load compiled code; peak memory is
that of the process. Seconds are wall time, so stop other programs before ``--record``.

Limits: an hour by `kineme` in 3 s and 0.5 GB, four in 4.2 times that.
"""

from __future__ import annotations

import argparse
import resource
import subprocess
import sys
import warnings
from collections.abc import Sequence
from time import perf_counter

import numpy as np
from numpy.typing import NDArray

import kineme
from _figures import add_option, record
from _measure import judge
from _options import QUICK, choose_size, find_data, make_parser
from kineme.methods.base import Preset
from kineme.methods.prepare import compute_motion_features
from kineme.methods.presets import DEFAULT, PRESETS, PUBLISHED

TRIALS = ("86_01", "86_09", "86_10", "86_11", "86_14")
NOISE = 0.02  # share of the standard deviation of the features
MAX_LAG_S = 10.0


def make_features(preset: Preset, hours: float) -> NDArray[np.float64]:
    """Repeat the features of the trials for so many hours, with noise."""
    folder = find_data("cmu86")
    once = np.concatenate(
        [
            compute_motion_features(kineme.read(folder / f"{trial}.amc"), preset)
            for trial in choose_size(TRIALS, TRIALS[:1])
        ]
    )
    frames = round(hours * 3600 * preset.working_fps)
    features = np.resize(once, (frames, once.shape[1]))
    noise = np.random.default_rng(0)
    for part in np.array_split(features, max(1, frames // 10_000)):
        part[:] += noise.normal(0, NOISE * once.std(), part.shape)
    return features


def run_here(preset: Preset, hours: float) -> None:
    """Print seconds and peak memory in GB of one run in this process."""
    features = make_features(preset, hours)
    preset.analyze(features[: round(60 * preset.working_fps)])
    start = perf_counter()
    found = preset.analyze(features)
    took = perf_counter() - start
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1e6
    print(took, peak)
    stages = ", ".join(f"{stage} {seconds:.1f}" for stage, seconds in found.timings.items())
    print(stages, file=sys.stderr)


def run_in_process(name: str, hours: float) -> tuple[float, float, str]:
    """Return seconds, gigabytes and stages of one run in a new process."""
    command = [sys.executable, __file__, "--one", "--presets", name, "--hours", str(hours)]
    done = subprocess.run(
        [*command, *choose_size([], [QUICK])], check=False, capture_output=True, text=True
    )
    if done.returncode:
        sys.stderr.write(done.stderr)
        sys.exit(done.returncode)
    seconds, gigabytes = map(float, done.stdout.split())
    return seconds, gigabytes, done.stderr.strip()


def show(name: str, lengths: Sequence[float]) -> None:
    """Print a line for each length, with its promised limits."""
    how = ".max_lag" if name != DEFAULT else ""
    first: tuple[float, float, float] | None = None
    for hours in lengths:
        seconds, gigabytes, stages = run_in_process(name, hours)
        line = f"{name}{how.replace('.', ', ')}, {hours:g} h: {seconds:.1f} s, {gigabytes:.2f} GB"
        key = f"growth.{name}{how}.{hours:g}_h"
        record(f"{key}.seconds", round(seconds, 2), unit="s")
        record(f"{key}.gigabytes", round(gigabytes, 3), unit="GB")
        if first is not None:
            times = seconds / first[1], gigabytes / first[2]
            line += f"; {times[0]:.2f} and {times[1]:.2f} times {first[0]:g} h"
        if name == DEFAULT and hours == 1:
            line += f"; s {judge(seconds, 3)}, GB {judge(gigabytes, 0.5)}"
        if name == DEFAULT and (first or (0,))[0] == 1 and hours == 4:
            line += f", {judge(max(times), 4.2)}"
        first = first or (hours, seconds, gigabytes)
        print(f"{line}\n  of which {stages}", flush=True)


def main() -> None:
    parser = make_parser(__doc__)
    parser.add_argument("--hours", type=float, nargs="+", default=choose_size([1, 4], [0.01, 0.04]))
    parser.add_argument("--presets", nargs="+", choices=PRESETS, default=[DEFAULT, *PUBLISHED])
    parser.add_argument("--one", action="store_true", help=argparse.SUPPRESS)
    add_option(parser)
    options = parser.parse_args()
    if options.one:
        preset = PRESETS[options.presets[0]]
        if hasattr(preset, "max_lag"):
            preset = preset.replace(max_lag=MAX_LAG_S)
        run_here(preset, options.hours[0])
        return
    for name in options.presets:
        show(name, options.hours)


if __name__ == "__main__":
    warnings.simplefilter("ignore")
    main()
