from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from format_samples import BVH
from scipy.spatial.transform import Rotation

import naive
from kineme.errors import KinemeWarning, SeveralPeopleError
from kineme.formats import read, write
from kineme.formats.units import UNITS, infer_rate
from kineme.recordings import Motion, Skeleton
from kineme.recordings.kinematics import compute_local_translations

REAL = [
    ("formats/PyMO_AV_8Walk", "inch", 120.0),
    ("formats/aitviewer_sample", "cm", 40.0),
    ("formats/cmu_131_01_bvh11", "cmu", 120.0),
    ("cmu_formats/02_01", "cmu", 120.0),
    ("cmu_formats/49_02", "cmu", 120.0),
]


def load(folder: Path, text: str | bytes = BVH, **options: object) -> Motion:
    path = folder / "figure.bvh"
    path.write_bytes(text.encode() if isinstance(text, str) else text)
    return read(path, **options)  # type: ignore[arg-type]


def test_what_a_file_says(tmp_path: Path) -> None:
    motion = load(tmp_path)
    names = ("Hips", "mixamorig:Left Up.Leg", "Foot", "Foot_end", "Head", "Head_end")
    assert motion.skeleton.names == names
    assert motion.skeleton.end_sites == {3, 5}
    assert motion.fps == 120
    assert motion.positions[1, 0] == pytest.approx([0.01, 0.91, 0.01])
    assert motion.rotations is not None
    hips = Rotation.from_euler("ZXY", [10, 20, 30], degrees=True)
    found = Rotation.from_quat(motion.rotations[0, 0], scalar_first=True)
    assert (found.inv() * hips).magnitude() < 1e-12
    notes = " ".join(motion.provenance.notes)
    assert "unit cm inferred" in notes
    assert "frame rate 120 Hz" in notes


