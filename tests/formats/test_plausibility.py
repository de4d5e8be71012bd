"""Markers that jump or vanish, bodies of wrong size, and bodies that lie."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from keypoint_samples import write_trc
from marker_samples import PLUG_IN_GAIT, make_walk, to_c3d

import kineme
from kineme.errors import KinemeWarning
from kineme.formats import ReadOptions, read_quietly

FPS, FRAMES = 100.0, 400
NAMES = PLUG_IN_GAIT
TURNS = {"y": [0, 1, 2], "z": [2, 0, 1], "x": [1, 2, 0]}
"""For each axis that is up, the axes of y-up positions in its order."""


def make_walker(*, head: bool = True) -> np.ndarray:
    """Return markers of somebody who walks along z with swinging arms, metres with y up."""
    points = make_walk(FRAMES, FPS)
    return points if head else points[:, [i for i, n in enumerate(NAMES) if "HD" not in n]]


def write_csv(path: Path, points: np.ndarray, names: list[str], up: str = "") -> Path:
    head = ["time_s", *(f"{name}_{axis}" for name in names for axis in "xyz")]
    rows = np.column_stack([np.arange(len(points)) / FPS, points.reshape(len(points), -1)])
    np.savetxt(path, rows, "%.5f", delimiter=",", header=",".join(head), comments="")
    return path


def write_millimetres(path: Path, points: np.ndarray, names: list[str] = NAMES) -> Path:
    return write_trc(path, 1000 * points, names, fps=FPS)


def write_c3d(path: Path, points: np.ndarray, names: list[str], up: str = "") -> Path:
    y_screen = f"+{up.upper()}" if up else None
    path.write_bytes(to_c3d(1000 * points, names, rate=FPS, y_screen=y_screen))
    return path


WRITERS = {".c3d": write_c3d, ".trc": write_millimetres, ".csv": write_csv}


def measure_height(motion: Any, upper: str) -> float:
    """Return how far a joint is above the left ankle, the median over frames."""
    joint, ankle = motion.joint(upper), motion.joint("left_ankle")
    return float(np.median(motion.positions[:, joint, 1] - motion.positions[:, ankle, 1]))


@pytest.mark.parametrize("head", [True, False], ids=["head", "no head"])
@pytest.mark.parametrize("up", TURNS)
@pytest.mark.parametrize("suffix", WRITERS)
def test_the_up_axis_is_that_of_the_body(tmp_path: Path, suffix: str, up: str, head: bool) -> None:
    points = make_walker(head=head)
    names = NAMES if head else [name for name in NAMES if "HD" not in name]
    turned = points[:, :, TURNS[up]]
    motion = read_quietly(WRITERS[suffix](tmp_path / f"a{suffix}", turned, names))
    part, expected = ("head", 1.55) if head else ("pelvis", 0.9)
    assert measure_height(motion, part) == pytest.approx(expected, abs=0.02)


@pytest.mark.parametrize("stated", ["x", "y", "z"])
def test_a_c3d_that_names_another_up_axis_is_warned_of(tmp_path: Path, stated: str) -> None:
    path = write_c3d(tmp_path / "a.c3d", make_walker()[:, :, TURNS["z"]], NAMES, up=stated)
    motion = read_quietly(path)
    assert measure_height(motion, "head") == pytest.approx(1.55, abs=0.02)
    assert [f"the file names {stated}" in each for each in motion.provenance.warnings] == (
        [] if stated == "z" else [True]
    )
    kept = read_quietly(path, ReadOptions(up="x"))
    assert measure_height(kept, "head") == pytest.approx(0, abs=0.2)
    assert not any("lies" in each for each in kept.provenance.warnings)


@pytest.mark.parametrize("marker", ["LASI", "LWRA"])
def test_a_marker_that_jumps_and_comes_back_is_not_seen_there(tmp_path: Path, marker: str) -> None:
    points = make_walker()
    sound = read_quietly(write_millimetres(tmp_path / "sound.trc", points))
    assert sound.provenance.warnings == ()
    points[200:206, NAMES.index(marker)] += (0.2, 0.55, 0.1)  # 58 m/s
    with pytest.warns(
        KinemeWarning, match=rf"jump away and back.*: {marker} \(frames 200 to 205\)"
    ):
        motion = kineme.read(write_millimetres(tmp_path / "a.trc", points))
    assert np.abs(motion.positions - sound.positions).max() < 0.005


def test_a_jump_without_return_is_warned_of_and_kept(tmp_path: Path) -> None:
    points = make_walker()
    points[200:, NAMES.index("LWRA"), 1] += 0.6
    motion = read_quietly(write_millimetres(tmp_path / "a.trc", points))
    assert motion.provenance.warnings == ("points that jump: LWRA (first in frame 200)",)
    assert motion.gaps == ()


def test_a_moved_origin_is_no_jump_of_each_marker(tmp_path: Path) -> None:
    points = make_walker()
    points[200:] += (1.0, 0, 2.0)
    motion = read_quietly(write_millimetres(tmp_path / "a.trc", points))
    assert motion.provenance.warnings == ()


def test_markers_at_the_origin_are_not_seen_there(tmp_path: Path) -> None:
    points = make_walker()
    sound = read_quietly(write_millimetres(tmp_path / "sound.trc", points))
    points[100:110, NAMES.index("LWRA")] = 0
    motion = read_quietly(write_millimetres(tmp_path / "a.trc", points))
    assert list(motion.provenance.warnings) == [
        "points exactly at the origin in some frames, read as missing there: LWRA"
    ]
    assert np.abs(motion.positions - sound.positions).max() < 0.005


def test_frames_of_zeros_are_a_gap(tmp_path: Path) -> None:
    points = make_walker()
    points[100:160] = 0
    motion = read_quietly(write_millimetres(tmp_path / "a.trc", points))
    assert motion.gaps == ((100, 160),)
    assert any("60 frames with zeros only" in each for each in motion.provenance.warnings)


def test_a_point_that_never_leaves_the_origin_stays(tmp_path: Path) -> None:
    points = make_walker()
    points -= points[:, :1]
    motion = read_quietly(write_csv(tmp_path / "a.csv", points, NAMES))
    assert not motion.provenance.warnings
    assert "LASI" in motion.skeleton.names


def test_markers_of_one_bone_that_are_exchanged_are_warned_of(tmp_path: Path) -> None:
    points = make_walker()
    left, right = NAMES.index("LASI"), NAMES.index("RPSI")
    points[150:250, [left, right]] = points[150:250, [right, left]]
    motion = read_quietly(write_millimetres(tmp_path / "a.trc", points))
    (warning,) = (each for each in motion.provenance.warnings if "bone" in each)
    assert warning.startswith("points on the same bone change their distance: LASI and LPSI")


def test_a_body_of_a_kilometre_is_of_another_unit(tmp_path: Path) -> None:
    path = write_trc(tmp_path / "a.trc", 1000 * make_walker(), NAMES, "m", FPS)
    with pytest.warns(
        KinemeWarning, match=r"unit m, the points spread over 1550 m: mm assumed \(1\.55 m\)"
    ):
        motion = kineme.read(path)
    assert measure_height(motion, "head") == pytest.approx(1.55, abs=0.02)
    assert measure_height(kineme.read(path, unit="m"), "head") == pytest.approx(1550, abs=20)
    assert measure_height(kineme.read(path, unit="mm"), "head") == pytest.approx(1.55, abs=0.02)


def test_a_body_that_lies_is_warned_of(tmp_path: Path) -> None:
    motion = read_quietly(write_millimetres(tmp_path / "a.trc", make_walker()))
    lying = motion.positions[:, :, [1, 2, 0]]
    path = tmp_path / "a.npz"
    np.savez(
        path,
        positions=lying,
        names=np.array(motion.skeleton.names),
        parents=np.array(motion.skeleton.parents),
        fps=FPS,
    )
    with pytest.warns(KinemeWarning, match="the body lies along x most of the time"):
        kineme.read(path, unit="m", up=None)


@pytest.mark.parametrize("cells", ["", "5"], ids=["empty", "standing still"])
def test_of_two_clocks_the_one_that_runs_is_taken(tmp_path: Path, cells: str) -> None:
    rows = (f"{cells},{i / 50:.3f},{np.sin(i / 9):.4f}" for i in range(200))
    path = tmp_path / "a.csv"
    path.write_text("\n".join(["timestamp,time_s,acc_x", *rows]))
    with pytest.warns(KinemeWarning, match="timestamp does not advance: time_s used"):
        signals = kineme.read(path)
    assert (signals.fps, signals.names) == (50, ("acc_x",))


@pytest.mark.parametrize(("empty", "warned"), [(2, False), (4, True)])
def test_most_bones_of_no_length_are_a_warning(tmp_path: Path, empty: int, warned: bool) -> None:
    offsets = np.array([[0.0, 0.9, 0.0], *([[0.0, 0.4, 0.0]] * 6)])
    offsets[1 : 1 + empty] = 0.0
    skeleton = kineme.Skeleton(tuple("abcdefg"), (-1, *range(6)), offsets)
    turns = np.tile([1.0, 0.0, 0.0, 0.0], (9, 7, 1))
    motion = kineme.Motion.from_rotations(skeleton, turns, FPS, np.zeros((9, 3)))
    kineme.write(motion, tmp_path / "a.glb")
    said = [str(each) for each in read_quietly(tmp_path / "a.glb").provenance.warnings]
    assert any("4 of 6 bones have no length" in each for each in said) == warned
