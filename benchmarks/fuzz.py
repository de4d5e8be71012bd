"""Damaged files of every kind through every reader: nothing but the package's own errors.

    python benchmarks/fuzz.py --minutes 5 --seed 1

Samples of recordings, labels, knowledge bases and motion graphs are made in a folder (and
those of KINEME_DATA up to 300 kB taken along), damaged in one to four ways, and read by
workers with limits of 4 GB and 20 s a file. What ends in anything but a `KinemeError`, in a
numpy warning, in a killed worker or after the time is a finding; findings are counted by
kind, and the number of the first of each gives the same bytes again (``--only NUMBER``).

Promises: no finding.
"""

from __future__ import annotations

import argparse
import json
import os
import random
import re
import resource
import selectors
import subprocess
import sys
import tempfile
import time
import traceback
import warnings
from collections import Counter
from collections.abc import Iterator
from pathlib import Path

import numpy as np

MEMORY = 4 << 30
SECONDS = 20
LARGEST = 300_000
"""Bytes of a sample from KINEME_DATA."""

WORDS = [b"nan", b"inf", b"-inf", b"1e300", b"-1.7e308", b"1e-320", b"0", b"-1", b"9" * 5000,
         b"18446744073709551616", b"9223372036854775808", b"2147483648", b"", b"{}", b"[]", b"null",
         b"true", b'""', b"\xff\xfe", b"\xef\xbb\xbf", b"\0", b"\n", b",", b"\t", b"x" * 140_000,
         b"=1+1", b"\xed\xa0\x80", b"(", b"1/0", b"{" * 3000, b"[" * 3000]  # fmt: skip
NUMBER = re.compile(rb"-?\d+(?:\.\d+)?(?:[eE][+-]?\d+)?")


def mutated(data: bytes, seed: int) -> bytes:
    """The bytes, damaged as the seed says."""
    chance = random.Random(seed)
    for _ in range(chance.randint(1, 4)):
        data = chance.choice((_bytes, _bytes, _lines, _numbers, _numbers, _head, _structure))(
            data, chance
        )
    return data


def _bytes(data: bytes, chance: random.Random) -> bytes:
    """A few bytes or a stretch of them turned, doubled, cut or replaced."""
    if not data:
        return data
    start = chance.randrange(len(data))
    stop = min(len(data), start + chance.choice((1, 1, 2, 4, 8, 64, 512)))
    new = chance.choice((
        bytes(255 - byte for byte in data[start:stop]),
        chance.randbytes(stop - start),
        data[start:stop] * 2,
        b"",
        b"\xff" * (stop - start),
        bytes(stop - start),
        chance.choice(WORDS),
    ))  # fmt: skip
    return data[:start] + new + data[stop:]


