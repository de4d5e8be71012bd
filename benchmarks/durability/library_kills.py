"""Builds of a library that are killed at any moment, and on a full disk: nothing is torn.

    python -m benchmarks library_kills [--kills 200] [--seed 0] [--at s3://bucket/lib] [--record]

A build is killed at a random moment, again and again until it gets through; half of them bring a
library up to date, the others make a new one. After each kill the library that a reader sees is
whole: as it was before the build or as it is after it. When a build got through, every file is byte
for byte that of a build that nothing disturbed. Then the same with files that may not grow over so
many bytes, which fails as a full disk does. Every library has an index, as large ones do. Needs a
system that can fork. ``--at`` does no more than kill builds of new libraries at a URL, where
nothing is yet: what is there in the end has the bytes of one on a disk.
"""

from __future__ import annotations

import os
import random
import resource
import shutil
import signal
import sys
import tempfile
import time
import warnings
from collections import Counter
from collections.abc import Callable, Iterator
from functools import partial
from itertools import product
from pathlib import Path
from typing import Any

import kineme
from _figures import add_option, record
from _options import command_line, few
from kineme.errors import KinemeError, WriteError
from kineme.library import Example, Library, build
from kineme.library.storage import index
from kineme.library.storage.analyses import read_analysis, read_features
from kineme.library.storage.places import is_remote, place

SPANS = {"a": (0, 400), "b": (700, 1100), "c": (1300, 1700), "d": (2000, 2500)}
"""Frames of the bundled recording."""
BEFORE = ("a", "b")
"""Those that a library has which is brought up to date."""
LIMITS = (0, 100, 400, 1_500, 3_000, 6_500, 12_000, 18_000)
"""Bytes that a file may have on the full disk."""
FAILED, REFUSED = 1, 3
"""How a build ends: by a mistake of ours; with a sentence."""


def write_takes(folder: Path) -> None:
    """The recordings: motions, and the heights of one as channels."""
    folder.mkdir()
    whole = kineme.read(kineme.bundled_recording())
    for name, (start, stop) in SPANS.items():
        kineme.write(whole[start:stop], folder / f"{name}.bvh")
    heights = whole.positions[:1200, 10:14, 1]
    (folder / "e.bvh").write_bytes((folder / "d.bvh").read_bytes())
    rows = "\n".join(
        f"{i / 60:.4f}," + ",".join(f"{x:.4f}" for x in row) for i, row in enumerate(heights)
    )
    (folder / "heights.csv").write_text(f"time_s,p,q,r,s\n{rows}\n")


def child(work: Callable[[], object]) -> int:
    """The process in which this is done."""
    process = os.fork()
    if process == 0:
        code = FAILED
        try:
            work()
            code = 0
        except WriteError:
            code = REFUSED
        except BaseException as error:
            print(f"{type(error).__name__}: {error}", file=sys.stderr, flush=True)
            raise
        finally:
            os._exit(code)
    return process


def ended(process: int) -> int:
    """How a process ended: its code, or less than 0 where it was killed."""
    return os.waitstatus_to_exitcode(os.waitpid(process, 0)[1])


def contents(folder: Path) -> dict[str, bytes]:
    """Every file by its place."""
    if is_remote(folder):
        there: Any = folder
        home = there.path.rstrip("/") + "/"
        names = there.fs.find(there.path)
        return {name.removeprefix(home): there.fs.cat_file(name) for name in names}
    files = (path for path in folder.rglob("*") if path.is_file())
    return {path.relative_to(folder).as_posix(): path.read_bytes() for path in files}


def torn(folder: Path, counts: set[int]) -> Iterator[str]:
    """What is wrong with what a reader sees."""
    for path in (folder / "pieces").glob("[!.]*.parquet"):
        try:
            read_analysis(path.parent, path.stem)
            read_features(path.parent, path.stem)
        except KinemeError as error:
            yield f"a piece is torn: {error}"
    if not (folder / "library.json").exists():
        if 0 not in counts:
            yield "the library is gone"
        return
    try:
        library = Library(folder)
        if len(library) not in counts:
            yield f"a library of {len(library)}"
        for name in ("segments", "words", "embeddings", "clusters"):
            library.table(name)
        for piece in library.recordings["piece"]:
            read_features(folder / "pieces", piece)
        if len(library.search(Example("b.bvh", 1.0, 2.0), top=1)) != 1:
            yield "the index does not find what is there"
    except KinemeError as error:
        yield f"the library is torn: {error}"


class Trial:
    """A library to be built from where it stands, and what it is to become."""

    def __init__(self, home: Path, takes: Path, before: Path | None):
        self.takes, self.before = takes, before
        self.folder = home / "library"
        self.counts = {len(Library(before)) if before else 0, len(SPANS) + 2}
        self.reset()
        started = time.perf_counter()
        self.build()
        self.lasts = time.perf_counter() - started
        self.wanted = contents(self.folder)

    def reset(self) -> None:
        shutil.rmtree(self.folder, ignore_errors=True)
        if self.before:
            shutil.copytree(self.before, self.folder)

    def with_pieces(self) -> None:
        """Where it stands when all recordings are read, and nothing else is written."""
        self.reset()
        for name, content in self.wanted.items():
            if name.startswith("pieces/"):
                (self.folder / name).parent.mkdir(parents=True, exist_ok=True)
                (self.folder / name).write_bytes(content)

    def build(self) -> None:
        build(self.takes, self.folder)

    def limited(self, most: int) -> None:
        """A build on a disk that takes no larger file."""
        resource.setrlimit(resource.RLIMIT_FSIZE, (most, most))
        self.build()


