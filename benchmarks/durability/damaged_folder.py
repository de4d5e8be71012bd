"""A folder of 10,000 recordings of which 1 % are damaged: all others are segmented.

    python -m benchmarks damaged_folder [--files 10000] [--jobs 2]

Recordings are two to three seconds long, a body in every fourth, channels in the others; the
damaged ones are each damaged in another way: those of ``fuzz``, and those that only
folders know, such as a name that is no UTF-8 or a link to nowhere. ``kineme segment FOLDER``
goes through them, and ``kineme library build --jobs`` through a tenth. Printed is what each
costs in the first and in the last quarter, and what the process held half-way and at the end.

Promises: a table for every sound recording, every other file in a table or in the list of
what was skipped, exit code 0 as the folder gave something, and no growth.
"""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
import time
import zipfile
from collections.abc import Callable
from itertools import pairwise
from pathlib import Path

import numpy as np

import kineme
from _damage import mutated
from _options import command_line, few
from kineme.datasets import bundled_recording

MEMORY_DISK = "/dev/shm" if Path("/dev/shm").is_dir() else None
GROWTH = 1.25
"""Of time and memory, from the first quarter to the last: what is left to chance."""


def write_sound(folder: Path, files: int) -> dict[str, bytes]:
    """So many recordings; two kinds of bytes, by suffix."""
    motion = kineme.read(bundled_recording())
    rng = np.random.default_rng(0)
    shape = np.sin(np.arange(75)[:, None] / (3.0, 5.0)) + 0.02 * rng.normal(size=(75, 2))
    kineme.write(motion[600:780], folder / "0.bvh")
    kineme.write(kineme.Signals(shape, 30, ["gyro_x", "gyro_y"]), folder / "0.csv")
    kinds = {suffix: (folder / f"0{suffix}").read_bytes() for suffix in (".bvh", ".csv")}
    for suffix in kinds:
        (folder / f"0{suffix}").unlink()
    for number in range(files):
        suffix = ".bvh" if number % 4 == 0 else ".csv"
        (folder / f"take_{number:05d}{suffix}").write_bytes(kinds[suffix])
    return kinds


