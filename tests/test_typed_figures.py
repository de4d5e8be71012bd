"""No page says how fast or how large something is without a benchmark that says so, too."""

from __future__ import annotations

import re
import runpy
from pathlib import Path

import pytest

from typed_figures import typed_figures

ROOT = Path(__file__).resolve().parents[1]
MADE_WHOLE = ("results", "changes")
"""Pages made from a template, which another test holds to its figures, and the changelog."""
PAGES = [ROOT / "README.md", *sorted((ROOT / "docs").rglob("*.md"))]
FILL = runpy.run_path(str(ROOT / "docs" / "fill_figures.py"))


@pytest.mark.parametrize(
    "page", [page for page in PAGES if page.stem not in MADE_WHOLE], ids=lambda page: page.stem
)
def test_speed_and_memory_are_measured_or_say_where_they_come_from(page: Path) -> None:
    assert list(typed_figures(page.read_text(encoding="utf-8"))) == []


@pytest.mark.parametrize(
    "typed",
    [
        "One hour in 1.8 s: it takes\n2.1 s of processor time.",
        "It holds 1.13 GB at most.",
        "Four hours are 4 times as slow.",
        "| file | seconds |\n|---|---|\n| a | 0.12 |",
        "| measure | found |\n|---|---|\n| a walk | 0.2 to 1.0 s on two shared cores |",
    ],
)
def test_a_typed_figure_is_found(typed: str) -> None:
    assert list(typed_figures(typed))


@pytest.mark.parametrize(
    "fine",
    [
        "A border counts within 0.25 s of the true one.",
        "It takes <!-- figure: growth.kineme.1_h.seconds .1f -->3.0<!-- / --> s.",
        "It takes <!-- stated: the paper -->35.3 s<!-- / -->.",
        "It takes what it is given:\n\n```python\nsleep(3)  # takes 3 s\n```\n",
        "| | border F1 (0.5 s) |\n|---|---|\n| a | 0.70 |",
    ],
)
def test_what_is_measured_or_no_cost_is_fine(fine: str) -> None:
    assert list(typed_figures(fine)) == []


def test_a_figure_still_to_be_measured_is_a_dash() -> None:
    page = "<!-- figure: growth.kineme.1_h.seconds .1f -->11.0<!-- / --> s"
    filled = FILL["filled"](page, {"growth.kineme.1_h.seconds": {"value": None}})
    assert re.sub("<!--.*?-->", "", filled) == "– s"
