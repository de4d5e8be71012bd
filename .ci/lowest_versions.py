"""The lowest versions that pyproject.toml allows, as constraints for pip: one line each."""

from __future__ import annotations

import re
import tomllib
from pathlib import Path


def lowest(requirements: list[str]) -> list[str]:
    """``name==version`` for each ``name>=version``."""
    found = (re.match(r"([\w.-]+)>=([\w.]+)", each) for each in requirements)
    return [f"{each[1]}=={each[2]}" for each in found if each]


project = tomllib.loads((Path(__file__).parents[1] / "pyproject.toml").read_text())["project"]
print("\n".join(lowest([*project["dependencies"], *project["optional-dependencies"]["tables"]])))
