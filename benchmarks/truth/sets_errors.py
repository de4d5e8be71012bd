"""Where the points are lost on recordings of other laboratories: at borders, by clusters, or both.

    python -m benchmarks sets_errors [SET ...] [--record]

Scores as they are; with our segments, each of which is told the class that most of it has;
and with the true segments, each of which has the cluster that most of it got. Then every
wrong frame is of one kind (`KINDS`). People in a lift stand: recordings with nothing but
these classes are a row of their own.
"""

from __future__ import annotations

import warnings
from collections import Counter, defaultdict
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from _figures import add_option, record
from _options import DATA, command_line, few, needed
from kineme.evaluation.comparison import Comparison, Run
from kineme.evaluation.recordings import Answer, Job, recordings_below
from kineme.evaluation.score import over_all, scores
from kineme.evaluation.tables import markdown
from kineme.labels.collections import labels_of
from sets import READING, SETS, scored

Ints = NDArray[np.int64]

STANDING = {"standing", "up_by_elevator", "down_by_elevator"}
NEAR = 0.75
"""Seconds: a border is late or early within it."""
KINDS = ("border", "split", "given", "merged")
"""At a border, the class beside it; in a cluster more of the class; in a cluster of another
class; and the same where the class has no cluster at all."""
WAYS = ("ours", "told_clusters", "told_segments")
KEYS = ("mof", "edit", "f1@50")


def most_in(runs: list[Run], labels: Ints) -> Ints:
    """For each frame the label that most of its run has."""
    most = [int(np.bincount(labels[run.start : run.stop]).argmax()) for run in runs]
    return np.repeat(np.array(most), [run.stop - run.start for run in runs])


def told(compared: Comparison) -> dict[str, Comparison]:
    """The comparison as it is, with clusters told, and with segments told."""
    _, found = np.unique(compared.found, return_inverse=True)
    truth, fps = compared.truth, compared.fps
    same = {int(label): int(label) for label in np.unique(truth)}
    return {
        "ours": compared,
        "told_clusters": Comparison(truth, most_in(compared.found_runs, truth), fps, same),
        "told_segments": Comparison(truth, most_in(compared.true_runs, found), fps),
    }


def kinds_of(compared: Comparison) -> Counter[str]:
    """How many wrong frames there are of each kind."""
    truth, mapped = compared.truth, compared.mapped
    near = np.zeros(len(truth), bool)
    width = round(NEAR * compared.fps)
    for run in compared.true_runs[1:]:
        beside = slice(max(0, run.start - width), run.start + width)
        near[beside] |= np.isin(mapped[beside], truth[[run.start - 1, run.start]])
    _, found = np.unique(compared.found, return_inverse=True)
    table = np.zeros((found.max() + 1, truth.max() + 1), np.int64)
    np.add.at(table, (found, truth), 1)
    mostly = table.argmax(axis=1)[found]
    has_cluster = np.isin(truth, np.unique(mapped))
    wrong = mapped != truth
    rest = wrong & ~near
    split = rest & (mapped < 0) & (mostly == truth)
    given = rest & ~split & has_cluster
    sums = (wrong & near, split, given, rest & ~split & ~given)
    return Counter({kind: int(which.sum()) for kind, which in zip(KINDS, sums, strict=True)})


def row(name: str, compared: list[Comparison]) -> list[str]:
    """Scores in each way, and shares of all frames that are wrong in each way."""
    ways: dict[str, list[Comparison]] = defaultdict(list)
    kinds: Counter[str] = Counter()
    for one in compared:
        kinds += kinds_of(one)
        for way, other in told(one).items():
            ways[way].append(other)
    cells = [name, str(len(compared))]
    record(f"sets_errors.{name}.recordings", len(compared))
    for way in WAYS:
        told_so = ways[way]
        values = [100 * over_all([scores()[key].function(one) for one in told_so]) for key in KEYS]
        for key, value in zip(KEYS, values, strict=True):
            record(f"sets_errors.{name}.{way}.{key}", round(value, 3))
        cells.append(", ".join(f"{value:.1f}" for value in values))
    frames = sum(len(one.truth) for one in compared)
    for kind in KINDS:
        record(f"sets_errors.{name}.{kind}", round(100 * kinds[kind] / frames, 3))
        cells.append(f"{100 * kinds[kind] / frames:.1f}")
    return cells


def parts_of(name: str, answers: list[Answer]) -> dict[str, list[Comparison]]:
    """The recordings of a set; apart where people only stand, if that is not so in all."""
    parts: dict[str, list[Comparison]] = {name: []}
    for answer in answers:
        if answer.compared is not None:
            still = set(answer.classes) <= STANDING
            parts.setdefault(f"{name}_standing" if still else name, []).append(answer.compared)
    return parts


def main() -> None:
    parser = command_line(__doc__)
    parser.add_argument("sets", nargs="*", default=few(SETS, SETS[:1]), help=", ".join(SETS))
    parser.add_argument("--data", type=Path, default=DATA)
    parser.add_argument("--processes", type=int, default=few(2, 1))
    add_option(parser)
    options = parser.parse_args()
    rows = []
    for name in options.sets:
        folder = needed(f"sets/{name}", options.data)
        labels = labels_of(recordings_below(folder / "recordings"), folder / "labels.csv")
        jobs = [Job(*one, "kineme", READING) for one in list(labels.items())[: few(None, 2)]]
        with ProcessPoolExecutor(options.processes, mp_context=get_context("spawn")) as pool:
            answers = list(pool.map(scored, jobs))
        rows += [row(part, compared) for part, compared in parts_of(name, answers).items()]
    print(markdown(["set", "recordings", *WAYS, *KINDS], rows))


if __name__ == "__main__":
    warnings.simplefilter("ignore")
    main()