@pytest.mark.parametrize(("recording", "unit", "fps"), REAL)
def test_real_files_equal_the_naive_implementation_and_stand_upright(
    data_dir: Path, recording: str, unit: str, fps: float
) -> None:
    """Had position channels been added to the offset, the feet would not be on the floor."""
    path = data_dir / f"{recording}.bvh"
    motion = read(path)
    frames = range(0, motion.n_frames, max(1, motion.n_frames // 40))
    expected = UNITS[unit] * np.array(naive.compute_bvh_positions(path.read_text(), frames))
    np.testing.assert_allclose(motion.positions[frames], expected, atol=1e-9)
    assert motion.fps == fps
    assert any(f"unit {unit} inferred" in note for note in motion.provenance.notes)
    lowest, highest = motion.positions[..., 1].min(axis=1), motion.positions[..., 1].max(axis=1)
    assert abs(np.median(lowest)) < 0.1
    assert 1.3 < np.median(highest - lowest) < 1.9


@pytest.mark.parametrize(
    "dialect",
    [
        pytest.param(BVH.replace("\n", "\r\n"), id="crlf"),
        pytest.param(BVH.replace("\n", "\r"), id="cr"),
        pytest.param("\ufeff" + BVH, id="byte order mark"),
        pytest.param(BVH.replace(" ", "\t").replace("Left\tUp.Leg", "Left Up.Leg"), id="tabs"),
        pytest.param(BVH.replace("\n{", " {").replace("\t{", "{"), id="brace on the name's line"),
        pytest.param(BVH.replace("}\n", "} "), id="braces in a row"),
        pytest.param(BVH.replace("Foot\n", "Foot\n\n"), id="blank lines"),
        pytest.param(BVH.replace("Frames: 3", "Frames:3").replace("Time: ", "Time:"), id="glued"),
        pytest.param(BVH.replace("HIERARCHY", "Hierarchy").replace("OFFSET", "Offset"), id="case"),
        pytest.param(BVH.replace(" -80 2", " -8.0e+01 2.E0"), id="exponents"),
        pytest.param(BVH.replace(" 1 2 3 0 -80", "\n1 2 3 0 -80"), id="frames over two lines"),
        pytest.param(BVH.rstrip(), id="no last line break"),
        pytest.param(BVH + "\n\n  \n", id="blank lines at the end"),
    ],
)
def test_dialects(tmp_path: Path, dialect: str) -> None:
    plain, other = load(tmp_path), load(tmp_path, dialect)
    assert other.skeleton.names == plain.skeleton.names
    assert other.fps == plain.fps
    np.testing.assert_array_equal(other.positions, plain.positions)


def test_channels_in_any_order(tmp_path: Path) -> None:
    text = BVH.replace("6 Xposition Yposition", "6 Yposition Xposition", 1)
    for x, y in (("0", "90"), ("1", "91"), ("2", "92")):
        text = text.replace(f"\n{x} {y} ", f"\n{y} {x} ")
    np.testing.assert_array_equal(load(tmp_path, text).positions, load(tmp_path).positions)


def test_channels_stay_and_angles_are_continuous(tmp_path: Path) -> None:
    turns = np.linspace(0, 800, 50)
    frames = "".join(f"0 90 0 {a} 20 30 1 {a / 5} 3 0 -80 0 4 5 6 7 8 9\n" for a in turns)
    head = BVH[: BVH.index("Frames:")]
    text = f"{head}Frames: 50\nFrame Time: 0.01\n{frames}"
    write(load(tmp_path, text, up="y"), tmp_path / "again.bvh")
    again = (tmp_path / "again.bvh").read_text()
    kept = [line for line in text.splitlines() if "CHANNELS" in line]
    assert [line for line in again.splitlines() if "CHANNELS" in line] == kept
    values = [[float(word) for word in line.split()] for line in again.splitlines()[-50:]]
    expected = [[float(word) for word in line.split()] for line in frames.splitlines()]
    np.testing.assert_allclose(values, expected, atol=1e-6)


def test_channels_are_added_where_the_motion_needs_them(tmp_path: Path) -> None:
    text = BVH.replace("3 Zrotation Yrotation Xrotation", "1 Xrotation").replace(" 7 8 9", " 9")
    motion = load(tmp_path, text)
    write(motion, tmp_path / "again.bvh")
    assert "CHANNELS 1 Xrotation" in (tmp_path / "again.bvh").read_text()
    assert motion.rotations is not None
    rotations, positions = motion.rotations.copy(), motion.positions.copy()
    rotations[:, 4] = Rotation.from_euler("zx", [0.3, 0.2]).as_quat(scalar_first=True)
    positions[1, 1] += 0.1
    changed = Motion.from_rotations(
        motion.skeleton,
        rotations,
        motion.fps,
        translations=compute_local_translations(motion.skeleton, positions, rotations),
        provenance=motion.provenance,
    )
    write(changed, tmp_path / "changed.bvh")
    again = read(tmp_path / "changed.bvh")
    np.testing.assert_allclose(again.positions, changed.positions, atol=1e-9)


@pytest.mark.parametrize("prefix", ["B:", ""])
def test_one_of_several_characters_is_read(tmp_path: Path, prefix: str) -> None:
    """Also if both have the same names of joints; a small one is a prop."""
    head, _, frames = BVH.partition("MOTION\n")
    body = head.removeprefix("HIERARCHY\n")
    prop = "ROOT Box\n{\nOFFSET 0 0 0\nCHANNELS 3 Xposition Yposition Zposition\n}\n"
    other = body.replace("ROOT ", f"ROOT {prefix}").replace("JOINT ", f"JOINT {prefix}")
    rows = frames.splitlines()
    text = f"HIERARCHY\n{body}{prop}{other}MOTION\n{rows[0]}\n{rows[1]}\n" + "".join(
        f"{row} 1 2 3 {' '.join(['5', *row.split()[1:]])}\n" for row in rows[2:]
    )
    with pytest.raises(SeveralPeopleError, match="2 characters are in it") as error:
        load(tmp_path, text)
    first, second = error.value.people
    one, alone = load(tmp_path, text, person=first), load(tmp_path)
    np.testing.assert_array_equal(one.positions, alone.positions)
    assert one.skeleton.names == alone.skeleton.names
    found = load(tmp_path, text, person=second)
    assert found.skeleton.names[0] == f"{prefix}Hips"
    assert found.provenance.people == (first, second)
    assert found.positions[:, 0, 0] == pytest.approx(0.05)
    np.testing.assert_allclose(found.positions[..., 1], alone.positions[..., 1])


def test_names_in_latin_1(tmp_path: Path) -> None:
    motion = load(tmp_path, BVH.replace("Head", "R\u00fccken").encode("latin-1"))
    assert motion.skeleton.names[4:] == ("R\u00fccken", "R\u00fccken_end")


@pytest.mark.parametrize("declared", [1, 2, 4, 10_000_000])
def test_frames_declared_and_found(tmp_path: Path, declared: int) -> None:
    with pytest.warns(KinemeWarning, match=f"line 31: {declared} frames declared, 3 found") as told:
        motion = load(tmp_path, BVH.replace("Frames: 3", f"Frames: {declared}"))
    assert motion.n_frames == 3
    assert told[0].filename == __file__


@pytest.mark.parametrize("lost", [len(" 9.0e0\n"), len("0\n")])
def test_a_truncated_last_frame_is_left_out_with_a_warning(tmp_path: Path, lost: int) -> None:
    with pytest.warns(KinemeWarning) as told:
        motion = load(tmp_path, BVH[:-lost])
    assert "line 35" in str(told[0].message)
    assert "last frame is truncated" in str(told[0].message)
    assert motion.n_frames == 2


@pytest.mark.parametrize("unit", UNITS)
def test_the_unit_is_inferred_from_the_size(tmp_path: Path, unit: str) -> None:
    """The figure is 1.65 m from head to heel in whatever unit it is written."""
    scale = 0.01 / UNITS[unit]

    def rescaled(line: str) -> str:
        words = line.split()
        if words and words[0] == "OFFSET":
            return "OFFSET " + " ".join(str(scale * float(x)) for x in words[1:])
        if len(words) == 18:
            places = {0, 1, 2, 9, 10, 11}
            values = [scale * float(x) if i in places else float(x) for i, x in enumerate(words)]
            return " ".join(map(str, values))
        return line

    motion = load(tmp_path, "\n".join(map(rescaled, BVH.splitlines())))
    np.testing.assert_allclose(motion.positions, load(tmp_path).positions, atol=1e-9)
    assert any(f"unit {unit} inferred" in note for note in motion.provenance.notes)


def test_a_size_that_fits_no_unit_is_told_and_unit_overrides(tmp_path: Path) -> None:
    tiny = BVH.replace(" -80 ", " -1e-4 ").replace(" 60 ", " 1e-4 ").replace(" 20 0\n", " 0 0\n")
    tiny = tiny.replace("10 -5 0", "0 0 0").replace("0 0 15", "0 0 0")
    with pytest.warns(KinemeWarning, match="not of human size in any unit: m assumed; give unit="):
        load(tmp_path, tiny)
    plain = load(tmp_path)
    for unit, factor in (("m", 100), ("mm", 0.1), (0.02, 2)):
        motion = load(tmp_path, unit=unit)
        np.testing.assert_allclose(motion.positions, factor * plain.positions)
        remarked = any("m tall: check the unit" in note for note in motion.provenance.notes)
        assert remarked == (factor != 2)


@pytest.mark.parametrize("up", ["x", "z", "-x", "-y", "-z"])
def test_a_body_that_stands_along_another_axis_is_turned(tmp_path: Path, up: str) -> None:
    plain = load(tmp_path)
    axis = "xyz".index(up[-1])
    sign = -1 if up[0] == "-" else 1
    lying = np.eye(3)[axis] * sign
    turn, _ = Rotation.align_vectors([lying], [[0, 1, 0]])
    offsets = turn.apply(np.array(plain.skeleton.offsets))
    skeleton = Skeleton(plain.skeleton.names, plain.skeleton.parents, offsets, frozenset({3, 5}))
    assert plain.rotations is not None
    locals_ = Rotation.from_quat(np.array(plain.rotations).reshape(-1, 4), scalar_first=True)
    quats = (turn * locals_ * turn.inv()).as_quat(scalar_first=True).reshape(-1, 6, 4)
    motion = Motion.from_rotations(skeleton, quats, 120, plain.positions[:, 0] @ turn.as_matrix().T)
    write(motion, tmp_path / "lying.bvh")
    upright = read(tmp_path / "lying.bvh")
    assert any(f"along {up}, so" in note for note in upright.provenance.notes)
    heights = upright.positions[..., 1]
    assert heights.max() == pytest.approx(plain.positions[..., 1].max(), abs=0.05)
    as_is = read(tmp_path / "lying.bvh", up="y")
    np.testing.assert_allclose(as_is.positions, motion.positions, atol=1e-9)
    told = read(tmp_path / "lying.bvh", up=up)
    np.testing.assert_allclose(told.positions, upright.positions, atol=1e-9)


def test_frame_times() -> None:
    for word, rate in [
        (".0083333", 120), ("0.008333", 120), ("8.3333e-3", 120), ("0.0333333", 30),
        ("0.033", 30), ("0.025000", 40), ("0.04", 25), ("0.016667", 60), ("1", 1),
    ]:  # fmt: skip
        assert infer_rate(word)[0] == rate
    for word in ("0.033926", "0.0333667"):
        assert infer_rate(word) == (pytest.approx(1 / float(word)), None)


def test_fps_overrides(tmp_path: Path) -> None:
    assert load(tmp_path, BVH.replace("0.0083333", "0"), fps=24).fps == 24


def test_numbers_that_are_not_apart(tmp_path: Path) -> None:
    """SlimeVR-Server#995: no blank before a minus sign."""
    sound = BVH.replace("1 91 1 11 21 31", "1 91 1 -11 21 31")
    with pytest.warns(KinemeWarning, match="spaces missing before minus signs added in 1 frame"):
        glued = load(tmp_path, sound.replace("1 -11 21", "1-11 21"))
    np.testing.assert_array_equal(glued.positions, load(tmp_path, sound).positions)


def test_a_minus_in_an_exponent_is_none(tmp_path: Path) -> None:
    """usdBVHAnim#36, BVHTools#11, BVHView#4: scientific notation, small and negative."""
    motion = load(tmp_path, BVH.replace("1 91 1 11", "1e0 9.1E+1 1 -1.1e-5"))
    other = load(tmp_path, BVH.replace("1 91 1 11", "1 91 1 -0.000011"))
    np.testing.assert_array_equal(motion.positions, other.positions)
