"""Store measured figures in ``docs/figures.json``, with command, version and date.

``python docs/fill_pages.py`` writes the tables of README and docs from them. With ``--record`` a
benchmark stores each figure under a name that starts with its own:
``record("constants.bands.off", 0.021)``. Without it, the figures are compared with those stored,
and differences are printed at the end.
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
    atexit.register(_print_comparison)
    parser.add_argument(OPTION, action="store_true", help=f"keep the numbers in {FILE.name}")


def record(name: str, value: float | str, *, unit: str = "") -> None:
    """Store a number, or a text such as "3 of 4", if the script runs with ``--record``.

    Ignore figures of quick runs, which use too little data.
    """
    if is_quick():
        return
    if OPTION not in sys.argv:
        _measured[name] = value
        return
    figures = _read_figures()
    figures[name] = {
        "value": value,
        "unit": unit,
        "command": _format_command(),
        "version": __version__,
        "date": dt.datetime.now(tz=dt.UTC).date().isoformat(),
    }
    lines = (f"{json.dumps(key)}: {json.dumps(entry)}" for key, entry in sorted(figures.items()))
    FILE.write_text("{\n" + ",\n".join(lines) + "\n}\n", encoding="utf-8")


def compare_figures(measured: dict[str, float | str]) -> list[str]:
    """Return the number of figures that equal those stored, and a line for each other one."""
    figures, lines, same = _read_figures(), [], 0
    for name, value in measured.items():
        kept = figures.get(name)
        if kept is not None and kept["value"] == value:
            same += 1
        elif kept is None:
            lines.append(f"  {name}: {value}, not recorded")
        else:
            other = "" if kept["command"] == _format_command() else f" by {kept['command']}"
            lines.append(f"  {name}: {value}, {kept['value']} recorded {kept['date']}{other}")
    return [f"{same} of {len(measured)} figures as recorded{':' if lines else ''}", *lines]


def _print_comparison() -> None:
    if _measured:
        print("\n".join(compare_figures(_measured)))


def _read_figures() -> dict[str, dict[str, float | str]]:
    return json.loads(FILE.read_text(encoding="utf-8")) if FILE.exists() else {}


def _format_command() -> str:
    """Return the command that measures the figures."""
    options = [_strip_folder(word) for word in sys.argv[1:] if word != OPTION]
    return shlex.join(["python", "-m", "benchmarks", Path(sys.argv[0]).stem, *options])


def _strip_folder(word: str) -> str:
    """Return an option without the folder of a file, which differs between machines."""
    return Path(word).name if Path(word).is_absolute() else word
