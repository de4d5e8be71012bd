"""How long reading ten minutes of 60 joints takes, and how much memory, from FBX.

    python -m benchmarks reading_scenes [--record]

A walk at 120 Hz, its keys at every frame, as motion capture leaves them: rotations of all joints
and translations of the root; and once more with keys for all that stands still, which doubles the
file. Each is read by a process of its own; the memory that it held counts all of Python.

Promises: less than 2 s of processor time for what moves, 4 s for all, and 0.5 GB for either.
"""

from __future__ import annotations

import subprocess
import sys
import tempfile
from multiprocessing import get_context
from pathlib import Path

import numpy as np

import _fbx
from _figures import add_option, record
from _measure import verdict
from _options import command_line, few

FPS, JOINTS, SECONDS = 120, 60, few(600, 5)
MOST_S, MOST_GB = 2.0, 0.5
READ = """
import resource, sys, time, warnings
import kineme
from kineme.formats import read_motion
read_motion(sys.argv[2])
start = time.process_time()
motion = read_motion(sys.argv[1])
took = time.process_time() - start
held = 1024 * resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
print(motion.n_frames, motion.skeleton.n_joints, took, held / 1e9)
"""


def write_fbx(path: Path, seconds: float, *, baked: bool) -> None:
    """A body of 60 joints; all nine curves of each where it is baked, else those that move."""
    scene = _fbx.Scene(TimeMode=1)
    layer = scene.layer(scene.take("walk", 0.0, seconds))
    n = round(FPS * seconds) + 1
    times = np.arange(n) / FPS
    rng = np.random.default_rng(0)
    body = [scene.model("Hips", 0, LclTranslation=[0.0, 95.0, 0.0])]
    for j in range(1, JOINTS):
        parent = body[rng.integers(max(0, j - 6), j)]
        body.append(scene.model(f"joint{j}", parent, LclTranslation=[0.0, 9.0, 2.0]))
    still = {axis: _fbx.Keys(times, np.ones(n)) for axis in "XYZ"}
    for j, model in enumerate(body):
        turns = {
            axis: _fbx.Keys(times, 30 * np.sin(rng.uniform(4, 9) * times) + rng.normal(size=n))
            for axis in "XYZ"
        }
        scene.animate(layer, model, "R", **turns)
        if j == 0:
            moved = {"X": _fbx.Keys(times, 9 * np.sin(times)), "Z": _fbx.Keys(times, 140 * times)}
            scene.animate(layer, model, "T", (0, 95, 0), **moved)
        elif baked:
            scene.animate(layer, model, "T", **still)
        if baked:
            scene.animate(layer, model, "S", **still)
    path.write_bytes(scene.binary())


def main() -> int:
    parser = command_line(__doc__)
    add_option(parser)
    parser.parse_args()
    failed = False
    with tempfile.TemporaryDirectory() as folder:
        short = Path(folder) / "short.fbx"
        write_fbx(short, 1, baked=False)
        for name, baked in (("moving", False), ("baked", True)):
            path = Path(folder) / f"{name}.fbx"
            # in a process of its own: what it holds would count as held by those started later
            writer = get_context("spawn").Process(
                target=write_fbx, args=(path, SECONDS), kwargs={"baked": baked}
            )
            writer.start()
            writer.join()
            size = path.stat().st_size / 1e6
            command = [sys.executable, "-W", "ignore", "-c", READ, str(path), str(short)]
            done = subprocess.run(command, check=True, capture_output=True, text=True)
            frames, joints, took, held = map(float, done.stdout.split())
            most = 2 * MOST_S if baked else MOST_S
            print(f"{name}: {size:.0f} MB, {frames:.0f} frames of {joints:.0f} joints; "
                  f"seconds {verdict(took, most)}: {took:.2f}; "
                  f"GB held {verdict(held, MOST_GB)}: {held:.2f}")  # fmt: skip
            failed |= took > most or held > MOST_GB
            record(f"reading_scenes.{name}.megabytes", round(size), unit="MB")
            record(f"reading_scenes.{name}.seconds", round(took, 2), unit="s")
            record(f"reading_scenes.{name}.held", round(held, 2), unit="GB")
    return int(failed)


if __name__ == "__main__":
    sys.exit(main())
