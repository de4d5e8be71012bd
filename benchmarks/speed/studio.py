"""How long the studio keeps people waiting, asked over HTTP as the page does.

    python -m benchmarks studio [--runs 7] [--record]

First of a recording of two minutes all that a page shows at first: the segments,
the figure, a tile of the matrix. Then a minute, segmented again by each preset.
The recordings are those of subject 86, one after the other, written as BVH. Last the first
poses of an hour at 120 Hz of 38 joints, which is shown before it is read.
Compiled code is cached, as after the first run ever.
"""

from __future__ import annotations

import atexit
import json
import os
import re
import signal
import subprocess
import sys
import tempfile
import urllib.request
from collections.abc import Iterable
from pathlib import Path
from statistics import median
from time import perf_counter, sleep
from typing import Any, NamedTuple

import numpy as np

import kineme
from _figures import add_option, record
from _measure import verdict
from _options import DATA, command_line, few, needed
from kineme.methods.presets import DEFAULT, PRESETS, PUBLISHED
from kineme.recordings.operations import cut
from reading import FILES, write_hour

TRIALS = ("86_10", "86_14", "86_11")
WARM = few(25.0, 2.0)  # seconds after which everything compiled is loaded


class Studio(NamedTuple):
    """A running studio."""

    process: subprocess.Popen[str]
    base: str
    token: str

    def ask(self, path: str, sent: Any = None) -> bytes:
        """The body of an answer."""
        data = None if sent is None else json.dumps(sent).encode()
        request = urllib.request.Request(self.base + path, data, {"X-Kineme-Token": self.token})
        with urllib.request.urlopen(request) as answer:
            body: bytes = answer.read()
        return body

    def end(self) -> None:
        """Press Ctrl+C."""
        self.process.send_signal(signal.SIGINT)
        self.process.wait()


def start(folder: Path) -> Studio:
    """``kineme studio`` of a folder, once it has said its address."""
    command = [sys.executable, "-m", "kineme", "studio", str(folder)]
    process = subprocess.Popen(
        [*command, "--no-browser", "--port", "0"], stdout=subprocess.PIPE, text=True
    )
    atexit.register(process.kill)  # so that it does not outlive a benchmark that fails
    found = re.search(r"(http://\S+)/\?token=(\S+)", process.stdout.readline())  # type: ignore[union-attr]
    return Studio(process, found[1], found[2])  # type: ignore[index]


class Took(NamedTuple):
    """Seconds by the clock, and of the server's processor time, which other work spares."""

    clock: float
    processor: float

    def __str__(self) -> str:
        return f"{self.clock:.3f} s ({self.processor:.3f} s of processor time)"


def timed(studio: Studio, path: str, sent: Any = None) -> tuple[Took, bytes]:
    """What an answer takes, and the answer."""
    clock, processor = perf_counter(), processor_time(studio.process.pid)
    answer = studio.ask(path, sent)
    spent = processor_time(studio.process.pid) - processor
    return Took(perf_counter() - clock, spent), answer


def processor_time(pid: int) -> float:
    """Seconds of processor time that a process has had; nan where there is no /proc."""
    try:
        words = Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()
    except OSError:
        return float("nan")
    return (int(words[11]) + int(words[12])) / os.sysconf("SC_CLK_TCK")


def middle(rows: Iterable[Took]) -> Took:
    """The medians."""
    return Took(*map(median, zip(*rows, strict=True)))


def joined(seconds: float) -> kineme.Motion:
    """So much motion of subject 86."""
    motions = [kineme.read(DATA / "cmu86" / f"{trial}.amc") for trial in TRIALS]
    rotations = np.concatenate([motion.rotations for motion in motions])
    roots = np.concatenate([motion.positions[:, 0] for motion in motions])
    first = motions[0]
    whole = kineme.Motion.from_rotations(first.skeleton, rotations, first.fps, roots)
    return cut(whole, 0, int(seconds * first.fps))


def first_answers(folder: Path) -> tuple[Took, ...]:
    """What the segments, the figure and a tile take, of a studio just started."""
    studio = start(folder)
    listed = json.loads(studio.ask("/api/state"))["recordings"]
    one = f"/api/recordings/{listed[0]['id']}"
    sleep(2)  # a person takes as long to choose
    took = [timed(studio, one + part)[0] for part in ("", "/motion", "/matrix/0/0/0")]
    studio.end()
    return tuple(took)


def revision_found(studio: Studio, one: str) -> int:
    """The revision of a recording, once its segments are found: before, no edit is taken."""
    while (message := json.loads(studio.ask(one))).get("finding"):
        sleep(0.2)
    revision: int = message["revision"]
    return revision


def again(folder: Path, runs: int) -> dict[str, Took]:
    """Medians of segmenting again by each preset, another value of a constant each time."""
    studio = start(folder)
    one = f"/api/recordings/{json.loads(studio.ask('/api/state'))['recordings'][0]['id']}"
    sleep(WARM)
    revision = revision_found(studio, one)
    found = {}
    for preset in (DEFAULT, *PUBLISHED):
        constant = "segment_cost" if preset == "kineme" else "radius"
        value = getattr(PRESETS[preset], constant)
        times = []
        for run in range(runs + 1):
            parameters = {constant: value * (1 - 0.02 * run)}
            edit = {"kind": "segment", "preset": preset, "parameters": parameters}
            took, answer = timed(studio, f"{one}/edits", {"revision": revision, "edit": edit})
            times.append(took)
            revision = json.loads(answer)["revision"]
        found[preset] = middle(times[1:])
    studio.end()
    return found


def hour(folder: Path) -> Took:
    """What the first poses of an hour take, of a studio that has loaded its code."""
    studio = start(folder)
    sleep(WARM)
    write_hour(needed(FILES[1]), folder / "hour.bvh")  # now, so that it is not opened before
    listed = json.loads(studio.ask("/api/state"))["recordings"]
    (one,) = (f"/api/recordings/{each['id']}" for each in listed if each["name"] == "hour.bvh")
    message, answer = timed(studio, one)
    poses = json.loads(answer)["motion"]["n_samples"]
    motion, _ = timed(studio, f"{one}/motion?poses={poses}")
    studio.end()
    return Took(message.clock + motion.clock, message.processor + motion.processor)


def main() -> None:
    parser = command_line(__doc__)
    parser.add_argument("--runs", type=int, default=few(7, 1))
    add_option(parser)
    runs = parser.parse_args().runs
    needed("cmu86")
    with tempfile.TemporaryDirectory() as place:
        folder = Path(place)
        kineme.write(joined(few(120, 20)), folder / "take.bvh")
        rows = [first_answers(folder) for _ in range(runs)]
        parts = [middle(part) for part in zip(*rows, strict=True)]
        for name, took in zip(("segments", "figure", "tile of the matrix"), parts, strict=True):
            print(f"two minutes, {name}: {took}")
        print(f"two minutes, all three: {verdict(sum(took.clock for took in parts), 1.5)}")
        kineme.write(joined(few(60, 20)), folder / "take.bvh")
        for preset, took in again(folder, runs).items():
            record(f"studio.again.{preset}.processor", round(took.processor, 2), unit="s")
            print(f"a minute again by {preset}: {took}; {verdict(took.clock, 0.5)}")
        took = hour(folder)
        print(f"an hour, first poses: {took}; {verdict(took.clock, 5)}")


if __name__ == "__main__":
    main()
