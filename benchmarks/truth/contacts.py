"""Check the times of foot contacts against annotators, force plates and event marks.

    python -m benchmarks contacts [--every 4] [--record]

Inertial sensors: ``sets/ipolgait``, where people walk, turn and walk back with a sensor on each
foot, and annotators checked every contact. A contact is right within 50 ms of one of the same
foot. Some recordings lost samples, so that marks and sensors drift apart: a foot turns fast during
many marked stands, or marks lie beyond the end. Scores are for all recordings and for those whose
marks fit ("fitting").

Force plates: C3D samples with marked heel strikes and toe offs, each foot on one plate.

Markers: walks of ``gait/overground``, from heel and toe, against plates that bore a whole stance;
and the walk of ``gait/treadmill`` against the events in its file.
"""

from __future__ import annotations

import sys
import warnings
from collections import defaultdict
from dataclasses import replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

import kineme
from _figures import add_option, record
from _measure import match_times
from _options import choose_size, find_data, is_quick, make_parser
from _recordings import read_rows
from kineme.cycles import Events, foot_events, stands_from_force
from kineme.cycles.contacts import SMOOTH_S
from kineme.cycles.events import OFF, STRIKE, normalize_event_name
from kineme.recordings import Motion, Signals

Floats = NDArray[np.float64]

NEAR_S = 0.05
TURN_S = 0.3
"""Seconds around a turn in which contacts belong to it."""
SAME = 0.5
"""Minimum covered share of a marked swing for a match."""
FAST, MOVING = 0.3, 0.15
"""Turning speed of a moving foot, relative to the middle of a swing; maximum share of stands."""
PLATES_S = 0.04
"""Tolerance of force plates in seconds: two frames of the samples."""
PROMISED = {"away": 0.97, "all": 0.93, "treadmill": 0.95}
WHOLE = 0.8
"""Minimum share of a stance on a plate; otherwise the foot was partly beside it."""
PLATES = {"Eb015pi": {"right": "FZ1"}, "Dec_real": {"right": "FZ2", "left": "FZ1"}}
"""Channel of the vertical force under each foot, by sample."""
MARKED = {"foot strike": "HS", "foot off": "TO"}
SIDES = ("left", "right")
PARTS = {"left": "lf", "right": "rf"}


class Foot(NamedTuple):
    """Marked swings, found offs and strikes, and turns of one foot, in seconds."""

    recording: str
    marked: Floats
    offs: Floats
    ons: Floats
    turns: list[tuple[float, float]]


def is_aligned(signals: Signals, side: str, marked: Floats) -> bool:
    """Return whether the marks of a foot fit its samples."""
    from scipy.ndimage import gaussian_filter1d

    rates = signals.values[:, [signals.names.index(f"{PARTS[side]}_gyr_{a}") for a in "xyz"]]
    rates = gaussian_filter1d(rates - np.median(rates, axis=0), SMOOTH_S * signals.fps, axis=0)
    speed = np.linalg.norm(rates, axis=1)
    if marked.max() > signals.duration:
        return False
    frames = np.rint(marked.mean(axis=1) * signals.fps).astype(int)
    usual = np.median(speed[np.minimum(frames, len(speed) - 1)])
    stands = np.column_stack([marked[:-1, 1], marked[1:, 0]])
    stands = stands[np.diff(stands, axis=1)[:, 0] < 1.5]
    middles = np.rint(stands.mean(axis=1) * signals.fps).astype(int)
    return float(np.mean(speed[middles] > FAST * usual)) < MOVING


def keep_away_from_turns(times: Floats, turns: list[tuple[float, float]]) -> Floats:
    inside = [any(a - TURN_S <= at <= b + TURN_S for a, b in turns) for at in times.tolist()]
    return times[~np.array(inside, bool)]


def show(name: str, feet: list[Foot]) -> bool:
    """Print and record scores of some feet; return whether the promise is kept."""
    kept = True
    late: dict[str, list[float]] = defaultdict(list)
    for where in ("away", "all"):
        found = true = right = 0
        for foot in feet:
            for place, events, event in ((0, foot.offs, OFF), (1, foot.ons, STRIKE)):
                marked, times = foot.marked[:, place], events
                if where == "away":
                    marked, times = (
                        keep_away_from_turns(marked, foot.turns),
                        keep_away_from_turns(times, foot.turns),
                    )
                each = match_times(marked.tolist(), times.tolist(), NEAR_S)
                late[event] += each if where == "away" else []
                found, true, right = found + len(times), true + len(marked), right + len(each)
        score = 2 * right / (found + true)
        kept &= score >= PROMISED[where]
        print(f"{name}, {where:4}: F1 within 50 ms {score:.3f} of {true}")
        record(f"contacts.{name}.f1_{where}", round(score, 3))
    for event, values in late.items():
        print(f"{name}, {event}: {1e3 * np.mean(values):+.1f} ± {1e3 * np.std(values):.1f} ms")
    swings = []
    for foot in feet:
        count = min(len(foot.offs), len(foot.ons))
        own = np.column_stack([foot.offs[:count], foot.ons[:count]])
        for off, on in foot.marked.tolist():
            shared = np.minimum(own[:, 1], on) - np.maximum(own[:, 0], off)
            same = np.flatnonzero(shared > SAME * (on - off))
            swings += (np.diff(own[same], axis=1)[:, 0] - (on - off)).tolist()
    bias = 1e3 * float(np.mean(swings))
    apart = np.array([abs(len(foot.ons) - len(foot.marked)) for foot in feet])
    exact, one = float(np.mean(apart == 0)), float(np.mean(apart <= 1))
    print(f"{name}: swings {bias:+.1f} ms; feet counted exactly {exact:.2f}, within one {one:.2f}")
    record(f"contacts.{name}.swing_bias", round(bias, 1), unit="ms")
    record(f"contacts.{name}.exact", round(exact, 2))
    record(f"contacts.{name}.within_one", round(one, 2))
    return kept and abs(bias) <= 10


