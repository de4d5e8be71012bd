"""List and run the benchmarks.

    python -m benchmarks                            list them, with the time that each takes
    python -m benchmarks sources hugadb --every 6   run one, with its own options
    python -m benchmarks startup,reading --record   run several in turn
    python -m benchmarks speed --quick              run those of a folder
    python -m benchmarks all --quick                run all on little data, several at a time

Each benchmark runs in its own process. ``--quick`` uses so little data that it takes seconds: it
shows only that a benchmark runs. A full run compares its figures with those in
``docs/figures.json``; ``--record`` stores them there, and the run time in ``times.json``. A
benchmark that lacks recordings, packages or a browser is skipped. The exit code is 1 if one fails.
"""

from __future__ import annotations

import ast
import datetime as dt
import json
import os
import re
import signal
import subprocess
import sys
from collections.abc import Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from time import perf_counter
from typing import NamedTuple

from benchmarks._options import QUICK, SKIPPED

HERE = Path(__file__).resolve().parent
ALL, RECORD, HELP = "all", "--record", ("-h", "--help")
LIMIT_S = 600.0
"""Time limit of one of several quick benchmarks."""
RECORDS = re.compile(r"^from _figures import .*\badd_option\b", re.MULTILINE)
"""Matches scripts that accept ``--record``; asking each for its help would take a second."""


class Outcome(NamedTuple):
    """How a benchmark ended (well, skipped or wrong), its run time and a message."""

    name: str
    status: str
    seconds: float
    message: str = ""


def main(arguments: Sequence[str]) -> int:
    if not arguments or arguments[0] in HELP:
        print((__doc__ or "") if arguments else list_benchmarks())
        return 0
    selection, *options = arguments
    chosen = find_scripts(selection)
    if len(chosen) == 1:
        return run_visibly(chosen[0], options).returncode
    start = perf_counter()
    wrong: list[str] = []
    for ended in run_several(chosen, options):
        print(f"{ended.name:24}{ended.seconds:6.1f} s  {ended.status}  {ended.message}", flush=True)
        wrong += [ended.name] if ended.status == "wrong" else []
    seconds = perf_counter() - start
    print(
        f"{len(chosen)} benchmarks in {seconds:.0f} s; wrong: {', '.join(sorted(wrong)) or 'none'}"
    )
    return 1 if wrong else 0


def find_scripts(selection: str) -> list[Path]:
    """Return all benchmarks, those of a folder, or those named, in that order."""
    known = {path.stem: path for path in sorted(HERE.glob("*/[!_]*.py"))}
    chosen: list[Path] = []
    for word in selection.split(","):
        within = [path for path in known.values() if word in (ALL, path.parent.name)]
        if not within and word not in known:
            raise SystemExit(f"no benchmark or folder {word!r}; python -m benchmarks lists them")
        chosen += within or [known[word]]
    return list(dict.fromkeys(chosen))


def list_benchmarks() -> str:
    """Return a line for each benchmark: seconds of a quick and a full run, and its summary."""
    times = read_times()
    lines = [f"{'':24}{'quick':>7}{'whole':>8}  (seconds, where recorded)"]
    home = None
    for script in find_scripts(ALL):
        if script.parent.name != home:
            home = script.parent.name
            lines += ["", home]
        taken = times.get(script.stem, {})
        quick, whole = (
            f"{taken[form]['seconds']:.0f}" if form in taken else "–" for form in ("quick", "whole")
        )
        summary = (ast.get_docstring(ast.parse(read_text(script))) or "").partition("\n")[0]
        lines.append(f"  {script.stem:22}{quick:>7}{whole:>8}  {summary}")
    return "\n".join(lines)


def run_visibly(script: Path, options: Sequence[str]) -> subprocess.CompletedProcess[bytes]:
    """Run a benchmark, show its output, and record its time if ``--record`` is set."""
    start = perf_counter()
    done = subprocess.run(build_command(script, options), env=build_environment(), check=False)
    if done.returncode == 0:
        record_time(script.stem, options, perf_counter() - start)
    return done


def run_several(chosen: Sequence[Path], options: Sequence[str]) -> Iterator[Outcome]:
    """Run benchmarks in turn and show their output.

    Quick runs measure nothing: they run in parallel without output, unless they are timed.
    """
    if QUICK not in options:
        for script in chosen:
            print(f"\n== {script.stem}", flush=True)
            start, code = perf_counter(), run_visibly(script, options).returncode
            status = {0: "well", SKIPPED: "skipped"}.get(code, "wrong")
            yield Outcome(script.stem, status, perf_counter() - start)
        return
    jobs = 1 if RECORD in options else len(os.sched_getaffinity(0))
    with ThreadPoolExecutor(jobs) as pool:
        yield from pool.map(lambda script: run_quietly(script, options), chosen)


def run_quietly(script: Path, options: Sequence[str]) -> Outcome:
    """Run a benchmark without output."""
    start = perf_counter()
    process = subprocess.Popen(
        build_command(script, options),
        env=build_environment(),
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        start_new_session=True,  # so that its child processes can be killed with it
    )
    try:
        out, err = process.communicate(timeout=LIMIT_S)
    except subprocess.TimeoutExpired:
        os.killpg(process.pid, signal.SIGKILL)
        process.communicate()
        return Outcome(script.stem, "wrong", LIMIT_S, f"not done after {LIMIT_S:g} s")
    seconds = perf_counter() - start
    if process.returncode == SKIPPED:
        return Outcome(script.stem, "skipped", seconds, err.strip().splitlines()[-1])
    if process.returncode:
        message = f"ended with {process.returncode}\n{out[-1000:]}{err[-3000:]}"
        return Outcome(script.stem, "wrong", seconds, message)
    record_time(script.stem, options, seconds)
    return Outcome(script.stem, "well", seconds)


def build_command(script: Path, options: Sequence[str]) -> list[str]:
    """Return the command; omit ``--record`` if the script does not accept it."""
    knows = RECORDS.search(read_text(script))
    return [sys.executable, str(script), *(word for word in options if knows or word != RECORD)]


def build_environment() -> dict[str, str]:
    """Return the environment in which benchmarks find each other, helpers and the reproduction."""
    ours = sorted({path.parent for path in find_scripts(ALL)})
    root = HERE.parent
    folders = [HERE, *ours, root / "reproduction", root / "tests" / "helpers"]
    path = os.pathsep.join([*map(str, folders), os.environ.get("PYTHONPATH", "")])
    return os.environ | {"PYTHONPATH": path.rstrip(os.pathsep)}


def record_time(name: str, options: Sequence[str], seconds: float) -> None:
    """Record the run time, unless the benchmark ran with options of its own."""
    if RECORD not in options or set(options) - {RECORD, QUICK}:
        return
    times = read_times()
    times.setdefault(name, {})["quick" if QUICK in options else "whole"] = {
        "seconds": round(seconds, 1),
        "date": dt.datetime.now(tz=dt.UTC).date().isoformat(),
    }
    lines = (f"{json.dumps(key)}: {json.dumps(entry)}" for key, entry in sorted(times.items()))
    (HERE / "times.json").write_text("{\n" + ",\n".join(lines) + "\n}\n", encoding="utf-8")


def read_times() -> dict[str, dict[str, dict[str, float | str]]]:
    """Return seconds and date by benchmark and kind of run."""
    file = HERE / "times.json"
    return json.loads(read_text(file)) if file.exists() else {}


def read_text(path: Path) -> str:
    return path.read_text(encoding="utf-8")


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
