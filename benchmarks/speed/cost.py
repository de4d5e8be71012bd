"""What segmenting bodies costs, against another version of kineme.

    python -m benchmarks cost [COMMIT] [--runs 9] [--every 20]

The source of that commit is laid beside this one, and both segment the same
recordings in turn, each in a process of its own with its code loaded: the five
trials of subject 86 and one in so many of HDM05's exercises. What counts is
processor time, of the whole process, the best of all runs; reading the files is
left out. The limit is 1.5 times what the other version takes.
"""

from __future__ import annotations

import io
import os
import subprocess
import sys
import tarfile
import tempfile
from pathlib import Path

from _measure import verdict
from _options import command_line, few, needed, skip

HERE = Path(__file__).resolve().parents[2]
MOST = 1.5
WORKER = """
import sys, time, warnings
import kineme
warnings.simplefilter("ignore")
motions = [kineme.read(path) for path in sys.argv[1:]]
for motion in motions:
    kineme.segment(motion)
print("ready", flush=True)
for line in sys.stdin:
    motion = motions[int(line)]
    start = time.process_time()
    kineme.segment(motion)
    print(time.process_time() - start, flush=True)
"""


class Worker:
    """A process that segments recordings with the source in a folder."""

    def __init__(self, source: Path, paths: list[Path]):
        self._process = subprocess.Popen(
            [sys.executable, "-c", WORKER, *map(str, paths)],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
            env={**os.environ, "PYTHONPATH": str(source)},
        )
        self._answer()

    def _answer(self) -> str:
        assert self._process.stdout is not None
        if not (line := self._process.stdout.readline()):
            raise SystemExit("a worker ended before it answered")
        return line

    def seconds(self, recording: int) -> float:
        """Processor time of one run."""
        assert self._process.stdin is not None
        self._process.stdin.write(f"{recording}\n")
        self._process.stdin.flush()
        return float(self._answer())

    def stop(self) -> None:
        assert self._process.stdin is not None
        self._process.stdin.close()
        self._process.wait()


def source_of(commit: str, folder: Path) -> Path:
    """The source as it was at a commit, in a folder."""
    if not (HERE / ".git").exists():
        skip("needs the history of the project: run it in a git checkout")
    packed = subprocess.run(
        ["git", "archive", commit, "src"], cwd=HERE, check=True, capture_output=True
    ).stdout
    with tarfile.open(fileobj=io.BytesIO(packed)) as archive:
        archive.extractall(folder, filter="data")
    return folder / "src"


def main() -> None:
    parser = command_line(__doc__)
    parser.add_argument("commit", nargs="?", default="HEAD", help="the version to compare with")
    parser.add_argument("--runs", type=int, default=few(9, 1))
    parser.add_argument("--every", type=int, default=few(20, 100), help="one in so many exercises")
    options = parser.parse_args()
    groups = {
        "subject 86": sorted(needed("cmu86").glob("86_*.amc"))[: few(None, 1)],
        "HDM05": sorted(needed("hdm05/amc").glob("*.amc"))[:: options.every],
    }
    paths = [path for group in groups.values() for path in group]
    with tempfile.TemporaryDirectory() as folder:
        workers = [Worker(source_of(options.commit, Path(folder)), paths)]
        workers.append(Worker(HERE / "src", paths))
        best = [[float("inf")] * len(paths) for _ in workers]
        for _ in range(options.runs):
            for i in range(len(paths)):
                for worker, least in zip(workers, best, strict=True):
                    least[i] = min(least[i], worker.seconds(i))
        for worker in workers:
            worker.stop()
    print(f"{'ms of processor time':44}{options.commit[:8]:>9}{'now':>9}{'times':>7}")
    for path, before, now in zip(paths, *best, strict=True):
        print(f"{path.stem:44}{1000 * before:9.1f}{1000 * now:9.1f}{now / before:7.2f}")
    first = 0
    for name, group in groups.items():
        before, now = (sum(each[first : first + len(group)]) for each in best)
        first += len(group)
        times = f"{now / before:.2f} times; {verdict(now / before, MOST)}"
        print(f"{name}: {1000 * before:.0f} ms before, {1000 * now:.0f} ms now, {times}")


if __name__ == "__main__":
    main()
