"""Loops: how often is the one put first the best of its cluster, or within a tenth of the best?

    python -m benchmarks loops [--record] [--pictures FOLDER]

Repetitions found in the bundled recording, CMU's 02_01 and the trials of subject 86 are written
as loops, and read again; so are those of recordings that neither ranking nor blending was made on
(``others``: exercises of uiprmd, samples of other programs). The blind number of each is the sum of

1. the step of pose and of speed at the seam, between the frame of the recording after the last
   and the first: in 3 cm, and in 0.3 m/s;
2. of the loop the step over the seam and its change, as shares of the recording's own (95 %
   quantiles);
3. how fast planted feet move over the floor in the loop, played twice: in 0.1 m/s. Contacts are
   found anew in what is played.

In groups of three candidates or more the one that kineme puts first is compared with the others.
kineme itself ranks by what it has before it writes, turn, rise and typical poses included.

A step over a seam may be above the 95 % quantile where the body is that fast: as in a run, in a
recording that mostly walks. So it is also compared with the recording's own steps within 0.1 s of
the ends of the segment.

Promises: the first has the smallest blind number, or one within a tenth of it, in 90 % of the
groups; no step over a seam is above the quantile and above the recording's own steps at the ends.
On the recordings it was made on, none is larger than the largest inside its loop.
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
from _measure import verdict
from _options import DATA, command_line, few
from kineme.clips.split import split
from kineme.cycles import landmarks, stands_from_positions
from kineme.recordings import Motion

PLACES = few(
    ("cmu_formats/02_01.amc", *(f"cmu86/86_{n}.amc" for n in ("01", "09", "10", "11", "14"))), ()
)
SAMPLES = ("formats/PyMO_AV_8Walk.bvh", "formats/aitviewer_sample.bvh", "cmu_formats/49_02.bvh")
EXERCISES = DATA / "bodies" / "uiprmd" / "recordings"
LEAST = 90.0
FEWEST = 3
AS_GOOD = 1.1
POSE_M, SPEED_M_S, SLIDE_M_S = 0.03, 0.3, 0.1
NEAR_S = 0.1
"""From the ends of a segment: the recording's own steps there."""


def main() -> int:
    parser = command_line(__doc__)
    parser.add_argument("--pictures", type=Path, metavar="FOLDER")
    add_option(parser)
    given = parser.parse_args()
    made_on = [kineme.bundled_recording(), *(DATA / place for place in PLACES)]
    others = [*(DATA / place for place in SAMPLES), *sorted(EXERCISES.glob("*.npz"))]
    kept = measured("loops", made_on, given.pictures, most=1.0)
    return int(not kept or not measured("loops.others", few(others, []), given.pictures))


def measured(
    name: str, paths: Sequence[Path], pictures: Path | None, *, most: float = np.inf
) -> bool:
    """Whether the promises hold on recordings; figures are recorded under a name."""
    loops, ratios = list[dict[str, Any]](), list[float]()
    for path in filter(Path.exists, paths):
        with tempfile.TemporaryDirectory() as folder:
            motion = kineme.read(path)
            for found in candidates(motion, Path(folder) / "loops").values():
                loops += found
                blind = [each["blind"] for each in found]
                if len(found) < FEWEST:
                    continue
                ratios.append(blind[0] / min(blind))
                place = 1 + sum(other < blind[0] for other in blind)
                title = f"{path.stem:12} cluster {found[0]['cluster']:3d}: {len(found):3d} loops"
                print(f"{title}, first {blind[0]:.2f} (place {place}), "
                      f"others {np.mean(blind[1:]):.2f}")  # fmt: skip
                if pictures:
                    draw(found, pictures / f"{path.stem}_{found[0]['cluster']}.png")
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
    said = verdict(largest, most) if np.isfinite(most) else "nothing promised"
    print(f"largest step over a seam, of the largest inside, {said}: {largest:.2f}")
    print(f"above the 95 % quantile of the recording's own steps: {above:.1f} %")
    print(f"above those at the ends of the segment, too, {verdict(beyond, 0)}: {beyond:.1f} %")
    print(f"changes of the step: median {changes:.2f} of their quantile")
    record(f"{name}.groups", len(ratios))
    record(f"{name}.best", round(best), unit="%")
    record(f"{name}.first", round(first), unit="%")
    record(f"{name}.seam", round(largest, 2))
    record(f"{name}.above", round(above, 1), unit="%")
    record(f"{name}.beyond", round(beyond, 1), unit="%")
    return first >= LEAST and largest <= most and beyond == 0


