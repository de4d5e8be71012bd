"""Markers of a part of the body: what the distances between them tell, beside the whole body.

    python -m benchmarks parts_of_bodies

The joints of both legs, of both arms, of one leg, and all of them, as markers
without names: of the trials of subject 86, of HDM05 (12 seeds), and of
synthetic recordings of what legs do (20 seeds). What the other limbs do cannot
be seen in them; the second rows tell how much of that costs: the same joints of
legs and arms, seen in the frame of the whole body.
"""

from __future__ import annotations

import warnings
from collections.abc import Callable, Iterator

import numpy as np

import kineme
from _options import command_line, few
from _recordings import Case, annotation, hdm05, subject_86
from kineme.datasets import Action, synthesize
from kineme.evaluation import evaluate_segmentation
from kineme.features import body_frame, body_size, end_effectors
from kineme.methods.kineme.preset import KINEME
from kineme.recordings import Motion, Skeleton
from kineme.recordings.operations import resample
from kineme.segments.segmentation import Segmentation

Segment = Callable[[Motion], Segmentation]

LEGS = ("femur", "tibia", "foot", "toes", "toes_end", "UpLeg", "Leg", "Foot", "ToeBase")
ARMS = ("humerus", "radius", "wrist", "hand", "fingers_end", "Arm", "ForeArm", "Hand", "Hand_end")
PARTS = {
    "both legs and pelvis": ("root", "Hips", *LEGS),
    "both arms and chest": ("thorax", "Spine1", *ARMS),
    "left leg": LEGS[:4] + LEGS[5:],
}
SHOWN = ("border_f1", "one_to_one", "count_exact")


def joints_of(motion: Motion, part: str) -> list[int]:
    """The joints of a part of the body, in CMU's skeletons and the synthetic one."""
    sides = ("l", "Left") if part == "left leg" else ("", "l", "r", "Left", "Right")
    names = {side + name for side in sides for name in PARTS[part]}
    return [joint for joint, name in enumerate(motion.skeleton.names) if name in names]


def as_markers(motion: Motion, joints: list[int]) -> Motion:
    """The positions of these joints, without names or bones."""
    n = len(joints)
    skeleton = Skeleton([f"M{i}" for i in range(n)], [-1] * n, np.zeros((n, 3)))
    return Motion(skeleton, motion.positions[:, joints], motion.fps)


def in_the_bodys_frame(motion: Motion, joints: list[int]) -> Segmentation:
    """The segments by the positions of these joints, seen from the pelvis."""
    looked, ends = resample(motion, KINEME.working_fps), end_effectors(motion)
    seen = body_frame(looked, tuple(joints), effectors=ends).reshape(looked.n_frames, -1)
    unit = body_size(motion, ends) / np.sqrt(seen.shape[1])
    return kineme.segment(
        motion,
        preset=KINEME,  # by its name, features would go to the preset for sensors
        features=seen,
        feature_fps=KINEME.working_fps,
        unit=unit,
    )


def leg_exercises(seeds: int) -> Iterator[Case]:
    """Walking between squats, kicks and running."""
    for seed in range(seeds):
        rng = np.random.default_rng(seed)
        names = [n for other in rng.permutation(["squat", "kick", "run"]) for n in ("walk", other)]
        made = synthesize([Action(n, int(rng.integers(3, 9))) for n in names], fps=60, seed=seed)
        yield Case(f"legs {seed}", made.motion, annotation(made.truth))


def show(title: str, cases: list[Case], segment: Segment) -> None:
    """One line of means."""
    rows = [evaluate_segmentation(case.truth, segment(case.motion)) for case in cases]
    means = (np.nanmean([row.get(name, np.nan) for row in rows]) for name in SHOWN)
    print(f"  {title:34}" + "".join(f"{value:13.3f}" for value in means))


def main() -> None:
    command_line(__doc__).parse_args()
    warnings.simplefilter("ignore")
    sets = {
        "subject 86": subject_86(),
        "HDM05": list(hdm05(12)),
        "synthetic, what legs do": list(leg_exercises(few(20, 1))),
    }
    for name, cases in sets.items():
        print(f"{name:36}" + "".join(f"{score:>13}" for score in SHOWN))
        show("the body", cases, kineme.segment)
        show(
            "all joints as markers",
            cases,
            lambda motion: kineme.segment(as_markers(motion, [*range(motion.skeleton.n_joints)])),
        )
        for part in PARTS:
            show(part, cases, lambda m, p=part: kineme.segment(as_markers(m, joints_of(m, p))))
            show(
                "  in the body's frame",
                cases,
                lambda m, p=part: in_the_bodys_frame(m, joints_of(m, p)),
            )


if __name__ == "__main__":
    main()