def others(trial: Trial) -> list[str]:
    """What says that files are not those of a build that nothing disturbed."""
    now = contents(trial.folder)
    names = now.keys() | trial.wanted.keys()
    return [
        f"other bytes in {Path(name).parent}/*{Path(name).suffix}"
        for name in names
        if now.get(name) != trial.wanted.get(name)
    ]


def killed(trial: Trial, moments: random.Random, kills: int, found: Counter[str]) -> int:
    """Builds killed until one gets through, ``kills`` at most; how many were."""
    trial.reset()
    n = 0
    while n < kills:
        process = child(trial.build)
        time.sleep(moments.uniform(0.0, trial.lasts))
        os.kill(process, signal.SIGKILL)
        code = ended(process)
        if code >= 0:
            found.update([f"a build ended with {code}"] * (code > 0))
            break
        n += 1
        found.update(torn(trial.folder, trial.counts))
    code = ended(child(trial.build))
    found.update([f"the last build ended with {code}"] * (code != 0))
    found.update(others(trial))
    return n


def on_a_full_disk(trial: Trial, found: Counter[str]) -> int:
    """How many builds were refused."""
    refused = 0
    for begin, most in product((trial.reset, trial.with_pieces), LIMITS):
        begin()
        code = ended(child(partial(trial.limited, most)))
        refused += code == REFUSED
        found.update([f"a build on a full disk ended with {code}"] * (code not in (0, REFUSED)))
        found.update(torn(trial.folder, trial.counts))
        code = ended(child(trial.build))
        found.update([f"the next build ended with {code}"] * (code != 0))
        found.update(others(trial))
    return refused


def show_at(url: str, home: Path, takes: Path, kills: int, moments: random.Random) -> Counter[str]:
    """Builds at a URL killed until so many were; what was found."""
    found: Counter[str] = Counter()
    os.environ["KINEME_CACHE"] = str(home / "cache")
    build(takes, home / "library")
    wanted = contents(home / "library")
    begun = time.perf_counter()
    found.update(["a build failed"] * ended(child(partial(build, takes, f"{url}/0"))))
    lasts = time.perf_counter() - begun
    n = rounds = 0
    while n < kills:
        rounds += 1
        there = f"{url}/{rounds}"
        while n < kills:
            process = child(partial(build, takes, there))
            time.sleep(moments.uniform(0.0, lasts))
            os.kill(process, signal.SIGKILL)
            if ended(process) >= 0:
                break
            n += 1
            found.update(["torn"] * ended(child(partial(whole_at, there))))
        found.update(["a build failed"] * ended(child(partial(build, takes, there))))
        found.update(["other bytes"] * ended(child(partial(equal_at, there, wanted))))
        print(f"{n} kills, {rounds} libraries: {dict(found) or 'nothing torn'}", flush=True)
    return found


def whole_at(url: str) -> None:
    """Whether what a reader sees is whole."""
    told = sorted(torn(place(url), {0, len(SPANS) + 2}))
    assert not told, told


def equal_at(url: str, wanted: dict[str, bytes]) -> None:
    """Whether a library has these bytes; a lock is on a disk only."""
    now = contents(place(url))
    other = [name for name in wanted.keys() | now.keys() if now.get(name) != wanted.get(name)]
    assert all(Path(name).name.endswith(".lock") for name in other), other


def main() -> None:
    """Kill, look, count; exit code 1 where something is torn."""
    parser = command_line(__doc__)
    parser.add_argument("--kills", type=int, default=few(200, 3))
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--at", metavar="URL")
    add_option(parser)
    options = parser.parse_args()
    os.environ["KINEME_THREADS"] = "1"  # threads do not outlive a fork
    warnings.simplefilter("ignore")
    index.FROM_HOURS = 0.0
    moments = random.Random(options.seed)
    found: Counter[str] = Counter()
    with tempfile.TemporaryDirectory() as name:
        home, takes = Path(name), Path(name) / "takes"
        write_takes(takes)
        if options.at:
            sys.exit(bool(show_at(options.at, home, takes, options.kills, moments)))
        build([takes / f"{each}.bvh" for each in BEFORE], home / "before")
        trials = [Trial(home, takes, None), Trial(home, takes, home / "before")]
        n = rounds = 0
        while n < options.kills:
            n += killed(trials[rounds % 2], moments, options.kills - n, found)
            rounds += 1
            if rounds % 5 == 0 or n >= options.kills:
                print(f"{n} kills, {rounds} libraries: {dict(found) or 'nothing torn'}", flush=True)
        refused = sum(on_a_full_disk(trial, found) for trial in trials)
        print(f"{refused} builds on a full disk: {dict(found) or 'nothing torn'}")
    record("library_kills.kills", n)
    record("library_kills.torn", sum(found.values()))
    record("library_kills.full_disk", refused)
    sys.exit(1 if found else 0)


if __name__ == "__main__":
    main()
