"""What a library costs: building it, building it again, and searching it.

    python -m benchmarks library [build] [again] [search] [--copies 40] [--files 1000] [--hours 10]
                                 [--record]

1. Forty copies of trial 86_10 as AMC, each with a comment of its own so that no two are equal:
   ``library build`` beside ``segment FOLDER``, as commands, on all cores; and forty equal ones.
2. A library of so many short recordings, built again with nothing changed.
3. A walk searched in so many hours of recording: pieces of subject 86, shaken anew for each
   recording; in a library that is open, and as a command.

Each line says what was promised.
"""

from __future__ import annotations

from pathlib import Path
from statistics import median
from tempfile import TemporaryDirectory
from time import perf_counter, process_time

from _figures import add_option, record
from _libraries import simulated
from _measure import kineme, verdict
from _options import DATA, command_line, few, needed
from kineme import Library, read

PARTS = ("build", "again", "search")
WALK = ("86_01.amc", 2.0, 3.2)


def copies(folder: Path, n: int, *, frames: int | None = None, equal: bool = False) -> None:
    """Copies of trial 86_10, equal or told apart by a comment, on the skeleton of the subject."""
    folder.mkdir()
    (folder / "86.asf").write_bytes((DATA / "cmu86" / "86.asf").read_bytes())
    text = (DATA / "cmu86" / "86_10.amc").read_text()
    if frames is not None:
        text = text[: text.index(f"\n{frames + 1}\n") + 1]
    for i in range(n):
        (folder / f"86_10_{i:04d}.amc").write_text(text if equal else f"# copy {i}\n{text}")


def show_build(home: Path, n: int) -> None:
    frames = few(None, 600)
    copies(home / "copies", n, frames=frames)
    copies(home / "equal", n, frames=frames, equal=True)
    alone, alone_used, _ = kineme("segment", home / "copies", "--quiet")
    print(f"{n} copies of 86_10: segment FOLDER {alone:.1f} s, processors {alone_used:.1f} s")
    record("library.segment_folder.processors", round(alone_used, 1), unit="s")
    for name in ("copies", "equal"):
        into = home / f"lib-{name}"
        built, used, memory = kineme("library", "build", home / name, "--into", into, "--quiet")
        print(
            f"library build, {name}: {built:.1f} s, {alone / built:.2f} times as fast (1.6 "
            f"promised); processors {used:.1f} s; largest process {memory:.2f} GB, "
            f"{verdict(memory, 1.0)}"
        )
        record(f"library.build.{name}.processors", round(used, 1), unit="s")
        record(f"library.build.{name}.memory", round(memory, 2), unit="GB")
    into = home / "lib-copies"
    kept = sum(path.stat().st_size for path in into.rglob("*") if path.is_file())
    print(f"kept: {kept / 1e6 / Library(into).hours:.1f} MB an hour of recording")


def show_second_build(home: Path, files: int) -> None:
    copies(home / "short", files, frames=60)
    first, *_ = kineme("library", "build", home / "short", "--into", home / "many", "--quiet")
    again, used, _ = kineme("library", "build", "--into", home / "many", "--quiet")
    print(
        f"{files} short recordings: {first:.1f} s; again {again:.2f} s, "
        f"{verdict(again, 2.0)}; processor {used:.2f} s"
    )
    record("library.again.processors", round(used, 2), unit="s")


def show_search(home: Path, hours: float) -> None:
    seconds = simulated(home / "hours", hours)
    library = Library(home / "hours")
    print(f"clusters in common of {len(library)} recordings: {seconds:.1f} s")
    name, start_s, stop_s = WALK
    example = read(DATA / "cmu86" / name)
    taken = []
    for _ in range(5):
        start, begun = perf_counter(), process_time()
        library.search(example, start_s, stop_s)
        taken.append((perf_counter() - start, process_time() - begun))
    warm, used = (median(column) for column in zip(*taken, strict=True))
    print(
        f"search in {library.hours:.0f} h: {warm:.2f} s, {verdict(warm, 0.02 * hours)}; "
        f"processor {used:.2f} s"
    )
    record("library.search.processor", round(used, 2), unit="s")
    like = ("--like", DATA / "cmu86" / name, "--start", start_s, "--stop", stop_s)
    command, used, _ = kineme("library", "search", home / "hours", *like, "--quiet")
    print(f"as a command {command:.2f} s, {verdict(command, 2.0)}; processor {used:.2f} s")


def main() -> None:
    options = command_line(__doc__)
    options.add_argument("parts", nargs="*", default=PARTS, help=", ".join(PARTS))
    options.add_argument("--copies", type=int, default=few(40, 2))
    options.add_argument("--files", type=int, default=few(1000, 5))
    options.add_argument("--hours", type=float, default=few(10.0, 0.3))
    add_option(options)
    given = options.parse_args()
    needed("cmu86")
    with TemporaryDirectory() as folder:
        home = Path(folder)
        if "build" in given.parts:
            show_build(home, given.copies)
        if "again" in given.parts:
            show_second_build(home, given.files)
        if "search" in given.parts:
            show_search(home, given.hours)


if __name__ == "__main__":
    main()
