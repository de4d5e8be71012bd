"""Writers killed at any moment: nothing torn, and no pair of files that lies.

    python benchmarks/kills.py [--kills 1000] [--seed 0]

A process writes the same targets again and again, tables at another frame rate each
time; it is killed at a random moment, and all that is there is read. Every file is
whole. A table and what lies beside it are of one writing, or a note says that they are
not. Folders of clips have all their clips. Needs a system that can fork.
"""

from __future__ import annotations

import argparse
import csv
import itertools
import os
import random
import shutil
import signal
import sys
import tempfile
import time
import traceback
import warnings
from collections import Counter
from collections.abc import Iterator
from pathlib import Path

import kineme
from kineme.clips.split import split
from kineme.datasets import bundled_recording, bundled_truth
from kineme.errors import KinemeError
from kineme.recordings import Motion
from kineme.segments.segmentation import Segmentation

LONGEST_S = 0.4
TABLES = ("cuts.csv", "cuts.json", "cuts.parquet", "pair_events.tsv", "cuts.eaf", "cuts.TextGrid")
NO_RATE = (".eaf", ".TextGrid")
MOTIONS = ("take.bvh", "take.amc", "take.npz", "take.trc")
CLIPS = "clips{}"


def write_for_ever(folder: Path, motion: Motion, truth: Segmentation) -> None:
    """Write tables, motions and clips, round after round."""
    cuts = kineme.segment(motion)
    for turn in itertools.count():
        table = Segmentation.from_columns(
            truth.table.columns(), n_frames=truth.n_frames, fps=50.0 + turn % 20
        )
        for name in TABLES:
            kineme.write_segments(table, folder / name)
        for name in MOTIONS:
            kineme.write(motion, folder / name)
        shutil.rmtree(folder / CLIPS.format(turn % 3), ignore_errors=True)
        split(motion, cuts, folder / CLIPS.format(turn % 3))


def kill_after(seconds: float, folder: Path, motion: Motion, truth: Segmentation) -> None:
    """A writer that lives no longer than this."""
    child = os.fork()
    if child == 0:
        try:
            write_for_ever(folder, motion, truth)
        except Exception:  # noqa: BLE001 (which would otherwise pass for a kill)
            traceback.print_exc()
        finally:
            os._exit(1)
    time.sleep(seconds)
    os.kill(child, signal.SIGKILL)
    _, status = os.waitpid(child, 0)
    if not os.WIFSIGNALED(status):
        sys.exit("the writer ended by itself: what it says is above")


def torn(folder: Path, motion: Motion, truth: Segmentation) -> Iterator[str]:
    """What is wrong with what a killed writer left."""
    for name in (*TABLES, *MOTIONS):
        path = folder / name
        if not path.exists():
            continue
        try:
            if name in MOTIONS:
                whole = kineme.read(path).n_frames == motion.n_frames
            else:
                rate = 60.0 if path.suffix in NO_RATE else None
                table = kineme.read_segments(path, fps=rate)
                whole = len(table.activities) == len(truth.activities)
                own = rate_in(path)
                told = any("another table" in note for note in notes_of(table))
                if own and abs(own - table.fps) > 1e-3 and not told:
                    yield f"{name} lies"
        except KinemeError as error:
            print(error, file=sys.stderr)
            whole = False
        if not whole:
            yield f"{name} is torn"
    for clips in folder.glob("clips*"):
        with (clips / "manifest.csv").open(encoding="utf-8") as file:
            names = [row["file"] for row in csv.DictReader(file)]
        if any(not (clips / name).exists() for name in names):
            yield "clips are missing"


def rate_in(path: Path) -> float | None:
    """The frame rate that the rows of a table tell, where it has both seconds and frames."""
    if path.suffix not in (".csv", ".tsv"):
        return None
    with path.open(encoding="utf-8") as file:
        *_, last = csv.DictReader(file, delimiter="\t" if path.suffix == ".tsv" else ",")
    stop = float(last.get("stop_s") or float(last["onset"]) + float(last["duration"]))
    return int(last["stop_frame"]) / stop


def notes_of(table: Segmentation) -> list[str]:
    """The notes of the provenance."""
    return [str(note) for note in table.provenance.get("notes", ())]


def main() -> None:
    """Kill, look, count; exit code 1 where something is torn."""
    parser = argparse.ArgumentParser(description=str(__doc__).splitlines()[0])
    parser.add_argument("--kills", type=int, default=1000)
    parser.add_argument("--seed", type=int, default=0)
    options = parser.parse_args()
    os.environ["KINEME_THREADS"] = "1"  # threads do not outlive a fork
    warnings.simplefilter("ignore")
    motion = kineme.read(bundled_recording())[:240]
    assert isinstance(motion, Motion)
    truth = kineme.read_segments(bundled_truth(), fps=60)
    kineme.segment(motion)
    moments = random.Random(options.seed)
    found: Counter[str] = Counter()
    with tempfile.TemporaryDirectory() as name:
        for kill in range(1, options.kills + 1):
            kill_after(moments.uniform(0.0, LONGEST_S), Path(name), motion, truth)
            found.update(torn(Path(name), motion, truth))
            if kill % 50 == 0 or kill == options.kills:
                print(f"{kill} kills: {dict(found) or 'nothing torn'}", flush=True)
    sys.exit(1 if found else 0)


if __name__ == "__main__":
    main()
