"""Measure how long reading takes, with kinematics, relative to splitting the bytes into words.

    python -m benchmarks reading [--hour] [--record]

Prints the median of nine runs per file. The last column is the ratio to ``bytes.split`` on the
same data, which depends less on the machine than seconds. ``--hour`` reads instead an hour of 38
joints at 120 Hz (a repeated BVH) and prints the peak memory.

Promises: the hour in less than 1.5 GB.
"""

from __future__ import annotations

import subprocess
import sys
import tempfile
import warnings
from pathlib import Path

from _figures import add_option, record
from _measure import judge, time_in_turn
from _options import choose_size, find_data, make_parser
from kineme.formats import read

HOUR = 120 * choose_size(3600, 60)
HELD = """
import resource, sys, time, kineme
motion = kineme.read(sys.argv[1])
size = motion.positions.nbytes + motion.rotations.nbytes
held = 1024 * resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
print(size / 1e9, held / 1e9, time.process_time())
"""

FILES = ("cmu86/86_10.amc", "cmu_formats/49_02.bvh", "formats/aitviewer_sample.bvh")
MOST_GB = 1.5
RUNS = choose_size(9, 1)


def write_hour(sample: Path, path: Path) -> None:
    """Write a BVH whose frames are repeated to an hour."""
    head, _, rest = sample.read_bytes().partition(b"Frames:")
    _, _, body = rest.partition(b"Frame Time:")
    lines = body.rstrip().splitlines()[1:]
    with path.open("wb") as file:
        file.write(head + b"Frames: %d\nFrame Time: 0.0083333\n" % HOUR)
        for first in range(0, HOUR, len(lines)):
            file.write(b"\n".join(lines[: HOUR - first]) + b"\n")


def measure_hour() -> int:
    """Print the peak memory of a process that reads an hour; return 1 if it is too high."""
    with tempfile.TemporaryDirectory() as place:
        path = Path(place) / "hour.bvh"
        write_hour(find_data(FILES[1]), path)
        text = path.stat().st_size / 1e6
        command = [sys.executable, "-W", "ignore", "-c", HELD, str(path)]
        done = subprocess.run(command, check=True, capture_output=True, text=True)
    size, held, spent = map(float, done.stdout.split())
    print(f"an hour of BVH, {text:.0f} MB of text and {size:.2f} GB of positions and rotations")
    print(f"{spent:.1f} s of processor time; GB held {judge(held, MOST_GB)}: {held:.2f}")
    record("reading.hour.text", round(text), unit="MB")
    record("reading.hour.arrays", round(size, 2), unit="GB")
    record("reading.hour.held", round(held, 2), unit="GB")
    return int(held > MOST_GB)


def main() -> int:
    parser = make_parser(__doc__)
    parser.add_argument("--hour", action="store_true")
    add_option(parser)
    given = parser.parse_args()
    if given.hour:
        return measure_hour()
    print(f"{'file':30} {'MB':>5} {'frames':>7} {'seconds':>8} {'MB/s':>6} {'x split':>8}")
    for name in FILES:
        path = find_data(name)
        data = path.read_bytes()
        size = len(data) / 1e6
        works = {"read": lambda path=path: read(path), "split": data.split}
        took, bare = time_in_turn(works, runs=RUNS).values()
        frames = read(path).n_frames
        print(
            f"{name:30} {size:5.1f} {frames:7d} {took:8.3f} {size / took:6.1f} {took / bare:8.1f}"
        )
        key = f"reading.{path.stem}"
        record(f"{key}.megabytes", round(size, 1), unit="MB")
        record(f"{key}.frames", frames)
        record(f"{key}.seconds", round(took, 3), unit="s")
        record(f"{key}.times_split", round(took / bare, 1), unit="times")
    return measure_hour() if given.quick else 0


if __name__ == "__main__":
    warnings.simplefilter("ignore")
    sys.exit(main())
