"""Synthetic recordings: what was ordered is what a person would count and see."""

from __future__ import annotations

from collections.abc import Callable
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from scipy.signal import find_peaks
from scipy.spatial.distance import cdist

import kineme
from kineme.datasets import (
    ACTIONS,
    Action,
    SyntheticRecording,
    bundled_recording,
    bundled_truth,
    random_recording,
    synthesize,
)
from kineme.errors import ParameterError
from kineme.features import pose_features, stack
from kineme.recordings import Motion
from make_bundled import make_bundled

FPS = 60.0
EXERCISES = [name for name in ACTIONS if name != "stand"]


def alone(name: str, repetitions: int = 5, **how: float | str) -> SyntheticRecording:
    return synthesize([Action(name, repetitions, **how)], fps=FPS, seed=2)  # type: ignore[arg-type]


def feet(motion: Motion) -> np.ndarray:
    """(frames, 4, 3): balls and tips of the feet."""
    names = ("LeftToeBase", "LeftToeBase_end", "RightToeBase", "RightToeBase_end")
    return motion.positions[:, [motion.joint(name) for name in names]]


def wrist_height(motion: Motion) -> np.ndarray:
    return motion.positions[:, motion.joint("RightHand"), 1]


def reach_ahead(motion: Motion, joint: str) -> np.ndarray:
    hips = motion.positions[:, 0, [0, 2]]
    return np.linalg.norm(motion.positions[:, motion.joint(joint)][:, [0, 2]] - hips, axis=1)


def ankle_height(motion: Motion) -> np.ndarray:
    return motion.positions[:, motion.joint("LeftFoot"), 1]


# What a person would look at to count each exercise, and how far it must move, in metres.
COUNTED: dict[str, tuple[Callable[[Motion], np.ndarray], float]] = {
    "walk": (ankle_height, 0.1),
    "run": (ankle_height, 0.2),
    "jump": (lambda motion: motion.positions[:, 0, 1], 0.3),
    "squat": (lambda motion: -motion.positions[:, 0, 1], 0.3),
    "kick": (lambda motion: reach_ahead(motion, "RightFoot"), 0.4),
    "arm circles": (wrist_height, 0.6),
    "punch": (lambda motion: reach_ahead(motion, "RightHand"), 0.2),
    "wave": (wrist_height, 0.3),
}


@pytest.mark.parametrize("name", EXERCISES)
@pytest.mark.parametrize("repetitions", [3, 6])
def test_a_person_counts_what_was_ordered(name: str, repetitions: int) -> None:
    lead_in = [Action("stand", 1), Action(name, repetitions), Action("stand", 1)]
    recording = synthesize(lead_in, fps=FPS, seed=repetitions)
    look, movement = COUNTED[name]
    peaks, _ = find_peaks(look(recording.motion), prominence=movement)
    rows = recording.truth.primitives
    true = rows.select(rows.label == name)
    assert len(true) == repetitions
    inside = (peaks >= true.start_frame[0]) & (peaks < true.stop_frame[-1])
    assert inside.sum() == len(peaks) == repetitions
    assert (
        np.searchsorted(true.start_frame, peaks, "right") == np.arange(1, repetitions + 1)
    ).all()


def test_the_truth_tells_activities_transitions_and_repetitions() -> None:
    ordered = [Action("walk", 3), Action("jump", 4), Action("stand", 2), Action("walk", 5)]
    truth = synthesize(ordered, fps=FPS, seed=1).truth
    activities, primitives = truth.activities, truth.primitives
    assert activities.label.tolist() == ["walk", "", "jump", "", "stand", "", "walk"]
    assert activities.kind.tolist() == ["activity", "transition"] * 3 + ["activity"]
    change = (activities.stop_s - activities.start_s)[1::2]
    assert ((change >= 0.5 - 1 / FPS) & (change <= 1 + 1 / FPS)).all()
    assert truth.repetitions() == {0: 8, 1: 4}
    assert set(primitives.label[primitives.cluster == 0]) == {"walk"}
    assert (primitives.label == "stand").sum() == 1


