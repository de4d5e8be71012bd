"""Measured numbers, kept in ``docs/figures.json`` with what measured them and when.

README and docs quote them from there: ``python docs/fill_figures.py`` writes
them in. A benchmark takes the option ``--record`` and then leaves each number
that is quoted, under a name that begins with its own:
``record("constants.alike.off", 0.021)``.
"""

from __future__ import annotations

import argparse
import datetime as dt
import json
import shlex
import sys
from pathlib import Path

from _options import is_quick
from kineme import __version__

FILE = Path(__file__).resolve().parents[1] / "docs" / "figures.json"
OPTION = "--record"


def add_option(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(OPTION, action="store_true", help=f"keep the numbers in {FILE.name}")


def record(name: str, value: float | str, *, unit: str = "") -> None:
    """Keep a number, or two as in "3 of 4", in the file if the script runs with ``--record``.

    Never one of a quick run, which goes over too little to say anything.
    """
    if OPTION not in sys.argv or is_quick():
        return
    figures = json.loads(FILE.read_text(encoding="utf-8")) if FILE.exists() else {}
    options = [_nowhere(word) for word in sys.argv[1:] if word != OPTION]
    figures[name] = {
        "value": value,
        "unit": unit,
        "command": shlex.join(["python", f"benchmarks/{Path(sys.argv[0]).name}", *options]),
        "version": __version__,
        "date": dt.datetime.now(tz=dt.UTC).date().isoformat(),
    }
    lines = (f"{json.dumps(key)}: {json.dumps(entry)}" for key, entry in sorted(figures.items()))
    FILE.write_text("{\n" + ",\n".join(lines) + "\n}\n", encoding="utf-8")


def _nowhere(word: str) -> str:
    """An option without the place of a file, which is one machine's own."""
    return Path(word).name if Path(word).is_absolute() else word