def damage(folder: Path, kinds: dict[str, bytes], every: int) -> list[Path]:
    """Every so many-th file damaged, and what only folders know put beside them."""
    paths = sorted(folder.iterdir())[every // 2 :: every]
    for number, path in enumerate(paths):
        path.write_bytes(mutated(kinds[path.suffix], number))
    for number, (path, made) in enumerate(zip(paths, FOLDER_KINDS, strict=False)):
        path.unlink()
        paths[number] = made(path)
    return paths


def version_255(path: Path) -> Path:
    """A zip archive that no program can unpack."""
    path = path.with_suffix(".npz")
    with zipfile.ZipFile(path, "w") as archive:
        archive.writestr("positions.npy", b"x" * 100)
    data = bytearray(path.read_bytes())
    data[data.rfind(b"PK\1\2") + 6] = 255
    path.write_bytes(data)
    return path


def not_utf8(path: Path) -> Path:
    """A name of other bytes."""
    other = Path(os.fsdecode(os.fsencode(path.with_suffix("")) + b"\xff.bvh"))
    other.write_bytes(b"HIERARCHY\n")
    return other


def link_to_nowhere(path: Path) -> Path:
    """A link whose file is gone."""
    path.symlink_to(path.with_name("gone.bvh"))
    return path


def folder_of_that_name(path: Path) -> Path:
    """A folder where a file should be."""
    path.mkdir()
    return path


def notes(path: Path) -> Path:
    """What might be one frame of a folder that is one recording."""
    path = path.with_name("notes_1.json")
    path.write_text('{"people": "none"}')
    return path


def empty(path: Path) -> Path:
    """No bytes."""
    path.write_bytes(b"")
    return path


def zeros(path: Path) -> Path:
    """As after a power failure."""
    path.write_bytes(bytes(5000))
    return path


FOLDER_KINDS: tuple[Callable[[Path], Path], ...] = (
    version_255, not_utf8, link_to_nowhere, folder_of_that_name, notes, empty, zeros,
)  # fmt: skip


def run(command: list[str], out: Path, said: Path) -> tuple[int, list[tuple[int, float, float]]]:
    """Exit code; tables, processor seconds and megabytes from time to time."""
    with said.open("w") as file:
        process = subprocess.Popen(command, stdout=file, stderr=file)
        seen: list[tuple[int, float, float]] = []
        while process.poll() is None:
            time.sleep(0.5)
            try:
                stat = Path(f"/proc/{process.pid}/stat").read_text().rpartition(")")[2].split()
            except OSError:
                break
            seconds = sum(map(int, stat[11:13])) / os.sysconf("SC_CLK_TCK")
            held = int(stat[21]) * os.sysconf("SC_PAGE_SIZE") / 1e6
            tables = len(os.listdir(out)) if out.is_dir() else 0  # noqa: PTH208
            seen.append((tables, seconds, held))
        return process.wait(), [each for each in seen if each[0] and each[2]]


def growth(seen: list[tuple[int, float, float]]) -> tuple[float, float]:
    """Seconds per table and megabytes of the last quarter, as shares of those of the second."""
    most = seen[-1][0]
    at = [min(seen, key=lambda one: abs(one[0] - share * most)) for share in (0.25, 0.5, 0.75, 1)]
    rates = [(b[1] - a[1]) / max(b[0] - a[0], 1) for a, b in pairwise(at)]
    print(f"  {1000 * rates[0]:.1f} ms of processor time a file in the second quarter, "
          f"{1000 * rates[-1]:.1f} in the last; {at[1][2]:.0f} MB half-way, {at[-1][2]:.0f} at the "
          "end")  # fmt: skip
    return rates[-1] / rates[0], at[-1][2] / at[1][2]


def segmented(folder: Path, out: Path, damaged: list[Path]) -> list[str]:
    """What is wrong after ``kineme segment FOLDER``."""
    said = out.with_suffix(".txt")
    command = [sys.executable, "-m", "kineme", "segment", str(folder), "-o", str(out), "-q"]
    code, seen = run(command, out, said)
    told = said.read_text(errors="surrogateescape")
    wrong = [f"exit code {code}"] if code else []
    wrong += ["a traceback"] if "Traceback" in told else []
    tables = {path.stem for path in out.glob("*.csv")}
    for path in folder.iterdir():
        if path in damaged:
            listed = path.name[:10] in told
            if path.stem not in tables and not listed and path.is_file():
                wrong.append(f"{path.name!r} is neither in a table nor in the list")
        elif path.stem not in tables:
            wrong.append(f"{path.name} is not segmented")
    by_kind = {suffix: {(out / f"{p.stem}.csv").read_bytes() for p in folder.glob(f"*{suffix}")
                        if p not in damaged and p.stem in tables}
               for suffix in (".bvh", ".csv")}  # fmt: skip
    wrong += [f"tables of {kind} differ" for kind, bodies in by_kind.items() if len(bodies) > 1]
    skipped = told.count("skipped: ")
    print(f"segment: {len(tables)} tables of {len(list(folder.iterdir()))} files, {skipped} "
          f"skipped, exit code {code}")  # fmt: skip
    if len(seen) > 20 and max(growth(seen)) > GROWTH:
        wrong.append("it grows")
    return wrong


def built(folder: Path, out: Path, damaged: list[Path], jobs: int) -> list[str]:
    """What is wrong after ``kineme library build --jobs``."""
    said = out.with_suffix(".txt")
    command = [sys.executable, "-m", "kineme", "library", "build", str(folder),
               "--into", str(out), "--jobs", str(jobs)]  # fmt: skip
    code, _ = run(command, out / "pieces", said)
    library = kineme.Library(out)
    inside = {Path(path).name for path in library.recordings["path"]}
    lost = [p.name for p in folder.iterdir() if p not in damaged and p.name not in inside]
    print(f"library build --jobs {jobs}: {len(library)} recordings, {len(library.failed)} failed, "
          f"exit code {code}")  # fmt: skip
    wrong = [f"{len(lost)} sound recordings are not in the library: {lost[:3]}"] if lost else []
    return wrong + (["a traceback"] if "Traceback" in said.read_text(errors="replace") else [])


def main() -> int:
    """Make, segment and build; exit code 1 where something is wrong."""
    parser = command_line(__doc__)
    parser.add_argument("--files", type=int, default=few(10_000, 40))
    parser.add_argument("--jobs", type=int, default=2)
    given = parser.parse_args()
    wrong = []
    with tempfile.TemporaryDirectory(dir=MEMORY_DISK) as name:
        for files, work in ((given.files, segmented), (given.files // 10, built)):
            folder = Path(name) / work.__name__
            folder.mkdir()
            damaged = damage(folder, write_sound(folder, files), 100 if files >= 1000 else 10)
            more = () if work is segmented else (given.jobs,)
            wrong += work(folder, Path(name) / f"of_{work.__name__}", damaged, *more)
    print("\n".join(wrong[:20]) or "nothing is wrong")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
