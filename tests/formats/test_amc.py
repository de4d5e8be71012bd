from __future__ import annotations

import importlib
import os
import sys
from pathlib import Path

import numpy as np
import pytest
from format_samples import AMC, ASF

import naive
from kineme.errors import KinemeWarning, ReadError
from kineme.formats import read, read_quietly, write
from kineme.recordings import Motion, Skeleton

CMU_UNIT = 0.0254 / 0.45


def write_pair(
    folder: Path, *, asf: str = ASF, amc: str = AMC, asf_name: str = "figure.asf"
) -> Path:
    path = folder / "figure_01.amc"
    (folder / asf_name).write_bytes(asf.encode())
    path.write_bytes(amc.encode())
    return path


def assert_same(one: Motion, other: Motion) -> None:
    assert one.skeleton.names == other.skeleton.names
    np.testing.assert_allclose(one.positions, other.positions, atol=1e-12)


def test_bones_become_joints_at_their_start(tmp_path: Path) -> None:
    motion = read(write_pair(tmp_path))
    assert motion.skeleton.names == ("root", "hip", "leg", "foot", "foot_end", "back", "back_end")
    assert motion.skeleton.end_sites == {4, 6}
    assert motion.fps == 120
    assert motion.positions[0, 0] == pytest.approx(np.array([1, 17, 2]) * CMU_UNIT)
    assert np.linalg.norm(motion.skeleton.offsets[motion.joint("foot")]) == pytest.approx(
        8 * CMU_UNIT
    )
    assert any("120 Hz assumed" in note for note in motion.provenance.notes)
    assert motion.provenance.sha256 is not None


