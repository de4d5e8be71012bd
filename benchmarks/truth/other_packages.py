"""Are strides right on the recordings that two gait packages come with, which nobody tuned for?

    pip download --no-deps --no-binary :all: gaitmap==2.6.0 mobgap==1.2.0   # then unpack both
    python -m benchmarks other_packages FOLDER [--record]

- gaitmap: a healthy person with a sensor at each foot; strides and contacts were marked by people.
- mobgap: two older people and one with multiple sclerosis, a sensor at the lower back. Contacts are
  those of a reference system, pressure insoles and sensors at the feet. They walk straight, and do
  the chores of a day, in which a bout of walking is some metres long and turns.

A primitive is a stride. Of a bout they are counted rightly where they are within one of the half
of its steps. Nothing of these recordings was looked at when the method was made.
"""

from __future__ import annotations

import csv
import warnings
from collections import defaultdict
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

import kineme
from _figures import add_option, record
from _options import command_line, skip
from kineme.cycles import foot_events
from kineme.cycles.events import OFF, STRIKE

Floats = NDArray[np.float64]

FPS = {"gaitmap": 204.8, "mobgap": 100.0}
NEAR_S = 0.05
PEOPLE = ("HA/001", "HA/002", "MS/001")
TESTS = {"straight": "Test5", "chores": "Test11"}


def marked(path: Path) -> list[dict[str, str]]:
    with path.open(encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


def hits(true: Floats, found: Floats) -> Floats:
    """By how much the nearest found event is late, of each true one."""
    nearest = np.abs(found[None] - true[:, None]).argmin(axis=1)
    return found[nearest] - true


def gaitmap(folder: Path) -> None:
    """Strides and contacts of the feet."""
    signals = kineme.read(folder / "imu_sample.csv", fps=FPS["gaitmap"])
    segments = kineme.segment(signals)
    found = [
        (row.start_frame, row.stop_frame) for row in segments.primitives if row.kind == "primitive"
    ]
    strides = marked(folder / "stride_borders_sample.csv")
    for foot in ("left", "right"):
        true = [(int(row["start"]), int(row["end"])) for row in strides if row["foot"] == foot]
        inside = [
            (a, b) for a, b in found if any(start <= (a + b) / 2 < stop for start, stop in true)
        ]
        usual = [float(np.median(np.diff(spans, axis=1))) for spans in (true, inside)]
        error = 100 * (usual[1] / usual[0] - 1)
        print(f"gaitmap, {foot}: {len(inside)} strides of {len(true)}, median {error:+.1f} %")
        record(f"other_packages.gaitmap.{foot}", f"{len(inside)} of {len(true)}")
    feet = {foot: f"{foot}_sensor_gyr_*" for foot in ("left", "right")}
    events = foot_events(signals, **feet)
    rows = marked(folder / "stride_events_sample.csv")
    late = []
    for foot in feet:
        for event, column in ((STRIKE, "ic"), (OFF, "tc")):
            times = sorted({float(row[column]) for row in rows if row["foot"] == foot})
            late += hits(np.array(times) / signals.fps, events.at(f"{foot} {event}")).tolist()
    near = int((np.abs(late) <= NEAR_S).sum())
    print(f"gaitmap, contacts: {near} of {len(late)} within 50 ms")
    record("other_packages.gaitmap.contacts", f"{near} of {len(late)}")


def fields(structure: Any) -> dict[str, Any]:
    """What a structure of MATLAB's holds."""
    return {name: value for name, value in vars(structure).items() if not name.startswith("_")}


def bouts(trial: Any) -> list[tuple[float, float, int]]:
    """Start, stop and number of contacts of each bout of walking that the reference system saw."""
    systems = fields(trial.Standards)
    system = systems.get("INDIP") or next(iter(systems.values()))
    periods = getattr(system, "ContinuousWalkingPeriod", [])
    return [
        (float(each.Start), float(each.End), len(np.atleast_1d(each.InitialContact_Event)))
        for each in np.atleast_1d(periods)
    ]


def mobgap(folder: Path) -> None:
    """Counts of strides in bouts of walking, straight ones and those of chores."""
    from scipy.io import loadmat

    right: dict[str, list[bool]] = defaultdict(list)
    for person in PEOPLE:
        path = folder / "data/lab" / person / "data.mat"
        tests = loadmat(path, squeeze_me=True, struct_as_record=False)["data"].TimeMeasure1
        for kind, test in TESTS.items():
            for name, trial in fields(getattr(tests, test)).items():
                table = folder / "data_csv" / person / f"TimeMeasure1_{test}_{name}.csv"
                segments = kineme.segment(kineme.read(table, fps=FPS["mobgap"]))
                middles = np.array(
                    [(row.start_s + row.stop_s) / 2 for row in segments.primitives
                     if row.kind == "primitive"]
                )  # fmt: skip
                for start, stop, contacts in bouts(trial):
                    count = int(((start <= middles) & (middles <= stop)).sum())
                    right[kind].append(abs(count - (contacts - 1) / 2) <= 1)
    for kind, within in right.items():
        print(f"mobgap, {kind}: {sum(within)} of {len(within)} bouts counted within one stride")
        record(f"other_packages.mobgap.{kind}", f"{sum(within)} of {len(within)}")


def main() -> int:
    parser = command_line(__doc__)
    parser.add_argument("folder", nargs="?", type=Path, help="in which both are unpacked")
    add_option(parser)
    folder = parser.parse_args().folder
    if folder is None:
        skip("needs the folder in which gaitmap and mobgap are unpacked: see the docstring")
    for measure in (gaitmap, mobgap):
        found = sorted(folder.glob(f"{measure.__name__}-*/example_data"))
        if not found:
            skip(f"no {measure.__name__}-*/example_data in {folder}")
        measure(found[-1])
    return 0


if __name__ == "__main__":
    warnings.simplefilter("ignore", kineme.errors.KinemeWarning)
    raise SystemExit(main())
