"""TRC, tables, arrays, poses and keypoints: content, inference and round trips."""

from __future__ import annotations

import io
import tempfile
import zipfile
from pathlib import Path

import numpy as np
import pytest
from format_samples import motions
from hypothesis import given, settings
from hypothesis import strategies as st
from keypoint_samples import write_trc

import kineme
from kineme.errors import KinemeWarning, ReadError
from kineme.formats import read_motion
from kineme.formats.arrays.numpy_files import make_smpl_skeleton
from reading import read

JOINTS = ["pelvis", "left_hip", "right_hip", "left_ankle", "right_ankle", "head", "left_wrist"]
JOINTS += ["right_wrist", "nose"]


def make_body(frames: int = 20) -> np.ndarray:
    rest = [(0, 1, 0), (0.1, 0.9, 0), (-0.1, 0.9, 0), (0.1, 0.1, 0), (-0.1, 0.1, 0)]
    rest += [(0, 1.6, 0), (0.3, 0.9, 0), (-0.3, 0.9, 0), (0, 1.55, 0.1)]
    points = np.repeat(np.array(rest)[None], frames, axis=0)
    points[:, :, 2] += np.linspace(0, 0.3, frames)[:, None]
    return points


def tabulate(points: np.ndarray, pattern: str = "{joint}_{axis}", sep: str = ",", **columns) -> str:
    """A table with these columns besides the positions."""
    names = [pattern.format(joint=joint, axis=axis) for joint in JOINTS for axis in "xyz"]
    rows = points.reshape(len(points), -1)
    cells = [[*map(str, [c[i] for c in columns.values()]), *map(repr, row.tolist())]
             for i, row in enumerate(rows)]  # fmt: skip
    return "\n".join([sep.join([*columns, *names]), *map(sep.join, cells)]) + "\n"


TIMES = [f"{i / 25:.3f}" for i in range(20)]


@pytest.mark.parametrize("pattern", ["{joint}_{axis}", "{joint}.{axis}", "{joint} {axis}"])
@pytest.mark.parametrize(("suffix", "sep"), [("csv", ","), ("csv", ";"), ("tsv", "\t")])
def test_tables(tmp_path: Path, pattern: str, suffix: str, sep: str) -> None:
    text = tabulate(make_body(), pattern, sep, label=["walk"] * 20, time=TIMES)
    motion = read(tmp_path, f"a.{suffix}", text)
    assert motion.fps == 25
    assert motion.skeleton.names[:8] == tuple(JOINTS[:8])
    assert np.allclose(motion.positions, make_body())
    assert kineme.pose_features(motion).shape == (20, 15)


def test_rates_of_tables(tmp_path: Path) -> None:
    assert read(tmp_path, "a.csv", tabulate(make_body(), fps=[29.97] * 20)).fps == 29.97
    milliseconds = tabulate(make_body(), time_ms=[i * 40 for i in range(20)])
    assert read(tmp_path, "a.csv", milliseconds).fps == 25
    assert read(tmp_path, "a.csv", tabulate(make_body()), fps=60).fps == 60
    for columns, reason in [
        ({}, "no column 'time' or 'fps' found: give fps="),
        ({"time": [0] * 20}, "times do not increase: row 2"),
        ({"fps": [*range(1, 21)]}, "not one positive number"),
        ({"time": [*range(19), 1e9]}, "its times are 1 apart"),
    ]:
        with pytest.raises(ReadError, match=reason):
            read(tmp_path, "a.csv", tabulate(make_body(), **columns))


def test_a_pause_is_a_gap_of_a_motion(tmp_path: Path) -> None:
    at = np.arange(40) / 25 + 2.0 * (np.arange(40) >= 15)
    motion = read(tmp_path, "a.csv", tabulate(make_body(40), time=at.tolist()))
    assert (motion.n_frames, motion.fps, motion.gaps) == (90, 25, ((15, 65),))
    assert np.allclose(motion.positions[65:], make_body(40)[15:])


@pytest.mark.parametrize("jump", [7e5, -2.0])
def test_a_jump_of_the_clock_splits_a_motion(tmp_path: Path, jump: float) -> None:
    at = np.arange(40) / 25 + jump * (np.arange(40) >= 15)
    with pytest.warns(KinemeWarning, match="the recording is split there"):
        motion = read(tmp_path, "a.csv", tabulate(make_body(40), time=at.tolist()))
    assert (motion.n_frames, motion.fps, motion.gaps) == (41, 25, ((15, 16),))
    assert np.allclose(np.delete(motion.positions, 15, axis=0), make_body(40))