def test_a_left_kick_is_another_movement_but_a_left_walk_is_not() -> None:
    ordered = [Action("kick", 2), Action("walk", 2), Action("kick", 3, side="left")]
    assert synthesize([*ordered, Action("walk", 3, side="left")], fps=FPS).truth.repetitions() == {
        0: 2,
        1: 5,
        2: 3,
    }


@pytest.mark.parametrize("name", [*EXERCISES, "stand"])
def test_feet_stay_on_the_floor_and_do_not_slide(name: str) -> None:
    motion = alone(name).motion
    points = feet(motion)
    lowest = points[:, :, 1].min(axis=1)
    assert lowest.min() > -0.03
    if name not in ("jump", "run"):
        assert lowest.max() < 0.08
    speed = np.linalg.norm(np.gradient(points, axis=0), axis=2) * FPS
    flat = np.abs(np.diff(points[:, :, 1].reshape(-1, 2, 2), axis=2)) < 0.008
    bearing = np.repeat(flat[:, :, 0], 2, axis=1) & (points[:, :, 1] < 0.012)
    assert bearing.any(axis=1).mean() > 0.3
    assert np.quantile(speed[bearing], 0.5) < 0.25  # hips move at 3 m/s in running
    assert np.quantile(speed[bearing], 0.9) < 0.9


def test_jumps_and_running_leave_the_floor() -> None:
    assert (feet(alone("jump").motion)[:, :, 1].min(axis=1) > 0.15).any()
    heights = feet(alone("run").motion)[:, :, 1].min(axis=1)
    flights, _ = find_peaks(heights, height=0.02, distance=10)
    assert 8 <= len(flights) <= 11


@pytest.mark.parametrize(("name", "least", "most"), [("walk", 1.0, 1.7), ("run", 1.5, 3.2)])
def test_each_double_step_goes_ahead(name: str, least: float, most: float) -> None:
    motion = alone(name, 6).motion
    way = np.linalg.norm(np.diff(motion.positions[:, 0, [0, 2]], axis=0), axis=1).sum()
    assert least < way / 6 < most
    to_left = motion.positions[:, motion.joint("LeftUpLeg")] - motion.positions[:, 0]
    ahead = np.cross(to_left, [0.0, 1.0, 0.0])
    step = np.gradient(motion.positions[:, 0], axis=0)
    assert (np.sum(ahead * step, axis=1) > 0).all()


def test_nothing_jumps_between_actions() -> None:
    recording = synthesize([Action(name, 2) for name in ACTIONS], seed=5)
    speed = np.linalg.norm(np.diff(recording.motion.positions, axis=0), axis=2) * 120
    assert speed.max() < 14
    assert np.abs(np.diff(speed, axis=0)).max() * 120 < 900


def test_speed_amplitude_and_size_do_what_they_say() -> None:
    assert alone("jump", speed=2.0).motion.duration * 2 == pytest.approx(
        alone("jump").motion.duration, rel=0.01
    )
    deep, shallow = alone("squat"), alone("squat", amplitude=0.5)
    assert np.ptp(shallow.motion.positions[:, 0, 1]) < 0.7 * np.ptp(deep.motion.positions[:, 0, 1])
    child = synthesize([Action("stand", 1)], size=1.2, fps=FPS).motion
    assert child.positions[0, child.joint("Head_end"), 1] == pytest.approx(1.2, abs=0.04)


def test_left_is_right_in_a_mirror() -> None:
    right, left = alone("kick").motion, alone("kick", side="left").motion
    mirrored = pose_features(right).reshape(-1, 5, 3)[:, [1, 0, 2, 4, 3]] * [-1, 1, 1]
    # Sway differs; the kick does not.
    assert np.abs(mirrored - pose_features(left).reshape(-1, 5, 3)).max() < 0.25


