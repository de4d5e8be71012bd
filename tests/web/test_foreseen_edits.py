"""The pages foresee what an edit makes; the file that holds them to it is that of this package."""

from __future__ import annotations

import importlib.util
from pathlib import Path

import pytest

import kineme

PAGES = Path(kineme.__file__).parent / "web" / "pages"


def test_the_edits_that_the_pages_are_held_to_are_up_to_date() -> None:
    path = PAGES / "make_edits.py"
    if "site-packages" in str(path) and not path.exists():
        pytest.skip("the sources of the pages are not in a wheel")
    spec = importlib.util.spec_from_file_location("make_edits", path)
    maker = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(maker)
    made = maker.TARGET.read_text(encoding="utf-8")
    assert made == maker.edits_json(), "run src/kineme/web/pages/make_edits.py"
