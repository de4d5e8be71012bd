"""Define the options that all benchmarks share, and skip benchmarks that cannot run.

With ``--quick`` a benchmark runs all its code on little data, in seconds. Its figures are not
recorded. A benchmark that lacks recordings, packages or programs ends as skipped.
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
"""Exit code of a skipped benchmark, as in automake."""

T = TypeVar("T")


def make_parser(doc: str | None) -> argparse.ArgumentParser:
    """Return a parser with the first line of the docstring as help, and ``--quick``."""
    parser = argparse.ArgumentParser(description=(doc or "").strip().splitlines()[0])
    parser.add_argument(QUICK, action="store_true", help="check that it runs, on little data")
    return parser


def is_quick() -> bool:
    return QUICK in sys.argv


def choose_size(usual: T, quick: T) -> T:
    """Return the second value in a quick run, otherwise the first."""
    return quick if is_quick() else usual


def find_data(place: str) -> Path:
    """Return the path of a folder or file of recordings; skip the benchmark if it is missing."""
    path = DATA / place
    if not path.exists():
        skip(f"no {place} among the recordings: set KINEME_DATA to the folder that holds it")
    return path


def need_packages(*names: str) -> None:
    """Skip the benchmark if a package is not installed."""
    missing = [name for name in names if find_spec(name) is None]
    if missing:
        skip(f"needs {', '.join(missing)}: pip install {' '.join(missing)}")


def skip(reason: str) -> NoReturn:
    """Exit as skipped, with a reason."""
    print(f"skipped: {reason}", file=sys.stderr)
    sys.exit(SKIPPED)
