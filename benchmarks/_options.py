"""What every benchmark asks of its command line, and how it says that it cannot run.

``--quick`` goes the whole way on as little as there is, in seconds: it shows that the benchmark
runs, not what it finds, and its figures are never recorded. ``python -m benchmarks all --quick``
runs all of them so. What recordings, packages or programs a benchmark lacks, it says, and ends as
skipped.
"""

from __future__ import annotations

import argparse
import os
import sys
from importlib.util import find_spec
from pathlib import Path
from typing import NoReturn, TypeVar

DATA = Path(os.environ.get("KINEME_DATA", Path(__file__).resolve().parents[2] / "shared" / "data"))
"""The folder of real recordings."""
QUICK = "--quick"
SKIPPED = 77
"""The exit code of a benchmark that lacks what it needs, as test programs of automake have it."""

T = TypeVar("T")


def command_line(doc: str | None) -> argparse.ArgumentParser:
    """A parser that tells the first line of the script's docstring, and knows ``--quick``."""
    parser = argparse.ArgumentParser(description=(doc or "").strip().splitlines()[0])
    parser.add_argument(QUICK, action="store_true", help="try that it runs, on next to nothing")
    return parser


def is_quick() -> bool:
    return QUICK in sys.argv


def few(usual: T, quick: T) -> T:
    """What is usual, or what will do to try that the script runs."""
    return quick if is_quick() else usual


def needed(place: str, data: Path = DATA) -> Path:
    """A folder or file of the recordings; ends the script as skipped where it is not."""
    path = data / place
    if not path.exists():
        skip(f"no {place} among the recordings: set KINEME_DATA to the folder that holds it")
    return path


def need_packages(*names: str) -> None:
    """End the script as skipped where a package is not installed."""
    missing = [name for name in names if find_spec(name) is None]
    if missing:
        skip(f"needs {', '.join(missing)}: pip install {' '.join(missing)}")


def skip(reason: str) -> NoReturn:
    """End the script as one that cannot run here."""
    print(f"skipped: {reason}", file=sys.stderr)
    sys.exit(SKIPPED)
