"""How long until the first result: the import, one file as one process, the first run ever.

    python -m benchmarks startup [--runs 7] [--record]

Each figure is a process of its own. The first run ever compiles into an empty
``NUMBA_CACHE_DIR``; the others find what it left there.
"""

from __future__ import annotations

import os
import resource
import subprocess
import sys
import tempfile
from collections.abc import Iterable
from statistics import median
from time import perf_counter
from typing import NamedTuple

from _figures import add_option, record
from _measure import verdict
from _options import DATA, command_line, few, needed
from kineme.methods.presets import DEFAULT, PUBLISHED

RECORDING = str(DATA / "cmu86" / "86_10.amc")


class Took(NamedTuple):
    """Seconds by the clock, and of processor time, which other work on the machine spares."""

    clock: float
    processor: float

    def __str__(self) -> str:
        return f"{self.clock:.2f} s ({self.processor:.2f} s of processor time)"


def process(*arguments: str, cache: str) -> Took:
    """What this python takes with the arguments; a failure is an error here, too."""
    environment = os.environ | {"NUMBA_CACHE_DIR": cache}
    before, start = resource.getrusage(resource.RUSAGE_CHILDREN), perf_counter()
    subprocess.run(
        [sys.executable, *arguments], env=environment, check=True, stdout=subprocess.DEVNULL
    )
    clock, after = perf_counter() - start, resource.getrusage(resource.RUSAGE_CHILDREN)
    return Took(clock, after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime)


def middle(runs: Iterable[Took]) -> Took:
    """The medians."""
    return Took(*map(median, zip(*runs, strict=True)))


def main() -> None:
    parser = command_line(__doc__)
    parser.add_argument("--runs", type=int, default=few(7, 1))
    add_option(parser)
    needed("cmu86/86_10.amc")
    runs = range(parser.parse_args().runs)
    for name in few((DEFAULT, *PUBLISHED), (DEFAULT,)):
        segment = ("-m", "kineme", "segment", "--preset", name, RECORDING)
        with tempfile.TemporaryDirectory() as cache:
            first = process(*segment, cache=cache)
            again = middle(process(*segment, cache=cache) for _ in runs)
        print(f"{name}, first run ever: {first}; {verdict(first.clock, 15)}")
        record(f"startup.{name}.first", round(first.clock, 1), unit="s")
        record(f"startup.{name}.cached", round(again.clock, 2), unit="s")
        print(f"{name}, compiled code cached: {again}; {verdict(again.clock, 2)}")
    bare = middle(process("-c", "pass", cache="") for _ in runs).clock
    whole = middle(process("-c", "import kineme", cache="") for _ in runs).clock
    record("startup.import", round(whole - bare, 3), unit="s")
    print(f"import kineme: {whole - bare:.3f} s; {verdict(whole - bare, 0.2)}")


if __name__ == "__main__":
    main()
