"""Check the ranking of loops and their seams.

    python -m benchmarks loops [--record]

Repetitions of the recordings that were used in development, and of others (``others``), are
written as loops and read again. The independent cost of a loop is the sum of

1. the differences of pose (in 3 cm) and speed (in 0.3 m/s) between the first frame and the frame
   of the recording after the last;
2. the step over the seam and its change, relative to the 95 % quantiles of the recording;
3. the speed of planted feet in the loop, played twice (in 0.1 m/s).

In groups of at least three candidates, the loop that kineme ranks first is compared with the
others. kineme ranks before writing, by turn, rise and typical poses too.

A step over a seam may exceed the 95 % quantile if the body is fast there, as in a run within a
walk. It is therefore also compared with the steps within 0.1 s of the ends of the segment.

Promises: in 90 % of the groups the first loop has the smallest cost or one within a tenth of it;
no step over a seam exceeds both the quantile and the steps at the ends. On the recordings used in
development, no step over a seam exceeds the largest inside its loop.
"""

from __future__ import annotations

import json
import sys
import tempfile
import warnings
from collections import defaultdict
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

import kineme
from _figures import add_option, record
from _measure import judge
from _options import DATA, choose_size, make_parser
from kineme.clips.split import split
from kineme.cycles import landmarks, stands_from_positions
from kineme.recordings import Motion

PLACES = choose_size(
    ("cmu_formats/02_01.amc", *(f"cmu86/86_{n}.amc" for n in ("01", "09", "10", "11", "14"))), ()
)
SAMPLES = ("formats/PyMO_AV_8Walk.bvh", "formats/aitviewer_sample.bvh", "cmu_formats/49_02.bvh")
EXERCISES = DATA / "bodies" / "uiprmd" / "recordings"
LEAST = 90.0
FEWEST = 3
AS_GOOD = 1.1
POSE_M, SPEED_M_S, SLIDE_M_S = 0.03, 0.3, 0.1
NEAR_S = 0.1
"""Seconds around the ends of a segment."""


def main() -> int:
    parser = make_parser(__doc__)
    add_option(parser)
    parser.parse_args()
    made_on = [kineme.bundled_recording(), *(DATA / place for place in PLACES)]
    others = [*(DATA / place for place in SAMPLES), *sorted(EXERCISES.glob("*.npz"))]
    kept = measure_loops("loops", made_on, most=1.0)
    return int(not kept or not measure_loops("loops.others", choose_size(others, [])))


def measure_loops(name: str, paths: Sequence[Path], *, most: float = np.inf) -> bool:
    """Measure loops of recordings; return whether the promises hold."""
    loops, ratios = list[dict[str, Any]](), list[float]()
    for path in filter(Path.exists, paths):
        with tempfile.TemporaryDirectory() as folder:
            motion = kineme.read(path)
            for found in measure_candidates(motion, Path(folder) / "loops").values():
                loops += found
                blind = [each["blind"] for each in found]
                if len(found) < FEWEST:
                    continue
                ratios.append(blind[0] / min(blind))
                place = 1 + sum(other < blind[0] for other in blind)
                title = f"{path.stem:12} cluster {found[0]['cluster']:3d}: {len(found):3d} loops"
                print(f"{title}, first {blind[0]:.2f} (place {place}), "
                      f"others {np.mean(blind[1:]):.2f}")  # fmt: skip
    if not ratios:
        return True
    best, first = (100 * float(np.mean(np.array(ratios) <= limit)) for limit in (1.0, AS_GOOD))
    largest = max(each["of_inside"] for each in loops)
    above = 100 * float(np.mean([each["step"] > 1 for each in loops]))
    beyond = 100 * float(np.mean([each["step"] > max(1.0, each["own"]) for each in loops]))
    changes = float(np.median([each["change"] for each in loops]))
    said = "kept" if first >= LEAST else "NOT KEPT"
    print(f"{name}: {len(ratios)} groups, {len(loops)} loops")
    print(f"the first is the best in {best:.0f} %")
    print(f"within a tenth of it, at least {LEAST:g} % promised: {said}: {first:.0f} %")
    said = judge(largest, most) if np.isfinite(most) else "nothing promised"
    print(f"largest step over a seam, of the largest inside, {said}: {largest:.2f}")
    print(f"above the 95 % quantile of the recording's own steps: {above:.1f} %")
    print(f"above those at the ends of the segment, too, {judge(beyond, 0)}: {beyond:.1f} %")
    print(f"changes of the step: median {changes:.2f} of their quantile")
    record(f"{name}.groups", len(ratios))
    record(f"{name}.best", round(best), unit="%")
    record(f"{name}.first", round(first), unit="%")
    record(f"{name}.seam", round(largest, 2))
    record(f"{name}.above", round(above, 1), unit="%")
    record(f"{name}.beyond", round(beyond, 1), unit="%")
    return first >= LEAST and largest <= most and beyond == 0


