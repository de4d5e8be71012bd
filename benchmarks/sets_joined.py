"""The recordings of a set one after the other, as one: are long recordings cut as short ones are?

    python benchmarks/sets_joined.py [SET] [--record]

Each stretch is scored as a recording of its own, so that clusters stand for classes of one person;
HAPT is three hours of 30 people. docs/experiments_for_sensors.md quotes what ``--record`` keeps.
"""

from __future__ import annotations

import argparse
import os
import time
from collections.abc import Sequence
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

import kineme
from _figures import add_option, record
from kineme.evaluation.comparison import UNLABELLED, Comparison
from kineme.evaluation.recordings import recordings_below
from kineme.evaluation.score import over_all, scores
from kineme.labels.collections import labels_of
from kineme.labels.spans import text_of
from kineme.recordings import Signals
from sets import OTHERS, READING, SETS, SHARES

Ints = NDArray[np.int64]


def joined(recordings: Sequence[Signals]) -> Signals:
    """One after the other, at the rate of the first."""
    values = np.concatenate([one.values for one in recordings])
    return Signals(values, recordings[0].fps, recordings[0].names)


def classes_of(truth: kineme.Segmentation) -> Ints:
    """The class of each frame; `UNLABELLED` where nobody says."""
    numbers: dict[str, int] = {}
    classes = np.full(truth.n_frames, UNLABELLED, np.int64)
    for row in truth.activities:
        if row.kind != "transition":
            number = numbers.setdefault(text_of(row), len(numbers))
            classes[row.start_frame : row.stop_frame] = number
    return classes


def clusters_of(found: kineme.Segmentation) -> Ints:
    """The cluster of each frame."""
    clusters = np.full(found.n_frames, UNLABELLED, np.int64)
    for row in found.activities:
        clusters[row.start_frame : row.stop_frame] = row.cluster
    return clusters


def main() -> None:
    parser = argparse.ArgumentParser(description="A set of recordings as one recording.")
    parser.add_argument("set", nargs="?", default="hapt", choices=SETS)
    parser.add_argument(
        "--data", type=Path, default=os.environ.get("KINEME_DATA", "../shared/data")
    )
    add_option(parser)
    options = parser.parse_args()
    folder = options.data / "sets" / options.set
    sources = labels_of(recordings_below(folder / "recordings"), folder / "labels.csv")
    recordings = [one for path in sources if isinstance(one := READING.read(path), Signals)]
    truths = [
        classes_of(source.of(n_frames=one.n_frames, fps=one.fps))
        for one, source in zip(recordings, sources.values(), strict=True)
    ]
    whole = joined(recordings)
    start, clock = time.process_time(), time.perf_counter()
    found = kineme.segment(whole)
    seconds, clock = time.process_time() - start, time.perf_counter() - clock
    parts = np.split(clusters_of(found), np.cumsum([len(truth) for truth in truths])[:-1])
    compared = [
        Comparison(truth[truth != UNLABELLED], part[truth != UNLABELLED], whole.fps)
        for truth, part in zip(truths, parts, strict=True)
    ]
    figures: dict[str, float] = {
        "hours": whole.duration / 3600,
        "people": len(recordings),
        "activities": len(found.activities),
        "true": sum(len(one.true_runs) for one in compared),
        "clusters": len(np.unique(clusters_of(found))),
        "seconds": seconds,
        "seconds_by_the_clock": clock,
    }
    for key in (*SHARES, *OTHERS):
        value = over_all([scores()[key].function(one) for one in compared])
        figures[key] = value * 100 if key in SHARES else value
    figures["mean"] = (figures["mof"] + figures["edit"] + figures["f1@50"]) / 3
    for key, value in figures.items():
        record(f"sets_joined.{options.set}.{key}", round(float(value), 3))
        print(f"{key:22s}{value:9.2f}")


if __name__ == "__main__":
    main()
