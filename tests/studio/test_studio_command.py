"""``kineme studio``: what it cannot serve is one sentence."""

from __future__ import annotations

from pathlib import Path

from typer.testing import CliRunner

import kineme
from kineme.cli.app import app


def refused(*arguments: object) -> str:
    done = CliRunner().invoke(app, ["studio", "--no-browser", *map(str, arguments)])
    assert done.exit_code == 1, done.output
    assert done.stderr.count("\n") == 1
    return done.stderr


def test_what_is_not_there_is_said(folder: Path) -> None:
    assert "nowhere: there is no such file or folder" in refused(folder / "nowhere")
    assert "is a folder: give one folder, or files" in refused(folder, folder / "take.bvh")
    assert "from 0 to 65535, not 99999" in refused(folder, "--port", 99999)


def test_what_files_do_not_say_can_be_said(start) -> None:
    studio = start("--fps", "30", "--unit", "inch", "--effectors", "head=Neck")
    message = studio.recording()
    assert (message["fps"], message["segmentation"]["fps"]) == (30, 30)
    given = kineme.read(studio.path, fps=30, unit="inch")
    expected = kineme.segment(given, effectors={"head": "Neck"})
    starts = expected.activities.start_frame.tolist()
    assert studio.starts() == starts
    notes = message["segmentation"]["provenance"]["notes"]
    assert notes == expected.provenance["notes"]


def test_what_no_file_could_mean_is_said_at_once(folder: Path) -> None:
    done = CliRunner().invoke(app, ["studio", "--no-browser", str(folder), "--unit", "feet"])
    assert done.exit_code == 2
    assert "feet" in done.stderr
