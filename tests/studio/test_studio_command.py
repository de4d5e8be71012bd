"""``kineme studio``: what it cannot serve is one sentence."""

from __future__ import annotations

from pathlib import Path

from typer.testing import CliRunner

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