def test_dates_tell_the_rate_of_a_motion(tmp_path: Path) -> None:
    at = np.datetime64("2026-03-29T00:59:59.500") + np.arange(20) * np.timedelta64(40, "ms")
    motion = read(tmp_path, "a.csv", tabulate(make_body(), timestamp=[f"{t}Z" for t in at]))
    assert (motion.n_frames, motion.fps) == (20, 25)
    with pytest.raises(ReadError, match=r"line 3: 'noon-ish' is not an ISO date"):
        read(tmp_path, "a.csv", tabulate(make_body(), timestamp=[str(at[0]), "noon-ish", *at[2:]]))


def test_times_that_nobody_can_read(tmp_path: Path) -> None:
    text = tabulate(make_body(), time=[f"half past {i}" for i in range(20)])
    with pytest.raises(ReadError, match=r"line 2: column 'time' holds neither .* \(--fps\)"):
        read(tmp_path, "a.csv", text)
    assert read(tmp_path, "a.csv", text, fps=25).fps == 25


def test_units_in_the_names_of_columns(tmp_path: Path) -> None:
    millimetres = 1000 * make_body()
    plain = read(tmp_path, "a.csv", tabulate(millimetres, time=TIMES), unit="mm")
    named = read(tmp_path, "b.csv", tabulate(millimetres, "{joint} {axis} [mm]", time=TIMES))
    assert named.positions.tolist() == plain.positions.tolist()
    assert named.skeleton.names == plain.skeleton.names
    assert not any("unit" in note for note in named.provenance.notes)


def to_units(units: dict[str, float], **columns) -> str:
    """A table in which the joints are in these units in turn, by the metres in each."""
    points, names = make_body(), list(units)
    told = [names[i % len(names)] for i in range(len(JOINTS))]
    points /= np.array([units[unit] for unit in told])[:, None]
    text = tabulate(points, time=TIMES, **columns)
    for joint, unit in zip(JOINTS, told, strict=True):
        for axis in "xyz":
            text = text.replace(f"{joint}_{axis}", f"{joint}_{axis}{unit}", 1)
    return text


def test_columns_in_several_units_are_each_taken_in_their_own(tmp_path: Path) -> None:
    plain = read(tmp_path, "a.csv", tabulate(make_body(), time=TIMES), unit="m")
    mixed = to_units({" [m]": 1, " [mm]": 0.001, " (cm)": 0.01})
    found = read(tmp_path, "b.csv", mixed)
    assert np.abs(found.positions - plain.positions).max() < 1e-12
    assert any(
        "cm and m and mm, each read in its own unit" in note for note in found.provenance.notes
    )
    with pytest.raises(ReadError, match=r"'left_hip_x' states no unit: add it .* \[m\]"):
        read(tmp_path, "c.csv", to_units({" [m]": 1, "": 1, " [mm]": 0.001}))


def test_columns_without_a_unit_are_in_that_of_the_others(tmp_path: Path) -> None:
    plain = read(tmp_path, "a.csv", tabulate(make_body(), time=TIMES), unit="m")
    with pytest.warns(KinemeWarning, match="columns of 4 points state no unit"):
        found = read(tmp_path, "b.csv", to_units({" [mm]": 0.001, "": 0.001}))
    assert np.abs(found.positions - plain.positions).max() < 1e-12
    once = tabulate(1000 * make_body(), time=TIMES).replace("_x", "_x [mm]")
    found = read(tmp_path, "c.csv", once)
    assert np.abs(found.positions - plain.positions).max() < 1e-12


def test_columns_with_a_unit_behind_the_axis_are_read_in_it(tmp_path: Path) -> None:
    """A head in mm beside a hip in metres without a unit."""
    rows = (f"{i / 50},{0.1},{0.9},{0.2},{100},{1700},{200 + i % 3}\n" for i in range(40))
    text = "time,hip_x,hip_y,hip_z,head_x_mm,head_y_mm,head_z_mm\n" + "".join(rows)
    with pytest.warns(KinemeWarning, match="1 point state no unit; read in m"):
        motion = read(tmp_path, "a.csv", text, up="y")
    heights = dict(zip(motion.skeleton.names, motion.positions[0, :, 1], strict=True))
    assert heights == pytest.approx({"hip": 0.9, "head": 1.7})


