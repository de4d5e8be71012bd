"""Measured numbers in README and docs, filled in from ``figures.json``.

    python docs/fill_figures.py

A number stands between two comments, of which the reader sees nothing. The
first names the figure and its format::

    <!-- figure: synthetic.kineme.counts .0f -->99<!-- / --> %

It may stand in a table, but not at the beginning of a line, where Markdown
takes a comment for a block of its own. Benchmarks measure the figures anew
(``--record``, see ``benchmarks/_figures.py``); one that is still to be measured
is null there, and a dash here.

What is not measured by a benchmark of ours says why, and is left as it is: a
limit, a promise, what a paper says, what was seen once while something was made::

    <!-- stated: the 2014 paper -->35.3 s<!-- / -->

A test finds speed and memory that bear neither mark.
"""

from __future__ import annotations

import json
import re
from collections.abc import Mapping
from pathlib import Path
from typing import Any

HERE = Path(__file__).resolve().parent
FIGURES = HERE / "figures.json"
PAGES = (HERE.parent / "README.md", *sorted(HERE.glob("*.md")))
MARK = re.compile(r"(<!-- figure: (\S+) (\S+) -->)(.*?)(<!-- / -->)")


def filled(text: str, figures: Mapping[str, Mapping[str, Any]]) -> str:
    """The text with every marked number as the figures have it; KeyError for a name not there."""

    def figure(mark: re.Match[str]) -> str:
        value = figures[mark[2]]["value"]
        return mark[1] + ("–" if value is None else format(value, mark[3])) + mark[5]

    return MARK.sub(figure, text)


def main() -> None:
    figures = json.loads(FIGURES.read_text(encoding="utf-8"))
    for page in PAGES:
        before = page.read_text(encoding="utf-8")
        after = filled(before, figures)
        if after != before:
            page.write_text(after, encoding="utf-8")
            print(f"{page.name}: filled")


if __name__ == "__main__":
    main()
