"""The command line as a process, as people run it."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

Kineme = Callable[..., subprocess.CompletedProcess[str]]


@pytest.fixture
def kineme(tmp_path: Path) -> Kineme:
    """Run ``kineme ARGUMENTS`` in an empty folder."""

    def run(*arguments: object, **environment: str) -> subprocess.CompletedProcess[str]:
        return subprocess.run(
            [sys.executable, "-m", "kineme", *map(str, arguments)],
            capture_output=True,
            text=True,
            encoding="utf-8",
            cwd=tmp_path,
            env={**os.environ, "COLUMNS": "120", "NO_COLOR": "1", **environment},
            timeout=120,
            check=False,
        )

    return run
