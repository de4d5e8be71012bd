"""The scripts that make files of the pages, which are in no package."""

from __future__ import annotations

import runpy
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

import kineme

PAGES = Path(kineme.__file__).parent / "web" / "pages"


@pytest.fixture(scope="session")
def page_script() -> Callable[[str], dict[str, Any]]:
    """What a script defines, by its name."""

    def load(name: str) -> dict[str, Any]:
        path = PAGES / name
        if "site-packages" in str(path) and not path.exists():
            pytest.skip("the sources of the pages are not in a wheel")
        return runpy.run_path(str(path))

    return load
