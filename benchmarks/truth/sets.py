"""Recordings of other laboratories, labelled by people, as ``kineme evaluate FOLDER`` scores them.

    python -m benchmarks sets [SET ...] [--methods kineme uniform] [--rivals] [--every N] [--record]

Channels of muscles are left out. Clusters stand for classes of their recording; then, where
``--one-mapping`` asks for it, for the same class in the whole set: joined as by
``--mapping folder --clusters N``, N the number of classes, and not told how many (``untold``).
``--rivals`` adds segmenters of other packages, those that are installed
(``benchmarks/rivals/requirements.txt``); they take long: ``--every 20`` takes every twentieth
recording. docs/results.md shows what ``--record`` keeps.
"""

from __future__ import annotations

import time
import warnings
from collections.abc import Mapping, Sequence
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context
from pathlib import Path

import numpy as np

from _figures import add_option, record
from _options import DATA, command_line, few, needed
from _rival_presets import register_rivals
from kineme.evaluation.comparison import Comparison
from kineme.evaluation.folder import (
    Job,
    JobResult,
    find_recordings,
    join_comparisons,
    read_selected,
    run_job,
)
from kineme.evaluation.score import format_markdown, pool_scores, scores
from kineme.formats import ReadOptions
from kineme.labels.collections import find_labels
from kineme.recordings import Motion, Signals

SETS = ("hugadb", "hapt", "ipolgait", "utkinect")
SHARES = ("mof", "edit", "f1@10", "f1@25", "f1@50")
OTHERS = ("border_f1", "cut_ratio")
WAYS = {"folder": True, "untold": False}
"""Ways to join the clusters of a set, and whether they are told the number of classes."""
READING, WITHOUT = ReadOptions(), ("emg*", "time*")
"""How recordings are read, and columns that are left out."""


def read_sensors(path: Path) -> Motion | Signals:
    """Return a recording of a set without muscles and times."""
    return read_selected(path, READING, WITHOUT)


def scored(job: Job) -> JobResult:
    """A method on a recording, or why it failed; processor time is that of this process."""
    warnings.simplefilter("ignore")
    try:
        register_rivals()
        return run_job(job, time.process_time)
    except Exception as error:  # noqa: BLE001 (a rival that fails is a result)
        return JobResult(error=f"{type(error).__name__}: {error}")


def with_one_mapping(answers: Mapping[Job, JobResult], *, told: bool) -> list[Comparison]:
    """The same results, a cluster of the whole set standing for the same class everywhere."""
    classes = {name for answer in answers.values() for name in answer.classes}
    compared = join_comparisons(list(answers.items()), len(classes) if told else None)
    return [one for one in compared if one is not None]


def row(name: str, compared: Sequence[Comparison]) -> list[str]:
    """The figures of a table, each recorded by its name."""
    cells = []
    for key in (*SHARES, *OTHERS):
        value = pool_scores([scores()[key].function(one) for one in compared])
        value *= 100 if key in SHARES else 1
        record(f"sets.{name}.{key}", round(value, 3))
        cells.append(f"{value:.1f}" if key in SHARES else f"{value:.2f}")
    record(f"sets.{name}.recordings", len(compared))
    return [name, str(len(compared)), *cells]


def main() -> None:
    parser = command_line(__doc__)
    parser.add_argument("sets", nargs="*", default=few(SETS, SETS[:1]), help=", ".join(SETS))
    parser.add_argument("--data", type=Path, default=DATA)
    parser.add_argument("--methods", nargs="+", default=["kineme"])
    parser.add_argument("--one-mapping", action="store_true", help="for the whole set, too")
    parser.add_argument("--rivals", action="store_true", help="segmenters of other packages, too")
    parser.add_argument("--every", type=int, default=1, help="every n-th recording only")
    parser.add_argument("--processes", type=int, default=few(2, 1))
    add_option(parser)
    options = parser.parse_args()
    here, missing = register_rivals()
    if options.rivals and missing:
        print(f"not installed, so left out: {', '.join(missing)}")
    methods = [*options.methods, *(here if options.rivals else ())]
    part = "" if options.every == 1 else f".every_{options.every}"
    rows = []
    for name in options.sets:
        folder = needed(f"sets/{name}", options.data)
        labels = find_labels(find_recordings(folder / "recordings"), folder / "labels.csv")
        chosen = list(labels.items())[:: options.every][: few(None, 2)]
        with ProcessPoolExecutor(options.processes, mp_context=get_context("spawn")) as pool:
            for method in methods:
                jobs = [Job(*one, method, READING, WITHOUT, options.one_mapping) for one in chosen]
                tried = dict(zip(jobs, pool.map(scored, jobs), strict=True))
                for job, answer in tried.items():
                    if answer.error:
                        print(f"{job.path.stem}, {method}: {answer.error}")
                answers = {job: answer for job, answer in tried.items() if not answer.error}
                if not answers:
                    continue
                compared = [a.compared for a in answers.values() if a.compared is not None]
                rows.append(row(f"{name}.recording.{method}{part}", compared))
                hours = sum(a.length_s for a in answers.values()) / 3600
                cost = sum(a.seconds for a in answers.values()) / hours
                record(f"sets.{name}.recording.{method}{part}.seconds_per_hour", round(cost, 1))
                rows[-1].append(f"{cost:.1f}")
                for key, told in WAYS.items() if options.one_mapping else ():
                    whole = with_one_mapping(answers, told=told)
                    rows.append([*row(f"{name}.{key}.{method}{part}", whole), ""])
                    clusters = len(np.unique(np.concatenate([one.found for one in whole])))
                    record(f"sets.{name}.{key}.{method}{part}.clusters", clusters)
    head = ["set", "recordings", *SHARES, *OTHERS, "processor s / h"]
    print(format_markdown(head, rows))


if __name__ == "__main__":
    main()
