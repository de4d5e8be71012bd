"""Recordings of other laboratories, labelled by people, as ``kineme evaluate FOLDER`` scores them.

    python benchmarks/sets.py [SET ...] [--methods kineme uniform] [--rivals] [--every N] [--record]

Channels of muscles are left out. Clusters stand for classes of their recording; then, where
``--one-mapping`` asks for it, for the same class in the whole set (`_one_mapping.py`).
``--rivals`` adds segmenters of other packages, those that are installed
(``benchmarks/rivals/requirements.txt``); they take long: ``--every 20`` takes every twentieth
recording. docs/sets.md quotes what ``--record`` keeps.
"""

from __future__ import annotations

import argparse
import os
import time
import warnings
from collections.abc import Mapping, Sequence
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context
from pathlib import Path
from typing import NamedTuple

from _figures import add_option, record
from _one_mapping import Described, described, one_vocabulary
from _rival_presets import register_rivals
from kineme.evaluation.comparison import Comparison, best_mapping, compare
from kineme.evaluation.methods import segment_by
from kineme.evaluation.recordings import Reading, recordings_below
from kineme.evaluation.score import over_all, scores
from kineme.evaluation.tables import markdown
from kineme.labels.collections import LabelSource, labels_of

SETS = ("hugadb", "hapt", "ipolgait", "utkinect")
SHARES = ("mof", "edit", "f1@10", "f1@25", "f1@50")
OTHERS = ("border_f1", "cut_ratio")
READING = Reading(without=("emg*", "time*"))


class Scored(NamedTuple):
    """A method on a recording: what there is to compare, what took how long, and the clusters."""

    compared: Comparison
    classes: Mapping[str, int]
    seconds: float
    hours: float
    clusters: Described | None


def scored(path: Path, source: LabelSource, method: str, one_mapping: bool) -> Scored | str:
    """A method on a recording, or why it failed; processor time is that of this process."""
    try:
        return _scored(path, source, method, one_mapping)
    except Exception as error:  # noqa: BLE001 (a rival that fails is a result)
        return f"{path.stem}, {method}: {type(error).__name__}: {error}"


def _scored(path: Path, source: LabelSource, method: str, one_mapping: bool) -> Scored:
    warnings.simplefilter("ignore")
    register_rivals()
    recording = READING.read(path)
    truth = source.of(n_frames=recording.n_frames, fps=recording.fps)
    classes: dict[str, int] = {}
    compare(truth, truth, classes=classes)
    start = time.process_time()
    found = segment_by(method, recording, n_classes=len(classes))
    seconds = time.process_time() - start
    compared = compare(truth, found, classes=classes)
    clusters = described(recording, found) if one_mapping else None
    return Scored(compared, classes, seconds, recording.duration / 3600, clusters)


def with_one_mapping(answers: Sequence[Scored]) -> list[Comparison]:
    """The same results, a cluster of the whole set standing for the same class everywhere."""
    numbers: dict[str, int] = {}
    renumbered = []
    for answer in answers:
        new = {old: numbers.setdefault(name, len(numbers)) for name, old in answer.classes.items()}
        truth = [new[old] for old in answer.compared.truth.tolist()]
        renumbered.append(Comparison(truth, answer.compared.found, answer.compared.fps))
    shared = one_vocabulary(renumbered, [answer.clusters for answer in answers], len(numbers))
    mapping = best_mapping(shared)
    return [Comparison(one.truth, one.found, one.fps, mapping) for one in shared]


def row(name: str, compared: Sequence[Comparison]) -> list[str]:
    """The figures of a table, each recorded by its name."""
    cells = []
    for key in (*SHARES, *OTHERS):
        value = over_all([scores()[key].function(one) for one in compared])
        value *= 100 if key in SHARES else 1
        record(f"sets.{name}.{key}", round(value, 3))
        cells.append(f"{value:.1f}" if key in SHARES else f"{value:.2f}")
    record(f"sets.{name}.recordings", len(compared))
    return [name, str(len(compared)), *cells]


def main() -> None:
    parser = argparse.ArgumentParser(description="Scores on sets of labelled recordings.")
    parser.add_argument("sets", nargs="*", default=SETS, help=", ".join(SETS))
    parser.add_argument(
        "--data", type=Path, default=os.environ.get("KINEME_DATA", "../shared/data")
    )
    parser.add_argument("--methods", nargs="+", default=["kineme"])
    parser.add_argument("--one-mapping", action="store_true", help="for the whole set, too")
    parser.add_argument("--rivals", action="store_true", help="segmenters of other packages, too")
    parser.add_argument("--every", type=int, default=1, help="every so manieth recording only")
    parser.add_argument("--processes", type=int, default=2)
    add_option(parser)
    options = parser.parse_args()
    here, missing = register_rivals()
    if options.rivals and missing:
        print(f"not installed, so left out: {', '.join(missing)}")
    methods = [*options.methods, *(here if options.rivals else ())]
    part = "" if options.every == 1 else f".every_{options.every}"
    rows = []
    for name in options.sets:
        folder = options.data / "sets" / name
        labels = labels_of(recordings_below(folder / "recordings"), folder / "labels.csv")
        chosen = list(labels.items())[:: options.every]
        with ProcessPoolExecutor(options.processes, mp_context=get_context("spawn")) as pool:
            for method in methods:
                jobs = [pool.submit(scored, *one, method, options.one_mapping) for one in chosen]
                results = [job.result() for job in jobs]
                for failed in (each for each in results if isinstance(each, str)):
                    print(failed)
                answers = [each for each in results if isinstance(each, Scored)]
                if not answers:
                    continue
                rows.append(row(f"{name}.recording.{method}{part}", [a.compared for a in answers]))
                cost = sum(a.seconds for a in answers) / sum(a.hours for a in answers)
                record(f"sets.{name}.recording.{method}{part}.seconds_per_hour", round(cost, 1))
                rows[-1].append(f"{cost:.1f}")
                if options.one_mapping:
                    whole = row(f"{name}.folder.{method}{part}", with_one_mapping(answers))
                    rows.append([*whole, ""])
    head = ["set", "recordings", *SHARES, *OTHERS, "processor s / h"]
    print(markdown(head, rows))


if __name__ == "__main__":
    main()
