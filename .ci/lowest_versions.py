"""The lowest versions that pyproject.toml allows, as constraints for pip: one line each.

    python .ci/lowest_versions.py tables library

Of what kineme needs always, and of the extras that are named.
"""

from __future__ import annotations

import re
import sys
import tomllib
from pathlib import Path


def lowest(requirements: list[str]) -> list[str]:
    """``name==version`` for each ``name>=version``."""
    found = (re.match(r"([\w.-]+)>=([\w.]+)", each) for each in requirements)
    return [f"{each[1]}=={each[2]}" for each in found if each]


project = tomllib.loads((Path(__file__).parents[1] / "pyproject.toml").read_text())["project"]
extras = [each for name in sys.argv[1:] for each in project["optional-dependencies"][name]]
print("\n".join(dict.fromkeys(lowest([*project["dependencies"], *extras]))))
