"""Bad input at the command line: one sentence, exit code 1, nothing half-written."""

from __future__ import annotations

import os
import subprocess
import sys
import tracemalloc
from pathlib import Path

import numpy as np
import pytest

import kineme as package
from kineme.datasets import bundled_recording, bundled_truth

HIERARCHY = """HIERARCHY
ROOT Hips
{{
  OFFSET 0 0 0
  CHANNELS 3 Zrotation Xrotation Yrotation
  End Site
  {{
    OFFSET 0 90 0
  }}
}}
MOTION
Frames: {frames}
Frame Time: 0.01
{values}
"""
BAD = {
    "empty.bvh": "",
    "binary.bvh": "\0\1\2" * 300,
    "cut_short.bvh": "HIERARCHY\nROOT Hips\n{\n  OFFSET 0 0",
    "nan.bvh": HIERARCHY.format(frames=3, values="0 nan 0\n0 0 0\n0 0 0"),
    "infinite.bvh": HIERARCHY.format(frames=3, values="0 inf 0\n0 0 0\n0 0 0"),
    "words.bvh": HIERARCHY.format(frames=3, values="0 0 0\n0 zero 0\n0 0 0"),
    "no_frames.bvh": HIERARCHY.format(frames=0, values=""),
    "alone.amc": ":FULLY-SPECIFIED\n:DEGREES\n1\nroot 0 0 0 0 0 0\n",
    "unknown.xyz": "what is this?",
}


def test_each_bad_file_is_one_sentence(kineme, tmp_path: Path) -> None:
    for name, text in BAD.items():
        (tmp_path / name).write_text(text)
    (tmp_path / "folder").mkdir()
    before = sorted(path.name for path in tmp_path.iterdir())
    done = kineme(
        "segment", *BAD, "missing.bvh", "folder", "-o", "cuts/{name}.json", "--plot", "cuts", code=1
    )
    assert done.stdout == ""
    lines = [line for line in done.stderr.splitlines() if not line.startswith("warning: ")]
    assert len(lines) == len(BAD) + 2, done.stderr
    for name, line in zip(["folder", *BAD, "missing.bvh"], lines, strict=True):
        assert line.startswith(f"error: {name}"), line
    assert sorted(path.name for path in tmp_path.iterdir()) == sorted([*before, "cuts"])
    assert list((tmp_path / "cuts").iterdir()) == []


def test_neither_missing_hands_nor_missing_frames_are_a_failure(
    kineme_process, tmp_path: Path
) -> None:
    (tmp_path / "no_hands.bvh").write_text(
        HIERARCHY.format(frames=10_000_000, values="0 0 0\n" * 10)
    )
    done = kineme_process("segment", "no_hands.bvh", "-o", "cuts.csv")
    assert "10000000 frames declared, 10 found" in done.stderr
    assert "distances between 2 of its 2 points" in " ".join(done.stdout.split())
    assert (tmp_path / "cuts.csv").exists()


@pytest.mark.parametrize(
    ("option", "place", "reason"),
    [
        ("--output", "no/such/cuts.csv", "the folder no/such cannot be created"),
        ("--output", "/proc/cuts.csv", "/proc"),
    ],
)
def test_a_place_that_cannot_be_written(
    kineme, tmp_path: Path, option: str, place: str, reason: str
) -> None:
    done = kineme("segment", bundled_recording(), option, place, "-q", code=1)
    assert done.stdout == ""
    assert reason in done.stderr
    assert len(done.stderr.splitlines()) == 1
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    "arguments",
    [
        (),
        ("segment",),
        ("cut", "a.bvh"),
        ("segment", "a.bvh", "--preset", "voegele"),
        ("segment", "a.bvh", "--radius", "1"),
        ("segment", "a.bvh", "--unit", "parsec"),
        ("segment", "a.bvh", "--fps", "0"),
        ("segment", "a.bvh", "--level", "phrase"),
        ("segment", "a.bvh", "b.bvh", "-o", "cuts.csv"),
        ("segment", "x/a.bvh", "x/b.bvh", "-o", "{parent}.csv"),
        ("segment", "a.bvh", "-o", "cuts.xlsx"),
        ("segment", "a.bvh", "--plot", "cuts.jpeg2"),
        ("report", "a.bvh", "-o", "page.docx"),
        ("events", "a.bvh", "-o", "events.xlsx"),
        ("events", "a.bvh", "--gait", "gait.json"),
        ("events", "a.bvh", "--labels", "steps.docx"),
        ("library", "export", "lib", "-o", "segments.xlsx"),
        ("graph", "a.bvh", "-o", "graph.csv"),
        ("synthesize", "graph.json", "--actions", "walk", "-o", "new.docx"),
        ("live", "--replay", "a.bvh", "--speed", "-1"),
        ("convert", "a.bvh", "b.bvh", "folder"),
    ],
)
def test_a_command_that_makes_no_sense_exits_with_2(kineme, arguments: tuple[str, ...]) -> None:
    done = kineme(*arguments, code=2)
    assert "Traceback" not in done.stderr


