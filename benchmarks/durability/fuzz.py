"""Read damaged files of every kind and report everything except the package's own errors.

    python -m benchmarks fuzz --minutes 5 --seed 1

Samples of every kind of file, and parts of those of KINEME_DATA, are damaged in one to four ways
and read by a worker with limits of 4 GB and 20 s per file. A finding is any exception but a
`KinemeError`, a numpy warning, a killed worker, a timeout, or more than 2 GB. Findings are counted
by kind; ``--only NUMBER`` repeats the first of each. ``--structure`` keeps the syntax and changes
the content.

Workers are forks of a process that has read every sample once, so that no worker has to import or
compile. Needs a system that can fork.

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

from _options import choose_size, make_parser

os.environ["KINEME_THREADS"] = os.environ["OMP_NUM_THREADS"] = "1"  # threads outlive no fork

from _damage import damage_bytes
from _fuzz_samples import Case, write_samples
from _restructure import change_structure
from kineme.errors import KinemeError, KinemeWarning

MEMORY, MOST_HELD = 4 << 30, 2 << 30
SECONDS = 20
BATCH = 3000
"""Files that a worker reads before it is replaced."""

MEMORY_DISK = "/dev/shm" if Path("/dev/shm").is_dir() else None
CLOCK = "qd"
"""Format of the shared memory: number of the current file, and when its reading began."""

GENERIC_MESSAGE = "cannot be understood, it is damaged"
"""Message for errors that only the outermost handler caught."""

STRUCTURED = 500_000
"""In each million, numbers from here on change the content, not the bytes."""


def damage_case(case: Case, number: int) -> bytes:
    """Return the bytes of a case with the damage of this number."""
    if number % 1_000_000 < STRUCTURED:
        return damage_bytes(case.sound, number)
    return change_structure(case.path, case.sound, number)


def choose_case(number: int, cases: Sequence[Case]) -> tuple[Case, int]:
    """Return the case of a number and the index of its reader; all take turns."""
    case = cases[number % len(cases)]
    return case, number // len(cases) % len(case.readers)


def check_reader(root: Path, case: Case, reader: int) -> tuple[str, str]:
    """Return the fault of a reader, and an error that only the outermost handler caught."""
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            warnings.simplefilter("ignore", KinemeWarning)
            case.readers[reader](root)
    except KinemeError as error:
        if "\n" in str(error):
            return f"a message of several lines: {type(error).__name__}", ""
        if GENERIC_MESSAGE in str(error) and error.__cause__ is not None:
            return "", _locate_error(error.__cause__)
    except Exception as error:  # noqa: BLE001 (findings are such exceptions)
        return _locate_error(error), ""
    return "", ""


def _locate_error(error: BaseException) -> str:
    """Return the exception type and the innermost line of the package in its traceback."""
    frames = traceback.extract_tb(error.__traceback__)
    own = [frame for frame in frames if "/kineme/" in frame.filename] or frames
    return f"{type(error).__name__} at {Path(own[-1].filename).name}:{own[-1].lineno}"


def read_damaged(
    root: Path, cases: Sequence[Case], numbers: range, at: mmap.mmap, log: Path
) -> None:
    """Damage and read files in turn; share the current number and write findings."""
    resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
    with log.open("a", buffering=1) as file:
        for number in numbers:
            at[:] = struct.pack(CLOCK, number, time.monotonic())
            case, reader = choose_case(number, cases)
            (root / case.path).write_bytes(damage_case(case, number))
            started = time.process_time()
            kind, caught = check_reader(root, case, reader)
            took = time.process_time() - started
            (root / case.path).write_bytes(case.sound)
            held = 1024 * resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
            if held > MOST_HELD:
                kind = kind or f"held {held / 1e9:.1f} GB"
            if kind or caught or took > 1:
                file.write(json.dumps([number, kind, caught, took]) + "\n")
            if held > MOST_HELD:  # the peak would count for all later files too
                return


def watch_workers(
    root: Path, cases: Sequence[Case], numbers: range, until: float
) -> Iterator[tuple[int, str, str, float]]:
    """Yield number, finding, error of the outermost handler, and processor seconds.

    Workers run one at a time; each continues where the previous one ended or died. The last item
    is the first number that was not read.
    """
    at = mmap.mmap(-1, struct.calcsize(CLOCK))
    log = root.parent / "log.jsonl"
    first = numbers.start
    while first < numbers.stop and time.monotonic() < until:
        at[:] = struct.pack(CLOCK, first, time.monotonic())
        log.write_text("")
        child = os.fork()
        if child == 0:
            status = 1
            try:
                read_damaged(root, cases, range(first, min(first + BATCH, numbers.stop)), at, log)
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
        for line in log.read_text().splitlines():
            yield tuple(json.loads(line))
        if waited[1]:
            ended = f"ended the process with {os.waitstatus_to_exitcode(waited[1])}"
        (root / choose_case(last, cases)[0].path).write_bytes(choose_case(last, cases)[0].sound)
        if ended and ended != "time is over":
            yield last, ended, "", 0.0
        first = last + (ended != "time is over")
        print(f"# {first - numbers.start} files", file=sys.stderr, flush=True)
    yield first, "", "", 0.0


def fuzz(seconds: float, most: int, first: int) -> Counter[str]:
    """Count findings by kind within limits of seconds and files, from a first number."""
    kinds: Counter[str] = Counter()
    generic: Counter[str] = Counter()
    slowest = (0.0, 0)
    number = first
    with tempfile.TemporaryDirectory(dir=MEMORY_DISK) as name:
        root = Path(name) / "samples"
        cases = write_samples(root)
        for case in cases:
            for reader in range(len(case.readers)):
                said, caught = check_reader(root, case, reader)
                if said or caught:
                    kinds[f"{case.path}, sound: {said or caught}"] += 1
        until = time.monotonic() + seconds
        for number, kind, caught, took in watch_workers(
            root, cases, range(first, first + most), until
        ):
            case, _ = choose_case(number, cases)
            slowest = max(slowest, (took, number))
            if caught:
                generic[f"{case.path}: {caught}"] += 1
            if kind and not kinds[f"{case.path}: {kind}"]:
                print(f"{number}: {case.path}: {kind}", flush=True)
            kinds[f"{case.path}: {kind}"] += bool(kind)
    print(f"{number - first} damaged files of {len(cases)} kinds from number {first} on, "
          f"{sum(kinds.values())} findings; {sum(generic.values())} with a generic message only; "
          f"slowest {slowest[0]:.1f} s of processor time ({slowest[1]})")  # fmt: skip
    for kind, times in generic.most_common():
        print(f"{times:6d}  generic message: {kind}", file=sys.stderr)
    return +kinds


def main() -> int:
    """Fuzz; the exit code is 1 if anything was found."""
    parser = make_parser(__doc__)
    parser.add_argument("--minutes", type=float, default=choose_size(1.0, 0.05))
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
