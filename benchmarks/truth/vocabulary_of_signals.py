"""How well the clusters of a library of signals, and searches in it, agree with what people say.

    python -m benchmarks vocabulary_of_signals [SET ...] [--record]

Every fourth recording of HuGaDB, HAPT, the gait laboratory and UTKinect (joints as channels), each
a library of its own, built as ``kineme library build`` does and not told how many classes there
are. A cluster of the library stands for one class in all recordings. Beside it, the same segments
with the clusters of `kineme.transfer.share_clusters`.

Then stretches of up to 3 s, drawn from what people labelled, are searched for: of what is found in
other recordings, how much has the same label; and how many of the recordings with that label are
found. docs/library.md quotes what ``--record`` keeps.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

import kineme
from _figures import add_option, record
from _options import command_line, few, needed
from kineme.evaluation.comparison import best_mapping, compare
from kineme.evaluation.recordings import recordings_below
from kineme.evaluation.score import over_all, scores
from kineme.labels.collections import labels_of
from kineme.library import Hit, Library, Settings, build
from kineme.matching import THRESHOLD
from kineme.transfer import share_clusters
from sets import READING

SETS = {"hugadb": 4, "hapt": 1, "ipolgait": 1, "utkinect": 1}
"""Every so manieth recording is taken."""
KEPT = ("level", "kind", "start_frame", "stop_frame")
SHARES = ("mof", "edit", "f1@50")
EXAMPLES, LONGEST = few(40, 5), 3.0
WIDE = 1.4
"""A threshold for who would rather look through too much than miss it."""


def show(name: str, home: Path) -> None:
    """The scores of one library."""
    folder = needed(f"sets/{name}")
    labels = labels_of(recordings_below(folder / "recordings"), folder / "labels.csv")
    chosen = dict(list(labels.items())[:: SETS[name]][: few(None, 3)])
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
    searched(
        name, library, {names[str(path)]: one for path, one in zip(chosen, truths, strict=True)}
    )


def searched(name: str, library: Library, truths: Mapping[str, kineme.Segmentation]) -> None:
    """What is found of labelled stretches in the recordings that they are not of."""
    random = np.random.default_rng(0)
    rows = [(key, row) for key, truth in truths.items() for row in truth.activities if row.label]
    examples = random.choice(len(rows), EXAMPLES)
    for way, threshold in {"search": THRESHOLD, "wide_search": WIDE}.items():
        right = found = reached = there = 0
        for number in examples:
            key, row = rows[number]
            start = row.start_s + max(row.duration_s - LONGEST, 0) / 2
            stop = min(start + LONGEST, row.stop_s)
            hits = [
                hit
                for hit in library.search(key, start, stop, top=None, threshold=threshold)
                if hit.recording != key
            ]
            good = [hit for hit in hits if label_at(truths[hit.recording], hit) == row.label]
            right, found = right + len(good), found + len(hits)
            reached += len({hit.recording for hit in good})
            there += len({other for other, one in rows if other != key and one.label == row.label})
        precision, recall = right / max(found, 1), reached / max(there, 1)
        print(
            f"{name}, {way}: precision {precision:.2f}, recordings found {recall:.2f}", flush=True
        )
        record(f"vocabulary_of_signals.{name}.{way}.precision", round(precision, 2))
        record(f"vocabulary_of_signals.{name}.{way}.recordings", round(recall, 2))


def label_at(truth: kineme.Segmentation, hit: Hit) -> str:
    """What people say of the middle of a hit."""
    middle = (hit.start_s + hit.stop_s) / 2
    for row in truth.activities:
        if row.start_s <= middle < row.stop_s:
            return str(row.label)
    return ""


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
    options = command_line(__doc__)
    options.add_argument("sets", nargs="*", default=list(SETS))
    add_option(options)
    for name in options.parse_args().sets:
        with TemporaryDirectory() as home:
            show(name, Path(home) / "library")


if __name__ == "__main__":
    main()
