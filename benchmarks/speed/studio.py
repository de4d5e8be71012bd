"""Measure how long the studio takes to answer the requests of its page.

    python -m benchmarks studio [--runs 7] [--record]

1. The first view of two minutes of subject 86: segments, figure, a tile of the matrix.
2. Segmenting one minute again by each preset.
3. The first poses of an hour of 38 joints at 120 Hz, which are shown before the file is read.

Compiled code is cached.
"""

from __future__ import annotations

import json
import os
import tempfile
import urllib.request
from pathlib import Path
from time import perf_counter, sleep
from typing import Any

import numpy as np

import kineme
from _figures import add_option, record
from _measure import Duration, judge, take_medians
from _options import DATA, choose_size, find_data, make_parser
from kineme.methods.presets import DEFAULT, PRESETS, PUBLISHED
from kineme.recordings.operations import cut
from reading import FILES, write_hour
from studio_server import StudioServer

TRIALS = ("86_10", "86_14", "86_11")
WARM = choose_size(25.0, 2.0)  # seconds until compiled code is loaded


def ask(studio: StudioServer, path: str, sent: Any = None) -> bytes:
    """Send a request and return the body of the answer."""
    data = None if sent is None else json.dumps(sent).encode()
    address = studio.root.rstrip("/") + path
    request = urllib.request.Request(address, data, {"X-Kineme-Token": studio.token})
    with urllib.request.urlopen(request) as answer:
        body: bytes = answer.read()
    return body


def find_recordings(studio: StudioServer) -> dict[str, str]:
    """Return the address of each recording by name."""
    listed = json.loads(ask(studio, "/api/state"))["recordings"]
    return {each["name"]: f"/api/recordings/{each['id']}" for each in listed}


def time_request(studio: StudioServer, path: str, sent: Any = None) -> tuple[Duration, bytes]:
    """Return the duration of a request and its answer."""
    clock, processor = perf_counter(), read_processor_time(studio.process.pid)
    answer = ask(studio, path, sent)
    spent = read_processor_time(studio.process.pid) - processor
    return Duration(perf_counter() - clock, spent), answer


def read_processor_time(pid: int) -> float:
    """Return the processor seconds of a process; nan without /proc."""
    try:
        words = Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()
    except OSError:
        return float("nan")
    return (int(words[11]) + int(words[12])) / os.sysconf("SC_CLK_TCK")


def join_motion(seconds: float) -> kineme.Motion:
    """Join trials of subject 86 to a motion of so many seconds."""
    motions = [kineme.read(DATA / "cmu86" / f"{trial}.amc") for trial in TRIALS]
    rotations = np.concatenate([motion.rotations for motion in motions])
    roots = np.concatenate([motion.positions[:, 0] for motion in motions])
    first = motions[0]
    whole = kineme.Motion.from_rotations(first.skeleton, rotations, first.fps, roots)
    return cut(whole, 0, int(seconds * first.fps))


def time_first_answers(folder: Path) -> tuple[Duration, ...]:
    """Return the times of segments, figure and a tile in a new studio."""
    with StudioServer(folder) as studio:
        one = find_recordings(studio)["take.bvh"]
        sleep(2)  # a person takes about as long to choose
        parts = ("", "/motion", "/matrix/0/0/0")
        return tuple(time_request(studio, one + part)[0] for part in parts)


def wait_for_segments(studio: StudioServer, one: str) -> int:
    """Wait until a recording is segmented, as edits need; return its revision."""
    while (message := json.loads(ask(studio, one))).get("finding"):
        sleep(0.2)
    revision: int = message["revision"]
    return revision


def time_segmenting_again(folder: Path, runs: int) -> dict[str, Duration]:
    """Return median times of segmenting again by each preset, each time with another constant."""
    found = {}
    with StudioServer(folder) as studio:
        one = find_recordings(studio)["take.bvh"]
        sleep(WARM)
        revision = wait_for_segments(studio, one)
        for preset in (DEFAULT, *PUBLISHED):
            constant = "segment_cost" if preset == "kineme" else "radius"
            value = getattr(PRESETS[preset], constant)
            times = []
            for run in range(runs + 1):
                parameters = {constant: value * (1 - 0.02 * run)}
                edit = {"kind": "segment", "preset": preset, "parameters": parameters}
                sent = {"revision": revision, "edit": edit}
                took, answer = time_request(studio, f"{one}/edits", sent)
                times.append(took)
                revision = json.loads(answer)["revision"]
            found[preset] = take_medians(times[1:])
    return found


def time_hour(folder: Path) -> Duration:
    """Return the time to the first poses of an hour in a warm studio."""
    with StudioServer(folder) as studio:
        sleep(WARM)
        # Written only now, so that the studio has not opened it.
        write_hour(find_data(FILES[1]), folder / "hour.bvh")
        one = find_recordings(studio)["hour.bvh"]
        message, answer = time_request(studio, one)
        poses = json.loads(answer)["motion"]["n_samples"]
        motion, _ = time_request(studio, f"{one}/motion?poses={poses}")
    return Duration(message.clock + motion.clock, message.processor + motion.processor)


def main() -> None:
    parser = make_parser(__doc__)
    parser.add_argument("--runs", type=int, default=choose_size(7, 1))
    add_option(parser)
    runs = parser.parse_args().runs
    find_data("cmu86")
    with tempfile.TemporaryDirectory() as place:
        folder = Path(place)
        kineme.write(join_motion(choose_size(120, 20)), folder / "take.bvh")
        rows = [time_first_answers(folder) for _ in range(runs)]
        parts = [take_medians(part) for part in zip(*rows, strict=True)]
        for name, took in zip(("segments", "figure", "tile of the matrix"), parts, strict=True):
            print(f"two minutes, {name}: {took}")
        print(f"two minutes, all three: {judge(sum(took.clock for took in parts), 1.5)}")
        kineme.write(join_motion(choose_size(60, 20)), folder / "take.bvh")
        for preset, took in time_segmenting_again(folder, runs).items():
            record(f"studio.segment_again.{preset}", round(took.processor, 2), unit="s")
            print(f"a minute again by {preset}: {took}; {judge(took.clock, 0.5)}")
        took = time_hour(folder)
        print(f"an hour, first poses: {took}; {judge(took.clock, 5)}")


if __name__ == "__main__":
    main()
