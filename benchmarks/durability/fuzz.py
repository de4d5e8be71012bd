"""Damaged files of every kind through every reader: nothing but the package's own errors.

    python -m benchmarks fuzz --minutes 5 --seed 1

Samples of recordings, labels, tables with what lies beside them, knowledge bases, motion
graphs, a library and the studio's journal are made in a folder (and the beginnings of those
of KINEME_DATA taken along), damaged in one to four ways, and read by a worker with limits of
4 GB and 20 s a file. What ends in anything but a `KinemeError`, in a warning of numpy, in a
killed worker, after the time or with more than 2 GB is a finding; findings are counted by
kind, and the number of the first of each gives the same bytes again (``--only NUMBER``).
``--structure`` leaves the syntax sound and changes what the files mean.

Workers are forks of a process that has read every sample once, so that a file costs little
more than its reader. Needs a system that can fork.

Promises: no finding.
"""

from __future__ import annotations

import json
import mmap
import os
import resource
import signal
import struct
import sys
import tempfile
import time
import traceback
import warnings
from collections import Counter
from collections.abc import Iterator, Sequence
from pathlib import Path

from _options import command_line, few

os.environ["KINEME_THREADS"] = os.environ["OMP_NUM_THREADS"] = "1"  # threads outlive no fork

from _damage import mutated
from _fuzz_samples import Case, write_samples
from _restructure import restructured
from kineme.errors import KinemeError, KinemeWarning

MEMORY, MOST_HELD = 4 << 30, 2 << 30
SECONDS = 20
BATCH = 3000
"""Files that a worker reads before it is started anew."""

MEMORY_DISK = "/dev/shm" if Path("/dev/shm").is_dir() else None
CLOCK = "qd"
"""The number that is being read, and since when."""

AT_THE_DOOR = "cannot be understood, it is damaged"
"""What is said of a file whose fault no reader has a word for."""


STRUCTURED = 500_000
"""Of each million of numbers the second half changes what a file means, not its bytes."""


def damaged(case: Case, number: int) -> bytes:
    """The bytes of a case, damaged as the number says."""
    if number % 1_000_000 < STRUCTURED:
        return mutated(case.sound, number)
    return restructured(case.path, case.sound, number)


def chosen(number: int, cases: Sequence[Case]) -> tuple[Case, int]:
    """The case of a number and which of its doors: each gets its turn."""
    case = cases[number % len(cases)]
    return case, number // len(cases) % len(case.doors)


def finding(root: Path, case: Case, door: int) -> tuple[str, str]:
    """What a reader did wrong, and what only the door caught; empty where there is nothing."""
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            warnings.simplefilter("ignore", KinemeWarning)
            case.doors[door](root)
    except KinemeError as error:
        if "\n" in str(error):
            return f"a message of several lines: {type(error).__name__}", ""
        if AT_THE_DOOR in str(error) and error.__cause__ is not None:
            return "", _where(error.__cause__)
    except Exception as error:  # noqa: BLE001 (which is what is looked for)
        return _where(error), ""
    return "", ""


def _where(error: BaseException) -> str:
    """An exception and the line of the package that it came through last."""
    frames = traceback.extract_tb(error.__traceback__)
    own = [frame for frame in frames if "/kineme/" in frame.filename] or frames
    return f"{type(error).__name__} at {Path(own[-1].filename).name}:{own[-1].lineno}"


def work(root: Path, cases: Sequence[Case], numbers: range, at: mmap.mmap, told: Path) -> None:
    """Damage and read one file after another; say which, and then what was found."""
    resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
    with told.open("a", buffering=1) as file:
        for number in numbers:
            at[:] = struct.pack(CLOCK, number, time.monotonic())
            case, door = chosen(number, cases)
            (root / case.path).write_bytes(damaged(case, number))
            started = time.process_time()
            kind, caught = finding(root, case, door)
            took = time.process_time() - started
            (root / case.path).write_bytes(case.sound)
            held = 1024 * resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
            if held > MOST_HELD:
                kind = kind or f"held {held / 1e9:.1f} GB"
            if kind or caught or took > 1:
                file.write(json.dumps([number, kind, caught, took]) + "\n")
            if held > MOST_HELD:  # which would be said of all that follow
                return


