"""The studio of a small folder: asked directly, and as a process as people run it."""

from __future__ import annotations

import shutil
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
from starlette.testclient import TestClient
from studio_clients import PORT, TOKEN, Process, Studio

from kineme.datasets import bundled_recording
from kineme.studio.folder import Folder
from kineme.studio.http.events import Hub
from kineme.studio.open_recordings import OpenRecordings
from kineme.studio.routes import create_app

FRAMES = 240


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


@pytest.fixture
def make_studio(folder: Path) -> Iterator[Callable[..., Studio]]:
    """A studio asked without a network; options are those of ``create_app``."""
    clients = []

    def make(files: list[Path] | None = None, **options: Any) -> Studio:
        hub = Hub()
        recordings = OpenRecordings(Folder(folder, files), hub.tell)
        app = create_app(recordings, token=TOKEN, port=PORT, hub=hub, **options)
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


@pytest.fixture
def start(folder: Path) -> Iterator[Callable[..., Process]]:
    """Start a studio of the folder."""
    started: list[Process] = []

    def run(*arguments: str) -> Process:
        started.append(Process(folder, *arguments))
        return started[-1]

    yield run
    for studio in started:
        studio.server.kill()
        studio.client.close()


@pytest.fixture(autouse=True)
def _segments_are_there(monkeypatch: pytest.MonkeyPatch) -> None:
    """Answers come with segments, though the first ones take longer while code is compiled."""
    monkeypatch.setattr("kineme.studio.open_recording.FIRST_WAIT_S", 300.0)
