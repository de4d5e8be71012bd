"""Some damaged files, as `python -m benchmarks fuzz` makes them for hours."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

FUZZ = [sys.executable, "-m", "benchmarks", "fuzz"]
ROOT = Path(__file__).parents[2]


@pytest.mark.slow
@pytest.mark.skipif(not hasattr(os, "fork"), reason="workers are forks")
@pytest.mark.parametrize("how", [[], ["--structure"]])
def test_damaged_files(how: list[str]) -> None:
    ran = subprocess.run(
        [*FUZZ, "--minutes", "4", "--files", "60", "--seed", "0", *how],
        capture_output=True,
        text=True,
        timeout=300,
        check=False,
        cwd=ROOT,
    )
    assert ran.returncode == 0, ran.stdout + ran.stderr
