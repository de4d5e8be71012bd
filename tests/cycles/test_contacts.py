"""Feet come down and leave the ground when they do, whatever saw it."""

from __future__ import annotations

import warnings
from collections import defaultdict
from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from posed_figures import find_recording

import kineme
from kineme._util import rotations as rot
from kineme.cycles import (
    foot_events,
    gait,
    stands_from_force,
    stands_from_positions,
    swings_from_gyroscope,
)
from kineme.datasets import Action, synthesize
from kineme.errors import KinemeWarning, ParameterError
from kineme.recordings import Motion, Signals, Skeleton
from rows import pick_row

FPS = 100.0


def make_turns(seconds: float, *turns: tuple[float, float, float]) -> np.ndarray:
    """How a foot turns about one axis: when, how fast and for how long."""
    t = np.arange(0, seconds, 1 / FPS)
    rate = sum(high * np.exp(-((t - when) ** 2) / 2 / wide**2) for when, high, wide in turns)
    return np.column_stack([0 * t, rate, 0 * t])


def make_steps(n: int = 6, period: float = 1.1) -> np.ndarray:
    """How a foot turns over so many steps."""
    step = (-0.25, 8.0, 0.05), (0.0, -5.5, 0.09), (0.2, 4.5, 0.03)
    turns = [(1 + k * period + when, *turn) for k in range(n) for when, *turn in step]
    return make_turns(1 + n * period, *turns)


@given(st.floats(0.01, 100), st.tuples(*[st.floats(-3, 3)] * 3))
def test_neither_the_unit_nor_the_direction_of_a_sensor_matters(unit: float, turn) -> None:
    rates = make_steps()
    before = swings_from_gyroscope(rates, FPS)
    turned = unit * rot.rotate(rot.from_euler(np.array([turn]), "xyz"), rates)
    np.testing.assert_allclose(swings_from_gyroscope(turned, FPS), before, atol=1e-6)
    assert len(before) == 6


def test_a_swing_is_between_the_turns_of_the_foot() -> None:
    offs, ons = swings_from_gyroscope(make_steps(), FPS).T
    np.testing.assert_allclose(np.diff(offs), 1.1, atol=0.01)
    assert ((offs > 1 - 0.25 + np.arange(6) * 1.1) & (offs < 1 + np.arange(6) * 1.1)).all()
    assert ((ons > 1 + np.arange(6) * 1.1) & (ons < 1.2 + np.arange(6) * 1.1)).all()


def test_a_foot_that_is_slow_between_heel_and_swing_takes_one_step() -> None:
    rates = make_steps()
    slow = make_turns(3, (1.0, 3.0, 0.06), (1.5, -3.0, 0.09), (1.72, 3.0, 0.03))
    found = swings_from_gyroscope(np.concatenate([rates, slow]), FPS)
    assert len(found) == 7
    start = len(rates) / FPS
    assert start + 1.0 < found[-1, 0] < start + 1.2 < start + 1.5 < found[-1, 1] < start + 1.8


def test_a_sensor_that_lies_still_has_no_swings() -> None:
    assert swings_from_gyroscope(np.zeros((500, 3)), FPS).shape == (0, 2)
    with pytest.raises(ParameterError, match="frames x 3"):
        swings_from_gyroscope(np.zeros(500), FPS)


def test_a_foot_stands_while_heel_or_toe_does() -> None:
    up, down = [0.2] * 30, [0.0] * 30
    heel, toe = np.array(down + up + up + down), np.array(down + down + up + up)
    paths = [np.column_stack([0 * y, y, 0 * y]) for y in (heel, toe)]
    stands = stands_from_positions(paths, 60.0)
    np.testing.assert_allclose(stands, [[0.0, 1.0], [1.5, 2.0]], atol=0.04)
    with pytest.raises(ParameterError, match="at least one point"):
        stands_from_positions([], 60.0)


