"""Invalid files raise an error with file, line and reason."""

from __future__ import annotations

import tracemalloc
from pathlib import Path

import numpy as np
import pytest
from format_samples import AMC, ASF, BVH

import kineme
from kineme.errors import KinemeWarning, ReadError
from kineme.formats import read


def bvh(folder: Path, text: str | bytes) -> Path:
    path = folder / "bad.bvh"
    path.write_bytes(text if isinstance(text, bytes) else text.encode())
    return path


def amc(folder: Path, text: str | bytes = AMC, asf: str | bytes = ASF) -> Path:
    path = folder / "bad.amc"
    path.write_bytes(text if isinstance(text, bytes) else text.encode())
    (folder / "bad.asf").write_bytes(asf if isinstance(asf, bytes) else asf.encode())
    return path


def swap(text: str, old: str, new: str) -> str:
    assert old in text
    return text.replace(old, new, 1)


HEAD, DATA = BVH.split("MOTION")


@pytest.mark.parametrize("suffix", [".bvh", ".amc", ".trc", ".csv", ".npz", ".signals.csv"])
@pytest.mark.parametrize("what", ["person", "take"])
def test_a_person_or_take_that_the_file_does_not_name(
    tmp_path: Path, suffix: str, what: str
) -> None:
    path, motion = tmp_path / f"walk{suffix}", kineme.read(kineme.bundled_recording())[:60]
    kineme.write(kineme.Signals(np.eye(60, 2), 30.0) if "signals" in suffix else motion, path)
    if (suffix, what) == (".signals.csv", "person"):  # read beside motions of several people
        assert read(path, person=1).n_frames == 60
    else:
        with pytest.raises(ReadError, match=rf"no {what} '1': it names no {what}, so leave out"):
            read(path, **{what: 1})
    assert read(path, **{what: 0}).n_frames == 60


@pytest.mark.parametrize(
    ("text", "line", "reason"),
    [
        ("", None, "the file is empty"),
        (HEAD, None, "no MOTION"),
        (HEAD + "MOTION\nFrames: x\n", 31, "not followed by a number and 'Frame Time:'"),
        (HEAD + "MOTION\nFrames: 3\nFrame Time: 0.1\n", None, "ends before its first frame"),
        (HEAD + "MOTION\nFrames: 1\nFrame Time: 0.1\n1 2\n", 33, "2 values, but .* 18 channels"),
        (swap(BVH, "Time: 0.0083333", "Time: 0"), 32, "Frame Time is 0 s: give fps="),
        (swap(BVH, "1 91 1 11", "1 91 nan 11"), 34, "'nan' is not a finite number"),
        (swap(BVH, "1 91 1 11", "1 91 one 11"), 34, "'one' is not a number"),
        (swap(BVH, "1 91 1 11", "1 91 11"), 34, "17 values, but the hierarchy has 18 channels"),
        (swap(BVH, "HIERARCHY", "HIERARCH"), 1, "begins with the word HIERARCHY"),
        (swap(BVH, "ROOT", "TOOR"), 2, "ROOT expected, found 'TOOR'"),
        (swap(BVH, "\tJOINT Foot", "\tROOT Foot"), 10, "ROOT inside a joint"),
        (swap(BVH, "Head", "Foot"), 20, "a second joint is called 'Foot'"),
        (swap(BVH, "OFFSET 0 -80 0", "OFFSET 0 -80 inf"), 12, "OFFSET: 'inf' is not a finite"),
        (swap(BVH, "OFFSET 0 -80 0", "OFFSET 0 -80"), 12, "OFFSET: 'CHANNELS' is not a number"),
        (swap(BVH, "6 Xpos", "x Xpos"), 5, "CHANNELS needs a number, found 'x'"),
        (swap(BVH, "6 Xpos", "7 Xpos"), 5, "unknown channel 'JOINT' of 7"),
        (swap(BVH, "Yposition", "Xposition"), 5, "position channel is listed twice"),
        (swap(BVH, "Yposition", "Wposition"), 5, "unknown channel 'Wposition'"),
        (swap(BVH, "\t}\n}", "\t}"), 28, "'}' of joint 'Hips' is missing"),
        (swap(BVH, "Head\n\t{", "Head\n\t"), 22, "'{' expected"),
        ("HIERARCHY\nMOTION\nFrames: 1\nFrame Time: 1\n1\n", None, "has no ROOT"),
        ("HIERARCHY ROOT a { OFFSET 0 0 0 } MOTION Frames: 1 Frame Time: 1\n1\n", None, "channel"),
    ],
)
def test_bvh(tmp_path: Path, text: str | bytes, line: int | None, reason: str) -> None:
    path = bvh(tmp_path, text)
    with pytest.raises(ReadError, match=reason) as caught:
        read(path)
    assert caught.value.line == line
    assert str(caught.value).startswith(str(path))
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    ("text", "line", "reason"),
    [
        ("", None, "the file is empty"),
        (":FULLY-SPECIFIED\n", None, "no frame found"),
        (":DEGREES\n1\n", 2, "a frame has no values for any bone"),
        (AMC[: AMC.index("\n2\n")][:-1], 8, "bone 'foot' has 1 values, .* in the only frame|needs"),
        (swap(AMC, "back 5.5 6 7", "back 5.5 nan 7"), 11, "'nan' is not a finite number"),
        (swap(AMC, "back 5.5 6 7", "back 5.5 x 7"), 11, "'x' is not a number"),
        (swap(AMC, "back 5.5 6 7", "back 5.5 6"), 11, "has 2 values, but the skeleton needs 3"),
        (swap(AMC, "back 5.5 6 7", "tail 5.5 6 7"), 11, "'tail' is not in the skeleton: give"),
        (swap(AMC, "back 5.5 6 7", "leg 5.5 6 7"), 12, "'leg' appears twice in one frame"),
        (swap(AMC, "back 5.5 6 7\n", ""), 9, "a frame has no values for back"),
    ],
)
def test_amc(tmp_path: Path, text: str | bytes, line: int | None, reason: str) -> None:
    path = amc(tmp_path, text)
    with pytest.raises(ReadError, match=reason) as caught:
        read(path)
    assert caught.value.line == line
    assert str(caught.value).startswith(str(path))


