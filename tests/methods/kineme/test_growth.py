"""Time and memory are linear in the length of a recording; short recordings do not change."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from gestures import insert_gestures
from kineme.methods.kineme import events
from kineme.methods.kineme.events import Occurrences
from kineme.methods.kineme.preset import KINEME

# Processor time, so that other programs do not count; memory beyond what compiled code needs.
MEASURE = """
import re, sys, time
from pathlib import Path
import numpy as np
from gestures import stack_features, insert_gestures
from kineme.methods.kineme.pipeline import analyze
from kineme.methods.kineme.preset import KINEME
from loops import make_swings

def peak():  # rusage has that of the process that started this one, too
    return int(re.search(r"VmHWM:\\s+(\\d+)", Path("/proc/self/status").read_text())[1])

parts = []
for seed in range(6):
    walk = make_swings(6 + seed, period=1 + seed / 10, axis=seed % 4)
    parts += [walk, insert_gestures(seed, [100, 310, 555, 790])]
PRESET = KINEME.replace(part=300.0)  # parts are done alone, so that two and four are compared
frames = round(60 * 20 * PRESET.working_fps)
rows = np.tile(np.resize(np.concatenate(parts), (frames, 6)), 2)
rows = stack_features(rows + np.random.default_rng(0).normal(0, 0.01, rows.shape))
analyze(rows[: round(15 * PRESET.working_fps)], PRESET)
before = peak()
for share in (2, 1):
    start = time.process_time()
    analyze(rows[: frames // share], PRESET)
    print(time.process_time() - start, peak() - before)
"""


@pytest.mark.slow
@pytest.mark.skipif(sys.platform != "linux", reason="peak memory is read from /proc")
def test_twice_as_long_takes_about_twice_the_time_and_memory() -> None:
    helpers = str(Path(__file__).parents[2] / "helpers")
    path = os.pathsep.join([helpers, *filter(None, [os.environ.get("PYTHONPATH")])])
    env = {**os.environ, "PYTHONPATH": path}
    command = [sys.executable, "-c", MEASURE]
    done = subprocess.run(command, env=env, capture_output=True, text=True, check=True)
    half, whole = (line.split() for line in done.stdout.splitlines())
    for less, more in zip(half, whole, strict=True):
        assert float(more) / float(less) < 2.6


def found_in(rows: np.ndarray, leg: float) -> Occurrences:
    with pytest.MonkeyPatch.context() as patched:
        patched.setattr(events, "LEG", leg)
        return events.find_occurrences(rows, np.ones(len(rows), np.bool_), KINEME)


def test_paths_that_are_longer_than_a_leg_are_found_as_without_one() -> None:
    rows = np.vstack([insert_gestures(1, [100, 310, 555, 790])] * 4)
    rows += np.random.default_rng(0).normal(0, 0.01, rows.shape)
    whole, in_legs = found_in(rows, 3600), found_in(rows, 5)
    assert in_legs.clusters.tolist() == whole.clusters.tolist()
    assert np.abs(in_legs.starts - whole.starts).max() <= 1
    assert np.abs(in_legs.stops - whole.stops).max() <= 1
