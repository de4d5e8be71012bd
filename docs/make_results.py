"""Write the page of results and its pictures, from the recordings of CMU subject 86.

    python docs/make_results.py [FOLDER OF RECORDINGS]

Run what ``kineme evaluate cmu86 --figures`` runs: every method on every trial that is there. Times
are those of the machine it runs on. The page keeps the rows, methods and pictures that it shows.
"""

from __future__ import annotations

import datetime as dt
import os
import platform
import re
import runpy
import shutil
import sys
import tempfile
import warnings
from collections.abc import Collection
from pathlib import Path
from string import Template

from kineme._version import __version__
from kineme_reproduction.benchmark import METHODS, run
from kineme_reproduction.figures import make_figures
from kineme_reproduction.trials import find_folder, load_trials

HERE = Path(__file__).parent
PICTURES = HERE / "images" / "results"
SHOWN_METHODS = ("kineme", "sensors", "voegele2014", "krueger2017", "aca", "haca", "gmm", "uniform")
SHOWN_SCORES = (
    "one to one",
    "one to one, agreed",
    "ARI",
    "Edit",
    "F1@50",
    "border precision",
    "border recall",
    "border F1",
    "covering",
    "borders, found / true",
    "clusters, found / true",
    "strict",
    "tolerant",
    "seconds",
)
SHOWN_PUBLISHED = ("ACA **mean**", "HACA **mean**")


def main() -> None:
    beside = HERE.resolve().parents[1] / "shared" / "data"
    data = find_folder(sys.argv[1] if len(sys.argv) > 1 else os.environ.get("KINEME_DATA", beside))
    template = (HERE / "results.template").read_text(encoding="utf-8")
    results = run(load_trials(data), METHODS)
    with tempfile.TemporaryDirectory() as folder:
        tables = make_figures(results, data, Path(folder))
        for name in re.findall(r"images/results/(\w+\.png)", template):
            shutil.copy(Path(folder, name), PICTURES)
    trials = list(dict.fromkeys(r.trial.name for r in results))
    page = Template(template).substitute(
        version=__version__,
        day=dt.datetime.now(tz=dt.UTC).date().isoformat(),
        cores=len(os.sched_getaffinity(0)),
        machine=platform.machine(),
        trials=", ".join(trials),
        means=select_cells(tables["means"], rows=SHOWN_SCORES, columns=SHOWN_METHODS),
        uniform=tables["uniform cuts"],
        published=select_cells(tables["published cuts"], rows=SHOWN_PUBLISHED),
    )
    (HERE / "results.md").write_text(page, encoding="utf-8")
    runpy.run_path(str(HERE / "fill_pages.py"))["main"]()


def select_cells(table: str, *, rows: Collection[str], columns: Collection[str] = ()) -> str:
    """Return a Markdown table with these rows and columns only; all columns if none are named."""
    lines = [line.strip("|").split("|") for line in table.strip().splitlines()]
    head, _, *body = [[cell.strip() for cell in line] for line in lines]
    kept = [i for i, name in enumerate(head) if i == 0 or not columns or name in columns]
    chosen = [head, ["---", *["---:"] * (len(head) - 1)], *(row for row in body if row[0] in rows)]
    return "\n".join(f"| {' | '.join(row[i] for i in kept)} |" for row in chosen) + "\n"


if __name__ == "__main__":
    warnings.simplefilter("ignore")
    main()
