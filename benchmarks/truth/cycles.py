"""Check durations of repetitions, the stability of their borders, and joint angles.

    python -m benchmarks cycles [--seeds 50] [--record]

1. *Durations.* Synthetic recordings: relative error of the durations of inner and of first and last
   repetitions, if the count is right. It is measured as the true phase from start to end, which is
   1 for a correct repetition.
2. *Jitter.* A synthetic recording at 240 Hz, read at 60, 80, 120 and 240 Hz and with shifted
   start: distances between the borders of two readings.
3. *People.* ``bodies/uiprmd``: repetitions cut by people, if the count is right. Their cuts
   include pauses, so pauses are added to the measured durations.
4. *Angles.* Knees, hips and elbows of a synthetic figure against its true angles.
5. *Laboratory.* ``gait/overground``: knees and ankles against the Plug-in Gait angles in the
   same files: difference of ranges, mean offset, and the deviation without it. Knees also without
   thigh markers and hip centres.
"""

from __future__ import annotations

import sys
import warnings
from collections import defaultdict
from collections.abc import Sequence
from dataclasses import replace
from itertools import combinations

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import PchipInterpolator

import kineme
from _figures import add_option, record
from _options import DATA, choose_size, is_quick, make_parser
from _recordings import read_rows, synthesize_cases
from kineme.cycles import channels_of
from kineme.cycles.table import Cycles
from kineme.datasets import Action, synthesize
from kineme.datasets.figure import ANGLES, compute_joint_rotations, make_figure
from kineme.formats.files import load
from kineme.formats.markers.c3d_file import parse_c3d
from kineme.recordings import Motion
from kineme.recordings.operations import resample

Floats = NDArray[np.float64]

CONDITIONS = ("as it is", "all")
RATES = (60.0, 80.0, 120.0, 240.0)
SETS = ("uiprmd", "uiprmd_incorrect")
NEAR_S = 0.25
"""Seconds within which borders of two readings are the same."""
STANDING = "01"
"""End of the names of static trials."""
SPEED = ("LeftFoot.speed",)
"""Channels to measure if only borders matter."""
LEAST = 3
"""Minimum repetitions of an activity."""


def list_spans(found: kineme.Segmentation) -> list[Floats]:
    """Return start and end seconds of the repetitions of each activity."""
    rows = found.primitives.select(found.primitives.kind == "primitive")
    return [
        np.column_stack([rows.start_s, rows.stop_s])[rows.activity == activity]
        for activity in np.unique(rows.activity)
    ]


def list_runs(cycles: Cycles) -> list[NDArray[np.intp]]:
    """Return the row numbers of each activity."""
    activities = cycles.columns["activity"]
    return [np.flatnonzero(activities == activity) for activity in np.unique(activities)]


def check_durations(seeds: int) -> bool:
    kept = True
    for condition in CONDITIONS:
        found: dict[str, list[float]] = defaultdict(list)
        for case in synthesize_cases(condition, seeds):
            segments = kineme.segment(case.motion)
            cycles = kineme.cycles(case.motion, segments, channels=SPEED)
            columns, true = cycles.columns, list_spans(case.made)
            for rows in list_runs(cycles):
                start, stop = columns["start_s"][rows], columns["stop_s"][rows]
                known = max(
                    true, key=lambda each: min(each[-1, 1], stop[-1]) - max(each[0, 0], start[0])
                )
                if not LEAST <= len(rows) == len(known):
                    continue
                phase = PchipInterpolator(
                    np.append(known[:, 0], known[-1, 1]), np.arange(len(known) + 1)
                )
                longer = phase(stop) - phase(start) - 1
                inner = columns["place"][rows] == "inner"
                complete = columns["excluded"][rows] == ""
                found["inner"] += longer[inner].tolist()
                found["ends"] += longer[~inner & complete].tolist()
        for place, (most, spread) in (("inner", (1, 1.5)), ("ends", (2, 4))):
            mean, deviation = 100 * np.mean(found[place]), 100 * np.std(found[place])
            median = 100 * float(np.median(np.abs(found[place])))
            print(f"{condition:9} {place:6} {mean:+5.2f} ± {deviation:5.2f} % of "
                  f"{len(found[place])}, half within {median:.2f} %")  # fmt: skip
            name = f"cycles.{condition.replace(' ', '_')}.{place}"
            record(f"{name}.mean", round(float(mean), 2), unit="%")
            record(f"{name}.deviation", round(float(deviation), 2), unit="%")
            kept &= abs(mean) <= most and deviation <= spread
    return kept


