"""Several recordings, in folders and deeper: one rule for every command."""

from __future__ import annotations

import errno
import json
import os
import shutil
from pathlib import Path

import numpy as np
import pytest

import kineme as package
from kineme._util import files as _files
from kineme.cli.files import choose_files
from kineme.datasets import bundled_recording
from kineme.recordings.operations import cut

SHORT = (
    "HIERARCHY\nROOT Hips\n{\nOFFSET 0 0 0\nCHANNELS 3 Zrotation Xrotation Yrotation\n"
    "End Site\n{\nOFFSET 0 90 0\n}\n}\nMOTION\nFrames: 40\nFrame Time: 0.02\n" + "0 0 0\n" * 40
)
UNIT = ("--unit", "cm")


@pytest.fixture
def takes(tmp_path: Path) -> Path:
    """Two recordings of one name in two folders, a broken one, and one deeper."""
    for place in ("a", "b", "b/deep"):
        (tmp_path / "takes" / place).mkdir(parents=True)
        (tmp_path / "takes" / place / "take.bvh").write_text(SHORT)
    (tmp_path / "takes" / "b" / "broken.bvh").write_text("HIERARCHY")
    return tmp_path / "takes"


def files_under(folder: Path, pattern: str = "*.csv") -> list[str]:
    return sorted(path.relative_to(folder).as_posix() for path in folder.rglob(pattern))


def test_one_name_in_two_folders_is_told_apart(kineme, tmp_path, takes) -> None:
    done = kineme("segment", "takes", "-r", "-q", *UNIT, "-o", "cuts")
    assert done.stderr.count("skipped: takes/b/broken.bvh") == 1
    assert files_under(tmp_path / "cuts") == ["a_take.csv", "b_take.csv", "deep_take.csv"]
    kineme("segment", "takes", "-r", "-q", *UNIT, "-o", "out/{parent}/{name}.csv")
    assert files_under(tmp_path / "out") == ["a/take.csv", "b/take.csv", "deep/take.csv"]
    done = kineme("report", "takes", "-r", "-q", *UNIT, "--segments", "cuts", "-o", "pages")
    assert len(files_under(tmp_path / "pages", "*.html")) == 3


def test_a_skeleton_beside_its_motion_is_no_recording_of_its_own(kineme, tmp_path) -> None:
    package.write(cut(package.read(bundled_recording()), 0, 60), tmp_path / "walk.amc")
    assert (tmp_path / "walk.asf").exists()
    for given in ((tmp_path,), ("walk.asf", "walk.amc"), ("walk.amc", "walk.asf")):
        done = kineme("info", *given, "--json", errors="")
        (facts,) = map(json.loads, done.stdout.splitlines())
        assert facts["format"] == "AMC"
    (tmp_path / "walk.amc").unlink()
    done = kineme("info", tmp_path, code=1)
    assert "a skeleton (.asf) needs the motion (.amc) beside it" in done.stderr
    kineme("info", "walk.asf", code=1)


def test_links_to_nothing_are_said_and_standard_input_is_refused(kineme, tmp_path, takes) -> None:
    (tmp_path / "linked").mkdir()
    (tmp_path / "linked" / "good.bvh").symlink_to(takes / "a" / "take.bvh")
    (tmp_path / "linked" / "gone.bvh").symlink_to(tmp_path / "nowhere.bvh")
    done = kineme("info", "linked", *UNIT, "--json")
    assert len(done.stdout.splitlines()) == 1
    assert done.stderr == "skipped: linked/gone.bvh: is a link to a missing file\n"
    done = kineme("segment", "-", code=2)
    assert "cannot be read from standard input" in done.stderr


def test_folders_deeper_down_and_their_like_are_told_apart_too() -> None:
    inputs = [Path("/y/a/take.bvh"), Path("/y/a/take.trc"), Path("/y/b.trc")]
    named = [path.name for path in choose_files("-o", Path("{name}.csv"), inputs)]
    assert named == ["take_bvh.csv", "take_trc.csv", "b.csv"]
    two = [Path("/x/a/take.bvh"), Path("/y/a/take.bvh")]
    assert choose_files("-o", Path("{parent}/{name}.csv"), two) == [
        Path("x_a/take.csv"),
        Path("y_a/take.csv"),
    ]