def test_positions_beside_other_columns_of_joints(tmp_path: Path) -> None:
    plain = read(tmp_path, "a.csv", tabulate(make_body(), time=TIMES))
    more = {f"head_{what}_{axis}": [90.0] * 20 for what in ("rotation", "vel") for axis in "xyz"}
    text = tabulate(make_body(), "{joint}_position_{axis}", time=TIMES, **more)
    beside = read(tmp_path, "b.csv", text)
    assert beside.skeleton.names == plain.skeleton.names
    assert beside.positions.tolist() == plain.positions.tolist()


def test_a_subject_may_be_called_by_a_letter(tmp_path: Path) -> None:
    motion = read(tmp_path, "a.csv", tabulate(make_body(), "A:{joint}_{axis}", time=TIMES))
    assert motion.skeleton.names[:8] == tuple(JOINTS[:8])


def test_units_and_axes_of_tables(tmp_path: Path) -> None:
    centimetres_z_up = 100 * make_body()[:, :, [0, 2, 1]] * [1, -1, 1]
    motion = read(tmp_path, "a.csv", tabulate(centimetres_z_up, time=TIMES))
    assert np.allclose(motion.positions, make_body())
    notes = " ".join(motion.provenance.notes)
    assert "unit cm inferred" in notes
    assert "up axis z inferred" in notes


def test_keypoints_that_are_not_sure_count_as_gaps(tmp_path: Path) -> None:
    sure = ["0.9"] * 20
    sure[7] = "0.1"
    points = make_body()
    points[7, 0] = 99.0
    motion = read(tmp_path, "a.csv", tabulate(points, time=TIMES, pelvis_confidence=sure))
    assert np.allclose(motion.positions[:, 0], make_body()[:, 0])
    assert any("1 position below confidence 0.5" in note for note in motion.provenance.notes)


def test_what_is_hidden_is_used(tmp_path: Path) -> None:
    text = tabulate(make_body(), time=TIMES, pelvis_visibility=["0.1"] * 20)
    assert np.allclose(read(tmp_path, "a.csv", text).positions[:, 0], make_body()[:, 0])
    notes = read(tmp_path, "a.csv", text, confidence=0.5).provenance.notes
    assert any("20 positions below confidence 0.5" in note for note in notes)


def test_parquet(tmp_path: Path) -> None:
    pa = pytest.importorskip("pyarrow")
    from pyarrow import parquet

    columns = {
        f"{j}_{a}": make_body()[:, i, k] for i, j in enumerate(JOINTS) for k, a in enumerate("xyz")
    }
    columns["time"] = np.arange(20) / 50
    parquet.write_table(pa.table(columns), tmp_path / "a.parquet")
    motion = kineme.read(tmp_path / "a.parquet")
    assert motion.fps == 50
    assert np.allclose(motion.positions, make_body())
    parquet.write_table(pa.table({"a_x": np.zeros(10**7)}), tmp_path / "big.parquet")
    with pytest.raises(ReadError, match="claims 10000000 rows of 1 columns"):
        kineme.read(tmp_path / "big.parquet")
    data = (tmp_path / "a.parquet").read_bytes()
    with pytest.raises(ReadError, match="is not a Parquet file, or is damaged"):
        read(tmp_path, "b.parquet", data[: len(data) // 2])


TRC = """PathFileType\t4\t(X/Y/Z)\ta.trc
DataRate\tCameraRate\tNumFrames\tNumMarkers\tUnits\tOrigDataRate\tOrigDataStartFrame\tOrigNumFrames
100\t100\t3\t2\tmm\t100\t1\t3
Frame#\tTime\tR.ASIS\t\t\tTop.Head\t\t
\t\tX1\tY1\tZ1\tX2\tY2\tZ2

1\t0.00\t1\t2\t3\t4\t5\t6
2\t0.01\t\t\t\t4\t5\t6
3\t0.02\t3\t2\t3\t4\t5\t6
"""


def test_trc(tmp_path: Path) -> None:
    motion = read(tmp_path, "a.trc", TRC)
    assert motion.fps == 100
    assert motion.skeleton.names == ("R.ASIS", "Top.Head")
    assert np.allclose(motion.positions[:, 0] * 1000, [(1, 2, 3), (2, 2, 3), (3, 2, 3)])
    assert any("filled" in note for note in motion.provenance.notes)
    decimal = TRC.replace("0.0", "0,0").replace("\n100\t", "\n100,0\t")
    german = read(tmp_path, "c.trc", decimal)
    assert np.array_equal(german.positions, motion.positions)
    assert "numbers have a decimal comma" in german.provenance.notes
    commas = TRC.replace("\t", ",").replace("\n\n", "\n")
    assert np.array_equal(read(tmp_path, "b.trc", commas).positions, motion.positions)


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ("100\t100\t3", "100\t100\t9", "9 frames declared, 3 found"),
        ("100\t100\t3", "50\t100\t3", "DataRate is 50, but the times give 100 Hz"),
        ("3\t0.02\t3\t2\t3\t4\t5\t6", "3\t0.02\t3", "line 9: 3 cells, but 8 columns"),
    ],
)
@pytest.mark.filterwarnings("ignore::kineme.errors.KinemeWarning")
def test_trc_that_contradicts_itself(tmp_path: Path, old: str, new: str, said: str) -> None:
    with pytest.warns(KinemeWarning, match=said):
        assert read(tmp_path, "a.trc", TRC.replace(old, new)).fps == 100


