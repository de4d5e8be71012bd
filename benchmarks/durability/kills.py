"""Writers killed at any moment: nothing torn, and no pair of files that lies.

    python -m benchmarks kills [--kills 1000] [--seed 0]

A process writes the same targets again and again, tables at another frame rate each
time; it is killed at a random moment, and all that is there is read. Every file is
whole. A table and what lies beside it are of one writing, or it is said that they are
not: in a note, or, where they contradict each other, in the error that names what to
remove. Folders of clips have all their clips. Needs a system that can fork.
"""

from __future__ import annotations

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
from _options import command_line, few
from kineme.clips.split import split
from kineme.datasets import bundled_recording
from kineme.errors import KinemeError
from kineme.recordings import Motion
from kineme.segments.segmentation import Segmentation

TABLES = ("cuts.csv", "cuts.json", "cuts.parquet", "pair_events.tsv", "cuts.eaf", "cuts.TextGrid")
NO_RATE = (".TextGrid",)
MOTIONS = ("take.bvh", "take.amc", "take.npz", "take.trc")
CLIPS = "clips{}"
TURNS = 2.0
"""Turns of writing within which a writer is killed."""


def write_all(folder: Path, motion: Motion, cuts: Segmentation, turn: int) -> None:
    """Tables at a frame rate of that turn, motions, and clips."""
    rate = 50.0 + turn % 20
    columns = cuts.table.columns()
    table = Segmentation.from_columns(columns, n_frames=cuts.n_frames, fps=rate)
    for name in TABLES:
        kineme.write_segments(table, folder / name)
    for name in MOTIONS:
        kineme.write(motion, folder / name)
    clips = folder / CLIPS.format(turn % 3)
    gone = folder / "gone"  # a writer killed while it removes clips tears none
    shutil.rmtree(gone, ignore_errors=True)
    if clips.exists():
        clips.rename(gone)
    split(motion, cuts, clips)


def kill_after(seconds: float, folder: Path, motion: Motion, cuts: Segmentation) -> None:
    """A writer that goes on writing, and lives no longer than this."""
    child = os.fork()
    if child == 0:
        try:
            for turn in itertools.count():
                write_all(folder, motion, cuts, turn)
        except Exception:  # noqa: BLE001 (which would otherwise pass for a kill)
            traceback.print_exc()
        finally:
            os._exit(1)
    time.sleep(seconds)
    os.kill(child, signal.SIGKILL)
    _, status = os.waitpid(child, 0)
    if not os.WIFSIGNALED(status):
        sys.exit("the writer ended by itself: what it says is above")


def torn(folder: Path, motion: Motion, cuts: Segmentation) -> Iterator[str]:
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
                whole = len(table.activities) == len(cuts.activities)
                own = rate_in(path)
                told = any("another table" in note for note in notes_of(table))
                if own and abs(own - table.fps) > 1e-3 and not told:
                    yield f"{name} lies"
        except KinemeError as error:
            whole = "was written with another table: remove that file" in str(error)
            if not whole:
                print(error, file=sys.stderr)
        if not whole:
            yield f"{name} is torn"
    for clips in folder.glob("clips*"):
        with (clips / "manifest.csv").open(encoding="utf-8") as file:
            names = [row["file"] for row in csv.DictReader(file)]
        if any(not (clips / name).exists() for name in names):
            yield "clips are missing"


def left_drafts(folder: Path) -> Iterator[str]:
    """What writers were at when they were killed: suffixes; the drafts are removed."""
    for draft in folder.glob(".kineme-*"):
        yield draft.suffix or "clips"
        shutil.rmtree(draft) if draft.is_dir() else draft.unlink()


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
    parser = command_line(__doc__)
    parser.add_argument("--kills", type=int, default=few(1000, 5))
    parser.add_argument("--seed", type=int, default=0)
    options = parser.parse_args()
    os.environ["KINEME_THREADS"] = "1"  # threads do not outlive a fork
    warnings.simplefilter("ignore")
    motion = kineme.read(bundled_recording())[:240]
    assert isinstance(motion, Motion)
    cuts = kineme.segment(motion)
    moments = random.Random(options.seed)
    found: Counter[str] = Counter()
    drafts: Counter[str] = Counter()
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        write_all(folder, motion, cuts, 0)
        began = time.perf_counter()
        write_all(folder, motion, cuts, 1)
        longest = TURNS * (time.perf_counter() - began)
        for kill in range(1, options.kills + 1):
            kill_after(moments.uniform(0.0, longest), folder, motion, cuts)
            found.update(torn(folder, motion, cuts))
            drafts.update(left_drafts(folder))
            if kill % 50 == 0 or kill == options.kills:
                print(f"{kill} kills: {dict(found) or 'nothing torn'}", flush=True)
    print("killed while writing:", dict(sorted(drafts.items())))
    sys.exit(1 if found else 0)


if __name__ == "__main__":
    main()
