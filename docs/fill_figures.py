"""Write the measured figures into README.md and results.md.

    python docs/fill_figures.py

`figures.json` has what the benchmarks measured (``python -m benchmarks NAME --record``). The tables
stand between ``<!-- figures -->`` and ``<!-- /figures -->``; no other text on any page is changed.
"""

from __future__ import annotations

import json
import re
from collections.abc import Mapping
from pathlib import Path
from typing import Any

HERE = Path(__file__).resolve().parent
FIGURES = HERE / "figures.json"
MARKED = re.compile(r"(<!-- figures -->\n).*?(<!-- /figures -->)", re.DOTALL)
METHODS = ("kineme", "voegele2014", "krueger2017", "haca")
SCORES = {
    "CMU subject 86: frames in the right class": "fairness.subject_86.{}.one_to_one",
    "CMU subject 86: border F1 within 0.25 s": "fairness.subject_86.{}.border_f1",
    "synthetic recordings: activities counted exactly, %": "synthetic.{}.counts",
}
"""Rows of the table in README: what they tell, and the figure of each method."""

Figures = Mapping[str, Mapping[str, Any]]


def readme_table(figures: Figures) -> str:
    """Return the scores of the methods beside each other."""
    rows = [["", *(f"`{method}`" for method in METHODS)], ["---"] * (1 + len(METHODS))]
    for title, name in SCORES.items():
        found = (figures.get(name.format(method), {}) for method in METHODS)
        rows.append([title, *(shown(each) if each else "–" for each in found)])
    return table_of(rows)


def results_tables(figures: Figures) -> str:
    """Return all figures: a table for each benchmark, a row for what has several figures."""
    groups: dict[str, dict[str, list[str]]] = {}
    dates: dict[str, str] = {}
    for name, figure in figures.items():
        benchmark, _, rest = name.partition(".")
        row, _, last = rest.rpartition(".")
        groups.setdefault(benchmark, {}).setdefault(row, []).append(f"{last} {shown(figure)}")
        dates[benchmark] = max(dates.get(benchmark, ""), figure["date"])
    head = [["of", "figures"], ["---"] * 2]
    parts = (
        f"### {name}\n\nMeasured {dates[name]}.\n\n"
        + table_of([*head, *([row, ", ".join(c)] for row, c in rows.items())])
        for name, rows in groups.items()
    )
    return "\n\n".join(parts)


def shown(figure: Mapping[str, Any]) -> str:
    """Return a figure with its unit."""
    value = figure["value"]
    text = f"{value:.4g}" if isinstance(value, float) else "–" if value is None else str(value)
    return f"{text} {figure['unit']}".strip()


def table_of(rows: list[list[str]]) -> str:
    return "\n".join(f"| {' | '.join(row)} |" for row in rows)


PAGES = {HERE.parent / "README.md": readme_table, HERE / "results.md": results_tables}


def filled(page: Path) -> str:
    """Return the text of a page with its tables as the figures have them."""
    table = PAGES[page](json.loads(FIGURES.read_text(encoding="utf-8")))
    text = page.read_text(encoding="utf-8")
    return MARKED.sub(lambda mark: f"{mark[1]}\n{table}\n\n{mark[2]}", text)


def main() -> None:
    for page in PAGES:
        page.write_text(filled(page), encoding="utf-8")


if __name__ == "__main__":
    main()
