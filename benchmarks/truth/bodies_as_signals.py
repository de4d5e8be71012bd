"""Bodies whose joints come as channels of a table, told by their bones and not told.

    python -m benchmarks bodies_as_signals [--every 4] [--record]

Subject 86 and sequences of HDM05's exercises as bodies, as channels that are named after joints
(``hip_x``, ``hip_y``, ``hip_z``), and as channels without names, of which nothing is told.
"""

from __future__ import annotations

import warnings
from collections.abc import Iterator

import numpy as np

import kineme
from _figures import add_option, record
from _options import command_line
from _recordings import Case, hdm05, subject_86
from kineme.evaluation import evaluate_segmentation
from kineme.recordings import Motion, Signals

SHOWN = ("one_to_one", "border_f1", "border_ratio", "cluster_ratio", "count_exact")


def ways(motion: Motion) -> Iterator[tuple[str, Motion | Signals]]:
    """The recording in all ways."""
    channels = motion.positions.reshape(motion.n_frames, -1)
    names = [f"{joint}_{axis}" for joint in motion.skeleton.names for axis in "xyz"]
    yield "body", motion
    yield "named", Signals(channels, motion.fps, names)
    yield "unnamed", Signals(channels, motion.fps)


def show(source: str, cases: list[Case]) -> None:
    """A line for each way, the means over the recordings."""
    found: dict[str, list[list[float]]] = {}
    for case in cases:
        for way, recording in ways(case.motion):
            scored = evaluate_segmentation(case.truth, kineme.segment(recording))
            found.setdefault(way, []).append([scored.get(key, np.nan) for key in SHOWN])
    for way, rows in found.items():
        means = dict(zip(SHOWN, np.mean(rows, axis=0).tolist(), strict=True))
        shown = ", ".join(f"{key} {mean:.3f}" for key, mean in means.items())
        print(f"{source}, {way}: {shown}", flush=True)
        for key, mean in means.items():
            if np.isfinite(mean):
                record(f"bodies_as_signals.{source}.{way}.{key}", round(mean, 3))


def main() -> None:
    parser = command_line(__doc__)
    parser.add_argument("--every", type=int, default=1, help="one in so many sequences")
    add_option(parser)
    options = parser.parse_args()
    warnings.simplefilter("ignore")
    show("subject_86", subject_86())
    show("hdm05", list(hdm05(24 // options.every)))


if __name__ == "__main__":
    main()
