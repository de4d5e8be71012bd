"""Repetitions counted by sensors on the body, where they are known.

    python -m benchmarks sensor_counts [--every 4] [--only SOURCE ...] [--record]

- **barbell**: a sensor on the wrist, five or ten repetitions as planned; nobody watched. Told
  is the cluster with the most repetitions; counts that are more than one off are named.
- **strides**: sensors on head or back and both feet; a swing of each foot is a stride, one of
  one foot half of it, which counts as exact. Told is what lies in activities that mostly walk.
- **wrist**, **wrist_and_ankle**: sequences of HDM05's exercises, with sensors made from the
  skeleton (`sensors.sensors`) on the right side. Told is what lies in a true run of an exercise.
"""

from __future__ import annotations

import warnings
from collections import Counter
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np

import kineme
from _figures import add_option, record
from _options import command_line, few, needed
from _recordings import by_recording, hdm05
from kineme.evaluation import labelling_of
from kineme.evaluation.segments import found_counts
from kineme.segments.segmentation import Segmentation
from sensors import RIGHT, sensors

WRIST = (4,)
Counts = tuple[list[float], list[float]]
"""Repetitions told and true."""


def barbell(every: int) -> Iterator[Counts]:
    folder = needed("sets/barbell")
    for name, (row,) in list(by_recording(folder / "counts.csv").items())[::every]:
        if row["exercise"] != "rest":
            found = segmented(folder, name)
            clusters = found.primitives.cluster
            told = max(Counter(clusters[clusters >= 0].tolist()).values(), default=0)
            true = int(row["nominal_count"])
            if abs(told - true) > 1:
                print(f"  {row['exercise']}: {told} of {true}")
            yield [told], [true]


def strides(every: int) -> Iterator[Counts]:
    folder = needed("sets/ipolgait")
    labels = by_recording(folder / "labels.csv")
    for name, events in list(by_recording(folder / "events.csv").items())[::every]:
        walks = [span(row, "") for row in labels[name] if row["label"] == "walking"]
        swings = [sum(span(row, "swing_")) / 2 for row in events]
        found = segmented(folder, name)
        told = true = 0.0
        for row in found.activities:
            inside = sum(
                max(0.0, min(stop, row.stop_s) - max(start, row.start_s)) for start, stop in walks
            )
            if inside > (row.stop_s - row.start_s) / 2:
                parts = found.primitives
                told += ((parts.activity == row.activity) & (parts.cluster >= 0)).sum()
                true += sum(row.start_s <= swing < row.stop_s for swing in swings) / 2
        yield [told], [true]


def made(places: tuple[int, ...]) -> Callable[[int], Iterator[Counts]]:
    """Sequences of HDM05 as sensors at these places see them."""

    def counted(every: int) -> Iterator[Counts]:
        for case in hdm05(24 // min(every, 24)):
            found = kineme.segment(sensors(case.motion, places))
            parts = labelling_of(found.primitives, fps=found.fps)
            parts = parts.at(frames=case.truth.frames, fps=case.truth.fps)
            yield found_counts(case.truth, parts), [count or 0 for count in case.truth.counts]

    return counted


SOURCES = {
    "barbell": barbell,
    "strides": strides,
    "wrist": made(WRIST),
    "wrist_and_ankle": made(RIGHT),
}


def segmented(folder: Path, name: str) -> Segmentation:
    return kineme.segment(kineme.read(folder / "recordings" / f"{name}.parquet"))


def span(row: dict[str, str], prefix: str) -> tuple[float, float]:
    return float(row[f"{prefix}start_s"]), float(row[f"{prefix}stop_s"])


def main() -> None:
    parser = command_line(__doc__)
    parser.add_argument("--every", type=int, default=few(1, 20), help="one in so many recordings")
    parser.add_argument("--only", nargs="+", choices=SOURCES, default=list(SOURCES))
    add_option(parser)
    options = parser.parse_args()
    for source in options.only:
        sides = zip(*SOURCES[source](options.every), strict=True)
        told, true = (np.concatenate(side) for side in sides)
        errors = np.abs(told - true)
        shares = {"exact": np.mean(errors <= 0.5), "within_one": np.mean(errors <= 1)}
        record(f"sensor_counts.{source}.counts", len(errors))
        for name, share in shares.items():
            record(f"sensor_counts.{source}.{name}", round(100 * float(share), 2))
        cells = "".join(f"{100 * share:8.1f} % {name}" for name, share in shares.items())
        print(f"{source:16}{len(errors):5d} counts{cells}", flush=True)


if __name__ == "__main__":
    warnings.simplefilter("ignore")
    main()
