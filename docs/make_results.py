"""The page of results and its pictures, from the recordings of CMU subject 86.

    python docs/make_results.py [FOLDER OF RECORDINGS]

Runs what ``kineme evaluate cmu86 --figures`` runs: every method on every trial
at hand. Times are those of the machine it runs on.
"""

from __future__ import annotations

import datetime as dt
import os
import platform
import runpy
import sys
import warnings
from pathlib import Path
from string import Template

from kineme._version import __version__
from kineme.evaluation.tables import format_score
from kineme_reproduction.benchmark import METHODS, mean_scores, run
from kineme_reproduction.figures import make_figures
from kineme_reproduction.trials import find_folder, load_trials

HERE = Path(__file__).parent
PICTURES = HERE / "images" / "results"


def main() -> None:
    beside = HERE.resolve().parents[1] / "shared" / "data"
    data = find_folder(sys.argv[1] if len(sys.argv) > 1 else os.environ.get("KINEME_DATA", beside))
    PICTURES.mkdir(parents=True, exist_ok=True)
    results = run(load_trials(data), METHODS)
    tables = make_figures(results, data, PICTURES)
    means = mean_scores(results)
    scores = {
        f"{method}_{name}": format_score(value)
        for method, row in means.items()
        for name, value in row.items()
    }
    trials = list(dict.fromkeys(r.trial.name for r in results))
    page = Template((HERE / "results.template").read_text(encoding="utf-8")).substitute(
        scores,
        version=__version__,
        day=dt.datetime.now(tz=dt.UTC).date().isoformat(),
        cores=len(os.sched_getaffinity(0)),
        machine=platform.machine(),
        trials=", ".join(trials),
        means=tables["means"],
        uniform=tables["uniform cuts"],
        published=tables["published cuts"],
        reoccurrence=tables["reoccurrence"],
        per_trial="\n".join(f"### {trial}\n\n{tables[trial]}" for trial in trials),
    )
    (HERE / "results.md").write_text(page, encoding="utf-8")
    runpy.run_path(str(HERE / "fill_figures.py"))["main"]()


if __name__ == "__main__":
    warnings.simplefilter("ignore")
    main()
