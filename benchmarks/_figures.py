"""Measured numbers, kept in ``docs/figures.json`` with what measured them and when.

``python docs/fill_pages.py`` writes the tables of README and docs from them.
A benchmark takes the option ``--record`` and then keeps each number, under a name
that begins with its own:
``record("constants.alike.off", 0.021)``. Without the option the numbers are
compared with those kept, and what differs is told at the end.
"""

from __future__ import annotations

import argparse
import atexit
import datetime as dt
import json
import shlex
import sys
from pathlib import Path

from _options import is_quick
from kineme import __version__

FILE = Path(__file__).resolve().parents[1] / "docs" / "figures.json"
OPTION = "--record"

_measured: dict[str, float | str] = {}


def add_option(parser: argparse.ArgumentParser) -> None:
    atexit.register(_tell)
    parser.add_argument(OPTION, action="store_true", help=f"keep the numbers in {FILE.name}")


def record(name: str, value: float | str, *, unit: str = "") -> None:
    """Keep a number, or two as in "3 of 4", in the file if the script runs with ``--record``.

    Never one of a quick run, which goes over too little to say anything.
    """
    if is_quick():
        return
    if OPTION not in sys.argv:
        _measured[name] = value
        return
    figures = _kept()
    figures[name] = {
        "value": value,
        "unit": unit,
        "command": _command(),
        "version": __version__,
        "date": dt.datetime.now(tz=dt.UTC).date().isoformat(),
    }
    lines = (f"{json.dumps(key)}: {json.dumps(entry)}" for key, entry in sorted(figures.items()))
    FILE.write_text("{\n" + ",\n".join(lines) + "\n}\n", encoding="utf-8")


def compared(measured: dict[str, float | str]) -> list[str]:
    """A line for each number that is not the one kept, and how many are."""
    figures, lines, same = _kept(), [], 0
    for name, value in measured.items():
        kept = figures.get(name)
        if kept is not None and kept["value"] == value:
            same += 1
        elif kept is None:
            lines.append(f"  {name}: {value}, not recorded")
        else:
            other = "" if kept["command"] == _command() else f" by {kept['command']}"
            lines.append(f"  {name}: {value}, {kept['value']} recorded {kept['date']}{other}")
    return [f"{same} of {len(measured)} figures as recorded{':' if lines else ''}", *lines]


def _tell() -> None:
    if _measured:
        print("\n".join(compared(_measured)))


def _kept() -> dict[str, dict[str, float | str]]:
    return json.loads(FILE.read_text(encoding="utf-8")) if FILE.exists() else {}


def _command() -> str:
    """What is typed to measure that."""
    options = [_nowhere(word) for word in sys.argv[1:] if word != OPTION]
    return shlex.join(["python", "-m", "benchmarks", Path(sys.argv[0]).stem, *options])


def _nowhere(word: str) -> str:
    """An option without the place of a file, which is one machine's own."""
    return Path(word).name if Path(word).is_absolute() else word
