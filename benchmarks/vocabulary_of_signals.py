"""How well the clusters of a library of signals agree with what people say, one mapping for all.

    python benchmarks/vocabulary_of_signals.py [SET ...] [--record]

Every fourth recording of HuGaDB, the gait laboratory and UTKinect (joints as channels), each a
library of its own, built as ``kineme library build`` does and not told how many classes there are.
A cluster of the library stands for one class in all recordings. Beside it, the same segments with
the clusters of `kineme.transfer.share_clusters`. docs/library.md quotes what ``--record`` keeps.
"""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

import kineme
from _figures import add_option, record
from _recordings import DATA
from kineme.evaluation.comparison import best_mapping, compare
from kineme.evaluation.recordings import recordings_below
from kineme.evaluation.score import over_all, scores
from kineme.labels.collections import labels_of
from kineme.library import Library, Settings, build
from kineme.transfer import share_clusters
from sets import READING

SETS = {"hugadb": 4, "ipolgait": 1, "utkinect": 1}
"""Every so manieth recording is taken."""
KEPT = ("level", "kind", "start_frame", "stop_frame")
SHARES = ("mof", "edit", "f1@50")


def show(name: str, home: Path) -> None:
    """The scores of one library."""
    folder = DATA / "sets" / name
    labels = labels_of(recordings_below(folder / "recordings"), folder / "labels.csv")
    chosen = dict(list(labels.items())[:: SETS[name]])
    recordings = [READING.read(path) for path in chosen]
    settings = Settings(reading={"columns": list(recordings[0].names)})
    build(list(chosen), home, settings=settings)
    library = Library(home)
    names = dict(zip(library.recordings["path"], library.recordings["recording"], strict=True))
    rows = library.table("segments").to_pydict()
    truths = [
        source.of(n_frames=recording.n_frames, fps=recording.fps)
        for recording, source in zip(recordings, chosen.values(), strict=True)
    ]
    together, alone = (
        [
            found_in(rows, names[str(path)], cluster, truth.n_frames, truth.fps)
            for path, truth in zip(chosen, truths, strict=True)
        ]
        for cluster in ("cluster", "own_cluster")
    )
    ways = {"library": together, "share_clusters": share_clusters(recordings, alone)}
    for way, segmentations in ways.items():
        score(f"{name}.{way}", truths, segmentations)


def score(
    name: str, truths: Sequence[kineme.Segmentation], found: Sequence[kineme.Segmentation]
) -> None:
    """One line on clusters that stand for the same class in all recordings."""
    classes: dict[str, int] = {}
    compared = [
        compare(truth, one, classes=classes) for truth, one in zip(truths, found, strict=True)
    ]
    mapping = best_mapping(compared)
    mapped = [replace(one, mapping=mapping) for one in compared]
    shares = {
        key: 100 * over_all([scores()[key].function(one) for one in mapped]) for key in SHARES
    }
    clusters = len({c for one in found for c in one.activities.cluster.tolist()} - {-1})
    shown = ", ".join(f"{key} {value:.1f}" for key, value in shares.items())
    print(f"{name}: {shown}; {clusters} clusters, {len(classes)} classes", flush=True)
    for key, value in {**shares, "clusters": clusters}.items():
        record(f"vocabulary_of_signals.{name}.{key}", round(value, 1))


def found_in(
    rows: dict[str, list[object]], name: str, cluster: str, n_frames: int, fps: float
) -> kineme.Segmentation:
    """The segments of a recording of a library, with the clusters in a column."""
    own = [i for i, recording in enumerate(rows["recording"]) if recording == name]
    columns = {key: np.array([rows[key][i] for i in own]) for key in KEPT}
    columns["cluster"] = np.array([rows[cluster][i] for i in own])
    return kineme.Segmentation.from_columns(columns, n_frames=n_frames, fps=fps)


def main() -> None:
    options = argparse.ArgumentParser(description=str(__doc__).splitlines()[0])
    options.add_argument("sets", nargs="*", default=list(SETS))
    add_option(options)
    for name in options.parse_args().sets:
        with TemporaryDirectory() as home:
            show(name, Path(home) / "library")


if __name__ == "__main__":
    main()
