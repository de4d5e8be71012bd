"""What a library costs: building it, building it again, and searching it.

    python benchmarks/library.py [--files 1000] [--hours 10]

1. Forty copies of trial 86_10 as AMC, each with a comment of its own so that no two are equal:
   ``library build`` beside ``segment FOLDER``, as commands, on all cores.
2. A library of so many short recordings, built again with nothing changed.
3. A walk searched in so many hours of recording: pieces of subject 86, shaken anew for each
   recording; in a library that is open, and as a command.

Each line says what was promised.
"""

from __future__ import annotations

import argparse
from pathlib import Path
from tempfile import TemporaryDirectory
from time import perf_counter

from _libraries import simulated
from _measure import kineme, verdict
from _recordings import DATA
from kineme import Library, read

COPIES = 40
WALK = ("86_01.amc", 2.0, 3.2)


def copies(folder: Path, n: int, *, frames: int | None = None) -> None:
    """Copies of trial 86_10 that differ in a comment, on the skeleton of the subject."""
    folder.mkdir()
    (folder / "86.asf").write_bytes((DATA / "cmu86" / "86.asf").read_bytes())
    text = (DATA / "cmu86" / "86_10.amc").read_text()
    if frames is not None:
        text = text[: text.index(f"\n{frames + 1}\n") + 1]
    for i in range(n):
        (folder / f"86_10_{i:04d}.amc").write_text(f"# copy {i}\n{text}")


def show_build(home: Path) -> None:
    copies(home / "copies", COPIES)
    alone, alone_used, _ = kineme("segment", home / "copies", "--quiet")
    built, used, memory = kineme(
        "library", "build", home / "copies", "--into", home / "lib", "--quiet"
    )
    print(
        f"{COPIES} copies of 86_10: segment FOLDER {alone:.1f} s, library build {built:.1f} s, "
        f"{alone / built:.2f} times as fast (1.6 promised); processors {alone_used:.1f} and "
        f"{used:.1f} s"
    )
    print(f"largest process {memory:.2f} GB, {verdict(memory, 1.0)}")
    kept = sum(path.stat().st_size for path in (home / "lib").rglob("*") if path.is_file())
    hours = Library(home / "lib").hours
    print(f"kept: {kept / 1e6 / hours:.1f} MB an hour of recording")


def show_second_build(home: Path, files: int) -> None:
    copies(home / "short", files, frames=60)
    first, *_ = kineme("library", "build", home / "short", "--into", home / "many", "--quiet")
    again, used, _ = kineme("library", "build", "--into", home / "many", "--quiet")
    print(
        f"{files} short recordings: {first:.1f} s; again {again:.2f} s, "
        f"{verdict(again, 2.0)}; processor {used:.2f} s"
    )


def show_search(home: Path, hours: float) -> None:
    seconds = simulated(home / "hours", hours)
    library = Library(home / "hours")
    print(f"clusters in common of {len(library)} recordings: {seconds:.1f} s")
    name, start_s, stop_s = WALK
    example = read(DATA / "cmu86" / name)
    taken = []
    for _ in range(5):
        start = perf_counter()
        library.search(example, start_s, stop_s)
        taken.append(perf_counter() - start)
    warm = sorted(taken)[len(taken) // 2]
    print(f"search in {library.hours:.0f} h: {warm:.2f} s, {verdict(warm, 0.02 * hours)}")
    like = ("--like", DATA / "cmu86" / name, "--start", start_s, "--stop", stop_s)
    command, used, _ = kineme("library", "search", home / "hours", *like, "--quiet")
    print(f"as a command {command:.2f} s, {verdict(command, 2.0)}; processor {used:.2f} s")


def main() -> None:
    options = argparse.ArgumentParser()
    options.add_argument("--files", type=int, default=1000)
    options.add_argument("--hours", type=float, default=10.0)
    given = options.parse_args()
    with TemporaryDirectory() as folder:
        home = Path(folder)
        show_build(home)
        show_second_build(home, given.files)
        show_search(home, given.hours)


if __name__ == "__main__":
    main()
