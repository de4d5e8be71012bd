"""How long reading takes, kinematics included, beside the bare split into words.

    python -m benchmarks reading [FOLDER OF RECORDINGS] [--hour] [--record]

Prints the median of nine runs per file. The last column is the ratio to
``bytes.split`` on the same data in the same run, which does not depend on the
machine as seconds do. ``--hour`` reads, in place of that, an hour at 120 Hz of 38 joints (the
BVH of FILES, again and again) and prints the most memory that the process held.

Promises: the hour in less than 1.5 GB.
"""

from __future__ import annotations

import subprocess
import sys
import tempfile
import warnings
from collections.abc import Callable
from pathlib import Path
from statistics import median
from time import perf_counter

from _figures import add_option, record
from _measure import verdict
from _options import DATA, command_line, few, needed
from kineme.formats import read

HOUR = 120 * few(3600, 60)
HELD = """
import resource, sys, time, kineme
motion = kineme.read(sys.argv[1])
size = motion.positions.nbytes + motion.rotations.nbytes
held = 1024 * resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
print(size / 1e9, held / 1e9, time.process_time())
"""

FILES = ("cmu86/86_10.amc", "cmu_formats/49_02.bvh", "formats/aitviewer_sample.bvh")
MOST_GB = 1.5
RUNS = few(9, 1)


def seconds(work: Callable[[], object]) -> float:
    def once() -> float:
        start = perf_counter()
        work()
        return perf_counter() - start

    once()
    return median(once() for _ in range(RUNS))


def write_hour(sample: Path, path: Path) -> None:
    """The frames of a BVH again and again, until it is an hour."""
    head, _, rest = sample.read_bytes().partition(b"Frames:")
    _, _, body = rest.partition(b"Frame Time:")
    lines = body.rstrip().splitlines()[1:]
    with path.open("wb") as file:
        file.write(head + b"Frames: %d\nFrame Time: 0.0083333\n" % HOUR)
        for first in range(0, HOUR, len(lines)):
            file.write(b"\n".join(lines[: HOUR - first]) + b"\n")


def hour(folder: Path) -> int:
    """What a process holds that reads an hour; 1 where it is too much."""
    with tempfile.TemporaryDirectory() as place:
        path = Path(place) / "hour.bvh"
        write_hour(folder / FILES[1], path)
        text = path.stat().st_size / 1e6
        command = [sys.executable, "-W", "ignore", "-c", HELD, str(path)]
        done = subprocess.run(command, check=True, capture_output=True, text=True)
    size, held, spent = map(float, done.stdout.split())
    print(f"an hour of BVH, {text:.0f} MB of text and {size:.2f} GB of positions and rotations")
    print(f"{spent:.1f} s of processor time; GB held {verdict(held, MOST_GB)}: {held:.2f}")
    record("reading.hour.text", round(text), unit="MB")
    record("reading.hour.arrays", round(size, 2), unit="GB")
    record("reading.hour.held", round(held, 2), unit="GB")
    return int(held > MOST_GB)


def main() -> int:
    parser = command_line(__doc__)
    parser.add_argument("folder", nargs="?", type=Path, default=DATA)
    parser.add_argument("--hour", action="store_true")
    add_option(parser)
    given = parser.parse_args()
    folder = given.folder
    if given.hour:
        return hour(folder)
    print(f"{'file':30} {'MB':>5} {'frames':>7} {'seconds':>8} {'MB/s':>6} {'x split':>8}")
    for name in FILES:
        path = needed(name, folder)
        data = path.read_bytes()
        size = len(data) / 1e6
        took, bare = seconds(lambda path=path: read(path)), seconds(data.split)
        frames = read(path).n_frames
        print(
            f"{name:30} {size:5.1f} {frames:7d} {took:8.3f} {size / took:6.1f} {took / bare:8.1f}"
        )
        key = f"reading.{path.stem}"
        record(f"{key}.megabytes", round(size, 1), unit="MB")
        record(f"{key}.frames", frames)
        record(f"{key}.seconds", round(took, 3), unit="s")
        record(f"{key}.times_split", round(took / bare, 1), unit="times")
    return hour(folder) if given.quick else 0


if __name__ == "__main__":
    warnings.simplefilter("ignore")
    sys.exit(main())
