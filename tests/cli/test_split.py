"""``kineme split`` and ``kineme convert`` from file to file."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

import kineme as package
from kineme.datasets import bundled_recording, bundled_truth


def test_split_takes_the_segments_it_would_find(kineme, tmp_path: Path) -> None:
    options = ("--level", "primitive", "--cluster", 1, "--loop")
    done = kineme("split", bundled_recording(), *options, "-o", "clips", errors="")
    manifest = pd.read_csv(tmp_path / "clips" / "manifest.csv")
    rows = package.segment(package.read(bundled_recording())).primitives
    mine = [row for row in rows if row.cluster == 1]
    assert manifest.start_frame.tolist() == [row.start_frame for row in mine]
    assert f"{len(mine)} clips in clips" in done.stdout
    files = sorted(path.name for path in (tmp_path / "clips").glob("*.bvh"))
    assert files == manifest.file.tolist()
    assert {"turn_deg", "x_m", "z_m"} <= set(manifest.columns)


def test_the_best_loops_in_place_straight_and_mirrored(kineme, tmp_path: Path) -> None:
    options = ("--segments", bundled_truth(), "--level", "primitive", "--loop", "--format", "glb")
    kineme("split", bundled_recording(), *options, "--best", 1, "-o", "best", "-q",
           "--root-motion", "in-place", "--straight", "--mirror", errors="")  # fmt: skip
    told = json.loads((tmp_path / "best" / "manifest.json").read_text(encoding="utf-8"))["clips"]
    assert {clip["rank"] for clip in told} == {1}
    assert len({clip["cluster"] for clip in told}) == len(told)
    for clip in told:
        assert clip["changes"] == ["in place", "straight", "mirror"]
        assert clip["root"]["turn_deg_s"] == 0
        motion = package.read(tmp_path / "best" / clip["file"], take=clip["take"])
        assert np.abs(motion.positions[:, 0, [0, 2]].mean(axis=0)).max() < 1e-5
    done = kineme("split", bundled_recording(), "--best", 1, "-o", "more", "-q", code=1)
    assert "best needs loops: add loops (--loop)" in done.stderr


def test_a_file_that_holds_one_clip_is_no_output(kineme, tmp_path: Path) -> None:
    done = kineme("split", bundled_recording(), "-o", "clips.usda", code=2)
    assert "--format usda" in done.stderr
    assert not (tmp_path / "clips.usda").exists()


def test_split_by_labels_that_a_person_corrected(kineme, tmp_path: Path) -> None:
    (tmp_path / "mine.txt").write_text("1.0\t2.0\twalk\n2.0\t5.5\tÄpfel pflücken\n")
    done = kineme(
        "split", bundled_recording(), "--segments", "mine.txt", "-o", "clips", "-q", errors=""
    )
    assert done.stdout == ""
    assert sorted(path.name for path in (tmp_path / "clips").iterdir()) == [
        "exercises_0000_transition.bvh",
        "exercises_0001_walk.bvh",
        "exercises_0002_Äpfel_pflücken.bvh",
        "exercises_0003_transition.bvh",
        "manifest.csv",
        "manifest.json",
    ]
    assert package.read(tmp_path / "clips" / "exercises_0001_walk.bvh").n_frames == 60


@pytest.mark.parametrize(
    ("arguments", "reason"),
    [
        (("--cluster", 99), "no activity is in cluster 99"),
        (("--segments", "none.csv"), "none.csv: cannot be read: No such file"),
        (("--segments", "none"), "none: there is no such file or folder"),
        (("--segments", "short.txt"), "short.txt: has labels up to frame 6000"),
    ],
)
def test_split_says_what_is_wrong_and_leaves_nothing(kineme, tmp_path, arguments, reason) -> None:
    (tmp_path / "short.txt").write_text("0\t100\twalk\n")
    done = kineme("split", bundled_recording(), *arguments, "-o", "clips", code=1)
    assert done.stdout == ""
    assert reason in done.stderr
    assert len(done.stderr.splitlines()) == 1
    assert [path.name for path in tmp_path.iterdir()] == ["short.txt"]


def test_convert_goes_through_every_format_and_back(kineme, tmp_path: Path) -> None:
    truth = package.read_segments(bundled_truth())
    steps = [
        (bundled_truth(), "a.TextGrid", ()),
        ("a.TextGrid", "a.eaf", ("--fps", truth.fps)),
        ("a.eaf", "b.csv", ("--to", "boris")),
        ("b.csv", "a.tsv", ("--from", "boris")),
        ("a.tsv", "a.parquet", ()),
    ]
    for source, target, options in steps:
        done = kineme("convert", source, target, *options)
        assert done.stdout == f"{source} written as {target}\n"
        assert done.stderr == ""
    back = package.read_segments(tmp_path / "a.parquet")
    assert back.table.start_frame.tolist() == truth.table.start_frame.tolist()
    assert back.table.label.tolist() == truth.table.label.tolist()


def test_convert_says_what_a_format_of_one_level_leaves_out(kineme, tmp_path: Path) -> None:
    primitives = len(package.read_segments(bundled_truth()).primitives)
    done = kineme("convert", bundled_truth(), "a.txt")
    left_out = f"note: a.txt holds the activities only, without the {primitives} segments of"
    assert done.stderr.startswith(left_out)
    assert "--level primitive" in done.stderr
    assert (done.stdout, done.stderr.count("\n")) == (f"{bundled_truth()} written as a.txt\n", 1)
    for name, option in (
        ("b.txt", "--quiet"),
        ("c.txt", "--level=primitive"),
        ("c.eaf", "--fps=60"),
    ):
        assert kineme("convert", bundled_truth(), name, option).stderr == ""
    assert len((tmp_path / "c.txt").read_text().splitlines()) == primitives


def test_clips_as_animations_of_a_glb_and_back(kineme, tmp_path: Path) -> None:
    cuts = ("--segments", bundled_truth(), "--cluster", "0")
    kineme("split", bundled_recording(), *cuts, "--format", "glb", "-o", "clips", errors="")
    assert {path.name for path in (tmp_path / "clips").iterdir()} == {
        "exercises.glb",
        "manifest.csv",
        "manifest.json",
    }
    (name, *_) = (tmp_path / "clips" / "manifest.csv").read_text().splitlines()[1].split(",")[-1:]
    kineme("convert", "clips/exercises.glb", "walk.bvh", "--take", name, "-q", errors="")
    assert package.read(tmp_path / "walk.bvh").n_frames == 326
    done = kineme("split", bundled_recording(), *cuts, "--format", "doc", "-o", "more", code=1)
    assert "format is 'doc': motions are written as amc, bvh, csv, fbx, glb" in done.stderr


def test_convert_overwrites_nothing_and_knows_its_formats(kineme, tmp_path: Path) -> None:
    (tmp_path / "mine.eaf").write_text("corrected by hand")
    done = kineme("convert", bundled_truth(), "mine.eaf", code=1)
    assert done.stdout == ""
    assert "mine.eaf: exists already" in done.stderr
    assert (tmp_path / "mine.eaf").read_text() == "corrected by hand"
    done = kineme("convert", bundled_truth(), "mine.srt", "--to", "srt", code=2)
    assert "'srt' is not one of csv, json, parquet, " in done.stderr


def test_convert_turns_a_recording_into_another_format(kineme, tmp_path: Path) -> None:
    kineme("convert", bundled_recording(), "take.amc", "--unit", "cm", errors="")
    kineme("convert", "take.amc", "points.csv", "--fps", "60", errors="")
    before = package.read(bundled_recording(), unit="cm")
    after = package.read(tmp_path / "points.csv")
    assert after.fps == before.fps
    shared = [name for name in before.skeleton.names if name in after.skeleton.names]
    here, there = (
        motion.positions[:, [motion.skeleton.names.index(name) for name in shared]]
        for motion in (before, after)
    )
    assert len(shared) > 20
    assert abs(here - there).max() < 1e-3
    done = kineme("convert", bundled_recording(), "take.mvnx", code=1)
    assert done.stderr.count("\n") == 1


IMU = """# worn on the wrist
frame,time,acc_x,acc_y,acc_z,activity
"""


@pytest.fixture
def imu(tmp_path: Path) -> Path:
    """Twenty seconds of an accelerometer, with columns that are no channels."""
    t = np.arange(1000) / 50
    wave = [np.where(t < 10, np.sin((6 + i) * t), np.cos((11 + i) * t)) for i in range(3)]
    noise = 0.05 * np.random.default_rng(0).standard_normal((3, 1000))
    lines = [
        f"{i},{12 + t[i]:.3f},{x:.7f},{y:.7f},{z:.6e},rest\n"
        for i, (x, y, z) in enumerate((wave + noise).T.tolist())
    ]
    path = tmp_path / "imu.csv"
    path.write_text(IMU + "".join(lines))
    return path


def test_clips_of_signals_are_rows_of_their_file(kineme, tmp_path: Path, imu: Path) -> None:
    kineme("split", imu, "--columns", "acc_x,acc_z", "-o", "clips", errors="")
    kineme("segment", imu, "--columns", "acc_x,acc_z", "-q", "-o", "cuts.csv")
    cuts = package.read_segments(tmp_path / "cuts.csv").activities
    manifest = pd.read_csv(tmp_path / "clips" / "manifest.csv")
    assert manifest.start_frame.tolist() == cuts.start_frame.tolist()
    rows = imu.read_text().removeprefix(IMU).splitlines(keepends=True)
    for clip in manifest.itertuples():
        text = (tmp_path / "clips" / clip.file).read_text()
        assert text == IMU + "".join(rows[clip.start_frame : clip.stop_frame])
    done = kineme("split", imu, "--loop", "-o", "loops", code=1)
    assert "signals have no pose to blend" in done.stderr


def test_signals_are_converted_as_they_are(kineme, tmp_path: Path, imu: Path) -> None:
    done = kineme("convert", imu, "out.csv", errors="")
    assert done.stdout == f"{imu} written as out.csv\n"
    assert kineme("convert", imu, "quiet.csv", "-q").stdout == ""
    assert (tmp_path / "out.csv").read_bytes() == imu.read_bytes()
    kineme("convert", imu, "out.tsv", "--columns", "acc_z,acc_x", errors="")
    lines = [line.split("\t") for line in (tmp_path / "out.tsv").read_text().splitlines()]
    before = [line.split(",") for line in imu.read_text().splitlines()[1:]]
    assert lines == [[row[1], row[4], row[2]] for row in before]
    kineme("convert", imu, "some.csv", "--columns", "acc_[xy],ACC_Z*", errors="")
    lines = [line.split(",") for line in (tmp_path / "some.csv").read_text().splitlines()]
    assert lines == [[row[1], row[2], row[3], row[4]] for row in before]
    done = kineme("convert", imu, "out.bvh", code=1)
    assert "cannot write signals with the suffix '.bvh': use one of .csv" in done.stderr


def test_channels_of_other_files_become_tables(kineme, tmp_path: Path, imu: Path) -> None:
    table = pd.read_csv(imu, comment="#")
    table.to_parquet(tmp_path / "imu.parquet")
    header = f"imu\nnRows={len(table)}\nnColumns=3\nendheader\n"
    motion = table[["time", "acc_x", "acc_y"]].to_csv(sep="\t", index=False)
    (tmp_path / "imu.mot").write_text(header + motion)
    (tmp_path / "mine.txt").write_text("0\t2\twave\n")
    for suffix in (".parquet", ".mot"):
        name = f"clips{suffix}"
        kineme("split", f"imu{suffix}", "--segments", "mine.txt", "-q", "-o", name, errors="")
    clip = pd.read_parquet(tmp_path / "clips.parquet" / "imu_0000_wave.parquet")
    pd.testing.assert_frame_equal(clip, table.iloc[:100])
    clip = (tmp_path / "clips.mot" / "imu_0000_wave.mot").read_text()
    assert clip == header.replace("=1000", "=100") + "".join(motion.splitlines(True)[:101])
    kineme("convert", "imu.mot", "mot.csv", errors="")
    assert (tmp_path / "mot.csv").read_text() == motion.replace("\t", ",")
