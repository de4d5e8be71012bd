"""How long until the first result: the import, one file as one process, the first run ever.

    python benchmarks/startup.py [--runs 7]

Each figure is a process of its own. The first run ever compiles into an empty
``NUMBA_CACHE_DIR``; the others find what it left there.
"""

from __future__ import annotations

import argparse
import os
import subprocess
import sys
import tempfile
from pathlib import Path
from statistics import median
from time import perf_counter

from _measure import interleaved, verdict
from kineme.segmentation.presets import PRESETS

DATA = Path(os.environ.get("KINEME_DATA", Path(__file__).resolve().parents[2] / "shared" / "data"))
RECORDING = str(DATA / "cmu86" / "86_10.amc")


def process(*arguments: str, cache: str) -> None:
    """Runs this python with the arguments; a failure is an error here, too."""
    environment = os.environ | {"NUMBA_CACHE_DIR": cache}
    subprocess.run(
        [sys.executable, *arguments], env=environment, check=True, stdout=subprocess.DEVNULL
    )


def seconds(*arguments: str, cache: str) -> float:
    start = perf_counter()
    process(*arguments, cache=cache)
    return perf_counter() - start


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--runs", type=int, default=7)
    runs = parser.parse_args().runs
    with tempfile.TemporaryDirectory() as cache:
        segment = {name: ("-m", "kineme.cli", "segment", "--preset", name, RECORDING)
                   for name in PRESETS}  # fmt: skip
        for name, arguments in segment.items():
            with tempfile.TemporaryDirectory() as empty:
                first = seconds(*arguments, cache=empty)
            print(f"{name}, first run ever: {first:.2f} s; {verdict(first, 15)}")
        works = {name: lambda a=a: process(*a, cache=cache) for name, a in segment.items()}
        for name, took in interleaved(works, runs=runs).items():
            print(f"{name}, compiled code cached: {took:.2f} s; {verdict(took, 2)}")
        bare = median(seconds("-c", "pass", cache=cache) for _ in range(runs))
        whole = median(seconds("-c", "import kineme", cache=cache) for _ in range(runs))
        print(f"import kineme: {whole - bare:.3f} s; {verdict(whole - bare, 0.2)}")


if __name__ == "__main__":
    main()
