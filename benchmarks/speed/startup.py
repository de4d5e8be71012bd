"""Measure the time to the first result: import, one file per process, first run ever.

    python -m benchmarks startup [--runs 7] [--record]

Each run is a new process. The first compiles into an empty ``NUMBA_CACHE_DIR``; the others use
the compiled code.
"""

from __future__ import annotations

import os
import resource
import subprocess
import sys
import tempfile
from time import perf_counter

from _figures import add_option, record
from _measure import Duration, judge, take_medians
from _options import DATA, choose_size, find_data, make_parser
from kineme.methods.presets import DEFAULT, PUBLISHED

RECORDING = str(DATA / "cmu86" / "86_10.amc")


def run_process(*arguments: str, cache: str) -> Duration:
    """Run this Python with arguments and return its duration; raise if it fails."""
    environment = os.environ | {"NUMBA_CACHE_DIR": cache}
    before, start = resource.getrusage(resource.RUSAGE_CHILDREN), perf_counter()
    subprocess.run(
        [sys.executable, *arguments], env=environment, check=True, stdout=subprocess.DEVNULL
    )
    clock, after = perf_counter() - start, resource.getrusage(resource.RUSAGE_CHILDREN)
    return Duration(clock, after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime)


def main() -> None:
    parser = make_parser(__doc__)
    parser.add_argument("--runs", type=int, default=choose_size(7, 1))
    add_option(parser)
    find_data("cmu86/86_10.amc")
    runs = range(parser.parse_args().runs)
    for name in choose_size((DEFAULT, *PUBLISHED), (DEFAULT,)):
        segment = ("-m", "kineme", "segment", "--preset", name, RECORDING)
        with tempfile.TemporaryDirectory() as cache:
            first = run_process(*segment, cache=cache)
            again = take_medians(run_process(*segment, cache=cache) for _ in runs)
        print(f"{name}, first run ever: {first}; {judge(first.clock, 15)}")
        record(f"startup.{name}.first", round(first.clock, 1), unit="s")
        record(f"startup.{name}.cached", round(again.clock, 2), unit="s")
        print(f"{name}, compiled code cached: {again}; {judge(again.clock, 2)}")
    bare = take_medians(run_process("-c", "pass", cache="") for _ in runs).clock
    whole = take_medians(run_process("-c", "import kineme", cache="") for _ in runs).clock
    record("startup.import", round(whole - bare, 3), unit="s")
    print(f"import kineme: {whole - bare:.3f} s; {judge(whole - bare, 0.2)}")


if __name__ == "__main__":
    main()
