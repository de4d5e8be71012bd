"""Segments from body-worn sensors instead of a skeleton, scored against the annotations.

    python -m benchmarks sensors [--data ../shared/data] [--presets kineme …] [--record]

The sensors are made from the five trials of subject 86: an accelerometer (with
gravity and noise of 0.3 m/s²) and a gyroscope (noise of 0.05 rad/s) at the
forearms, shanks and head, 100 Hz, in the sensor's own axes. ``pose`` takes the
fifteen numbers of a pose without telling that they are a body. Then the same from
synthetic recordings, and the accelerometer that walks, jogs and runs (change points 3800 and 6800).
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from _figures import add_option, record
from _options import DATA, command_line, few, needed
from _recordings import TRIALS
from kineme import Signals, read, segment
from kineme import _rotations as rot
from kineme.datasets import random_recording
from kineme.evaluation import Truth, evaluate_segmentation, labelling_of
from kineme.evaluation.tables import markdown, shown
from kineme.features import end_effectors, pose_features
from kineme.recordings import Motion
from kineme.recordings.kinematics import world_rotations
from kineme.recordings.operations import resample
from kineme_reproduction.trials import find_folder, load_trials

Floats = NDArray[np.float64]
Recording = tuple[Truth, Signals]
SYNTHETIC = range(100, few(108, 101))  # seeds
FPS = 100.0
GRAVITY = np.array([0.0, 9.81, 0.0])
EVERYWHERE, RIGHT = (0, 1, 2, 3, 4), (1, 4)  # ankles, head, wrists: of features.PARTS


def sensors(motion: Motion, places: Iterable[int], *, gyroscopes: bool = True) -> Signals:
    """Accelerometers, and gyroscopes, fixed to the bones that end in these end effectors."""
    from scipy.signal import savgol_filter

    rng = np.random.default_rng(0)
    ends = end_effectors(motion).indices
    worn = resample(motion, FPS)
    turned = world_rotations(worn.skeleton, worn.rotations)
    columns: list[Floats] = []
    for place in places:
        joint = ends[place]
        bone = turned[:, worn.skeleton.parents[joint]]
        back = bone * np.array([1.0, -1.0, -1.0, -1.0])
        path = worn.positions[:, joint]
        pull = savgol_filter(path, 11, 3, deriv=2, delta=1 / FPS, axis=0) + GRAVITY
        columns.append(rot.rotate(back, pull) + 0.3 * rng.standard_normal(pull.shape))
        if gyroscopes:
            step = rot.multiply(back[:-1], bone[1:])
            rate = 2 * FPS * step[:, 1:] * np.sign(step[:, :1])
            rate = np.concatenate([rate, rate[-1:]])
            columns.append(rate + 0.05 * rng.standard_normal(rate.shape))
    return Signals(np.hstack(columns), FPS)


def pose(motion: Motion) -> Signals:
    """The fifteen numbers of a pose, as if they were any."""
    return Signals(pose_features(resample(motion, 30.0)), 30.0)


KINDS: dict[str, Callable[[Motion], Signals]] = {
    "pose": pose,
    "5 accelerometers": lambda motion: sensors(motion, EVERYWHERE, gyroscopes=False),
    "5 accelerometers and gyroscopes": lambda motion: sensors(motion, EVERYWHERE),
    "2 of each, right wrist and ankle": lambda motion: sensors(motion, RIGHT),
}


OWN = ("kineme", "voegele2014", "krueger2017")


def scores(recordings: Iterable[Recording], preset: str) -> tuple[str, str]:
    """Border F1 within 0.25 s, and frames in the right class, means over the recordings."""
    found = [
        evaluate_segmentation(truth, segment(signals, preset=preset))
        for truth, signals in recordings
    ]
    border, right = (
        shown(float(np.mean([f[key] for f in found]))) for key in ("border_f1", "one_to_one")
    )
    return border, right


def synthetic(make: Callable[[Motion], Signals]) -> list[Recording]:
    """Recordings that no constant was chosen on."""
    made = [random_recording(seed) for seed in SYNTHETIC]
    truths = [labelling_of(one.truth.activities, fps=one.truth.fps) for one in made]
    signals = [make(one.motion) for one in made]
    return list(zip(map(Truth.from_labelling, truths), signals, strict=True))


def main() -> None:
    parser = command_line(__doc__)
    parser.add_argument("--data", type=Path, default=DATA)
    parser.add_argument("--presets", nargs="+", default=OWN)
    add_option(parser)
    options = parser.parse_args()
    needed("cmu86", options.data)
    trials = load_trials(find_folder(options.data), few(TRIALS, TRIALS[:1]))
    for title, sets in (
        (
            "subject 86",
            {kind: [(t.truth, f(t.motion)) for t in trials] for kind, f in KINDS.items()},
        ),
        ("synthetic", {kind: synthetic(f) for kind, f in KINDS.items()}),
    ):
        print(table(title, sets, options.presets))
    for path in sorted((options.data / "timeseries").glob("WalkJogRun*.txt")):
        found = segment(read(path, fps=FPS))
        borders = ", ".join(map(str, found.cuts().tolist()))
        record(f"sensors.{path.stem}.borders", borders)
        print(f"{path.stem}: {borders} of {found.n_frames} frames")


def table(title: str, sets: dict[str, list[Recording]], presets: Iterable[str]) -> str:
    """A row per set of sensors, a column per preset."""
    rows = []
    for kind, recordings in sets.items():
        rows.append([kind])
        for preset in presets:
            found = " / ".join(scores(recordings, preset))
            record(f"sensors.{title}.{kind}.{preset}".replace(" ", "_").replace(",", ""), found)
            rows[-1].append(found)
    return markdown([title, *presets], rows)


if __name__ == "__main__":
    main()
