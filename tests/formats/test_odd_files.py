"""Unusual but valid files: pipes, leap seconds, labels between semicolons, kineme's own arrays."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

import kineme
from kineme.errors import ReadError
from kineme.formats.listing import scan_folder
from kineme.recordings.times import parse_date


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="there are no pipes with names")
@pytest.mark.parametrize("suffix", [".bvh", ".csv", ".json", ".npz"])
def test_a_pipe_is_not_waited_for(tmp_path: Path, suffix: str) -> None:
    path = tmp_path / f"a{suffix}"
    os.mkfifo(path)
    for reader in (kineme.read, kineme.read_segments, kineme.KnowledgeBase.load):
        with pytest.raises(ReadError, match="is a pipe|are stored as"):
            reader(path)
    assert scan_folder(tmp_path).recordings == []


def test_a_leap_second(tmp_path: Path) -> None:
    assert parse_date("2016-12-31T23:59:60.5Z") == parse_date("2017-01-01T00:00:00.5Z")
    assert parse_date("23:59:60") == 86400
    assert parse_date("T09:30:00") == parse_date("09:30:00") == 34200
    with pytest.raises(ValueError, match="is not an ISO date"):
        parse_date("23:59:61")
    seconds = [58.0, 58.5, 59.0, 59.5, 60.0, 60.5]
    rows = "".join(f"2016-12-31T23:59:{second:04.1f}Z,{i}.5\n" for i, second in enumerate(seconds))
    (tmp_path / "a.csv").write_text("time,acc_x\n" + rows)
    found = kineme.read(tmp_path / "a.csv")
    assert (found.fps, found.n_frames, found.gaps) == (2, 6, ())


def test_what_kineme_wrote_keeps_its_unit_whatever_is_said_of_its_axis(tmp_path: Path) -> None:
    motion = kineme.read(kineme.bundled_recording())[:30]
    kineme.write(motion, tmp_path / "own.npz")
    for options in ({"up": "y"}, {"unit": "m"}, {"unit": "m", "up": "y"}):
        found = kineme.read(tmp_path / "own.npz", **options)
        assert (found.positions == motion.positions).all()
        assert found.rotations is not None
    turned = kineme.read(tmp_path / "own.npz", up="z")
    assert not any("unit" in note for note in turned.provenance.notes)
