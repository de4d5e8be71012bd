"""kineme at work in a process of its own, so that Blender goes on and the work can be ended.

kineme wants a newer numpy than some versions of Blender have, and compiled code; the Python that
runs it is that of the preferences, Blender's own where kineme is installed there, or the one
that the command ``kineme`` is found with.
"""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from importlib.util import find_spec
from pathlib import Path
from typing import Any

WORKER = Path(__file__).with_name("worker.py")
ADVICE = "install it (pip install kineme), and name its Python in the preferences of the extension"
HIDDEN = getattr(subprocess, "CREATE_NO_WINDOW", 0)
"""No window of a console on Windows."""


class FailureError(Exception):
    """What went wrong, in a sentence for the user."""


def python_of(preference: str) -> list[str]:
    """The command of the Python that has kineme; FailureError where there is none.

    The preference is a path of it, or of the command ``kineme``, which names it or lies beside it.
    """
    if preference:
        program = Path(preference).expanduser()
        if not program.is_file():
            raise FailureError(f"there is no program {preference}: {ADVICE}")
        return [str(_python_beside(program))]
    if find_spec("kineme") is not None:
        return [sys.executable]
    if command := shutil.which("kineme"):
        return [str(_python_beside(Path(command)))]
    raise FailureError(f"kineme is not found: {ADVICE}")


def _python_beside(program: Path) -> Path:
    """A program that is a Python, or the Python of a command: beside it, or in its first line."""
    if program.name.lower().startswith("python"):
        return program
    folder = program.resolve().parent
    for name in ("python3", "python", "python.exe"):
        if (folder / name).is_file():
            return folder / name
    with program.open("rb") as file:
        line = file.readline(1000).decode(errors="replace")
    if line.startswith("#!") and Path(line[2:].strip()).is_file():
        return Path(line[2:].strip())
    raise FailureError(f"no Python lies beside {program}: name the Python that has kineme")


def work(command: list[str], task: dict[str, Any]) -> Iterator[str]:
    """Have kineme do a task; the stage it is at, again and again. What it returns is the answer.

    Ends the process where nobody waits for it any more.
    """
    environment = dict(os.environ)
    environment.pop("PYTHONHOME", None)  # that of Blender's Python is not that of another
    if command[0] == sys.executable:  # what Blender's Python finds beyond its own folders
        environment["PYTHONPATH"] = os.pathsep.join(filter(None, sys.path))
    with tempfile.TemporaryDirectory(prefix="kineme-") as folder:
        place = Path(folder)
        (place / "task.json").write_text(json.dumps(task), encoding="utf-8")
        with (place / "stages").open("wb") as stages, (place / "errors").open("wb") as errors:
            process = subprocess.Popen(  # noqa: S603
                [*command, "-P", str(WORKER), folder],
                stdin=subprocess.DEVNULL,
                stdout=stages,
                stderr=errors,
                env=environment,
                creationflags=HIDDEN,
            )
        try:
            while process.poll() is None:
                lines = (place / "stages").read_text(encoding="utf-8", errors="replace").split("\n")
                yield next((line for line in reversed(lines[:-1]) if line), "starting")
        finally:
            if process.poll() is None:
                process.kill()
            process.wait()
        return _answer(place, process.returncode)


def _answer(place: Path, code: int) -> dict[str, Any]:
    """What the worker left; FailureError with its sentence, or with the last line it said."""
    try:
        answer = json.loads((place / "answer.json").read_text(encoding="utf-8"))
    except (OSError, ValueError):
        text = (place / "errors").read_text(encoding="utf-8", errors="replace")
        lines = [line for line in text.splitlines() if line.strip()]
        reason = lines[-1] if lines else f"it ended with {code}"
        if "No module named" in reason and "kineme" in reason:
            raise FailureError(f"this Python has no kineme: {ADVICE}") from None
        raise FailureError(f"kineme stopped: {reason:.300}") from None
    if "failure" in answer:
        raise FailureError(answer["failure"])
    return answer
