"""Requests that come slowly or break off: an answer or none, and no traceback."""

from __future__ import annotations

import asyncio
from typing import Any

import pytest
from starlette.requests import Request

from kineme.studio.http import bodies


def test_a_request_that_does_not_go_on_is_given_up(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(bodies, "CHUNK_TIMEOUT_S", 0.05)
    pieces: list[dict[str, Any]] = [{"type": "http.request", "body": b"{", "more_body": True}]

    async def receive() -> dict[str, Any]:
        if not pieces:
            await asyncio.sleep(60)
        return pieces.pop()

    with pytest.raises(bodies.TooSlowError, match="no data arrived for 0.05 s"):
        asyncio.run(bodies.read_body(Request({"type": "http"}, receive)))
