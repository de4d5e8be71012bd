"""Recordings without a skeleton on the command line."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

import kineme as package


@pytest.fixture
def phone(tmp_path: Path) -> Path:
    """Ten seconds of circles, then of eights, as a phone logs them, and a muscle."""
    t = np.arange(2000) / 100
    rng = np.random.default_rng(0)
    switch = t < 10
    x = np.where(switch, np.sin(6 * t), np.sin(22 * t)) + 0.05 * rng.standard_normal(len(t))
    y = np.where(switch, np.cos(6 * t), np.cos(11 * t)) + 0.05 * rng.standard_normal(len(t))
    muscle = np.clip(np.sin(6 * t), 0, None) * rng.standard_normal(len(t))
    path = tmp_path / "phone.csv"
    values = np.column_stack([t, x, y, muscle])
    np.savetxt(path, values, "%.5f", ",", header="time,acc_x,acc_y,biceps", comments="")
    return path


def test_sensors_are_segmented_as_they_are(kineme, tmp_path, phone) -> None:
    done = kineme("segment", phone, "-o", "cuts.csv", "--plot", "cuts.png", errors="")
    assert "2000 frames at 100 Hz, sensors" in done.stdout
    assert "note: channels: acc_x, acc_y, biceps" in done.stdout
    written = package.read_segments(tmp_path / "cuts.csv")
    assert np.abs(written.cuts() - 1000).min() <= 50
    assert (tmp_path / "cuts.png").stat().st_size > 10_000


def test_columns_rate_and_constants_are_options(kineme, phone) -> None:
    options = ("--columns", "acc_y, acc_x", "--fps", "50", "--preset", "krueger2017")
    done = kineme("segment", phone, *options, "--set", "radius=0.3", "--json")
    data = json.loads(done.stdout)
    assert data["provenance"]["parameters"]["radius"] == 0.3
    assert data["provenance"]["notes"][0].startswith("channels: acc_y, acc_x,")
    same = package.segment(
        package.read(phone, columns=["acc_y", "acc_x"], fps=50), preset="krueger2017", radius=0.3
    )
    assert [row["stop_frame"] for row in data["segments"]] == same.table.stop_frame.tolist()


def test_muscles_are_taken_as_envelopes(kineme, phone) -> None:
    done = kineme("segment", phone, "--columns", "biceps", "--emg")
    assert "note: muscle signals: rectified and low-passed" in done.stdout


def test_info_lists_the_channels(kineme, phone) -> None:
    done = kineme("info", phone)
    assert "3: acc_x, acc_y, biceps" in done.stdout
    assert "2000 frames at 100 Hz, 20.00 s" in done.stdout
    facts = json.loads(kineme("info", phone, "--columns", "biceps", "--json").stdout)
    assert facts["channels"] == ["biceps"]


def test_many_channels_are_a_line_each_where_nothing_is_wrapped(kineme, tmp_path) -> None:
    names = [f"sensor_{i}_acceleration" for i in range(262)]
    values = np.random.default_rng(0).normal(size=(60, 262))
    wide = tmp_path / "wide.csv"
    np.savetxt(wide, values, "%.3f", ",", header=",".join(names), comments="")
    done = kineme("info", wide, "--fps", 30)
    lines = done.stdout.splitlines()
    assert "channels  262, below" in lines
    assert [line for line in lines if line.startswith("sensor_")] == names
    kineme("convert", wide, "wide.tsv", "--fps", 30)
    head = (tmp_path / "wide.tsv").read_text().splitlines()[0].split("\t")
    assert head[-262:] == names


def test_what_is_missing_is_one_sentence(kineme, tmp_path, phone) -> None:
    done = kineme("segment", phone, "--columns", "acc_q", code=1)
    assert done.stderr.strip().endswith("no column 'acc_q'; there are time, acc_x, acc_y, biceps")
    (tmp_path / "bare.txt").write_text("1\n2\n3\n")
    done = kineme("segment", "bare.txt", code=1)
    assert done.stderr.strip() == (
        "error: bare.txt: it does not state its frame rate: give fps (--fps)"
    )
    kineme("segment", phone, "--columns", ",", code=2)


def test_force_plates_are_no_muscles(kineme, data_dir) -> None:
    done = kineme("segment", data_dir / "formats" / "Eb015pr.c3d", "--emg", code=1)
    assert "which analog channels are muscles" in " ".join(done.stderr.split())


def test_a_result_is_scored_though_its_recording_was_read_otherwise(kineme, tmp_path, phone):
    table = phone.read_text().splitlines()
    (tmp_path / "bare.csv").write_text("\n".join(line.split(",", 1)[1] for line in table))
    (tmp_path / "truth.csv").write_text("start_s,stop_s,label\n0,20,slow\n20,40,fast\n")
    kineme("segment", "bare.csv", "--fps", 50, "-q", "-o", "cuts.csv")
    done = kineme("evaluate", "cuts.csv", "--against", "truth.csv", errors="")
    assert "border F1" in done.stdout