def _lines(data: bytes, chance: random.Random) -> bytes:
    """A line left out, doubled, moved, cut off or many times there."""
    lines = data.split(b"\n")
    at, to = chance.randrange(len(lines)), chance.randrange(len(lines))
    line = lines[at]
    new = chance.choice(([], [line] * 2, [line] * 500, [line[: len(line) // 2]], [lines[to]]))
    lines[at : at + 1] = new
    return b"\n".join(lines)


def _numbers(data: bytes, chance: random.Random) -> bytes:
    """A number of a text replaced by an odd one."""
    found = list(NUMBER.finditer(data[:100_000]))
    if not found:
        return _bytes(data, chance)
    where = chance.choice(found)
    return data[: where.start()] + chance.choice(WORDS) + data[where.end() :]


def _head(data: bytes, chance: random.Random) -> bytes:
    """A byte of the first thousand, where formats keep their counts, or of the last."""
    if not data:
        return data
    at = chance.randrange(min(len(data), 1000))
    at = chance.choice((at, len(data) - 1 - at))
    return data[:at] + bytes([chance.choice((0, 1, 127, 128, 255))]) + data[at + 1 :]


def _structure(data: bytes, chance: random.Random) -> bytes:
    """A file cut off, repeated, turned round, or two stretches of it exchanged."""
    a, b = sorted(chance.randrange(len(data) + 1) for _ in range(2))
    middle = (a + b) // 2
    return chance.choice((
        data[:a],
        data[a:],
        data + data[a:b],
        data[:a] + data[middle:b] + data[a:middle] + data[b:],
        data[:a] + chance.choice(WORDS) + data[a:],
    ))  # fmt: skip


def write_samples(folder: Path) -> None:
    """One small sound file of each kind that the package writes, and small ones of KINEME_DATA."""
    import kineme
    from kineme import formats, labels
    from kineme.datasets import bundled_recording, bundled_truth
    from kineme.synthesis.graph_file import write_graph

    motion = formats.read_motion(bundled_recording())[:600]
    for known in formats.supported_formats():
        for suffix in known.suffixes if known.write else ():
            formats.write(motion[:60], folder / f"motion{suffix}")
    rng = np.random.default_rng(0)
    signals = kineme.Signals(rng.normal(size=(80, 3)), 50, ["a", "b", "c"])
    for suffix in (".csv", ".parquet"):
        formats.write(signals, folder / f"signals{suffix}")
    np.save(folder / "array.npy", np.asarray(motion.positions[:20]))
    truth = kineme.read_segments(bundled_truth())
    for label_format in labels.label_formats().values():
        if label_format.write and not label_format.folder:
            path = folder / f"labels-{label_format.name}{label_format.written_suffix}"
            labels.write_segments(truth, path, format=label_format.name)
    whole = formats.read_motion(bundled_recording())
    kineme.KnowledgeBase.from_recording(whole, truth).save(folder / "base.npz")
    write_graph(kineme.MotionGraph((), (), (), 60.0, 0.1, 0.3), folder / "graph.json")
    data = Path(os.environ.get("KINEME_DATA", "/nowhere"))
    for path in sorted(data.glob("*formats/*")) + sorted(data.glob("timeseries/*")):
        if path.is_file() and 0 < path.stat().st_size < LARGEST:
            (folder / path.name).write_bytes(path.read_bytes())


def doors(path: Path) -> Iterator[tuple[str, object]]:
    """What reads a file of this name."""
    import kineme
    from kineme.synthesis.graph_file import read_graph

    name = path.name
    if name.startswith("labels-"):
        form = name.removeprefix("labels-").partition(".")[0]
        yield "labels", lambda: kineme.read_segments(path, format=form, fps=60)
        yield "labels", lambda: kineme.read_segments(path)
    elif name.startswith("graph"):
        yield "graph", lambda: read_graph(path)
    elif name.startswith("base"):
        yield "knowledge", lambda: kineme.KnowledgeBase.load(path)
    else:
        yield "recording", lambda: kineme.read(path)
        yield "recording", lambda: kineme.read(path, fps=60)
        yield "recording", lambda: kineme.read(path, columns=[])


def finding(path: Path) -> str:
    """The kind of what a reader did wrong; empty if it did nothing wrong."""
    from kineme.errors import KinemeError, KinemeWarning

    for door, read in doors(path):
        try:
            with warnings.catch_warnings():
                warnings.simplefilter("error")
                warnings.simplefilter("ignore", KinemeWarning)
                read()  # type: ignore[operator]
        except KinemeError as error:
            if "\n" in str(error):
                return f"{door}: a message of several lines: {type(error).__name__}"
            cause = error.__cause__
            if "cannot be understood, it is damaged" in str(error) and cause is not None:
                last = traceback.extract_tb(cause.__traceback__)[-1]
                print(f"# caught at the door: {type(cause).__name__} at "
                      f"{Path(last.filename).name}:{last.lineno}", file=sys.stderr)  # fmt: skip
        except Exception as error:  # noqa: BLE001 (which is what is looked for)
            last = traceback.extract_tb(error.__traceback__)[-1]
            return f"{door}: {type(error).__name__} at {Path(last.filename).name}:{last.lineno}"
    return ""


def work(folder: Path) -> None:
    """Read the files that stdin names, and answer with what was found."""
    resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
    for line in sys.stdin:
        print(json.dumps(finding(folder / line.strip())), flush=True)


class Worker:
    """A process that reads damaged files, started anew where one ends it."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.process = self._started()

    def _started(self) -> subprocess.Popen[str]:
        command = [sys.executable, __file__, "--work", str(self.folder)]
        return subprocess.Popen(
            command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True, bufsize=1
        )

    def read(self, name: str) -> str:
        """What is found in a file, with the end of the process and of the time among it."""
        stdin, stdout = self.process.stdin, self.process.stdout
        if stdin is None or stdout is None:
            return "the worker has no pipes"
        stdin.write(name + "\n")
        stdin.flush()
        with selectors.DefaultSelector() as selector:
            selector.register(stdout, selectors.EVENT_READ)
            ready = selector.select(SECONDS)
        line = stdout.readline() if ready else ""
        if line:
            return str(json.loads(line))
        self.process.kill()
        code = self.process.wait()
        self.process = self._started()
        return f"ended with {code}" if ready else f"took more than {SECONDS} s"

    def close(self) -> None:
        """End the process."""
        self.process.kill()
        self.process.wait()


def fuzz(seconds: float, most: int, seed: int, only: int | None = None) -> Counter[str]:
    """How often each kind was found in so many seconds or files, from this seed on."""
    kinds: Counter[str] = Counter()
    with tempfile.TemporaryDirectory() as place:
        sound, damaged = Path(place) / "sound", Path(place) / "damaged"
        sound.mkdir()
        damaged.mkdir()
        write_samples(sound)
        samples = sorted(path for path in sound.iterdir() if path.is_file())
        for path in samples:  # what lies beside them, ASF and side files, is sound
            (damaged / path.name).write_bytes(path.read_bytes())
        worker = Worker(damaged)
        number = seed * 1_000_000 if only is None else only
        started = time.monotonic()
        count = 0
        most = most if only is None else 1
        while time.monotonic() - started < seconds and count < most:
            sample = samples[number % len(samples)]
            (damaged / sample.name).write_bytes(mutated(sample.read_bytes(), number))
            kind = worker.read(sample.name)
            if kind and not kinds[f"{sample.name}: {kind}"]:
                print(f"{number}: {sample.name}: {kind}", flush=True)
            kinds[f"{sample.name}: {kind}"] += bool(kind)
            (damaged / sample.name).write_bytes(sample.read_bytes())
            number, count = number + 1, count + 1
        worker.close()
    print(f"{count} damaged files of {len(samples)} kinds, {sum(kinds.values())} findings")
    return +kinds


def main() -> int:
    """Fuzz as the command line asks; exit code 1 if anything was found."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--minutes", type=float, default=1.0)
    parser.add_argument("--files", type=int, default=10**9, help="at most")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--only", type=int)
    parser.add_argument("--work", type=Path, help=argparse.SUPPRESS)
    given = parser.parse_args()
    if given.work:
        work(given.work)
        return 0
    kinds = fuzz(60 * given.minutes, given.files, given.seed, given.only)
    for kind, times in kinds.most_common():
        print(f"{times:6d}  {kind}")
    return 1 if kinds else 0


if __name__ == "__main__":
    sys.exit(main())