def test_a_plate_bears_who_stands_on_it_and_need_not_tell_zero() -> None:
    force = np.r_[np.zeros(200), -700 * np.ones(600), np.zeros(200)]
    for offset in (-30.0, 0.0, 25.0):
        assert stands_from_force(force + offset, 1000.0).tolist() == [[0.2, 0.8]]
    assert len(stands_from_force(force, 1000.0, least=800)) == 0
    assert stands_from_force(700 + np.zeros(500), 1000.0).tolist() == [[0.0, 0.5]]
    assert len(stands_from_force(np.zeros(500), 1000.0)) == 0


def test_contacts_of_a_plate_are_those_that_its_file_marks(data_dir: Path) -> None:
    path = data_dir / "formats" / "Dec_real.c3d"
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", KinemeWarning)  # markers that are not seen all the time
        marked = {name: at for at, name in kineme.read(path).provenance.events}
    found = foot_events(kineme.read(path, columns=["*"]), left="FZ1", right="FZ2")
    for name, mark in (("left foot strike", "LHS"), ("left foot off", "LTO"),
                       ("right foot strike", "RHS"), ("right foot off", "RTO")):  # fmt: skip
        assert found.at(name) == pytest.approx([marked[mark]], abs=0.04)


@pytest.fixture(scope="module")
def walk() -> Motion:
    return synthesize([Action("walk", 8)], fps=100, seed=1).motion


def test_a_walk_has_steps_of_both_feet_in_turn(walk: Motion) -> None:
    events = foot_events(walk)
    left, right = events.at("left foot strike"), events.at("right_foot_contact")
    assert 7 <= len(left) <= 8
    assert 7 <= len(right) <= 8
    both = sorted([(at, 0) for at in left] + [(at, 1) for at in right])
    assert all(a[1] != b[1] for a, b in pairwise(both))
    table = gait(events, walk)
    values = {name: pick_row(table, measure=name)["left_mean"] for name in table["measure"]}
    assert values["stride_s"] == pytest.approx(1.1, abs=0.03)
    assert values["stance_s"] + values["swing_s"] == pytest.approx(values["stride_s"])
    assert values["cadence_per_min"] == pytest.approx(120 / 1.1, rel=0.03)
    assert values["step_s"] == pytest.approx(0.55, abs=0.04)
    assert 0.5 < values["stride_m"] < 2.5
    assert abs(table["asymmetry_percent"][0]) < 5


def put_on_a_belt(walk: Motion, speed: float) -> Motion:
    """The same walk seen from a room in which the ground moves back at the walker's speed."""
    seconds = np.arange(walk.n_frames)[:, None, None] / walk.fps
    forward = walk.positions[-1, 0] - walk.positions[0, 0]
    forward = forward * [1, 0, 1] / np.linalg.norm(forward * [1, 0, 1])
    return replace(walk, positions=walk.positions - seconds * speed * forward, rotations=None)


def test_a_walk_on_a_treadmill_has_the_contacts_of_the_same_walk_overground(walk: Motion) -> None:
    travel = (walk.positions[-1, 0] - walk.positions[0, 0]) * [1, 0, 1]
    belt = put_on_a_belt(walk, float(np.linalg.norm(travel)) / walk.duration)
    overground, carried = foot_events(walk), foot_events(belt)
    for name in {*overground.names.tolist()}:
        np.testing.assert_allclose(carried.at(name), overground.at(name), atol=0.03)
    lengths = [
        pick_row(gait(*each), measure="stride_m")["left_mean"]
        for each in ((overground, walk), (carried, belt))
    ]
    # The feet of the figure slide back by 0.06 m/s while they stand.
    assert lengths[1] == pytest.approx(lengths[0], rel=0.07)


@pytest.mark.parametrize("slope", [-0.1, 0.05, 0.15])
def test_a_walk_on_a_ramp_has_the_contacts_of_the_same_walk_on_level_ground(
    walk: Motion, slope: float
) -> None:
    ahead = (walk.positions[-1, 0] - walk.positions[0, 0]) * [1, 0, 1]
    rise = slope * (walk.positions @ ahead) / np.linalg.norm(ahead)
    ramp = walk.positions + rise[..., None] * [0, 1, 0]
    level, found = foot_events(walk), foot_events(replace(walk, positions=ramp, rotations=None))
    # The first foot is just coming down when the recording begins.
    level_times, times = (each.times[each.times > 0.1] for each in (level, found))
    np.testing.assert_allclose(times, level_times, atol=0.07)


