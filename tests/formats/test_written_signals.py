"""Written signals read back with the same rate, names and values, or are refused."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import kineme
from kineme import Signals
from kineme.clips.split import write_clips
from kineme.errors import WriteError
from kineme.formats import write
from reading import read
from segmentations import make_activities

VALUES = np.random.default_rng(0).normal(size=(30, 2))
TIMES = [f"{i / 50}" for i in range(30)]


def to_lines(mark: str = ",", *, timed: bool) -> str:
    rows = ([*([time] if timed else []), *map(repr, row)]
            for time, row in zip(TIMES, VALUES.tolist(), strict=True))  # fmt: skip
    return "".join(mark.join(row) + "\n" for row in rows)


FILES = {
    "times.csv": "time,a,b\n" + to_lines(timed=True),
    "units.csv": "Logger 5\n\ntime,a,b\ns,g,g\n" + to_lines(timed=True),
    "rates.csv": "rate,a,b\n"
    + "".join(f"50,{row}\n" for row in to_lines(timed=False).splitlines()),
    "no_times.csv": "a,b\n" + to_lines(timed=False),
    "no_names.csv": to_lines(timed=False),
    "tabs.tsv": "a\tb\n" + to_lines("\t", timed=False),
    "angles.mot": "x\nversion=1\nnRows=30\nnColumns=3\nendheader\ntime\ta\tb\n"
    + to_lines("\t", timed=True),
}


@pytest.mark.parametrize("name", FILES)
@pytest.mark.parametrize("fps", [25.0, 50.0])
@pytest.mark.parametrize("suffix", [".csv", ".tsv", ".parquet"])
def test_the_rate_that_was_given_is_in_what_is_written(
    tmp_path: Path, name: str, fps: float, suffix: str
) -> None:
    given = read(tmp_path, name, FILES[name], fps=fps)
    write(given, tmp_path / f"new{suffix}")
    found = kineme.read(tmp_path / f"new{suffix}")
    assert (found.fps, found.names) == (fps, given.names)
    assert (found.values == VALUES).all()


def test_rows_whose_times_are_right_stay_as_they_are(tmp_path: Path) -> None:
    write(read(tmp_path, "units.csv", FILES["units.csv"]), tmp_path / "new.csv")
    assert (tmp_path / "new.csv").read_text() == FILES["units.csv"]


def test_parquet_at_another_rate(tmp_path: Path) -> None:
    write(Signals(VALUES, 50, ["a", "b"]), tmp_path / "a.parquet")
    write(kineme.read(tmp_path / "a.parquet", fps=25), tmp_path / "b.parquet")
    assert kineme.read(tmp_path / "b.parquet").fps == 25


def test_a_mot_whose_times_are_of_another_rate_is_refused(tmp_path: Path) -> None:
    given = read(tmp_path, "a.mot", FILES["angles.mot"], fps=25)
    with pytest.raises(WriteError, match="its own times have another rate"):
        write(given, tmp_path / "b.mot")


@pytest.mark.parametrize("n", [1, 2, 3])
@pytest.mark.parametrize("suffix", [".csv", ".tsv", ".parquet"])
@pytest.mark.parametrize("names", [["a", "b"], ["1", "2"], ["=1+1", "-b"], ["'=a", "@b"]])
def test_few_rows(tmp_path: Path, n: int, suffix: str, names: list[str]) -> None:
    write(Signals(VALUES[:n], 50, names), tmp_path / f"few{suffix}")
    found = kineme.read(tmp_path / f"few{suffix}")
    assert (found.fps, list(found.names)) == (50, names)
    assert (found.values == VALUES[:n]).all()
    if suffix != ".parquet":
        head = (tmp_path / f"few{suffix}").read_text().replace("\t", ",").splitlines()[0]
        assert not [name for name in head.split(",") if name.startswith(("=", "+", "-", "@"))]


@pytest.mark.parametrize("name", ["times.csv", "no_times.csv", "angles.mot"])
def test_a_clip_of_one_row(tmp_path: Path, name: str) -> None:
    signals = read(tmp_path, name, FILES[name], fps=50)
    rows = list(make_activities(5, 6, 30, fps=50))
    for row, clip in zip(rows, write_clips([(signals, rows)], tmp_path / "clips"), strict=True):
        found = kineme.read(clip)
        assert found.fps == 50
        assert (found.values == VALUES[row.start_frame : row.stop_frame]).all()


@pytest.mark.parametrize("suffix", [".csv", ".tsv"])
def test_a_motion_of_one_frame(tmp_path: Path, suffix: str) -> None:
    motion = kineme.read(kineme.bundled_recording())[:1]
    write(motion, tmp_path / f"a{suffix}")
    found = kineme.read(tmp_path / f"a{suffix}")
    assert (found.n_frames, found.fps) == (1, motion.fps)


@pytest.mark.parametrize(("n_frames", "fps"), [(10**9, 1e-6), (10**15, 1.0), (9, 1e9)])
def test_what_no_label_format_can_tell_is_no_segmentation(n_frames: int, fps: float) -> None:
    with pytest.raises(ValueError, match="a recording cannot last|frame rate must be"):
        make_activities(n_frames, fps=fps)
