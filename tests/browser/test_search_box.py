"""The search box of the documentation, in pages that lie on a disk."""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]


@pytest.mark.slow
def test_finds_pages_opened_from_a_disk_and_asks_nobody(chromium, tmp_path: Path) -> None:
    pytest.importorskip("mkdocs", reason="the docs are built with the extra [docs]")
    subprocess.run(
        [sys.executable, "-m", "mkdocs", "build", "--quiet", "--site-dir", str(tmp_path / "site")],
        cwd=ROOT,
        check=True,
    )
    page = chromium.new_page()
    asked = []
    page.on("request", lambda request: asked.append(request.url))
    page.goto((tmp_path / "site" / "tutorials" / "animator.html").as_uri())
    page.get_by_role("textbox", name="Search").click()
    page.keyboard.type("loops")
    # What the first letters find stands there first.
    found = page.locator(".md-search-result__item").first
    found.filter(has_text=re.compile("loops", re.IGNORECASE)).wait_for()
    assert [url for url in asked if not url.startswith(("file:", "data:", "blob:"))] == []
    page.close()