def test_what_is_named_and_fails_is_an_error_what_is_found_is_skipped(kineme, takes) -> None:
    done = kineme("info", "takes/b", *UNIT, "--json")
    assert len(done.stdout.splitlines()) == 1
    assert [line.split(":")[0] for line in done.stderr.splitlines()] == ["skipped", "skipped"]
    assert "takes/b: --recursive looks into its folders (deep)" in done.stderr
    done = kineme("info", "takes/b/broken.bvh", "takes/a", *UNIT, "--json", code=1)
    assert len(done.stdout.splitlines()) == 1
    assert done.stderr.startswith("error: takes/b/broken.bvh")
    (takes / "b" / "take.bvh").unlink()
    kineme("info", "takes/b", "takes/a", *UNIT, "--json", code=1)
    done = kineme("info", "takes", code=1)
    assert "there is no recording in this folder; --recursive looks into its folders (a, b)" in (
        done.stderr
    )


def test_a_numbered_json_makes_no_video_of_a_folder(kineme, tmp_path, takes) -> None:
    (takes / "a" / "notes_1.json").write_text('{"subject": 1}')
    done = kineme("info", "takes/a", *UNIT, "--json")
    assert json.loads(done.stdout)["frames"] == 40
    frame = {"people": [{"pose_keypoints_2d": [1.0] * 75}]}
    (takes / "a" / "video_1_keypoints.json").write_text(json.dumps(frame))
    done = kineme("info", "takes/a", *UNIT, "--json")
    assert json.loads(done.stdout)["frames"] == 40
    assert "1 frame of OpenPose next to other recordings" in done.stderr


def test_every_command_takes_folders(kineme, tmp_path: Path) -> None:
    motion = cut(package.read(bundled_recording(), unit="cm"), 0, 900)
    truth = package.Segmentation.from_columns(
        {"level": ["activity"], "kind": ["activity"], "start_frame": [0], "stop_frame": [900],
         "label": ["walk"]}, n_frames=900, fps=60.0)  # fmt: skip
    for place in ("a", "b"):
        (tmp_path / "takes" / place).mkdir(parents=True)
        package.write(motion, tmp_path / "takes" / place / "take.bvh")
    (tmp_path / "takes" / "broken.bvh").write_text("")
    (tmp_path / "cuts").mkdir()
    for name in ("a_take", "b_take"):
        package.write_segments(truth, tmp_path / "cuts" / f"{name}.json")
    given = ("takes", "--recursive", "-q", *UNIT)
    for arguments in (
        ("split", *given, "--segments", "cuts", "-o", "clips"),
        ("label", *given, "--labels", "cuts", "--knowledge", "base.npz"),
        ("transfer", *given, "--knowledge", "base.npz", "-o", "named"),
        ("graph", *given, "--threshold", 0.3, "-o", "graph.json"),
        ("convert", "takes", "-r", *UNIT, "trc/{parent}.trc"),
    ):
        done = kineme(*arguments)
        assert "skipped: takes/broken.bvh: the file is empty" in done.stderr
    assert {path.name for path in (tmp_path / "clips").iterdir()} == {"a_take", "b_take"}
    assert files_under(tmp_path / "named") == ["a_take.csv", "b_take.csv"]
    assert files_under(tmp_path / "trc", "*") == ["a.trc", "b.trc"]
    assert len(json.loads((tmp_path / "graph.json").read_text())["sources"]) == 2


def test_commands_for_motions_refuse_signals(kineme, tmp_path: Path) -> None:
    rows = np.column_stack([np.arange(90) / 30, *np.random.default_rng(0).normal(size=(3, 90))])
    np.savetxt(
        tmp_path / "imu.csv", rows, "%.3f", ",", header="time,acc_x,acc_y,acc_z", comments=""
    )
    shutil.copy(bundled_recording(), tmp_path / "take.bvh")
    done = kineme("graph", "imu.csv", "-o", "graph.json", code=1)
    assert done.stderr == (
        "error: imu.csv: holds signals without a skeleton, but a motion is needed\n"
    )


@pytest.mark.parametrize(
    "option", [("-o", "out/{name}.json"), ("--plot", "out"), ("--report", "out")]
)
def test_a_result_that_cannot_be_written_is_an_error_whatever_else_was(
    kineme, takes, monkeypatch, option
) -> None:
    """On a disk with room for one of two files."""
    whole, room = _files._flush_to_disk, [None, None]  # of a file, and of its name in the folder

    def full(place: Path) -> None:
        if not room:
            raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
        room.pop()
        whole(place)

    home = takes / "a"
    motion = cut(package.read(bundled_recording()), 0, 400)
    for name in ("one", "other"):
        package.write(motion, home / f"{name}.bvh")
    (home / "take.bvh").unlink()
    monkeypatch.setattr(_files, "_flush_to_disk", full)
    done = kineme("segment", "takes/a", "-q", *option, code=1)
    assert len(list(Path("out").iterdir())) == 1
    (line,) = done.stderr.splitlines()
    assert line.startswith("error: takes/a/other.bvh: ")
    assert line.endswith("cannot be written: No space left on device")