@pytest.mark.parametrize(
    ("arguments", "reason"),
    [
        (("segment", "--take", "nope"), "there is no take 'nope'"),
        (("info", "--person", "3"), "there is no person '3'"),
        (("events", "--c3d", "out.c3d"), "is not a C3D file"),
        (("cycles", "--anchor", "knee_l maxi"), "left foot strike, left foot off, right foot"),
        (("info", "--effectors", "Foo", "--joints"), None),
    ],
)
def test_a_value_that_fits_no_recording_is_one_sentence(
    kineme, arguments: tuple[str, ...], reason: str | None
) -> None:
    done = kineme(*arguments, bundled_recording(), code=int(reason is not None))
    if reason is None:
        assert "not Foo;" in done.stdout
    else:
        assert reason in done.stderr
        assert len(done.stderr.splitlines()) == 1


@pytest.mark.parametrize(
    "name", ["cuts.csv", "cuts.json", "cuts.parquet", "cuts.eaf", "a.TextGrid"]
)
def test_a_table_of_segments_is_not_read_as_a_recording(kineme, name: str) -> None:
    package.write_segments(package.read_segments(bundled_truth()), name)
    for command in ("segment", "info"):
        done = kineme(command, name, code=1)
        assert done.stderr.startswith(f"error: {name}: is a table of segments, not a recording")


@pytest.mark.parametrize(
    ("target", "named"), [("out", "out/{name}.bvh"), ("walk.glb", "walk/{name}.glb")]
)
def test_several_files_are_told_at_once_how_they_are_named(kineme, target: str, named: str) -> None:
    done = kineme("convert", "a.bvh", "b.bvh", target, code=2)
    assert named in done.stderr.replace("\\", "/")


@pytest.mark.skipif(sys.platform == "win32", reason="signals are others there")
def test_control_c_ends_quietly_with_130(interrupted, tmp_path: Path) -> None:
    head, _, motion = bundled_recording().read_text().partition("Frame Time:")
    time_line, _, frames = motion.partition("\n")
    long = head.replace("Frames: 2898", f"Frames: {40 * 2898}")
    (tmp_path / "a.bvh").write_text(f"{head}Frame Time:{motion}")
    (tmp_path / "b.bvh").write_text(f"{long}Frame Time:{time_line}\n" + 40 * frames)

    def at_work(_: int) -> bool:
        return (tmp_path / "a.csv").exists()  # then the long one is

    command = ("segment", "a.bvh", "b.bvh", "-q", "-o", "{name}.csv")
    assert interrupted(at_work, *command) == (130, "", "")
    assert not list(tmp_path.glob("b.*csv")) + list(tmp_path.glob(".kineme-*"))


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="needs a named pipe")
def test_a_named_pipe_is_not_waited_for(kineme_process, tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "slow.bvh")
    done = kineme_process("segment", "slow.bvh", "-o", "cuts.csv", code=1)
    assert "slow.bvh: is a pipe or a device: save its output to a file first" in done.stderr


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="needs a device that is always full")
def test_what_is_printed_to_a_full_disk_is_one_sentence(tmp_path: Path) -> None:
    with Path("/dev/full").open("w") as full:
        done = subprocess.run(
            [sys.executable, "-m", "kineme", "info", bundled_recording()],
            stdout=full,
            stderr=subprocess.PIPE,
            text=True,
            cwd=tmp_path,
            check=False,
        )
    assert done.returncode == 1
    assert done.stderr == "error: output cannot be written: No space left on device\n"


@pytest.mark.skipif(sys.platform == "win32", reason="there such names are missing files")
@pytest.mark.parametrize("command", ["segment", "library show", "library build --into lib"])
def test_a_name_that_is_too_long_is_one_sentence(kineme_process, command: str) -> None:
    done = kineme_process(*command.split(), "a" * 300, code=1)
    assert done.stderr.startswith("error: " + "a" * 300)
    assert done.stderr.endswith(": File name too long\n")
    assert len(done.stderr.splitlines()) == 1


def test_memory_does_not_grow_with_the_square_of_the_columns() -> None:
    values = np.random.default_rng(0).normal(size=(40, 12_000))
    tracemalloc.start()
    try:
        with pytest.warns(package.KinemeWarning, match="more channels"):
            package.segment(package.Signals(values, 30.0))
        peak = tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()
    assert peak < 12_000**2 * 8 / 4  # a quarter of one matrix of channels × channels


@pytest.mark.skipif(sys.platform != "linux", reason="other systems refuse such names")
def test_a_name_that_is_not_utf8_costs_no_output(kineme, kineme_process, tmp_path) -> None:
    name = os.fsdecode(b"take\xff.bvh")
    package.write(package.read(bundled_recording())[:400], tmp_path / "take.bvh")
    (tmp_path / "take.bvh").rename(tmp_path / name)
    printed = kineme_process("segment", name, "-o", "out.parquet", "--report", "out.html")
    assert "Traceback" not in printed.stderr
    for command in (
        *(f"cycles --ends -o out.{form}" for form in ("csv", "mat", "nc", "xlsx")),
        *("segment --plot out.png", "events -o feet.csv", "report", "split -o clips"),
    ):
        words = command.split()
        kineme(words[0], name, *words[1:], "-q")  # what is printed is of the process alone
        assert all((tmp_path / each).stat().st_size for each in words if "." in each)