def candidates(motion: Motion, folder: Path) -> dict[int, list[dict[str, Any]]]:
    """By cluster the loops as measured on their files, the best ranked first."""
    split(motion, kineme.segment(motion), folder, level="primitive", loops=True)
    steps, fps = np.diff(motion.positions, axis=0), motion.fps
    usual, recorded = (quantile(steps), quantile(np.diff(steps, axis=0))), sizes(steps)
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
        twice, n = np.concatenate([loop, carried(loop, clip["carry"])]), len(loop)
        steps = np.diff(twice, axis=0)
        inside, changes = sizes(steps), sizes(np.diff(steps, axis=0))
        pose, speed = gaps(motion.positions, clip)
        step, change = inside[n - 1] / usual[0], changes[n - 2 : n].max() / usual[1]
        dragged = slide(twice, points, fps)
        groups[clip["cluster"]].append(
            {
                "cluster": clip["cluster"],
                "step": step,
                "of_inside": inside[n - 1] / inside[: n - 1].max(),
                "own": at_ends(recorded, clip, fps) / usual[0],
                "change": change,
                "blind": pose / POSE_M
                + speed * fps / SPEED_M_S
                + step
                + change
                + dragged / SLIDE_M_S,
                "positions": twice,
                "parents": motion.skeleton.parents,
                "cost": clip["quality"]["cost"],
            }
        )
    return groups


def at_ends(recorded: np.ndarray, clip: dict[str, Any], fps: float) -> float:
    """The largest of the recording's own steps near the ends of a clip."""
    near = max(1, round(NEAR_S * fps))
    ends = (clip["start_frame"], clip["stop_frame"])
    return float(max(recorded[max(end - near, 0) : end + near].max() for end in ends))


def gaps(positions: np.ndarray, clip: dict[str, Any]) -> tuple[float, float]:
    """Step of pose and of speed between the frame after the clip and its first, carried on."""
    first, after = clip["start_frame"], min(clip["stop_frame"], len(positions) - 2)
    ahead = carried(positions[first : first + 2], clip["carry"])
    behind = positions[after : after + 2]
    return float(sizes(ahead[:1] - behind[:1])[0]), float(
        sizes(np.diff(ahead, axis=0) - np.diff(behind, axis=0))[0]
    )


def carried(positions: np.ndarray, carry: dict[str, float]) -> np.ndarray:
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


def slide(positions: np.ndarray, points: list[int], fps: float) -> float:
    """Metres per second by which points of the feet that stand move over the floor."""
    speeds: list[float] = []
    for point in points:
        path = positions[:, point]
        steps = np.hypot(*np.diff(path, axis=0)[:, [0, 2]].T) * fps
        for start, stop in np.rint(stands_from_positions([path], fps) * fps).astype(int):
            speeds += steps[start : stop - 1].tolist()
    return float(np.mean(speeds)) if speeds else 0.0


def sizes(steps: np.ndarray) -> np.ndarray:
    return np.sqrt((steps**2).sum(axis=-1).mean(axis=-1))


def quantile(steps: np.ndarray) -> float:
    return float(np.percentile(sizes(steps), 95))


def draw(found: list[dict[str, Any]], path: Path) -> None:
    """The best and the worst loop of a cluster, the poses on both sides of the seam."""
    from matplotlib.figure import Figure

    path.parent.mkdir(parents=True, exist_ok=True)
    figure = Figure(figsize=(12, 5), layout="constrained")
    for axes, each, name in zip(figure.subplots(2), (found[0], found[-1]), ("best", "worst"),
                                strict=True):  # fmt: skip
        twice = each["positions"]
        n = len(twice) // 2
        frames = np.linspace(n // 2, n + n // 2, 13).astype(int)
        for place, frame in enumerate(frames):
            pose = twice[frame] - twice[frame, :1] * [1, 0, 1]
            for joint, parent in enumerate(each["parents"]):
                if parent >= 0:
                    bone = pose[[parent, joint]]
                    axes.plot(bone[:, 0] + bone[:, 2] + place, bone[:, 1],
                              color="C0" if frame < n else "C1")  # fmt: skip
        axes.set(aspect="equal", title=f"{name}: cost {each['cost']:.2f}, blue before the seam")
        axes.axis("off")
    figure.savefig(path, dpi=80)


if __name__ == "__main__":
    warnings.simplefilter("ignore")
    sys.exit(main())
