"""The studio of a small folder: asked directly, and as a process as people run it."""

from __future__ import annotations

import os
import re
import shutil
import signal
import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import httpx2 as httpx
import pytest
from starlette.testclient import TestClient

from kineme.datasets import bundled_recording
from kineme.studio.app import create_app
from kineme.studio.events import Hub
from kineme.studio.folder import Folder, file_id

TOKEN, PORT = "the token", 8750
FRAMES = 240

Answer = httpx.Response


@pytest.fixture(scope="session")
def short_recording(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Four seconds of the bundled recording."""
    lines = bundled_recording().read_text().splitlines()
    start = next(i for i, line in enumerate(lines) if line.startswith("Frames:"))
    lines[start] = f"Frames: {FRAMES}"
    path = tmp_path_factory.mktemp("recordings") / "take.bvh"
    path.write_text("\n".join(lines[: start + 2 + FRAMES]) + "\n")
    return path


@pytest.fixture
def folder(tmp_path: Path, short_recording: Path) -> Path:
    """A folder with one recording, in a folder with a secret."""
    (tmp_path / "secret.bvh").write_text("HIERARCHY secret")
    place = tmp_path / "folder"
    place.mkdir()
    shutil.copy(short_recording, place / "take.bvh")
    return place


class Studio:
    """A client of a studio, and the recording in its folder."""

    def __init__(self, client: httpx.Client, folder: Path):
        self.client, self.folder = client, folder
        self.path = folder / "take.bvh"
        self.table = folder / "take.segments.json"
        self.id = file_id(self.path)

    def get(self, address: str, **options: Any) -> Answer:
        return self.client.get(address, **options)

    def recording(self) -> dict[str, Any]:
        answer = self.get(f"/api/recordings/{self.id}")
        assert answer.status_code == 200, answer.text
        message: dict[str, Any] = answer.json()
        return message

    def edit(self, revision: int, kind: str, **rest: Any) -> Answer:
        sent = {"revision": revision, "edit": {"kind": kind, **rest}}
        return self.client.post(f"/api/recordings/{self.id}/edits", json=sent)

    def done(self, revision: int, kind: str, **rest: Any) -> dict[str, Any]:
        answer = self.edit(revision, kind, **rest)
        assert answer.status_code == 200, answer.text
        message: dict[str, Any] = answer.json()
        return message

    def starts(self, level: str = "activity") -> list[int]:
        rows = self.recording()["segmentation"]["segments"]
        return [row["start_frame"] for row in rows if row["level"] == level]


@pytest.fixture
def make_studio(folder: Path) -> Iterator[Callable[..., Studio]]:
    """A studio asked without a network; options are those of ``create_app``."""
    clients = []

    def make(files: list[Path] | None = None, **options: Any) -> Studio:
        app = create_app(Folder(folder, files), token=TOKEN, port=PORT, hub=Hub(), **options)
        client = TestClient(
            app,
            base_url=f"http://127.0.0.1:{PORT}",
            headers={"x-kineme-token": TOKEN},
            raise_server_exceptions=False,
        )
        clients.append(client)
        return Studio(client, folder)

    yield make
    for client in clients:
        client.close()


@pytest.fixture
def studio(make_studio: Callable[..., Studio]) -> Studio:
    return make_studio()


class Process(Studio):
    """``kineme studio`` on a free port."""

    def __init__(self, folder: Path, *arguments: str):
        self.process = subprocess.Popen(
            [sys.executable, "-m", "kineme.cli", "studio", str(folder), "--no-browser"]
            + (["--port", "0"] if "--port" not in arguments else [])
            + list(arguments),
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
            env={**os.environ, "PYTHONUNBUFFERED": "1"},
        )
        assert self.process.stdout is not None
        self.said = self.process.stdout.readline()
        found = re.search(r"(http://127\.0\.0\.1:(\d+)/)\?token=(\S+)", self.said)
        if found is None:
            self.said, errors = self.process.communicate(timeout=30)
            raise RuntimeError(errors)
        self.address, self.port, self.token = found[1], int(found[2]), found[3]
        headers = {"x-kineme-token": self.token}
        super().__init__(httpx.Client(base_url=self.address, headers=headers, timeout=60), folder)

    def end(self, how: int = signal.SIGINT) -> tuple[int, str, str]:
        """End it; exit code and what else it said."""
        self.process.send_signal(how)
        rest, errors = self.process.communicate(timeout=30)
        self.client.close()
        return self.process.returncode, rest, errors


@pytest.fixture
def start(folder: Path) -> Iterator[Callable[..., Process]]:
    """Start a studio of the folder."""
    started: list[Process] = []

    def run(*arguments: str) -> Process:
        started.append(Process(folder, *arguments))
        return started[-1]

    yield run
    for studio in started:
        if studio.process.poll() is None:
            studio.process.kill()
            studio.process.communicate()
        studio.client.close()
