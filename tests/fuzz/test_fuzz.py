"""Some thousand damaged files, as `benchmarks/fuzz.py` makes them for hours."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

FUZZ = Path(__file__).parents[2] / "benchmarks" / "fuzz.py"


@pytest.mark.skipif(not hasattr(os, "fork"), reason="workers are forks")
@pytest.mark.parametrize("how", [[], ["--structure"]])
def test_a_thousand_damaged_files(how: list[str]) -> None:
    ran = subprocess.run(
        [sys.executable, str(FUZZ), "--minutes", "4", "--files", "1000", "--seed", "0", *how],
        capture_output=True,
        text=True,
        timeout=300,
        check=False,
    )
    assert ran.returncode == 0, ran.stdout + ran.stderr
