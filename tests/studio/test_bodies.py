"""Requests that come slowly or break off: an answer or none, and no traceback."""

from __future__ import annotations

import asyncio
import signal
import socket
from typing import Any

import pytest
from starlette.requests import Request

from kineme.studio.http import bodies


def test_a_request_that_does_not_go_on_is_given_up(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(bodies, "SLOWEST", 0.05)
    pieces: list[dict[str, Any]] = [{"type": "http.request", "body": b"{", "more_body": True}]

    async def receive() -> dict[str, Any]:
        if not pieces:
            await asyncio.sleep(60)
        return pieces.pop()

    with pytest.raises(bodies.TooSlowError, match="nothing came for 0.05 s"):
        asyncio.run(bodies.body(Request({"type": "http"}, receive)))


def test_an_edit_that_breaks_off_leaves_no_traceback(start) -> None:
    studio = start()
    name = studio.recording()["id"]
    with socket.create_connection(("127.0.0.1", studio.port), timeout=20) as line:
        head = (
            f"POST /api/recordings/{name}/edit HTTP/1.1\r\n"
            f"Host: 127.0.0.1:{studio.port}\r\nX-Kineme-Token: {studio.token}\r\n"
            "Content-Type: application/json\r\nContent-Length: 1000\r\n\r\n"
        )
        line.sendall(head.encode() + b"{")
    assert studio.get("/api/state").status_code == 200
    code, _, errors = studio.end(signal.SIGINT)
    assert (code, errors) == (0, "")
