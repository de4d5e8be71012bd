"""Some damaged files, as `python -m benchmarks fuzz` makes them for hours."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
# The numbers on both sides of this one: bytes are damaged, and then what they mean. One run, since
# to make the samples takes longer than to read them.
FUZZ = """
import sys
sys.path[:0] = ["benchmarks", "benchmarks/durability"]
from fuzz import STRUCTURED, fuzz
found = fuzz(240, 160, STRUCTURED - 80)
print(found)
sys.exit(bool(found))
"""


@pytest.mark.slow
@pytest.mark.skipif(not hasattr(os, "fork"), reason="workers are forks")
def test_damaged_files() -> None:
    command = [sys.executable, "-c", FUZZ]
    ran = subprocess.run(
        command, capture_output=True, text=True, timeout=300, check=False, cwd=ROOT
    )
    assert ran.returncode == 0, ran.stdout + ran.stderr
