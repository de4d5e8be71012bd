"""The recordings of a set one after the other, as one: are long recordings cut as short ones are?

    python -m benchmarks sets_joined [SET] [--by-person] [--part SECONDS] [--record]

Each stretch is scored as a recording of its own, so that clusters stand for classes of one person;
HAPT is three hours of 30 people. ``--by-person`` makes a recording of each person instead: of
HuGaDB, whose files last about a minute, some of 6 to 27 minutes. README and docs/sets.md quote what
``--record`` keeps.
"""

from __future__ import annotations

import time
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

import kineme
from _figures import add_option, record
from _options import DATA, command_line, few, needed
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


def person_of(name: str) -> str:
    """The person of a recording that is named after the person and a number of its own."""
    return name.rpartition("_")[0]


class Piece(NamedTuple):
    """A recording that is to be joined, and the classes of its frames."""

    name: str
    recording: Signals
    truth: Ints


class Measured(NamedTuple):
    """What a joined recording took, and its pieces, each against its truth."""

    whole: kineme.Segmentation
    compared: list[Comparison]
    seconds: float
    clock: float


def pieces(folder: Path) -> Iterator[Piece]:
    sources = labels_of(recordings_below(folder / "recordings"), folder / "labels.csv")
    for path, source in few(list(sources.items()), list(sources.items())[:2]):
        one = READING.read(path)
        if isinstance(one, Signals):
            truth = source.of(n_frames=one.n_frames, fps=one.fps)
            yield Piece(path.stem, one, classes_of(truth))


def measured(parts: Sequence[Piece], **constants: float) -> Measured:
    """These recordings as one, each scored as one of its own."""
    whole = joined([part.recording for part in parts])
    start, clock = time.process_time(), time.perf_counter()
    found = kineme.segment(whole, **constants)
    seconds, clock = time.process_time() - start, time.perf_counter() - clock
    ends = np.cumsum([len(part.truth) for part in parts])[:-1]
    compared = []
    for part, clusters in zip(parts, np.split(clusters_of(found), ends), strict=True):
        known = part.truth != UNLABELLED
        compared.append(Comparison(part.truth[known], clusters[known], whole.fps))
    return Measured(found, compared, seconds, clock)


def figures_of(runs: Sequence[Measured]) -> dict[str, float]:
    """Of all joined recordings together."""
    compared = [one for run in runs for one in run.compared]
    lengths = [run.whole.n_frames / run.whole.fps for run in runs]
    figures: dict[str, float] = {
        "hours": sum(lengths) / 3600,
        "shortest_minutes": min(lengths) / 60,
        "longest_minutes": max(lengths) / 60,
        "joined": len(runs),
        "recordings": len(compared),
        "activities": sum(len(run.whole.activities) for run in runs),
        "true": sum(len(one.true_runs) for one in compared),
        "clusters": sum(len(np.unique(clusters_of(run.whole))) for run in runs),
        "seconds": sum(run.seconds for run in runs),
        "seconds_by_the_clock": sum(run.clock for run in runs),
    }
    for key in (*SHARES, *OTHERS):
        value = over_all([scores()[key].function(one) for one in compared])
        figures[key] = value * 100 if key in SHARES else value
    figures["mean"] = (figures["mof"] + figures["edit"] + figures["f1@50"]) / 3
    return figures


def main() -> None:
    parser = command_line(__doc__)
    parser.add_argument("set", nargs="?", default="hapt", choices=SETS)
    parser.add_argument("--by-person", action="store_true", help="a recording for each person")
    parser.add_argument("--part", type=float, help="of a longer recording, in seconds")
    parser.add_argument("--data", type=Path, default=DATA)
    add_option(parser)
    options = parser.parse_args()
    groups: dict[str, list[Piece]] = {}
    for piece in pieces(needed(f"sets/{options.set}", options.data)):
        person = person_of(piece.name) if options.by_person else ""
        groups.setdefault(person, []).append(piece)
    constants = {} if options.part is None else {"part": options.part}
    runs = [measured(parts, **constants) for parts in groups.values()]
    name = f"sets_joined.{options.set}" + ".by_person" * options.by_person
    name += "".join(f".{key}_{value:g}" for key, value in constants.items())
    for key, value in figures_of(runs).items():
        record(f"{name}.{key}", round(float(value), 3))
        print(f"{key:22s}{value:9.2f}")


if __name__ == "__main__":
    main()
