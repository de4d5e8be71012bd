"""The command line as people run it: in this process, and as one of its own."""

from __future__ import annotations

import os
import shutil
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from functools import partial
from pathlib import Path

import pytest
from typer.testing import CliRunner

from kineme.cli.app import app
from kineme.datasets import bundled_recording

Done = subprocess.CompletedProcess[str]
Kineme = Callable[..., Done]
"""Runs ``kineme ARGUMENTS``; checks the exit ``code`` and, if given, what standard error says."""


def checked(done: Done, code: int | None, errors: str | None) -> Done:
    assert code in (None, done.returncode), done.stderr
    assert errors in (None, done.stderr)
    return done


@pytest.fixture(scope="session")
def kineme_in() -> Kineme:
    """Run ``kineme ARGUMENTS`` in the folder that comes first."""

    def run(
        folder: Path,
        *arguments: object,
        code: int | None = 0,
        errors: str | None = None,
        **environment: str,
    ) -> Done:
        done = subprocess.run(
            [sys.executable, "-m", "kineme", *map(str, arguments)],
            capture_output=True,
            text=True,
            encoding="utf-8",
            cwd=folder,
            env={**os.environ, "COLUMNS": "120", "NO_COLOR": "1", **environment},
            timeout=600,
            check=False,
        )
        return checked(done, code, errors)

    return run


@pytest.fixture
def kineme_process(kineme_in: Kineme, tmp_path: Path) -> Kineme:
    """Run ``kineme ARGUMENTS`` in an empty folder, as a process: it takes two seconds to start."""
    return partial(kineme_in, tmp_path)


@pytest.fixture
def interrupted(tmp_path: Path) -> Callable[..., tuple[int, str, str]]:
    """Press Ctrl+C in ``kineme ARGUMENTS`` once something holds; exit code and what is said."""

    def run(at_work: Callable[[int], object], *arguments: object) -> tuple[int, str, str]:
        with subprocess.Popen(
            [sys.executable, "-m", "kineme", *map(str, arguments)],
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
            cwd=tmp_path,
            env={**os.environ, "KINEME_THREADS": "2"},
            start_new_session=True,
            # What runs in a script's background is started deaf to Ctrl+C.
            preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL),
        ) as process:
            while not at_work(process.pid):
                assert process.poll() is None
                time.sleep(0.01)
            os.killpg(process.pid, signal.SIGINT)
            out, err = process.communicate(timeout=60)
        return process.returncode, out, err

    return run


@pytest.fixture
def recording(tmp_path: Path) -> Path:
    """The bundled recording, in the folder that commands run in."""
    return Path(shutil.copy(bundled_recording(), tmp_path / "exercises.bvh"))


@pytest.fixture
def kineme(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Kineme:
    """Run ``kineme ARGUMENTS`` in an empty folder, sooner: without a process of its own.

    It reads ``text`` from standard input.
    """
    monkeypatch.chdir(tmp_path)

    def run(
        *arguments: object,
        code: int | None = 0,
        errors: str | None = None,
        text: str = "",
        **environment: str,
    ) -> Done:
        given = [*map(str, arguments)]
        runner = CliRunner(env={"COLUMNS": "120", "NO_COLOR": "1", **environment})
        done = runner.invoke(app, given, input=text)
        shown = subprocess.CompletedProcess(given, done.exit_code, done.stdout, done.stderr)
        return checked(shown, code, errors)

    return run
