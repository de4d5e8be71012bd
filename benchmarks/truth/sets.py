"""Score labelled sets of other laboratories as ``kineme evaluate FOLDER`` does.

    python -m benchmarks sets [SET ...] [--methods kineme uniform] [--rivals] [--every N] [--record]

Channels of muscles are left out. Clusters are mapped to classes for each recording. With
``--one-mapping`` they are also mapped for the whole set, joined to the true number of classes
(as by ``--mapping folder --clusters N``) or to a number that is found (``untold``). ``--rivals``
adds installed segmenters of other packages (``benchmarks/rivals/requirements.txt``); they are slow,
so combine it with ``--every 20``, which takes every twentieth recording.
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
from _options import choose_size, find_data, make_parser
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
from kineme.evaluation.score import pool_scores, scores
from kineme.formats import ReadOptions
from kineme.labels.collections import find_labels
from kineme.recordings import Motion, Signals
from kineme_reproduction.figures import format_markdown

SETS = ("hugadb", "hapt", "ipolgait", "utkinect")
SHARES = ("mof", "edit", "f1@10", "f1@25", "f1@50")
OTHERS = ("border_f1", "cut_ratio")
WAYS = {"folder": True, "untold": False}
"""Ways to join the clusters of a set, and whether the number of classes is given."""
READING, WITHOUT = ReadOptions(), ("emg*", "time*")
"""Options for reading, and columns to leave out."""


def read_sensors(path: Path) -> Motion | Signals:
    """Read a recording of a set without muscles and times."""
    return read_selected(path, READING, WITHOUT)


def run_safely(job: Job) -> JobResult:
    """Run a method on a recording, timed by processor seconds; return errors as answers."""
    warnings.simplefilter("ignore")
    try:
        register_rivals()
        return run_job(job, time.process_time)
    except Exception as error:  # noqa: BLE001 (a rival that fails is a result)
        return JobResult(error=f"{type(error).__name__}: {error}")


def map_whole_set(answers: Mapping[Job, JobResult], *, is_given: bool) -> list[Comparison]:
    """Map each cluster to the same class in the whole set."""
    classes = {name for answer in answers.values() for name in answer.classes}
    compared = join_comparisons(list(answers.items()), len(classes) if is_given else None)
    return [one for one in compared if one is not None]


def make_row(name: str, compared: Sequence[Comparison]) -> list[str]:
    """Make a table row and record its figures."""
    cells = []
    for key in (*SHARES, *OTHERS):
        value = pool_scores([scores()[key].function(one) for one in compared])
        value *= 100 if key in SHARES else 1
        record(f"sets.{name}.{key}", round(value, 3))
        cells.append(f"{value:.1f}" if key in SHARES else f"{value:.2f}")
    record(f"sets.{name}.recordings", len(compared))
    return [name, str(len(compared)), *cells]


def main() -> None:
    parser = make_parser(__doc__)
    parser.add_argument(
        "sets", nargs="*", default=choose_size(SETS, SETS[:1]), help=", ".join(SETS)
    )
    parser.add_argument("--methods", nargs="+", default=["kineme"])
    parser.add_argument("--one-mapping", action="store_true", help="for the whole set, too")
    parser.add_argument("--rivals", action="store_true", help="segmenters of other packages, too")
    parser.add_argument("--every", type=int, default=1, help="every n-th recording only")
    parser.add_argument("--processes", type=int, default=choose_size(2, 1))
    add_option(parser)
    options = parser.parse_args()
    here, missing = register_rivals()
    if options.rivals and missing:
        print(f"not installed, so left out: {', '.join(missing)}")
    methods = [*options.methods, *(here if options.rivals else ())]
    part = "" if options.every == 1 else f".every_{options.every}"
    rows = []
    for name in options.sets:
        folder = find_data(f"sets/{name}")
        labels = find_labels(find_recordings(folder / "recordings"), folder / "labels.csv")
        chosen = list(labels.items())[:: options.every][: choose_size(None, 2)]
        with ProcessPoolExecutor(options.processes, mp_context=get_context("spawn")) as pool:
            for method in methods:
                jobs = [Job(*one, method, READING, WITHOUT, options.one_mapping) for one in chosen]
                tried = dict(zip(jobs, pool.map(run_safely, jobs), strict=True))
                for job, answer in tried.items():
                    if answer.error:
                        print(f"{job.path.stem}, {method}: {answer.error}")
                answers = {job: answer for job, answer in tried.items() if not answer.error}
                if not answers:
                    continue
                compared = [a.compared for a in answers.values() if a.compared is not None]
                rows.append(make_row(f"{name}.recording.{method}{part}", compared))
                hours = sum(a.length_s for a in answers.values()) / 3600
                cost = sum(a.seconds for a in answers.values()) / hours
                record(f"sets.{name}.recording.{method}{part}.seconds_per_hour", round(cost, 1))
                rows[-1].append(f"{cost:.1f}")
                for key, is_given in WAYS.items() if options.one_mapping else ():
                    whole = map_whole_set(answers, is_given=is_given)
                    rows.append([*make_row(f"{name}.{key}.{method}{part}", whole), ""])
                    clusters = len(np.unique(np.concatenate([one.found for one in whole])))
                    record(f"sets.{name}.{key}.{method}{part}.clusters", clusters)
    head = ["set", "recordings", *SHARES, *OTHERS, "processor s / h"]
    print(format_markdown(head, rows))


if __name__ == "__main__":
    main()
