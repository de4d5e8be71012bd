"""Those who ask a studio: directly, and over the network as it is run."""

from __future__ import annotations

import signal
import time
from pathlib import Path
from typing import Any

import httpx2 as httpx

from kineme.studio.storage.sidecars import make_file_id
from studio_server import StudioServer

TOKEN, PORT = "the token", 8750
Answer = httpx.Response


class Studio:
    """A client of a studio, and the recording in its folder."""

    def __init__(self, client: httpx.Client, folder: Path):
        self.client, self.folder = client, folder
        self.path = folder / "take.bvh"
        self.table = folder / "take.segments.json"
        self.id = make_file_id(self.path)

    @property
    def one(self) -> str:
        """Return the address of the recording."""
        return f"/api/recordings/{self.id}"

    def get(self, address: str, **options: Any) -> Answer:
        return self.client.get(address, **options)

    def post(self, address: str, sent: object, **options: Any) -> Answer:
        return self.client.post(address, json=sent, **options)

    def state(self) -> dict[str, Any]:
        state: dict[str, Any] = self.get("/api/state").json()
        return state

    def ids(self) -> dict[str, str]:
        """Return the recordings of the folder by name."""
        return {listed["name"]: listed["id"] for listed in self.state()["recordings"]}

    def choose(self, name: str) -> Studio:
        """Return a client for the recording that the folder lists by this name."""
        chosen = Studio(self.client, self.folder)
        chosen.path, chosen.id = self.folder / name, self.ids()[name]
        return chosen

    def recording(self) -> dict[str, Any]:
        """The recording with its segments, which a busy machine may find later."""
        while True:
            answer = self.get(self.one)
            assert answer.status_code == 200, answer.text
            message: dict[str, Any] = answer.json()
            if not message.get("finding"):
                return message
            time.sleep(0.1)

    def edit(self, revision: int, kind: str, **rest: Any) -> Answer:
        sent = {"revision": revision, "edit": {"kind": kind, **rest}}
        return self.post(f"{self.one}/edits", sent)

    def apply(self, kind: str, **rest: Any) -> dict[str, Any]:
        """Edit the present table; return what the edit made, and the table that it left."""
        answer = self.edit(self.recording()["revision"], kind, **rest)
        assert answer.status_code == 200, answer.text
        message: dict[str, Any] = answer.json()
        return {**message, "segmentation": self.recording()["segmentation"]}

    def starts(self, level: str = "activity") -> list[int]:
        rows = self.recording()["segmentation"]["segments"]
        return [row["start_frame"] for row in rows if row["level"] == level]


def change_rows(rows: list[dict[str, Any]], change: dict[str, Any]) -> list[dict[str, Any]]:
    """Return the rows that a change makes of others, as the page does."""
    left = {(row["level"], row["start_frame"]): row for row in rows}
    for place in change["removed"]:
        del left[tuple(place)]
    left |= {(row["level"], row["start_frame"]): row for row in change["rows"]}
    activities = [start for level, start in left if level == "activity"]
    return [
        {**left[place], "activity": sum(start <= place[1] for start in activities) - 1}
        for place in sorted(left)
    ]


class Process(Studio):
    """A client of ``kineme studio`` on a free port."""

    def __init__(self, folder: Path, *options: str):
        self.server = StudioServer(folder, *options)
        self.server.start()
        self.said, self.address = self.server.said, self.server.root
        self.port, self.token = self.server.port, self.server.token
        headers = {"x-kineme-token": self.token}
        # Where code is compiled for the first time, a busy machine takes minutes to answer.
        super().__init__(httpx.Client(base_url=self.address, headers=headers, timeout=600), folder)

    def end(self, how: int = signal.SIGINT) -> tuple[int, str, str]:
        """End it; exit code and what else it said."""
        ended = self.server.end(how)
        self.client.close()
        return ended
