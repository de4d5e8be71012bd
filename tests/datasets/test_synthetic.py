"""Synthetic recordings: what was ordered is what a person would count and see."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from scipy.signal import find_peaks

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
from kineme.recordings import Motion
from make_bundled import make_bundled

FPS = 60.0
EXERCISES = [name for name in ACTIONS if name != "stand"]


def synthesize_alone(name: str, repetitions: int = 5, **how: float | str) -> SyntheticRecording:
    return synthesize([Action(name, repetitions, **how)], fps=FPS, seed=2)  # type: ignore[arg-type]


def measure_wrist_height(motion: Motion) -> np.ndarray:
    return motion.positions[:, motion.joint("RightHand"), 1]


def measure_reach(motion: Motion, joint: str) -> np.ndarray:
    hips = motion.positions[:, 0, [0, 2]]
    return np.linalg.norm(motion.positions[:, motion.joint(joint)][:, [0, 2]] - hips, axis=1)


def measure_ankle_height(motion: Motion) -> np.ndarray:
    return motion.positions[:, motion.joint("LeftFoot"), 1]


# What a person would look at to count each exercise, and how far it must move, in metres.
COUNTED: dict[str, tuple[Callable[[Motion], np.ndarray], float]] = {
    "walk": (measure_ankle_height, 0.1),
    "run": (measure_ankle_height, 0.2),
    "jump": (lambda motion: motion.positions[:, 0, 1], 0.3),
    "squat": (lambda motion: -motion.positions[:, 0, 1], 0.3),
    "kick": (lambda motion: measure_reach(motion, "RightFoot"), 0.4),
    "arm circles": (measure_wrist_height, 0.6),
    "punch": (lambda motion: measure_reach(motion, "RightHand"), 0.2),
    "wave": (measure_wrist_height, 0.3),
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


def test_speed_amplitude_and_size_do_what_they_say() -> None:
    assert synthesize_alone("jump", speed=2.0).motion.duration * 2 == pytest.approx(
        synthesize_alone("jump").motion.duration, rel=0.01
    )
    deep, shallow = synthesize_alone("squat"), synthesize_alone("squat", amplitude=0.5)
    assert np.ptp(shallow.motion.positions[:, 0, 1]) < 0.7 * np.ptp(deep.motion.positions[:, 0, 1])
    child = synthesize([Action("stand", 1)], size=1.2, fps=FPS).motion
    assert child.positions[0, child.joint("Head_end"), 1] == pytest.approx(1.2, abs=0.04)


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


def test_the_seed_decides_everything() -> None:
    one, again, other = random_recording(7), random_recording(7), random_recording(8)
    np.testing.assert_array_equal(one.motion.positions, again.motion.positions)
    assert one.truth.table == again.truth.table
    assert one.motion.n_frames != other.motion.n_frames


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
