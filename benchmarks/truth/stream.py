"""Measure scores, delays and costs of streams, and the robustness of live recordings.

    python -m benchmarks stream [SOURCE|hours|kills ...] [--every N] [--hours N] [--kills N]

Scores of a stream are printed beside those of the file. The delay of a change is the time from a
final border to the first event that reported it, in seconds. The delay of a repetition is the time
from its end to the first event that counted it, relative to its length. Cost is processor time of
all threads. ``hours`` repeats half an hour of joined recordings and compares memory and MoF of the
first and last part. ``kills`` kills ``kineme live --record`` at random moments and counts takes
that lose more than a second.
"""

from __future__ import annotations

import random
import subprocess
import sys
import time
import warnings
from collections.abc import Sequence
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

import kineme
from _figures import add_option, record
from _options import choose_size, find_data, make_parser
from _recordings import read_subject_86
from _sources import SOURCES, Piece, compute_scores, join_signals, read_pieces
from kineme.evaluation.comparison import UNLABELLED, Comparison
from kineme.evaluation.score import pool_scores
from kineme.live import ActivityStarted, Event, Repetition, Stream
from kineme.live.storage import recover_journal
from kineme.recordings import Motion, Signals

EVERY = {"subject_86": 1, "uiprmd": 9, "hugadb": 40}
"""Every n-th recording of each source."""
NEAR_S = 1.5
"""Maximum difference in seconds between reported starts of one activity."""
CHUNK_S = 0.25
PART_S = 1800.0
"""Seconds of joined recordings to repeat."""
MOST_LOST_S = 1.0


def make_stream(recording: Motion | Signals, **options: float) -> Stream:
    """Make a stream for the channels or the body of a recording."""
    if isinstance(recording, Signals):
        return Stream(fps=recording.fps, channels=recording.names, **options)
    return Stream(fps=recording.fps, skeleton=recording.skeleton, **options)


def push_all(stream: Stream, recording: Motion | Signals) -> list[Event]:
    """Push a recording in small pieces and return all events."""
    values = recording.values if isinstance(recording, Signals) else recording.positions
    step = max(1, round(CHUNK_S * recording.fps))
    events: list[Event] = []
    for start in range(0, len(values), step):
        events += stream.push(values[start : start + step])
    return events + stream.finish()


def measure_delays(events: Sequence[Event]) -> tuple[list[float], list[float]]:
    """Return the delays of changes in seconds and of repetitions relative to their lengths."""
    starts = [each for each in events if isinstance(each, ActivityStarted)]
    units = [each for each in events if isinstance(each, Repetition)]
    changes = [
        min(e.at_s for e in starts if abs(e.start_s - final.start_s) <= NEAR_S) - final.start_s
        for final in starts
        if final.is_final and final.start_s > 0
    ]
    counts = []
    for final in units:
        if final.is_final:
            middle = (final.start_s + final.stop_s) / 2
            reported_s = min(e.at_s for e in units if e.start_s <= middle < e.stop_s)
            counts.append((reported_s - final.stop_s) / (final.stop_s - final.start_s))
    return changes, counts


def measure_cost(recording: Motion | Signals, **options: float) -> float:
    """Return milliseconds per row, with compiled code."""
    stream = make_stream(recording, **options)
    start = time.process_time()
    push_all(stream, recording)
    return (time.process_time() - start) * 1e3 / recording.n_frames


def read_watch() -> Signals:
    """Read six channels of a watch at the gym, three times over."""
    path = min((find_data("sets/gym_watch") / "recordings").glob("*"))
    watch = kineme.read(path)
    return Signals(np.tile(watch.values[:, :6], (3, 1)), watch.fps, watch.names[:6])


def replay_hours(hours: float, **options: float) -> None:
    """Repeat recordings for hours and compare the first part with the last."""
    parts: list[Piece] = []
    for piece in read_pieces(find_data("sets/hugadb")):
        parts.append(piece)
        if sum(each.recording.duration for each in parts) >= choose_size(PART_S, 60.0):
            break
    part = join_signals(parts)
    n_parts = max(2, round(hours * 3600 / part.duration))
    stream, memory = make_stream(part, **options), []
    for _ in range(n_parts):
        for start in range(0, part.n_frames, 15):
            stream.push(part.values[start : start + 15])
        memory.append(int(Path("/proc/self/statm").read_text().split()[1]) * 4096 / 1e6)
    stream.finish()
    clusters = stream.segmentation.per_frame(level="activity").reshape(n_parts, -1)
    borders = np.cumsum([len(piece.truth) for piece in parts])[:-1]
    for which, at in (("first", 0), ("last", -1)):
        each = zip(parts, np.split(clusters[at], borders), strict=True)
        mof = pool_scores(
            compute_scores(["mof"], Comparison(piece.truth[known], own[known], part.fps))["mof"]
            for piece, own in each
            if (known := piece.truth != UNLABELLED).any()
        )
        seconds = f"{part.duration:.0f} s of {n_parts} times that"
        print(f"hours, {which} {seconds}: MoF {mof:.3f}, {memory[at]:.0f} MB", flush=True)
        record(f"stream.hours.{which}.mof", round(mof, 3))
        record(f"stream.hours.{which}.memory", round(memory[at]), unit="MB")