@pytest.mark.parametrize(
    ("asf", "line", "reason"),
    [
        ("", None, "no :root section"),
        (ASF[: ASF.index(":hierarchy")], None, "no :hierarchy section"),
        (swap(ASF, "length 0.45", "length 0"), 6, r"1 positive number\(s\) expected, found '0'"),
        (swap(ASF, "length 8", "length nan"), 27, "'nan' is not a finite number"),
        (swap(ASF, "direction 0 -1 0", "direction 0 -1"), 26, r"3 number\(s\) expected"),
        (swap(ASF, "axis 0 0 20 XYZ", "axis 0 0 20 XYY"), 28, "'xyy' is not made of X, Y and Z"),
        (swap(ASF, "dof rz rx", "dof rz rw"), 40, "'rw' is not one of"),
        (swap(ASF, "dof rz rx", "dof rz rz"), 40, "listed twice"),
        (swap(ASF, "name leg", "name hip"), 25, "a second bone is called 'hip'"),
        (swap(ASF, "  end\n", ""), 22, "an 'end' is missing"),
        (
            swap(ASF, "    hip leg\n", "    hip leg\n    leg hip\n"),
            54,
            "has a second parent, 'leg'",
        ),
        (swap(ASF, "root hip back", "root back\n    foot hip"), None, "missing or circular"),
        (swap(ASF, "    leg foot\n", ""), None, "'foot' is not connected to the root"),
        (swap(ASF, "leg foot", "leg toe"), 54, "'toe' is not in :bonedata"),
    ],
)
def test_asf(tmp_path: Path, asf: str | bytes, line: int | None, reason: str) -> None:
    with pytest.raises(ReadError, match=reason) as caught:
        read(amc(tmp_path, asf=asf))
    assert caught.value.line == line
    assert caught.value.path.endswith("bad.asf")


def test_values_too_large_to_compute_with(tmp_path: Path) -> None:
    with pytest.raises(ReadError, match="positions hold values that are not finite"):
        read(bvh(tmp_path, swap(BVH, "1 91 1 11", "1 91 1e308 11")), unit=1e9)


def test_one_frame_is_enough(tmp_path: Path) -> None:
    assert read(amc(tmp_path, AMC[: AMC.index("2\nroot")])).n_frames == 1
    one = swap(BVH, "Frames: 3", "Frames: 1")
    assert read(bvh(tmp_path, one[: one.index("1 91")])).n_frames == 1


def test_files_that_are_not_there_or_not_known(tmp_path: Path) -> None:
    with pytest.raises(ReadError, match="cannot be opened: No such file"):
        read(tmp_path / "nothing.bvh")
    with pytest.raises(ReadError, match="is a folder without OpenPose files"):
        read(tmp_path)
    (tmp_path / "a.xyz").write_text("hello")
    with pytest.raises(ReadError, match="unknown content and suffix '.xyz'"):
        read(tmp_path / "a.xyz")
    lonely = tmp_path / "lonely.amc"
    lonely.write_text(AMC)
    with pytest.raises(ReadError, match="no ASF skeleton found next to it.*skeleton="):
        read(lonely)
    with pytest.raises(ReadError, match="cannot be opened"):
        read(lonely, skeleton=tmp_path / "nothing.asf")


def test_content_speaks_louder_than_the_suffix(tmp_path: Path) -> None:
    path = tmp_path / "really_bvh.amc"
    path.write_text(BVH)
    assert read(path).provenance.format == "BVH"


def test_memory_follows_the_file_and_not_what_it_declares(tmp_path: Path) -> None:
    path = bvh(tmp_path, swap(BVH, "Frames: 3", "Frames: 10000000"))
    tracemalloc.start()
    with pytest.warns(KinemeWarning, match="10000000 frames declared, 3 found"):
        read(path)
    _, peak = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert peak < 2_000_000