def watched(
    root: Path, cases: Sequence[Case], numbers: range, until: float
) -> Iterator[tuple[int, str, str, float]]:
    """Number, finding, what the door caught, processor seconds of what is worth telling.

    Workers are started one after another; each begins where the one before ended, however it
    did. Last comes the first number that was not read, with nothing found.
    """
    at = mmap.mmap(-1, struct.calcsize(CLOCK))
    told = root.parent / "told.jsonl"
    first = numbers.start
    while first < numbers.stop and time.monotonic() < until:
        at[:] = struct.pack(CLOCK, first, time.monotonic())
        told.write_text("")
        child = os.fork()
        if child == 0:
            status = 1
            try:
                work(root, cases, range(first, min(first + BATCH, numbers.stop)), at, told)
                status = 0
            except BaseException:  # noqa: BLE001 (a fork must not go on as its parent)
                traceback.print_exc()
            finally:
                os._exit(status)
        ended = ""
        while not (waited := os.waitpid(child, os.WNOHANG))[0]:
            time.sleep(0.05)
            late = time.monotonic() - struct.unpack(CLOCK, at)[1] > SECONDS
            if late or time.monotonic() > until:
                os.kill(child, signal.SIGKILL)
                os.waitpid(child, 0)
                ended = f"took more than {SECONDS} s" if late else "time is over"
                break
        last = struct.unpack(CLOCK, at)[0]
        for line in told.read_text().splitlines():
            yield tuple(json.loads(line))
        if waited[1]:
            ended = f"ended the process with {os.waitstatus_to_exitcode(waited[1])}"
        (root / chosen(last, cases)[0].path).write_bytes(chosen(last, cases)[0].sound)
        if ended and ended != "time is over":
            yield last, ended, "", 0.0
        first = last + (ended != "time is over")
        print(f"# {first - numbers.start} files", file=sys.stderr, flush=True)
    yield first, "", "", 0.0


def fuzz(seconds: float, most: int, first: int) -> Counter[str]:
    """How often each kind was found in so many seconds or files, from this number on."""
    kinds: Counter[str] = Counter()
    doors: Counter[str] = Counter()
    slowest = (0.0, 0)
    number = first
    with tempfile.TemporaryDirectory(dir=MEMORY_DISK) as name:
        root = Path(name) / "samples"
        cases = write_samples(root)
        for case in cases:
            for door in range(len(case.doors)):
                said, caught = finding(root, case, door)
                if said or caught:
                    kinds[f"{case.path}, sound: {said or caught}"] += 1
        until = time.monotonic() + seconds
        for number, kind, caught, took in watched(root, cases, range(first, first + most), until):
            case, _ = chosen(number, cases)
            slowest = max(slowest, (took, number))
            if caught:
                doors[f"{case.path}: {caught}"] += 1
            if kind and not kinds[f"{case.path}: {kind}"]:
                print(f"{number}: {case.path}: {kind}", flush=True)
            kinds[f"{case.path}: {kind}"] += bool(kind)
    print(f"{number - first} damaged files of {len(cases)} kinds from number {first} on, "
          f"{sum(kinds.values())} findings; {sum(doors.values())} caught at the door only; "
          f"slowest {slowest[0]:.1f} s of processor time ({slowest[1]})")  # fmt: skip
    for kind, times in doors.most_common():
        print(f"{times:6d}  at the door: {kind}", file=sys.stderr)
    return +kinds


def main() -> int:
    """Fuzz as the command line asks; exit code 1 if anything was found."""
    parser = command_line(__doc__)
    parser.add_argument("--minutes", type=float, default=few(1.0, 0.05))
    parser.add_argument("--files", type=int, default=10**6, help="at most")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--structure", action="store_true", help="other meanings, sound syntax")
    parser.add_argument("--only", type=int, metavar="NUMBER")
    given = parser.parse_args()
    first = given.seed * 1_000_000 + STRUCTURED * given.structure
    first = first if given.only is None else given.only
    kinds = fuzz(60 * given.minutes, given.files if given.only is None else 1, first)
    for kind, times in kinds.most_common():
        print(f"{times:6d}  {kind}")
    return 1 if kinds else 0


if __name__ == "__main__":
    sys.exit(main())
