"""No page says how fast or how large something is without a benchmark that says so, too."""

from __future__ import annotations

import runpy
from pathlib import Path

import pytest

from typed_figures import typed_figures

ROOT = Path(__file__).resolve().parents[1]
MADE_WHOLE = ("results", "changes")
"""Pages made from a template, which another test holds to its figures, and the changelog."""
PAGES = [ROOT / "README.md", *sorted((ROOT / "docs").rglob("*.md"))]
FILL = runpy.run_path(str(ROOT / "docs" / "fill_figures.py"))
QUOTED = FILL["quoted"](FILL["QUOTED"].read_text(encoding="utf-8"))
FIGURE = "It takes {growth.kineme.1_h.seconds .1f} s."


@pytest.mark.parametrize(
    "page", [page for page in PAGES if page.stem not in MADE_WHOLE], ids=lambda page: page.stem
)
def test_speed_and_memory_are_measured_or_say_where_they_come_from(page: Path) -> None:
    text = page.read_text(encoding="utf-8")
    passages = QUOTED.get(page.relative_to(ROOT).as_posix(), ())
    assert list(typed_figures(FILL["unquoted"](text, passages))) == []


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
        "It takes what it is given:\n\n```python\nsleep(3)  # takes 3 s\n```\n",
        "| | border F1 (0.5 s) |\n|---|---|\n| a | 0.70 |",
    ],
)
def test_what_is_measured_or_no_cost_is_fine(fine: str) -> None:
    assert list(typed_figures(fine)) == []


@pytest.mark.parametrize(
    ("page", "passage"),
    [
        ("Much.\nIt takes\n3.0 s.", FIGURE),
        ("It takes 35.3 s.", "takes {35.3 s; stated: the paper}."),
        ("| file | seconds |\n|---|---|\n| a | 0.12 |", "| a | {reading.a.seconds .2f} |"),
    ],
)
def test_a_quoted_figure_is_no_typed_one(page: str, passage: str) -> None:
    assert list(typed_figures(page))
    assert not list(typed_figures(FILL["unquoted"](page, [passage])))


def test_a_figure_still_to_be_measured_is_a_dash() -> None:
    page, named = "It takes 11.0 s. It takes 11.0 h.", "growth.kineme.1_h.seconds"
    assert FILL["filled"](page, [FIGURE], {named: {"value": None}}) == (
        "It takes – s. It takes 11.0 h."
    )
    dash = FILL["filled"](page, [FIGURE], {named: {"value": None}})
    assert FILL["filled"](dash, [FIGURE], {named: {"value": 11}}) == page


@pytest.mark.parametrize("page", ["It takes long.", "It takes 1 s. It takes 2 s."])
def test_a_passage_is_there_as_often_as_it_is_listed(page: str) -> None:
    with pytest.raises(LookupError, match="not 1 times there"):
        FILL["filled"](page, [FIGURE], {})


def test_rows_that_look_alike_are_told_by_their_order() -> None:
    page, figures = "| a | 1 |\n\n| a | 2 |\n| a | 1 | 2 |", {"x": {"value": 3}, "y": {"value": 4}}
    found = FILL["filled"](page, ["| a | {x d} |", "| a | {y d} |"], figures)
    assert found == "| a | 3 |\n\n| a | 4 |\n| a | 1 | 2 |"