def check_jitter(seeds: int) -> bool:
    apart: list[float] = []
    for seed in range(seeds):
        rng = np.random.default_rng(seed)
        names = rng.permutation(["squat", "jump", "arm circles", "kick", "run"])[:2].tolist()
        actions = [Action("walk", 5), *(Action(name, int(rng.integers(4, 8))) for name in names)]
        made = synthesize(actions, fps=240.0, seed=seed, noise=0.002).motion
        borders = []
        for i, rate in enumerate(RATES):
            shift = i % 3  # in frames at 240 Hz
            motion = resample(made[shift:], rate)
            cycles = kineme.cycles(motion, kineme.segment(motion), channels=SPEED)
            inside = cycles.columns["place"] != "first"
            borders.append(cycles.columns["start_s"][inside] + shift / 240)
        for first, second in combinations(borders, 2):
            distances = np.abs(first[:, None] - second).min(axis=1) if len(second) else np.empty(0)
            apart += distances[distances < NEAR_S].tolist()
    median, most = 1e3 * np.percentile(apart, [50, 95])
    print(f"borders of one recording at several rates: {median:.1f} ms apart, 95 % {most:.1f} ms")
    record("cycles.jitter.median", round(float(median), 1), unit="ms")
    record("cycles.jitter.most", round(float(most), 1), unit="ms")
    return bool(median <= 8 and most <= 20)


def check_people(every: int) -> bool:
    kept = True
    for name in SETS:
        folder = DATA / "bodies" / name
        if not folder.is_dir():
            print(f"{name}: not there")
            continue
        wrong: list[float] = []
        right = takes = 0
        for key, rows in sorted(read_rows(folder / "labels.csv").items())[::every]:
            motion = kineme.read(folder / "recordings" / f"{key}.npz")
            cycles = kineme.cycles(motion, kineme.segment(motion), channels=["pelvis.y"])
            takes += 1
            if len(cycles) != len(rows):
                continue
            right += 1
            true = np.array([[float(row["start_s"]), float(row["stop_s"])] for row in rows])
            own = np.append(cycles.columns["start_s"], cycles.columns["stop_s"][-1])
            lengths = np.diff(true, axis=1)[:, 0]
            wrong += (np.abs(np.diff(own) - lengths) / lengths)[1:-1].tolist()
        median, most = 100 * np.percentile(wrong or [np.nan], [50, 90])
        print(f"{name}: {right} of {takes} counted right; inner repetitions as long as people "
              f"say within {median:.1f} % (half), {most:.1f} % (90 %)")  # fmt: skip
        record(f"cycles.{name}.median", round(float(median), 1), unit="%")
        record(f"cycles.{name}.most", round(float(most), 1), unit="%")
        kept &= bool(median <= 6 and most <= 15)
    return kept


