"""``kineme studio``: what it cannot serve is one sentence."""

from __future__ import annotations

import socket
from pathlib import Path

import httpx2 as httpx
import pytest
from typer.testing import CliRunner

import kineme
from kineme.cli.app import app
from kineme.studio.http.security import DEVELOPMENT


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
    with pytest.warns(kineme.KinemeWarning, match="Hz; 30 is used"):
        given = kineme.read(studio.path, fps=30, unit="inch")
    expected = kineme.segment(given, effectors={"head": "Neck"})
    starts = expected.activities.start_frame.tolist()
    assert studio.starts() == starts
    notes = message["segmentation"]["provenance"]["notes"]
    assert notes == expected.provenance["notes"]


def test_pages_from_their_sources_may_ask_and_a_port_in_use_is_refused(start) -> None:
    with socket.create_server(("127.0.0.1", 0)) as free:
        port = free.getsockname()[1]
    studio = start("--dev", "--port", str(port))
    assert studio.address == f"{DEVELOPMENT}/"
    headers = {"x-kineme-token": studio.token, "origin": DEVELOPMENT}
    answer = httpx.get(f"http://127.0.0.1:{port}/api/state", headers=headers, timeout=300)
    assert answer.status_code == 200
    with pytest.raises(RuntimeError, match=f"port {port} is not available"):
        start("--port", str(port))