def test_contacts_on_a_treadmill_are_those_that_its_file_marks(data_dir: Path) -> None:
    motion = kineme.read(find_recording(data_dir, "gait/treadmill/treadmill_events.c3d"))
    events = foot_events(replace(motion, provenance=motion.provenance.marked(())))
    near = [np.abs(events.at(name) - at).min() <= 0.05 for at, name in motion.provenance.events]
    assert len(near) == 43
    assert sum(near) >= 41
    assert len(events) <= 45
    speed = pick_row(gait(events, motion), measure="speed_m_per_s")
    for side in ("left", "right"):  # heel and toe of a flat foot move at 1.093 to 1.1 m/s
        assert speed[f"{side}_mean"] == pytest.approx(1.095, abs=0.01)


def test_contacts_of_markers_are_near_those_of_plates(data_dir: Path) -> None:
    apart = []
    for name in ("HC030A05", "HC032A03", "HC038A11"):
        path = find_recording(data_dir, f"gait/overground/{name}.c3d")
        plates = foot_events(kineme.read(path, columns=["Fz*"]), left="Fz1", right="Fz2")
        motion = kineme.read(path)
        found = foot_events(replace(motion, provenance=motion.provenance.marked(())))
        apart += [np.abs(found.at(event) - at).min()
                  for at, event in zip(plates.times, plates.names, strict=True)]  # fmt: skip
    assert len(apart) == 12
    assert max(apart) < 0.05


def pick_markers(walk: Motion, **joints: str) -> Motion:
    """Return joints of a walk as markers with these names."""
    chosen = [walk.skeleton.joint(joint) for joint in joints.values()]
    offsets = np.zeros((len(joints), 3))
    skeleton = Skeleton(tuple(joints), [-1] * len(joints), offsets)
    return Motion(skeleton, walk.positions[:, chosen], walk.fps)


def test_both_feet_are_found_from_the_same_markers_and_a_missing_one_is_warned_of(
    walk: Motion,
) -> None:
    ankles = {"LANK": "LeftFoot", "RANK": "RightFoot"}
    heels, toes = {"LCAL": "LeftFoot", "RCAL": "RightFoot"}, {"LHLX": "LeftToeBase"}
    both = toes | {"RHLX": "RightToeBase"}
    with warnings.catch_warnings():
        warnings.simplefilter("error", KinemeWarning)
        events = foot_events(pick_markers(walk, **ankles, **heels, **both))
    assert events.sources == {"left": "LCAL and LHLX", "right": "RCAL and RHLX"}
    with pytest.warns(KinemeWarning, match="right toe not found: .* RHEE, RTOE"):
        events = foot_events(pick_markers(walk, **ankles, **heels, **toes))
    assert events.sources == {"left": "LCAL", "right": "RCAL"}
    unknown = {"LTalon": "LeftFoot", "RTalon": "RightFoot"}
    with pytest.raises(ParameterError, match="no foot found: no heel or ankle .* RHEE, RTOE"):
        foot_events(pick_markers(walk, **unknown))


def test_marks_of_people_replace_contacts_that_are_found(walk: Motion) -> None:
    found = foot_events(walk)
    first, second, *_ = found.at("left foot strike").tolist()
    marks = [(first + 0.05, "Left Foot Strike"), (second - 0.45, "Left Foot Strike")]
    events = foot_events(replace(walk, provenance=walk.provenance.marked(marks)))
    strikes = events.at("left foot strike").tolist()
    assert strikes[:3] == pytest.approx([first + 0.05, second - 0.45, second])
    assert len(events) == len(found) + 1
    assert events.sources["left"].endswith("2 of them marked in the file")


def test_a_gait_that_nobody_has_is_warned_of(walk: Motion) -> None:
    events = foot_events(walk)
    with warnings.catch_warnings():
        warnings.simplefilter("error", KinemeWarning)
        gait(events)
    missed = events.names == "left foot off"
    times = events.times - np.where(missed, 0.6, 0)  # a stance of 10 %
    with pytest.warns(KinemeWarning, match="left foot is on the ground for .* Check"):
        gait(replace(events, times=times))