def test_noise_moves_the_wrists_by_about_so_much() -> None:
    still = synthesize([Action("stand", 2)], seed=4).motion
    noisy = synthesize([Action("stand", 2)], seed=4, noise=0.01).motion
    moved = (noisy.positions - still.positions)[:, noisy.joint("LeftHand")]
    assert 0.005 < moved.std() < 0.03
    lengths = np.linalg.norm(
        noisy.positions[:, noisy.joint("LeftHand")]
        - noisy.positions[:, noisy.joint("LeftForeArm")],
        axis=1,
    )
    assert np.ptp(lengths) < 1e-9


def test_repetitions_vary_but_stay_alike() -> None:
    """Distances as in real recordings: tens of centimetres within, more between exercises."""
    recording = synthesize([Action("squat", 4), Action("kick", 4)], fps=30, seed=3)
    stacked = stack(pose_features(recording.motion), (-10, -5, 0, 5, 10))
    rows = recording.truth.primitives
    first, second, *_, last = rows.select(rows.kind == "primitive")
    own = cdist(stacked[first.start_frame : first.stop_frame], stacked)
    to_next = own[:, second.start_frame : second.stop_frame].min(axis=1)
    middle = slice(len(own) // 3, 2 * len(own) // 3)
    to_other = own[middle, last.start_frame : last.stop_frame].min(axis=1)
    assert 0.05 < np.median(to_next) < 0.5
    assert to_other.min() > 0.67


def test_the_seed_decides_everything() -> None:
    one, again, other = random_recording(7), random_recording(7), random_recording(8)
    np.testing.assert_array_equal(one.motion.positions, again.motion.positions)
    assert one.truth.table == again.truth.table
    assert one.motion.n_frames != other.motion.n_frames


@pytest.mark.parametrize("seed", range(8))
def test_random_recordings_hold_several_repeated_exercises(seed: int) -> None:
    truth = random_recording(seed, fps=30).truth
    rows = truth.primitives
    counts = [int(np.sum(rows.activity == i)) for i in range(0, len(truth.activities), 2)]
    assert len(counts) == 6
    assert all(3 <= count <= 8 for count in counts)
    labels = truth.activities.label[::2]
    assert (labels == "walk").sum() == 3
    assert all(a != b for a, b in pairwise(labels))


@pytest.mark.parametrize(
    "make",
    [
        lambda: synthesize([]),
        lambda: synthesize([Action("walk")], fps=0),
        lambda: synthesize([Action("walk")], size=-1),
        lambda: synthesize([Action("walk")], noise=float("nan")),
        lambda: synthesize([Action("walk", speed=50)], fps=30),
        lambda: random_recording(0, activities=15),
        lambda: Action("fly"),
        lambda: Action("walk", 0),
        lambda: Action("walk", speed=0),
        lambda: Action("walk", side="up"),
    ],
)
def test_what_makes_no_recording_is_refused(make: Callable[[], object]) -> None:
    with pytest.raises(ParameterError):
        make()


def test_it_is_small_and_reads_with_its_truth() -> None:
    assert bundled_recording().stat().st_size <= 1_000_000
    motion = kineme.read(bundled_recording())
    truth = kineme.read_segments(bundled_truth())
    assert (motion.n_frames, motion.fps) == (truth.n_frames, pytest.approx(truth.fps))
    assert 40 < motion.duration < 60
    activities = truth.activities.label[truth.activities.kind == "activity"]
    assert activities.tolist() == ["walk", "squat", "walk", "arm circles", "jump", "run", "kick"]


def test_making_it_again_gives_the_same(tmp_path: Path) -> None:
    make_bundled(tmp_path)
    for stored in (bundled_recording(), bundled_truth()):
        again = (tmp_path / stored.name).read_text(encoding="utf-8").splitlines()
        lines = stored.read_text(encoding="utf-8").splitlines()
        assert len(again) == len(lines)
        for new, old in zip(again, lines, strict=True):
            if new != old:  # the last decimal may differ between processors
                np.testing.assert_allclose(
                    np.array(new.split(), float), np.array(old.split(), float), atol=0.0101
                )
