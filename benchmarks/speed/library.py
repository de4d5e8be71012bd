"""Measure building a library.

    python -m benchmarks library [--copies 40] [--files 1000] [--record]

1. ``library build`` and ``segment FOLDER`` on forty copies of trial 86_10 as AMC, each with a
   comment of its own, and on forty equal copies.
2. Rebuilding an unchanged library of short recordings.
"""

from __future__ import annotations

from pathlib import Path
from tempfile import TemporaryDirectory

from _figures import add_option, record
from _measure import judge, run_kineme
from _options import DATA, choose_size, find_data, make_parser
from kineme import Library


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


def main() -> None:
    options = make_parser(__doc__)
    options.add_argument("--copies", type=int, default=choose_size(40, 2))
    options.add_argument("--files", type=int, default=choose_size(1000, 5))
    add_option(options)
    given = options.parse_args()
    find_data("cmu86")
    with TemporaryDirectory() as folder:
        home = Path(folder)
        show_build(home, given.copies)
        show_second_build(home, given.files)


if __name__ == "__main__":
    main()
