"""Check the accessibility of pages with axe-core."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import kineme

AXE = Path(kineme.__file__).parent / "web/pages/node_modules/axe-core/axe.min.js"
RULES = ["wcag2a", "wcag2aa", "wcag21a", "wcag21aa", "wcag22aa"]


def load_axe(page: Any) -> None:
    """Load axe-core into a page."""
    page.evaluate(f"{AXE.read_text(encoding='utf-8')}; 0")


def violations(page: Any, part: str = "body", *, colors_only: bool = False) -> list[str]:
    """Return the violations of WCAG level A and AA in a part of the page."""
    rules = {"type": "rule", "values": ["color-contrast"]} if colors_only else RULES
    found = page.evaluate(
        "([part, only]) => axe.run(part, { runOnly: only, resultTypes: ['violations'] })",
        [part, rules],
    )
    return [
        f"{each['id']}: {node['target']}, {node['failureSummary']}"
        for each in found["violations"]
        for node in each["nodes"]
    ]