def kill_takes(n_kills: int) -> None:
    """Kill live recordings at random moments and count those that lose more than a second."""
    watch, chance, lost_s = read_watch(), random.Random(0), []
    step = round(watch.fps / 10)
    for _ in range(n_kills):
        with TemporaryDirectory() as folder:
            journal = Path(folder) / "take.journal.csv"
            command = [sys.executable, "-m", "kineme", "live", "--quiet", "--fps", str(watch.fps)]
            with subprocess.Popen(
                [*command, "--record", str(Path(folder) / "take")], stdin=subprocess.PIPE, bufsize=0
            ) as process:
                process.stdin.write(f"{','.join(watch.names)}\n".encode())
                # The first row tells which columns are channels.
                np.savetxt(process.stdin, watch.values[:1], delimiter=",")
                while process.poll() is None and not journal.exists():
                    time.sleep(0.01)
                begun, sent, until = time.monotonic(), 1, chance.uniform(0.5, 6)
                while time.monotonic() - begun < until:
                    np.savetxt(process.stdin, watch.values[sent : sent + step], delimiter=",")
                    sent += step
                    time.sleep(max(0.0, begun + sent / watch.fps - time.monotonic()))
                process.kill()
            kept = kineme.read(recover_journal(journal), fps=watch.fps).n_frames
            lost_s.append((sent - kept) / watch.fps)
    n_lost = sum(each > MOST_LOST_S for each in lost_s)
    print(
        f"kills: {n_lost} of {n_kills} lose more than {MOST_LOST_S:g} s, most {max(lost_s):.2f} s"
    )
    record("stream.kills.lost", f"{n_lost} of {n_kills}")
    record("stream.kills.most", round(max(lost_s), 2), unit="s")


def main() -> None:
    parser = make_parser(__doc__)
    parser.add_argument("sources", nargs="*", help=", ".join([*SOURCES, "hours", "kills"]))
    parser.add_argument("--every", type=int, help="every n-th recording of a source")
    for name in ("delay", "interval", "memory"):
        parser.add_argument(f"--{name}", type=float, help="of the stream, in seconds")
    parser.add_argument(
        "--hours", type=float, default=choose_size(1.0, 0.0), help="that are replayed"
    )
    parser.add_argument(
        "--kills", type=int, default=choose_size(100, 3), help="runs that are killed"
    )
    add_option(parser)
    given = parser.parse_args()
    warnings.simplefilter("ignore")
    names = ("delay", "interval", "memory")
    options = {name: getattr(given, name) for name in names if getattr(given, name) is not None}
    changes: list[float] = []
    counts: list[float] = []
    chosen = given.sources or [*choose_size(list(EVERY), ["uiprmd"]), "hours", "kills"]
    if "hours" in chosen:
        replay_hours(given.hours, **options)
    if "kills" in chosen:
        kill_takes(given.kills)
    for source in [each for each in chosen if each in SOURCES]:
        every = given.every or choose_size(EVERY.get(source, 10), 1000)
        judged = []
        for sample in SOURCES[source](every):
            stream = make_stream(sample.recording, **options)
            events = push_all(stream, sample.recording)
            ways = kineme.segment(sample.recording), stream.segmentation
            judged.append([sample.judge(found) for found in ways])
            late, later = measure_delays(events)
            changes += late
            counts += later
        for name in judged[0][0]:
            file, live = (
                pool_scores([one[way][name] for one in judged if name in one[way]])
                for way in range(2)
            )
            print(f"{source:12}{name:14}file {file:.3f}  stream {live:.3f}", flush=True)
            record(f"stream.{source}.{name}.file", round(file, 3))
            record(f"stream.{source}.{name}.stream", round(live, 3))
    for name, values in (("change", changes), ("repetition", counts)):
        if values:
            middle, late = np.percentile(values, [50, 95])
            print(f"delay of a {name}: {middle:.2f}, 95 % {late:.2f}, of {len(values)}")
            record(f"stream.delay.{name}.median", round(float(middle), 2))
            record(f"stream.delay.{name}.most", round(float(late), 2))
    if not given.sources:
        measure_costs(**options)


def measure_costs(**options: float) -> None:
    """Measure the milliseconds per row of a body and of six channels."""
    body = read_subject_86()[choose_size(2, 0)].motion
    for name, recording in (("body", body), ("watch", read_watch())):
        each = measure_cost(recording, **options)
        print(f"cost, {name} at {recording.fps:g} Hz: {each:.2f} ms a row", flush=True)
        record(f"stream.cost.{name}", round(each, 2), unit="ms")


if __name__ == "__main__":
    main()
