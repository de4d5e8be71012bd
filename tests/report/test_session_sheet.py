"""Two sessions on one sheet: the numbers of the tables, whole, and on one page."""

from __future__ import annotations

import os
import re
import shutil
from pathlib import Path

import numpy as np
import pytest

import kineme
from kineme.cycles import Cycles, compare_sessions
from kineme.datasets import Action, synthesize
from kineme.errors import ParameterError, WriteError
from kineme.report.sessions import write_sessions
from rows import pick_row

CHROMIUM = os.environ.get("KINEME_CHROMIUM") or shutil.which("chromium")
EVIL = "</style><script>alert(1)</script> 3 & $x$"


def make_session(amplitude: float, seed: int, *names: str) -> Cycles:
    actions = [Action(name, 6, amplitude=amplitude) for name in names]
    made = synthesize(actions, fps=60, seed=seed)
    return kineme.cycles(made.motion, made.truth)


@pytest.fixture(scope="module")
def squats() -> tuple[Cycles, Cycles]:
    return make_session(1.0, 3, "squat"), make_session(0.7, 4, "squat")


def read_text(path: Path) -> str:
    return path.read_text(encoding="utf-8").replace("\N{MINUS SIGN}", "-")


def test_it_has_the_numbers_of_the_table(squats: tuple[Cycles, Cycles], tmp_path: Path) -> None:
    write_sessions(*squats, tmp_path / "sheet.html", names=("May", "June"))
    page = read_text(tmp_path / "sheet.html")
    row = pick_row(compare_sessions(*squats), measure="knee_l.range")
    mean, sd, difference, low, high = (
        f"{row[name]:.1f}" for name in ("first_mean", "first_sd", "difference", "low", "high")
    )
    assert "squat: 6 → 6 repetitions" in page
    assert f"<td>knee_l range (°)</td><td>{mean} ± {sd}</td>" in page
    assert f"<td>{difference}</td><td>{low} to {high}</td><td>less</td>" in page
    assert "Left beside right" in page


def test_it_says_what_was_left_out_and_where(squats: tuple[Cycles, Cycles], tmp_path: Path) -> None:
    sessions = squats[0], squats[1].exclude([2])
    write_sessions(*sessions, tmp_path / "sheet.html", names=("May", "June"))
    page = read_text(tmp_path / "sheet.html")
    assert "; 1 repetition of June left out (by hand)." in page
    assert "of May left out" not in page
    assert "(means of 4 and 3)" in page


def test_it_is_whole_and_texts_stay_texts(squats: tuple[Cycles, Cycles], tmp_path: Path) -> None:
    write_sessions(*squats, tmp_path / "sheet.html", names=(EVIL, "_June"))
    page = read_text(tmp_path / "sheet.html")
    assert "<script" not in page
    assert not re.findall(r'(?:src|href)="(?!data:)', page)
    assert page.count("<img") == 6


def test_what_cannot_be_compared_is_refused(squats: tuple[Cycles, Cycles], tmp_path: Path) -> None:
    with pytest.raises(ParameterError, match="the sessions have no group in common"):
        write_sessions(squats[0], make_session(1.0, 3, "walk"), tmp_path / "sheet.html")
    with pytest.raises(WriteError, match=r"written as \.html"):
        write_sessions(*squats, tmp_path / "sheet.pdf")
    assert list(tmp_path.iterdir()) == []


def test_few_repetitions_give_no_bounds(squats: tuple[Cycles, Cycles], tmp_path: Path) -> None:
    first = squats[0].select(np.arange(len(squats[0])) < 2)  # one of them inner
    write_sessions(first, squats[1], tmp_path / "sheet.html")
    page = read_text(tmp_path / "sheet.html")
    assert "too few" in page
    assert "nan" not in re.sub(r'src="[^"]*"', "", page)


@pytest.mark.skipif(not CHROMIUM, reason="no chromium on this machine")
def test_it_prints_on_one_sheet(squats: tuple[Cycles, Cycles], tmp_path: Path) -> None:
    sync_api = pytest.importorskip("playwright.sync_api", reason="playwright is not installed")
    many = ("squat", "walk", "jump", "wave", "run")
    pages = {"one": squats}
    for n in (2, 3, 5):
        pages[f"{n}"] = make_session(1.0, 3, *many[:n]), make_session(0.9, 4, *many[:n])
    long = "Thursday afternoon, after the second week of training with weights"
    with sync_api.sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=CHROMIUM, args=["--no-sandbox"])
        tab = browser.new_page()
        for name, both in pages.items():
            write_sessions(*both, tmp_path / f"{name}.html", names=(long, "Friday"))
            tab.goto((tmp_path / f"{name}.html").as_uri())
            printed = tab.pdf(prefer_css_page_size=True)
            assert len(re.findall(rb"/Type */Page[^s]", printed)) == 1, name
        browser.close()
