"""Recordings pushed as a stream: scores beside those of the file, how soon, at what cost a row.

    python -m benchmarks stream [SOURCE ...] [--every N] [--delay S] [--interval S] [--record]

``delay`` of a change: from a border that became final to the first event that told of it, in
seconds. ``delay`` of a repetition: from its end to the first event that counted it, over its
length. Cost is processor time of one thread and all others.
"""

from __future__ import annotations

import time
import warnings
from collections.abc import Sequence

import numpy as np

import kineme
from _figures import add_option, record
from _options import command_line, few, needed
from _recordings import subject_86
from _sources import SOURCES
from kineme.evaluation.score import pool_scores
from kineme.live import ActivityStarted, Event, Repetition, Stream
from kineme.recordings import Motion, Signals

EVERY = {"subject_86": 1, "uiprmd": 9, "hugadb": 40}
"""Sources, and every n-th recording of each."""
NEAR_S = 1.5
"""Starts of one activity differ by this at most from event to event."""
CHUNK_S = 0.25


def stream_of(recording: Motion | Signals, **options: float) -> Stream:
    """A stream of the channels or the body of a recording."""
    if isinstance(recording, Signals):
        return Stream(fps=recording.fps, channels=recording.names, **options)
    return Stream(fps=recording.fps, skeleton=recording.skeleton, **options)


def push_all(stream: Stream, recording: Motion | Signals) -> list[Event]:
    """All events of a recording that comes in small pieces."""
    values = recording.values if isinstance(recording, Signals) else recording.positions
    step = max(1, round(CHUNK_S * recording.fps))
    events: list[Event] = []
    for start in range(0, len(values), step):
        events += stream.push(values[start : start + step])
    return events + stream.finish()


def delays(events: Sequence[Event]) -> tuple[list[float], list[float]]:
    """Seconds to the first event of each change; shares of lengths to that of each repetition."""
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
            told = min(e.at_s for e in units if e.start_s <= middle < e.stop_s)
            counts.append((told - final.stop_s) / (final.stop_s - final.start_s))
    return changes, counts


def cost(recording: Motion | Signals, **options: float) -> float:
    """Milliseconds a row, compiled beforehand."""
    stream = stream_of(recording, **options)
    start = time.process_time()
    push_all(stream, recording)
    return (time.process_time() - start) * 1e3 / recording.n_frames


def main() -> None:
    parser = command_line(__doc__)
    parser.add_argument("sources", nargs="*", help=", ".join(SOURCES))
    parser.add_argument("--every", type=int, help="every n-th recording of a source")
    for name in ("delay", "interval", "memory"):
        parser.add_argument(f"--{name}", type=float, help="of the stream, in seconds")
    add_option(parser)
    given = parser.parse_args()
    warnings.simplefilter("ignore")
    names = ("delay", "interval", "memory")
    options = {name: getattr(given, name) for name in names if getattr(given, name) is not None}
    changes: list[float] = []
    counts: list[float] = []
    for source in given.sources or few(list(EVERY), ["uiprmd"]):
        every = given.every or few(EVERY.get(source, 10), 1000)
        judged = []
        for sample in SOURCES[source](every):
            stream = stream_of(sample.recording, **options)
            events = push_all(stream, sample.recording)
            ways = kineme.segment(sample.recording), stream.segmentation
            judged.append([sample.judge(found) for found in ways])
            late, later = delays(events)
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
    body = subject_86()[few(2, 0)].motion
    path = min((needed("sets/gym_watch") / "recordings").glob("*"))
    watch = kineme.read(path)
    six = Signals(np.tile(watch.values[:, :6], (3, 1)), watch.fps, watch.names[:6])
    for name, recording in (("body", body), ("watch", six)):
        each = cost(recording, **options)
        print(f"cost, {name} at {recording.fps:g} Hz: {each:.2f} ms a row", flush=True)
        record(f"stream.cost.{name}", round(each, 2), unit="ms")


if __name__ == "__main__":
    main()
