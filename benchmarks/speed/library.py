"""Measure building, rebuilding and searching a library.

    python -m benchmarks library [build] [again] [search] [--copies 40] [--files 1000] [--hours 10]
                                 [--record]

1. ``library build`` and ``segment FOLDER`` on forty copies of trial 86_10 as AMC, each with a
   comment of its own, and on forty equal copies.
2. Rebuilding an unchanged library of short recordings.
3. Searching a walk in noisy pieces of subject 86, in an open library and as a command.
"""

from __future__ import annotations

from pathlib import Path
from tempfile import TemporaryDirectory

from _figures import add_option, record
from _libraries import simulate_library
from _measure import judge, run_kineme, take_medians, time_call
from _options import DATA, choose_size, find_data, make_parser
from kineme import Library, read

PARTS = ("build", "again", "search")
WALK = ("86_01.amc", 2.0, 3.2)


def write_copies(folder: Path, n: int, *, frames: int | None = None, equal: bool = False) -> None:
    """Write copies of trial 86_10, equal or each with its own comment, and the skeleton."""
    folder.mkdir()
    (folder / "86.asf").write_bytes((DATA / "cmu86" / "86.asf").read_bytes())
    text = (DATA / "cmu86" / "86_10.amc").read_text()
    if frames is not None:
        text = text[: text.index(f"\n{frames + 1}\n") + 1]
    for i in range(n):
        (folder / f"86_10_{i:04d}.amc").write_text(text if equal else f"# copy {i}\n{text}")


def show_build(home: Path, n: int) -> None:
    frames = choose_size(None, 600)
    write_copies(home / "copies", n, frames=frames)
    write_copies(home / "equal", n, frames=frames, equal=True)
    alone, alone_used, _ = run_kineme("segment", home / "copies", "--quiet")
    print(f"{n} copies of 86_10: segment FOLDER {alone:.1f} s, processors {alone_used:.1f} s")
    record("library.segment_folder.processors", round(alone_used, 1), unit="s")
    for name in ("copies", "equal"):
        into = home / f"lib-{name}"
        built, used, memory = run_kineme("library", "build", home / name, "--into", into, "--quiet")
        print(
            f"library build, {name}: {built:.1f} s, {alone / built:.2f} times as fast (1.6 "
            f"promised); processors {used:.1f} s; largest process {memory:.2f} GB, "
            f"{judge(memory, 1.0)}"
        )
        record(f"library.build.{name}.processors", round(used, 1), unit="s")
        record(f"library.build.{name}.memory", round(memory, 2), unit="GB")
    into = home / "lib-copies"
    kept = sum(path.stat().st_size for path in into.rglob("*") if path.is_file())
    print(f"kept: {kept / 1e6 / Library(into).hours:.1f} MB an hour of recording")


def show_second_build(home: Path, files: int) -> None:
    write_copies(home / "short", files, frames=60)
    first, *_ = run_kineme("library", "build", home / "short", "--into", home / "many", "--quiet")
    again, used, _ = run_kineme("library", "build", "--into", home / "many", "--quiet")
    print(
        f"{files} short recordings: {first:.1f} s; again {again:.2f} s, "
        f"{judge(again, 2.0)}; processor {used:.2f} s"
    )
    record("library.again.processors", round(used, 2), unit="s")


def show_search(home: Path, hours: float) -> None:
    seconds = simulate_library(home / "hours", hours)
    library = Library(home / "hours")
    print(f"clusters in common of {len(library)} recordings: {seconds:.1f} s")
    name, start_s, stop_s = WALK
    example = read(DATA / "cmu86" / name)
    warm, used = take_medians(
        time_call(lambda: library.search(example, start_s, stop_s)) for _ in range(5)
    )
    print(
        f"search in {library.hours:.0f} h: {warm:.2f} s, {judge(warm, 0.02 * hours)}; "
        f"processor {used:.2f} s"
    )
    record("library.search.processor", round(used, 2), unit="s")
    like = ("--like", DATA / "cmu86" / name, "--start", start_s, "--stop", stop_s)
    command, used, _ = run_kineme("library", "search", home / "hours", *like, "--quiet")
    print(f"as a command {command:.2f} s, {judge(command, 2.0)}; processor {used:.2f} s")


def main() -> None:
    options = make_parser(__doc__)
    options.add_argument("parts", nargs="*", default=PARTS, help=", ".join(PARTS))
    options.add_argument("--copies", type=int, default=choose_size(40, 2))
    options.add_argument("--files", type=int, default=choose_size(1000, 5))
    options.add_argument("--hours", type=float, default=choose_size(10.0, 0.3))
    add_option(options)
    given = options.parse_args()
    find_data("cmu86")
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
