"""How large a report is, and what writing it takes, from a minute to an hour and more.

    python -m benchmarks report [RECORDING] [--record]

The recording, by default the bundled one, is repeated until it is long enough,
each time in another direction and with a millimetre of noise, as no two
repetitions are equal. Its segments are repeated with it, so that segmenting is
not part of the figures. The last line is a recording of noise with 80 joints:
what compresses worst. Memory is what writing takes at most, beside the motion.
"""

from __future__ import annotations

import tempfile
import tracemalloc
import warnings
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from time import perf_counter, process_time

import numpy as np

import kineme
from _figures import add_option, record
from _measure import verdict
from _options import command_line, few
from kineme.datasets import bundled_recording
from kineme.recordings import Motion, Skeleton
from kineme.recordings.operations import turn
from kineme.report.page import write_report
from kineme.segments.segmentation import Segmentation
from kineme.web.display import display_motion
from kineme.web.similarity import matrix_of_motion

MOST_MB = 30.0
MINUTES = few((1, 10, 60, 180), (1,))
COLUMNS = ("level", "kind", "start_frame", "stop_frame", "cluster", "label", "confidence")


def repeated(motion: Motion, segments: Segmentation, minutes: float) -> tuple[Motion, Segmentation]:
    """Both, again and again; positions alone."""
    rng = np.random.default_rng(0)
    times = int(np.ceil(60 * minutes / motion.duration))
    table = segments.table
    columns = {name: np.tile(getattr(table, name), times) for name in COLUMNS}
    shifts = np.repeat(np.arange(times) * motion.n_frames, len(table))
    columns["start_frame"] += shifts
    columns["stop_frame"] += shifts
    n_frames = times * motion.n_frames
    longer = Segmentation.from_columns(columns, n_frames=n_frames, fps=motion.fps)
    positions = np.concatenate(
        [turn(motion, rng.uniform(0, 6)).positions for _ in range(times)], dtype=np.float64
    )
    positions += rng.normal(scale=0.001, size=positions.shape)
    return replace(motion, positions=positions, rotations=None), longer


def noise(minutes: float) -> tuple[Motion, Segmentation]:
    """Eighty points that shake about, and one segment."""
    n = int(60 * 60 * minutes)
    positions = np.random.default_rng(0).normal(size=(n, 80, 3))
    skeleton = Skeleton(tuple(f"p{i}" for i in range(80)), (-1,) * 80, np.zeros((80, 3)))
    columns = {"level": ["activity"], "kind": ["activity"], "start_frame": [0], "stop_frame": [n]}
    return Motion(skeleton, positions, 60.0), Segmentation.from_columns(
        columns, n_frames=n, fps=60.0
    )


def cases(path: Path) -> Iterator[tuple[str, Motion, Segmentation]]:
    motion = kineme.read(path)
    segments = kineme.segment(motion)
    for minutes in MINUTES:
        yield f"{path.name}, {minutes} min", *repeated(motion, segments, minutes)
    minutes = few(60, 1)
    yield f"noise, noise {minutes} min", *noise(minutes)


def main() -> None:
    parser = command_line(__doc__)
    parser.add_argument("recording", nargs="?", type=Path, default=bundled_recording())
    add_option(parser)
    path = parser.parse_args().recording
    print(
        f"{'recording':28} {'seconds':>8} {'of processor':>12} {'MB':>6} {'motion':>7} "
        f"{'tiles':>6} {'number':>7} {'poses/s':>8} {'memory, MB':>11}"
    )
    hour = 0.0
    for name, motion, segments in cases(path):
        with tempfile.TemporaryDirectory() as folder:
            page = Path(folder) / "report.html"
            start, busy = perf_counter(), process_time()
            write_report(motion, segments, page)
            took, busy = perf_counter() - start, process_time() - busy
            size = page.stat().st_size / 1e6
            tracemalloc.start()
            write_report(motion, segments, page)
            peak = tracemalloc.get_traced_memory()[1] / 1e6
            tracemalloc.stop()
        head, binary = display_motion(motion)
        tiles, _ = matrix_of_motion(motion).report_tiles()
        stored = sum(map(len, tiles.values())) / 1e6
        print(
            f"{name:28} {took:8.1f} {busy:12.1f} {size:6.1f} {len(binary) / 1e6:7.1f} "
            f"{stored:6.1f} {len(tiles):7} {head.sample_fps:8.1f} {peak:11.0f}"
        )
        key = f"report.{name.rpartition(', ')[2].replace(' ', '_')}"
        record(f"{key}.megabytes", round(size, 1), unit="MB")
        record(f"{key}.processor", round(busy, 1), unit="s")
        record(f"{key}.memory", round(peak), unit="MB")
        hour = max(hour, size)
    print(f"the largest: {hour:.1f} MB, {verdict(hour, MOST_MB)}")


if __name__ == "__main__":
    warnings.simplefilter("ignore")
    main()