def measure_candidates(motion: Motion, folder: Path) -> dict[int, list[dict[str, Any]]]:
    """Write loops and measure their files; return them by cluster, best ranked first."""
    split(motion, kineme.segment(motion), folder, level="primitive", loops=True)
    steps, fps = np.diff(motion.positions, axis=0), motion.fps
    usual, recorded = (
        (take_quantile(steps), take_quantile(np.diff(steps, axis=0))),
        measure_sizes(steps),
    )
    points = [
        joint
        for part, joint in landmarks(motion).items()
        if part.endswith(("ankle", "heel", "toe"))
    ]
    groups = defaultdict(list)
    for clip in json.loads((folder / "manifest.json").read_text())["clips"]:
        if not clip["loop"]:
            continue
        loop = kineme.read(folder / clip["file"]).positions
        twice, n = np.concatenate([loop, move_by(loop, clip["carry"])]), len(loop)
        steps = np.diff(twice, axis=0)
        inside, changes = measure_sizes(steps), measure_sizes(np.diff(steps, axis=0))
        pose, speed = measure_gaps(motion.positions, clip)
        step, change = inside[n - 1] / usual[0], changes[n - 2 : n].max() / usual[1]
        dragged = measure_slide(twice, points, fps)
        groups[clip["cluster"]].append(
            {
                "cluster": clip["cluster"],
                "step": step,
                "of_inside": inside[n - 1] / inside[: n - 1].max(),
                "own": find_largest_step(recorded, clip, fps) / usual[0],
                "change": change,
                "blind": pose / POSE_M
                + speed * fps / SPEED_M_S
                + step
                + change
                + dragged / SLIDE_M_S,
            }
        )
    return groups


def find_largest_step(recorded: np.ndarray, clip: dict[str, Any], fps: float) -> float:
    """Return the largest step of the recording near the ends of a clip."""
    near = max(1, round(NEAR_S * fps))
    ends = (clip["start_frame"], clip["stop_frame"])
    return float(max(recorded[max(end - near, 0) : end + near].max() for end in ends))


def measure_gaps(positions: np.ndarray, clip: dict[str, Any]) -> tuple[float, float]:
    """Return differences of pose and speed between the moved start and the end of a clip."""
    first, after = clip["start_frame"], min(clip["stop_frame"], len(positions) - 2)
    ahead = move_by(positions[first : first + 2], clip["carry"])
    behind = positions[after : after + 2]
    return float(measure_sizes(ahead[:1] - behind[:1])[0]), float(
        measure_sizes(np.diff(ahead, axis=0) - np.diff(behind, axis=0))[0]
    )


def move_by(positions: np.ndarray, carry: dict[str, float]) -> np.ndarray:
    turn = np.radians(carry["turn_deg"])
    x, y, z = np.moveaxis(positions, -1, 0)
    return np.stack(
        [
            x * np.cos(turn) + z * np.sin(turn) + carry["x_m"],
            y,
            z * np.cos(turn) - x * np.sin(turn) + carry["z_m"],
        ],
        axis=-1,
    )


def measure_slide(positions: np.ndarray, points: list[int], fps: float) -> float:
    """Return the mean speed of standing feet over the floor in m/s."""
    speeds: list[float] = []
    for point in points:
        path = positions[:, point]
        steps = np.hypot(*np.diff(path, axis=0)[:, [0, 2]].T) * fps
        for start, stop in np.rint(stands_from_positions([path], fps) * fps).astype(int):
            speeds += steps[start : stop - 1].tolist()
    return float(np.mean(speeds)) if speeds else 0.0


def measure_sizes(steps: np.ndarray) -> np.ndarray:
    return np.sqrt((steps**2).sum(axis=-1).mean(axis=-1))


def take_quantile(steps: np.ndarray) -> float:
    return float(np.percentile(measure_sizes(steps), 95))


if __name__ == "__main__":
    warnings.simplefilter("ignore")
    sys.exit(main())