def check_angles() -> bool:
    t = np.linspace(0, 6 * np.pi, 600)
    given = {name: np.zeros(600) for name in ANGLES}
    for side, late in (("left", 0.0), ("right", np.pi)):
        given[f"{side} knee"] = 35 - 30 * np.cos(t + late)
        given[f"{side} hip"] = 10 + 30 * np.sin(t + late)
        given[f"{side} spread"] = 6 + 3 * np.sin(t)
        given[f"{side} elbow"] = 40 + 25 * np.sin(t - late)
    given["tilt"], given["bend"] = 8 * np.sin(t), 2 + 2 * np.sin(2 * t)
    skeleton = make_figure()
    rotations = compute_joint_rotations(skeleton, given, 30 * t)
    motion = Motion.from_rotations(skeleton, rotations, 60.0)
    kept = True
    for kind, recording, most in (
        ("rotations", motion, 0.1),
        ("positions", replace(motion, rotations=None), 3.0),
    ):
        worst = 0.0
        for side in ("left", "right"):
            for part in ("knee", "hip", "elbow"):
                values = channels_of(recording, [f"{part}_{side[0]}"])[0].values()
                wrong = np.abs(values - given[f"{side} {part}"])
                worst = max(worst, float(np.sqrt(np.mean(wrong**2))))
        print(f"angles from {kind}: {worst:.2f}° of those that made them (rms, the worst)")
        record(f"cycles.angles.{kind}", round(worst, 2), unit="°")
        kept &= worst <= most
    return kept


def check_laboratory() -> bool:
    folder = DATA / "gait" / "overground"
    if not folder.is_dir():
        print("gait/overground: not there")
        return True
    walks = [path for path in sorted(folder.glob("*.c3d")) if path.stem[-2:] != STANDING]
    kept = True
    for part, lacking, most in (
        ("knee", (), 2.0),
        ("knee", ("LTHI", "RTHI", "LHJC", "RHJC"), 4.0),
        ("ankle", (), 4.0),
    ):
        ranges, offsets, rests = [], [], []
        for path in walks:
            file = parse_c3d(load(path))
            motion = hide_markers(kineme.read(path), lacking)
            for side in "LR":
                label = f"{side}{part.title()}Angles"
                true = file.points[:, file.labels.index(label), 0]
                own = channels_of(motion, [f"{part}_{side.lower()}"])[0].values()
                ranges.append(np.ptp(own) - np.ptp(true))
                offsets.append((own - true).mean())
                rests.append((own - true).std())
        name = f"{part}, markers only" if lacking else part
        mean, deviation = float(np.mean(ranges)), float(np.std(ranges))
        offset, rest = float(np.mean(offsets)), float(np.mean(rests))
        print(f"Plug-in Gait, {name}: range {mean:+.1f} ± {deviation:.1f}°, offset {offset:+.1f}°, "
              f"without it {rest:.1f}° ({len(ranges)} legs of {len(walks)} walks)")  # fmt: skip
        key = f"cycles.laboratory.{name.replace(', ', '_').replace(' ', '_')}"
        for what, value in (("range", mean), ("range_deviation", deviation), ("offset", offset),
                            ("rest", rest)):  # fmt: skip
            record(f"{key}.{what}", round(value, 1), unit="°")
        kept &= abs(mean) <= most
    record("cycles.laboratory.walks", len(walks))
    return kept


def hide_markers(motion: Motion, lacking: Sequence[str]) -> Motion:
    """Rename markers, as if the file lacked them."""
    skeleton = motion.skeleton
    names = tuple(f"spare{i}" if name in lacking else name
                  for i, name in enumerate(skeleton.names))  # fmt: skip
    return replace(motion, skeleton=replace(skeleton, names=names))


def main() -> int:
    parser = make_parser(__doc__)
    parser.add_argument("--seeds", type=int, default=choose_size(50, 1))
    add_option(parser)
    seeds = parser.parse_args().seeds
    results = {
        "angles": check_angles(),
        "laboratory": check_laboratory(),
        "jitter": check_jitter(choose_size(max(1, seeds // 5), 1)),
        "people": check_people(choose_size(1, 25)),
        "durations": check_durations(seeds),
    }
    missed = [name for name, kept in results.items() if not kept]
    print(f"promises not kept: {', '.join(missed) or 'none'}")
    return 0 if not missed or is_quick() else 1


if __name__ == "__main__":
    warnings.simplefilter("ignore")
    sys.exit(main())
