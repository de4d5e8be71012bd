"""Two thousand damaged files, as `benchmarks/fuzz.py` makes them for hours."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

FUZZ = Path(__file__).parents[2] / "benchmarks" / "fuzz.py"


def test_two_thousand_damaged_files() -> None:
    ran = subprocess.run(
        [sys.executable, str(FUZZ), "--minutes", "4", "--files", "2000", "--seed", "0"],
        capture_output=True,
        text=True,
        timeout=300,
        check=False,
    )
    assert ran.returncode == 0, ran.stdout + ran.stderr