@pytest.mark.parametrize(
    ("old", "new", "line", "reason"),
    [
        ("2\t0.01\t\t\t\t", "2\t0.01\t\t\t", 8, "7 cells, but 8 columns"),
        ("2\t0.01\t\t\t\t", "2\t0.01\t\t\tx\t", 8, "'x' is not a number"),
        ("R.ASIS\t\t\tTop.Head", "", 4, "no marker is named"),
    ],
)
def test_bad_trc(tmp_path: Path, old: str, new: str, line: int, reason: str) -> None:
    with pytest.raises(ReadError, match=reason) as caught:
        read(tmp_path, "a.trc", TRC.replace(old, new))
    assert caught.value.line == line


@pytest.mark.parametrize("tabs", ["\t", "\t\t", "\t\t\t"])
def test_trc_names_stand_any_number_of_tabs_apart(tmp_path: Path, tabs: str) -> None:
    names = ["LELB", "RELB", "STRN"]
    points = np.random.default_rng(4).normal(size=(40, 3, 3)).cumsum(axis=0) + 900
    text = write_trc(tmp_path / "a.trc", points, names, fps=60).read_text()
    text = text.replace("LELB\t\t\tRELB\t\t\tSTRN", tabs.join(names))
    motion = read(tmp_path, "a.trc", text, up="y")
    found = motion.positions[:, [motion.joint(name) for name in names]]
    assert np.abs(found - points / 1000).max() < 1e-6


def test_npz_of_poses(tmp_path: Path) -> None:
    frames, skeleton = 10, make_smpl_skeleton()
    poses = np.zeros((frames, 156))
    poses[:, :3] = (np.pi / 2, 0, 0)  # upright where z is up
    knee = skeleton.joint("left_knee")
    poses[:, 3 * knee] = np.linspace(0, np.pi / 2, frames)
    trans = np.tile([0.0, 0.0, 0.9], (frames, 1))
    file = io.BytesIO()
    np.savez(file, poses=poses, trans=trans, mocap_framerate=120.0, gender=np.array("x"))
    motion = read(tmp_path, "a.npz", file.getvalue())
    assert (motion.provenance.format, motion.fps) == ("AMASS", 120.0)
    at = dict(zip(skeleton.names, motion.positions[-1], strict=True))
    assert np.allclose(at["pelvis"], (0, 0.9, 0))
    assert at["head_end"][1] == pytest.approx(0.9 + 0.78)
    assert np.allclose(at["left_ankle"] - at["left_knee"], (0, 0, -0.418))  # bent backwards
    height = np.ptp(motion.positions[0, :, 1])
    assert 1.6 < height < 1.8
    assert kineme.pose_features(motion)[0, 0] > 0.05  # the left ankle is on the left


