"""The one door to all benchmarks: what there is, and how to run it.

    python -m benchmarks                            what there is, and how long each takes
    python -m benchmarks sources hugadb --every 6   one, with options of its own
    python -m benchmarks startup,reading --record   several, one after the other
    python -m benchmarks durability --quick         a folder of them
    python -m benchmarks all --quick                every one in small, several at a time

Each runs as a process of its own. ``--quick`` goes over next to nothing, in seconds: it shows that
a benchmark runs, not what it finds. Of a whole run the numbers are compared with those recorded in
``docs/figures.json``; ``--record`` keeps them there, and in ``times.json`` how long it took. What
lacks recordings, packages or a browser says so and is skipped; what fails ends this with 1.
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
"""For a quick one of several."""
QUICK_FORM = re.compile(r"^from _options import .*\bcommand_line\b", re.MULTILINE)
RECORDS = re.compile(r"^from _figures import .*\badd_option\b", re.MULTILINE)
"""What a script has in it that knows the option; to ask it would take a second each."""
RIVALS = "python benchmarks/rivals/run.py: other packages, in an environment of its own"


class Ended(NamedTuple):
    """How a benchmark ended: well, skipped or wrong; after so long; what is to be said of it."""

    name: str
    how: str
    seconds: float
    said: str = ""


def main(arguments: Sequence[str], folder: Path = HERE) -> int:
    if not arguments or arguments[0] in HELP:
        print((__doc__ or "") if arguments else listed(folder))
        return 0
    what, *options = arguments
    chosen = scripts(folder, what)
    if QUICK in options:
        forgetful = [script for script in chosen if not QUICK_FORM.search(text_of(script))]
        for script in forgetful:
            print(f"{script.stem}: has no {QUICK}: see command_line in benchmarks/_options.py")
        chosen = [script for script in chosen if script not in forgetful]
    else:
        forgetful = []
    if len(chosen) + len(forgetful) == 1 and chosen:
        return in_view(chosen[0], options).returncode
    start = perf_counter()
    wrong = [script.stem for script in forgetful]
    for ended in several(chosen, options):
        print(f"{ended.name:24}{ended.seconds:6.1f} s  {ended.how}  {ended.said}", flush=True)
        wrong += [ended.name] if ended.how == "wrong" else []
    number, seconds = len(chosen) + len(forgetful), perf_counter() - start
    print(f"{number} benchmarks in {seconds:.0f} s; wrong: {', '.join(sorted(wrong)) or 'none'}")
    return 1 if wrong else 0


def scripts(folder: Path, what: str) -> list[Path]:
    """The benchmarks that are meant: all, those of a folder, or those named, in that order."""
    known = {path.stem: path for path in sorted(folder.glob("*/[!_]*.py"))}
    known = {name: path for name, path in known.items() if path.parent.name != "rivals"}
    chosen: list[Path] = []
    for word in what.split(","):
        within = [path for path in known.values() if word in (ALL, path.parent.name)]
        if not within and word not in known:
            raise SystemExit(f"no benchmark or folder {word!r}; python -m benchmarks lists them")
        chosen += within or [known[word]]
    return list(dict.fromkeys(chosen))


def listed(folder: Path) -> str:
    """A line for each benchmark: how many seconds it takes in small and whole, what it tells."""
    times = recorded_times()
    lines = [f"{'':24}{'quick':>7}{'whole':>8}  (seconds, where recorded)"]
    home = None
    for script in scripts(folder, ALL):
        if script.parent.name != home:
            home = script.parent.name
            lines += ["", home]
        taken = times.get(script.stem, {})
        quick, whole = (
            f"{taken[form]['seconds']:.0f}" if form in taken else "–" for form in ("quick", "whole")
        )
        told = (ast.get_docstring(ast.parse(text_of(script))) or "").partition("\n")[0]
        lines.append(f"  {script.stem:22}{quick:>7}{whole:>8}  {told}")
    return "\n".join([*lines, "", RIVALS])


def in_view(script: Path, options: Sequence[str]) -> subprocess.CompletedProcess[bytes]:
    """A benchmark that shows what it prints, and its time kept if that is asked for."""
    start = perf_counter()
    done = subprocess.run(command(script, options), env=environment(script), check=False)
    if done.returncode == 0:
        keep_time(script.stem, options, perf_counter() - start)
    return done


def several(chosen: Sequence[Path], options: Sequence[str]) -> Iterator[Ended]:
    """Each in turn, in view; quick ones side by side, out of view, as nothing is measured.

    Unless they are timed: then one after the other, too.
    """
    if QUICK not in options:
        for script in chosen:
            print(f"\n== {script.stem}", flush=True)
            start, code = perf_counter(), in_view(script, options).returncode
            how = {0: "well", SKIPPED: "skipped"}.get(code, "wrong")
            yield Ended(script.stem, how, perf_counter() - start)
        return
    jobs = 1 if RECORD in options else len(os.sched_getaffinity(0))
    with ThreadPoolExecutor(jobs) as pool:
        yield from pool.map(lambda script: tried(script, options), chosen)


def tried(script: Path, options: Sequence[str]) -> Ended:
    """A benchmark of which only the end is told."""
    start = perf_counter()
    process = subprocess.Popen(
        command(script, options),
        env=environment(script),
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
    keep_time(script.stem, options, seconds)
    return Ended(script.stem, "well", seconds)


def command(script: Path, options: Sequence[str]) -> list[str]:
    """What runs it; one that records no numbers does not know that option."""
    knows = RECORDS.search(text_of(script))
    return [sys.executable, str(script), *(word for word in options if knows or word != RECORD)]


def environment(script: Path) -> dict[str, str]:
    """Ours, where benchmarks find what they share, each other, and the reproduction's trials."""
    ours = sorted({path.parent for path in HERE.glob("*/[!_]*.py")})
    folders = [HERE, *ours, script.parent, HERE.parent / "reproduction"]
    path = os.pathsep.join([*map(str, folders), os.environ.get("PYTHONPATH", "")])
    return os.environ | {"PYTHONPATH": path.rstrip(os.pathsep)}


def keep_time(name: str, options: Sequence[str], seconds: float) -> None:
    """Record how long it took, where nothing but that was asked for."""
    if RECORD not in options or set(options) - {RECORD, QUICK}:
        return
    times = recorded_times()
    times.setdefault(name, {})["quick" if QUICK in options else "whole"] = {
        "seconds": round(seconds, 1),
        "date": dt.datetime.now(tz=dt.UTC).date().isoformat(),
    }
    lines = (f"{json.dumps(key)}: {json.dumps(entry)}" for key, entry in sorted(times.items()))
    (HERE / "times.json").write_text("{\n" + ",\n".join(lines) + "\n}\n", encoding="utf-8")


def recorded_times() -> dict[str, dict[str, dict[str, float | str]]]:
    """By benchmark and form, seconds and the day."""
    file = HERE / "times.json"
    return json.loads(text_of(file)) if file.exists() else {}


def text_of(path: Path) -> str:
    return path.read_text(encoding="utf-8")


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