def test_events_become_labels(walk: Motion, tmp_path: Path) -> None:
    events = foot_events(walk)
    spans = events.segmentation("left foot strike")
    assert spans.n_frames == walk.n_frames
    named = spans.activities.select(spans.activities.label == "left foot strike")
    strikes = np.rint(100 * events.at("left foot strike")).tolist()
    assert named.start_frame.tolist() == strikes[:-1]
    assert named.stop_frame.tolist() == strikes[1:]
    kineme.write_segments(events.segmentation(), tmp_path / "e.TextGrid")
    labels = kineme.read_segments(tmp_path / "e.TextGrid", fps=100).activities.label
    assert {*labels.tolist()} >= {"left foot strike", "right foot off"}
    with pytest.raises(ParameterError, match="no event hop; there are: left foot off, left"):
        events.segmentation("hop")


NAMES = {
    "set of feet": "lf_gyr_{a}",
    "sensor last": "gyro_lf_{a}",
    "in words": "LeftFootGyro{A}",
    "shank": "gyro_ls_{a}",
    "ankle": "left_ankle_gyr_{a}",
    "unit": "Left Foot Gyroscope {A} (deg/s)",
}


@pytest.mark.parametrize("pattern", NAMES.values(), ids=NAMES)
def test_sensors_at_feet_are_found_by_their_names(pattern: str) -> None:
    names = [pattern.format(a=a, A=a.upper()) for a in "xyz"]
    signals = Signals(
        np.hstack([make_steps(), make_steps() * 0]), FPS, [*names, "acc_x", "acc_y", "acc_z"]
    )
    events = foot_events(signals)
    assert len(events.at("left foot strike")) == 6
    assert [*events.sources] == ["left"]
    only = gait(events)
    assert np.isnan(only["right_mean"]).all()


def test_channels_of_a_foot_may_be_named() -> None:
    signals = Signals(make_steps(), FPS, ["a1", "a2", "a3"])
    with pytest.raises(ParameterError, match="no foot found"):
        foot_events(signals)
    with pytest.raises(ParameterError, match="names 2 channels"):
        foot_events(Signals(np.zeros((9, 2)), FPS, ["b1", "b2"]), left="b*")
    assert len(foot_events(signals, right="a*").at("right foot off")) == 6
    force = Signals(np.r_[np.zeros(50), 700 * np.ones(60), np.zeros(50)], FPS, ["Fz1"])
    assert foot_events(force, left="Fz1").at("left foot strike").tolist() == [0.5]


def test_gaps_hold_no_steps() -> None:
    signals = Signals(make_steps(), FPS, ["lf_gyr_x", "lf_gyr_y", "lf_gyr_z"], gaps=[(300, 500)])
    times = foot_events(signals).at("left foot strike")
    assert 0 < len(times) < 6
    assert not ((times > 3) & (times < 5)).any()


def test_contacts_checked_by_people_are_found(data_dir: Path) -> None:
    """One recording of people who walk with sensors at their feet; all of them: a benchmark."""
    folder = find_recording(data_dir, "sets/ipolgait")
    true = defaultdict(list)
    for line in (folder / "events.csv").read_text().splitlines()[1:]:
        recording, foot, _, on = line.split(",")
        if recording == "1-4":
            true[foot].append(float(on))
    events = foot_events(kineme.read(folder / "recordings" / "1-4.parquet"))
    for foot, times in true.items():
        found = events.at(f"{foot} foot strike")
        near = [np.abs(found - at).min() < 0.05 for at in times]
        assert np.mean(near) > 0.85
        assert abs(len(found) - len(times)) <= 1


def test_marks_outside_a_cropped_recording_are_left_out(walk: Motion) -> None:
    plain = foot_events(walk)
    mark = float(plain.at("left foot strike")[0])
    events = [(at, "Left Foot Strike") for at in (-0.5, mark, mark, 1000.0)]
    marked = replace(walk, provenance=walk.provenance.marked(events))
    assert foot_events(marked).at("left foot strike").tolist() == (
        plain.at("left foot strike").tolist()
    )