@pytest.mark.parametrize(
    ("arrays", "reason"),
    [
        ({"poses": np.zeros((4, 100)), "fps": 30}, "100 values per frame, not 72"),
        ({"poses": np.zeros((4, 72))}, "no 'mocap_frame_rate' in it: give fps="),
        ({"poses": np.full((4, 72), np.nan), "fps": 30}, "not finite"),
        ({"poses": np.zeros((4, 72)), "trans": np.zeros((3, 3)), "fps": 30}, "trans has shape"),
        ({"positions": np.zeros((4, 72)), "fps": 30}, r"not \(frames, joints, 3\)"),
        ({"positions": np.ones((4, 2, 3))}, "no 'fps' in it: give fps="),
        ({"positions": np.ones((4, 2, 3)), "fps": 1, "names": np.array(["a"])}, "1 names for 2"),
        ({"other": np.zeros(3)}, "no columns JOINT_x"),
        ({"positions": np.array([None])}, "no columns JOINT_x"),
    ],
)
def test_bad_npz(tmp_path: Path, arrays: dict, reason: str) -> None:
    file = io.BytesIO()
    np.savez(file, **arrays)
    with pytest.raises(ReadError, match=reason):
        read(tmp_path, "a.npz", file.getvalue())


def test_archives_that_claim_too_much(tmp_path: Path) -> None:
    file = io.BytesIO()
    with zipfile.ZipFile(file, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("positions.npy", bytes(50_000_000))
    with pytest.raises(ReadError, match="claims to unpack to 50 MB"):
        read(tmp_path, "a.npz", file.getvalue())
    huge = io.BytesIO()
    np.lib.format.write_array_header_1_0(
        huge, {"descr": "<f8", "fortran_order": False, "shape": (10**12, 3, 3)}
    )
    with pytest.raises(ReadError, match="more than the file holds"):
        read(tmp_path, "a.npy", huge.getvalue())


def test_npy_without_names(tmp_path: Path) -> None:
    np.save(tmp_path / "a.npy", make_body())
    motion = kineme.read(tmp_path / "a.npy", fps=30)
    assert motion.skeleton.names[:2] == ("joint0", "joint1")
    assert np.allclose(motion.positions, make_body())


def test_who_needs_a_body_is_told_that_there_is_none(tmp_path: Path) -> None:
    head = "Coordinates\nversion=1\nendheader\ntime\thip_flexion_r\tknee_angle_r\n"
    assert isinstance(read(tmp_path, "a.mot", head + "0\t1\t2\n0.01\t1\t3\n"), kineme.Signals)
    with pytest.raises(ReadError, match="signals without a skeleton, but a motion is needed"):
        read_motion(tmp_path / "a.mot")


@settings(max_examples=50)
@pytest.mark.filterwarnings("ignore:.* bones have no length")
@given(motions())
def test_npz_round_trip(motion: kineme.Motion) -> None:
    with tempfile.TemporaryDirectory() as folder:
        kineme.write(motion, Path(folder) / "a.npz")
        again = kineme.read(Path(folder) / "a.npz")
    assert again.skeleton.names == motion.skeleton.names
    assert again.skeleton.parents == motion.skeleton.parents
    assert again.skeleton.end_sites == motion.skeleton.end_sites
    assert again.fps == motion.fps
    assert np.array_equal(again.positions, motion.positions)
    assert np.array_equal(again.rotations, motion.rotations)


@settings(max_examples=50)
@given(
    st.sampled_from([".csv", ".trc"]),
    st.sampled_from([25.0, 29.97, 120.0, 59.94, 29.476]),
    st.integers(2, 40),
)
def test_positions_round_trip(suffix: str, fps: float, frames: int) -> None:
    skeleton = kineme.Skeleton(tuple(JOINTS), (-1,) + (0,) * 8, np.zeros((9, 3)))
    motion = kineme.Motion(skeleton, make_body(frames), fps)
    with tempfile.TemporaryDirectory() as folder:
        kineme.write(motion, Path(folder) / f"a{suffix}")
        again = kineme.read(Path(folder) / f"a{suffix}")
    assert again.fps == fps
    assert again.skeleton.names == motion.skeleton.names
    assert np.abs(again.positions - motion.positions).max() < 1e-8


def test_what_kineme_wrote_keeps_its_unit_whatever_is_said_of_its_axis(tmp_path: Path) -> None:
    motion = kineme.read(kineme.bundled_recording())[:30]
    kineme.write(motion, tmp_path / "own.npz")
    for options in ({"up": "y"}, {"unit": "m"}, {"unit": "m", "up": "y"}):
        found = kineme.read(tmp_path / "own.npz", **options)
        assert (found.positions == motion.positions).all()
        assert found.rotations is not None
    turned = kineme.read(tmp_path / "own.npz", up="z")
    assert not any("unit" in note for note in turned.provenance.notes)