@pytest.mark.parametrize(
    "recording", ["cmu86/86_10", "cmu_formats/49_02", "hdm05/amc/HDM_bk_squat1Reps_014_120"]
)
def test_equals_the_naive_implementation(data_dir: Path, recording: str) -> None:
    motion = read(data_dir / f"{recording}.amc")
    asf = Path(motion.provenance.notes[0].removeprefix("skeleton from "))
    frames = range(0, motion.n_frames, max(1, motion.n_frames // 40))
    text = (data_dir / f"{recording}.amc").read_text(encoding="latin-1")
    for frame, bones in zip(
        frames, naive.compute_amc_positions(asf.read_text(), text, frames), strict=True
    ):
        for name, (start, tip) in bones.items():
            assert motion.positions[frame, motion.joint(name)] == pytest.approx(start, abs=1e-9)
            if f"{name}_end" in motion.skeleton.names:
                end = motion.positions[frame, motion.joint(f"{name}_end")]
                assert end == pytest.approx(tip, abs=1e-9)


def test_values_may_come_in_any_order_and_layout(tmp_path: Path) -> None:
    plain = read(write_pair(tmp_path))
    swapped = AMC.replace("back 5.5 6 7\nleg 10 11.5 12", "leg 10 11.5 12\n# why not\nback 5.5 6 7")
    assert_same(read(write_pair(tmp_path, amc=swapped)), plain)
    assert_same(read(write_pair(tmp_path, amc=AMC.replace("\n", "\r\n"))), plain)
    asf = ASF.replace("\n", "\r\n").replace("dof rx ry rz", "dof rx ry rz # all")
    assert_same(read(write_pair(tmp_path, asf=asf)), plain)
    with_hip = AMC.replace("back", "hip\nback")
    assert_same(read(write_pair(tmp_path, amc=with_hip)), plain)


@pytest.mark.parametrize("encoding", ["utf-8", "cp1252"])
def test_names_with_umlauts(tmp_path: Path, encoding: str) -> None:
    (tmp_path / "a.asf").write_bytes(ASF.replace("foot", "Fuß").encode(encoding))
    (tmp_path / "a.amc").write_bytes(AMC.replace("foot", "Fuß").encode(encoding))
    motion = read(tmp_path / "a.amc")
    assert motion.skeleton.names[3:5] == ("Fuß", "Fuß_end")
    np.testing.assert_array_equal(motion.positions, read(write_pair(tmp_path)).positions)


@pytest.mark.parametrize(
    "line",
    [
        "back -0 +.5 12.",
        "back 9007199254740993 1e-3 0.12345678901234567890123",
        "# a comment\nback\t5.5  6 7 \r",
        "back 5.5 6 7\n\n3",
        "back 5.5-6 7",
        "back 5.5 . 7",
        "back5.5 6 7",
        "back 5.5 6\n7",
        "back 5.5 6 7 3",
        "back 5.5 6 7\ntail 3",
    ],
)
def test_compiled_reading_says_the_same(tmp_path: Path, monkeypatch, line: str) -> None:
    more = "".join(f"{i}\nroot {i} 2 3 4 5 6\nback 1 2 3\nleg 1 2 3\nfoot 1 {i}\n" for i in (4, 5))
    path = write_pair(tmp_path, amc=AMC.replace("back 5.5 6 7", line) + more)

    def read_or_refuse() -> tuple[object, ...]:
        try:
            motion = read_quietly(path)
        except ReadError as error:
            return (str(error),)
        return motion.positions.tobytes(), motion.rotations.tobytes(), motion.provenance.notes

    importlib.import_module("kineme.formats.skeletons._amc_kernels")  # loads numba
    compiled = read_or_refuse()
    monkeypatch.delitem(sys.modules, "numba")
    assert compiled == read_or_refuse()


def test_order_of_root_channels(tmp_path: Path) -> None:
    asf = ASF.replace("order TX TY TZ RX RY RZ", "order RX RY RZ TZ TY TX")
    amc = AMC
    for old, new in [
        ("1 17 2 10 20 30", "10 20 30 2 17 1"),
        ("1.5 17 2.5 11 21 31", "11 21 31 2.5 17 1.5"),
        ("2 17 3 12 22 32", "12 22 32 3 17 2"),
    ]:
        amc = amc.replace(old, new)
    turned = read(write_pair(tmp_path, asf=asf, amc=amc))
    assert_same(turned, read(write_pair(tmp_path)))


def test_radians_in_either_file(tmp_path: Path) -> None:
    plain = read(write_pair(tmp_path))

    def in_radians(line: str) -> str:
        name, *values = line.split()
        if name.isalpha() and values:
            keep = 3 if name == "root" else 0
            turned = [repr(float(np.radians(float(v)))) for v in values[keep:]]
            return " ".join([name, *values[:keep], *turned])
        return line

    amc = "\n".join(map(in_radians, AMC.splitlines()[1:])) + "\n"
    assert_same(read(write_pair(tmp_path, amc=amc.replace(":DEGREES", ":RADIANS"))), plain)
    asf = ASF.replace("angle deg", "angle rad").replace(
        "axis 0 0 20 XYZ", f"axis 0 0 {np.radians(20)} XYZ"
    )
    asf = asf.replace("-90 0 20 XYZ", f"{np.radians(-90)} 0 {np.radians(20)} XYZ")
    assert_same(read(write_pair(tmp_path, asf=asf, amc=amc.replace(":DEGREES\n", ""))), plain)


def test_any_axis_and_dof_order(tmp_path: Path) -> None:
    """Rotations are about fixed axes, the first named first."""
    from scipy.spatial.transform import Rotation

    asf = ASF.replace("axis 0 0 20 XYZ\n    dof rx ry rz", "axis 30 40 50 YZX\n    dof rz rx ry")
    motion = read(write_pair(tmp_path, asf=asf))
    frame = Rotation.from_euler("yzx", [40, 50, 30], degrees=True)
    own = Rotation.from_euler("zxy", [10, 11, 12], degrees=True)
    assert motion.rotations is not None
    found = Rotation.from_quat(motion.rotations[0, motion.joint("leg")], scalar_first=True)
    assert (found.inv() * frame * own * frame.inv()).magnitude() < 1e-12


def test_length_unit(tmp_path: Path) -> None:
    plain = read(write_pair(tmp_path))
    inches = read(write_pair(tmp_path, asf=ASF.replace("length 0.45", "length 1.0")))
    np.testing.assert_allclose(inches.positions, 0.45 * plain.positions, atol=1e-12)
    given = read(write_pair(tmp_path), unit="m")
    np.testing.assert_allclose(given.positions * CMU_UNIT, plain.positions, atol=1e-12)


@pytest.mark.parametrize("up", ["y", "z"])
def test_a_motion_is_written_for_the_asf_it_came_from(tmp_path: Path, up: str) -> None:
    asf = ASF.replace("axis 0 0 20 XYZ\n    dof rx ry rz", "axis 30 40 50 YZX\n    dof rz rx ry")
    asf = asf.replace(
        "position 0 0 0\n  orientation 0 0 0", "position 1 2 3\n  orientation 10 20 30"
    )
    path = write_pair(tmp_path, asf=asf)
    write(read(path, up=up, unit="inch"), tmp_path / "again.amc")
    assert (tmp_path / "again.asf").read_text() == asf

    def parse(path: Path) -> list[tuple[str, list[float]]]:
        lines = [line.split() for line in path.read_text().splitlines() if line[0] not in "#:"]
        return sorted((name, list(map(float, values))) for name, *values in lines)

    for (name, found), (same, expected) in zip(
        parse(tmp_path / "again.amc"), parse(path), strict=True
    ):
        assert name == same
        assert found == pytest.approx(expected, abs=1e-8)


def test_a_motion_that_its_asf_cannot_hold_gets_a_new_one(tmp_path: Path) -> None:
    motion = read(write_pair(tmp_path))
    assert motion.rotations is not None
    rotations = motion.rotations.copy()
    rotations[:, motion.joint("foot")] = [0.8, 0.6, 0, 0]  # turns its two axes and the third
    changed = Motion.from_rotations(motion.skeleton, rotations, motion.fps, motion.positions[:, 0])
    with pytest.warns(KinemeWarning, match="new ASF"):
        write(changed, tmp_path / "again.amc")
    again = read(tmp_path / "again.amc")
    here, there = (
        [each.joint(name) for name in ("leg", "foot", "foot_end")] for each in (motion, again)
    )
    np.testing.assert_allclose(again.positions[:, there], changed.positions[:, here], atol=1e-9)


def test_bones_without_length_have_a_direction(tmp_path: Path) -> None:
    """Other programs normalise it."""
    skeleton = Skeleton(("a", "b"), (-1, 0), np.array([[0.0, 0, 0], [0, 0, 0]]))
    write(Motion.from_rotations(skeleton, [[[1, 0, 0, 0]] * 2], 30), tmp_path / "a.amc")
    assert "direction 0.000000000000 1.0" in (tmp_path / "a.asf").read_text()


@pytest.mark.parametrize(
    ("lost", "why"),
    [
        (len("foot 3 5\n"), "has no values for foot"),
        (len(" 5\n"), "has 1 values"),
        (len("ot 3 5\n"), "'fo' is not in"),
    ],
)
def test_a_truncated_last_frame_is_left_out_with_a_warning(
    tmp_path: Path, lost: int, why: str
) -> None:
    whole = read(write_pair(tmp_path))
    with pytest.warns(KinemeWarning, match=f"{why}.*last frame is truncated") as caught:
        motion = read(write_pair(tmp_path, amc=AMC[:-lost]))
    assert caught[0].filename == __file__
    np.testing.assert_array_equal(motion.positions, whole.positions[:2])


def test_frames_that_jump_and_bones_without_values_are_told(tmp_path: Path) -> None:
    with pytest.warns(KinemeWarning, match="line 14: frame 7 follows 2"):
        read(write_pair(tmp_path, amc=AMC.replace("\n3\n", "\n7\n")))
    amc = "\n".join(line for line in AMC.splitlines() if not line.startswith("foot"))
    with pytest.warns(KinemeWarning, match="no values for foot"):
        read(write_pair(tmp_path, amc=amc))


def test_the_skeleton_is_found(data_dir: Path, tmp_path: Path) -> None:
    for recording, asf in [
        ("cmu_formats/49_02.amc", "cmu_formats/49.asf"),
        ("hdm05/amc/HDM_dg_squat1Reps_025_120.amc", "hdm05/asf/HDM_dg.asf"),
    ]:
        notes = read(data_dir / recording).provenance.notes
        assert notes[0].endswith(asf)
    assert read(write_pair(tmp_path, asf_name="anything.ASF")).n_frames == 3
    (tmp_path / "other.asf").write_text(ASF)
    with pytest.raises(ReadError, match="none of the 2 ASF files.*skeleton="):
        read(tmp_path / "figure_01.amc")
    assert read(tmp_path / "figure_01.amc", skeleton=tmp_path / "other.asf").n_frames == 3


def test_folders_and_pipes_are_no_skeletons(tmp_path: Path) -> None:
    path = write_pair(tmp_path, asf_name="anything.asf")
    (tmp_path / "figure_01.asf").mkdir()
    if hasattr(os, "mkfifo"):
        os.mkfifo(tmp_path / "figure.asf")
    assert read(path).n_frames == 3
