"""The pages foresee what an edit makes; the file that holds them to it is that of this package."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any


def test_the_edits_that_the_pages_are_held_to_are_up_to_date(
    page_script: Callable[[str], dict[str, Any]],
) -> None:
    maker = page_script("make_edits.py")
    made = maker["TARGET"].read_text(encoding="utf-8")
    assert made == maker["edits_json"](), "run src/kineme/web/pages/make_edits.py"
