"""Every benchmark once in its quick form: those that have stopped to run are found here.

    python benchmarks/quick.py [NAME ...] [--jobs 2] [--folder benchmarks]

Each script of the folder runs with ``--quick`` as a process of its own. One that fails, or that
has no quick form, is told with what it said last, and this ends with 1. One that lacks
recordings, packages or a browser says so and is skipped. Nothing is measured: several run at once.
"""

from __future__ import annotations

import argparse
import os
import re
import signal
import subprocess
import sys
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from time import perf_counter
from typing import NamedTuple

from _options import QUICK, SKIPPED

HERE = Path(__file__).resolve().parent
LIMIT_S = 600.0
QUICK_FORM = re.compile(r"^from _options import .*\bcommand_line\b", re.MULTILINE)
"""What a script has in it that knows ``--quick``; to ask it would take a second each."""


class Ended(NamedTuple):
    """How a script ended: well, skipped or wrong, after so long, and what is to be said of it."""

    name: str
    how: str
    seconds: float
    said: str


def scripts(folder: Path, names: list[str]) -> Iterator[Path]:
    """The benchmarks of a folder, the named ones or all but this one."""
    for path in sorted(folder.glob("[!_]*.py")):
        if path.name != Path(__file__).name and (path.stem in names or not names):
            yield path


def tried(script: Path) -> Ended:
    """A script in its quick form."""
    if not QUICK_FORM.search(script.read_text(encoding="utf-8")):
        return Ended(script.stem, "wrong", 0.0, f"has no {QUICK}: see _options.command_line")
    start = perf_counter()
    process = subprocess.Popen(
        [sys.executable, str(script), QUICK],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        start_new_session=True,  # so that all that it started can be ended with it
    )
    try:
        out, err = process.communicate(timeout=LIMIT_S)
    except subprocess.TimeoutExpired:
        os.killpg(process.pid, signal.SIGKILL)
        process.communicate()
        return Ended(script.stem, "wrong", LIMIT_S, f"not done after {LIMIT_S:g} s")
    seconds = perf_counter() - start
    if process.returncode == SKIPPED:
        return Ended(script.stem, "skipped", seconds, err.strip().splitlines()[-1])
    if process.returncode:
        said = f"ended with {process.returncode}\n{out[-1000:]}{err[-3000:]}"
        return Ended(script.stem, "wrong", seconds, said)
    return Ended(script.stem, "well", seconds, "")


def main() -> int:
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("names", nargs="*", help="of scripts, without .py; all, if none is named")
    parser.add_argument("--jobs", type=int, default=os.cpu_count() or 1, help="at a time")
    parser.add_argument("--folder", type=Path, default=HERE)
    options = parser.parse_args()
    chosen = list(scripts(options.folder, options.names))
    if unknown := set(options.names) - {path.stem for path in chosen}:
        parser.error(f"no such benchmark: {', '.join(sorted(unknown))}")
    if not options.names and options.folder == HERE:
        print("rivals: skipped, they make an environment of their own: rivals/run.py")
    start, wrong = perf_counter(), []
    with ThreadPoolExecutor(options.jobs) as pool:
        for ended in pool.map(tried, chosen):
            print(f"{ended.name:24}{ended.seconds:6.1f} s  {ended.how}  {ended.said}", flush=True)
            wrong += [ended.name] if ended.how == "wrong" else []
    print(f"{len(chosen)} benchmarks in {perf_counter() - start:.0f} s; wrong: {wrong or 'none'}")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
