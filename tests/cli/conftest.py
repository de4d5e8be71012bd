"""The command line as people run it: in this process, and as one of its own."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from collections.abc import Callable
from functools import partial
from pathlib import Path

import pytest
from typer.testing import CliRunner

from kineme.cli.app import app
from kineme.datasets import bundled_recording

Kineme = Callable[..., subprocess.CompletedProcess[str]]


@pytest.fixture(scope="session")
def kineme_in() -> Kineme:
    """Run ``kineme ARGUMENTS`` in the folder that comes first."""

    def run(
        folder: Path, *arguments: object, **environment: str
    ) -> subprocess.CompletedProcess[str]:
        return subprocess.run(
            [sys.executable, "-m", "kineme", *map(str, arguments)],
            capture_output=True,
            text=True,
            encoding="utf-8",
            cwd=folder,
            env={**os.environ, "COLUMNS": "120", "NO_COLOR": "1", **environment},
            timeout=120,
            check=False,
        )

    return run


@pytest.fixture
def kineme_process(kineme_in: Kineme, tmp_path: Path) -> Kineme:
    """Run ``kineme ARGUMENTS`` in an empty folder, as a process: it takes two seconds to start."""
    return partial(kineme_in, tmp_path)


@pytest.fixture
def recording(tmp_path: Path) -> Path:
    """The bundled recording, in the folder that commands run in."""
    return Path(shutil.copy(bundled_recording(), tmp_path / "exercises.bvh"))


@pytest.fixture
def kineme(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Kineme:
    """Run ``kineme ARGUMENTS`` in an empty folder, sooner: without a process of its own."""
    monkeypatch.chdir(tmp_path)

    def run(*arguments: object, **environment: str) -> subprocess.CompletedProcess[str]:
        given = [*map(str, arguments)]
        runner = CliRunner(env={"COLUMNS": "120", "NO_COLOR": "1", **environment})
        done = runner.invoke(app, given)
        return subprocess.CompletedProcess(given, done.exit_code, done.stdout, done.stderr)

    return run