def show_plates() -> bool:
    """Compare contacts from force plates with the events of their files."""
    apart: list[float] = []
    for name, plates in PLATES.items():
        path = find_data(f"formats/{name}.c3d")
        marked = kineme.read(path).provenance.events
        found = foot_events(kineme.read(path, columns=["*"]), **plates)
        for side in plates:
            for event, mark in MARKED.items():
                times = [at for at, text in marked if text == f"{side[0].upper()}{mark}"]
                apart += [float(np.abs(found.at(f"{side} {event}") - at).min()) for at in times]
    print(f"force plates: {len(apart)} contacts within {1e3 * max(apart):.0f} ms of those marked")
    record("contacts.plates.most", round(1e3 * max(apart)), unit="ms")
    record("contacts.plates.marked", len(apart))
    return max(apart) <= PLATES_S


def show_markers() -> bool:
    """Compare contacts from markers with force plates and treadmill events."""
    late: dict[str, list[float]] = {STRIKE: [], OFF: []}
    for path in sorted(find_data("gait/overground").glob("*.c3d")):
        events = foot_events(drop_marks(kineme.read(path)))
        own = [each for side in SIDES for each in find_stances(events, side)]
        plates = kineme.read(path, columns=["Fz*"])
        for force in plates.values.T if own else ():
            for on, off in stands_from_force(force, plates.fps).tolist():
                shared = [min(b, off) - max(a, on) for a, b in own]
                start, stop = own[int(np.argmax(shared))]
                if max(shared) > WHOLE * (stop - start):
                    late[STRIKE].append(start - on)
                    late[OFF].append(stop - off)
    for event, values in late.items():
        mean, deviation = 1e3 * np.mean(values), 1e3 * np.std(values)
        print(f"markers, {event}: {mean:+.0f} ± {deviation:.0f} ms of {len(values)} on plates")
        name = f"contacts.markers.{event.replace(' ', '_')}"
        record(name, round(float(mean)), unit="ms")
        record(f"{name}.deviation", round(float(deviation)), unit="ms")
    record("contacts.markers.plates", len(late[STRIKE]))
    motion = kineme.read(find_data("gait/treadmill/treadmill_events.c3d"))
    events = foot_events(drop_marks(motion))
    marked: dict[str, list[float]] = defaultdict(list)
    for at, name in motion.provenance.events:
        marked[normalize_event_name(name)].append(at)
    right = sum(
        len(match_times(times, events.at(name).tolist(), NEAR_S)) for name, times in marked.items()
    )
    true = sum(map(len, marked.values()))
    print(f"treadmill: {right} of {true} within 50 ms, {len(events)} found")
    record("contacts.treadmill", f"{right} of {true}")
    return right >= PROMISED["treadmill"] * true


def drop_marks(motion: Motion) -> Motion:
    """Return the motion without the events of its file, which would replace those found."""
    return replace(motion, provenance=motion.provenance.marked(()))


def find_stances(events: Events, side: str) -> list[tuple[float, float]]:
    """Return the stances of a foot: each strike with the next off."""
    offs = events.at(f"{side} {OFF}")
    strikes = events.at(f"{side} {STRIKE}").tolist()
    return [(at, float(offs[offs > at][0])) for at in strikes if (offs > at).any()]


def main() -> int:
    parser = make_parser(__doc__)
    parser.add_argument(
        "--every", type=int, default=choose_size(1, 30), help="one in so many recordings"
    )
    add_option(parser)
    every = parser.parse_args().every
    folder = find_data("sets/ipolgait")
    marks, labels = (read_rows(folder / f"{name}.csv") for name in ("events", "labels"))
    feet: list[Foot] = []
    fitting: list[Foot] = []
    for name in sorted(marks)[::every]:
        signals = kineme.read(folder / "recordings" / f"{name}.parquet")
        events = foot_events(signals)
        turns = [(float(row["start_s"]), float(row["stop_s"])) for row in labels[name]
                 if row["label"] == "u_turn"]  # fmt: skip
        both = []
        for side in SIDES:
            rows = [row for row in marks[name] if row["foot"] == side]
            swings = [(float(row["swing_start_s"]), float(row["swing_stop_s"])) for row in rows]
            offs, ons = (events.at(f"{side} {event}") for event in (OFF, STRIKE))
            both.append(Foot(name, np.array(swings), offs, ons, turns))
        feet += both
        fits = all(
            is_aligned(signals, side, foot.marked) for side, foot in zip(SIDES, both, strict=True)
        )
        fitting += both if fits else []
    print(f"{len(fitting) // 2} of {len(feet) // 2} recordings have marks that fit")
    record("contacts.recordings", f"{len(fitting) // 2} of {len(feet) // 2}")
    show("all", feet)
    kept = show("fitting", fitting) & show_plates() & show_markers()
    promise = "F1 .97 away from turns, .93 with them; plates within two frames; treadmill .95"
    print(f"promised: {promise}: {'kept' if kept else 'NOT KEPT'}")
    return 0 if kept or is_quick() else 1


if __name__ == "__main__":
    warnings.simplefilter("ignore")
    sys.exit(main())
