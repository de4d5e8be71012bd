"""The pages and the package speak of the same messages."""

from __future__ import annotations

import runpy
from pathlib import Path

import pytest

import kineme


def test_typescript_is_up_to_date() -> None:
    script = Path(kineme.__file__).parent / "web" / "pages" / "make_messages.py"
    if not script.exists():
        pytest.skip("the sources of the pages are not in a wheel")
    for path, made in runpy.run_path(str(script))["make_files"]().items():
        assert path.read_text(encoding="utf-8") == made, "run src/kineme/web/pages/make_messages.py"
