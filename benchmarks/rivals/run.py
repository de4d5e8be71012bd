"""Run our methods and other packages on the same recordings.

    python benchmarks/rivals/run.py [--trials 86_01 …] [--methods claspy_clasp …]

Creates an environment in ``benchmarks/rivals/.venv`` (about 800 MB), installs
``requirements.txt`` and this checkout there, and runs ``rivals.py`` in it, which prints JSON.
"""

from __future__ import annotations

import os
import subprocess
import sys
import venv
from pathlib import Path

HERE = Path(__file__).resolve().parent
CHECKOUT = HERE.parents[1]
REQUIREMENTS = HERE / "requirements.txt"
ENVIRONMENT = HERE / ".venv"
PYTHON = ENVIRONMENT / ("Scripts/python.exe" if os.name == "nt" else "bin/python")


def prepare() -> None:
    """Create the environment; replace it if the requirements changed."""
    installed = ENVIRONMENT / "installed.txt"
    if installed.is_file() and installed.read_text() == REQUIREMENTS.read_text():
        return
    venv.create(ENVIRONMENT, with_pip=True, clear=True)
    packages = ["-r", REQUIREMENTS, "-e", CHECKOUT, "-e", CHECKOUT / "reproduction"]
    subprocess.run([PYTHON, "-m", "pip", "install", "-q", *packages], check=True)
    installed.write_text(REQUIREMENTS.read_text())


if __name__ == "__main__":
    prepare()
    beside = CHECKOUT.parent / "shared" / "data"
    environment = {"KINEME_DATA": str(beside), **os.environ} if beside.is_dir() else None
    command = [PYTHON, HERE / "rivals.py", *sys.argv[1:]]
    sys.exit(subprocess.run(command, env=environment, check=False).returncode)
