"""Requests that come slowly, break off or never end: an answer or none, and no traceback."""

from __future__ import annotations

import asyncio
import socket
import threading
import time
from collections.abc import Iterator
from contextlib import suppress
from typing import Any

import pytest
import uvicorn
from starlette.requests import Request

from kineme.studio.http import bodies, security

HEAD = b"GET / HTTP/1.1\r\nHost: x\r\n"


async def _app(_: object, receive, send) -> None:
    """Answers late, once the whole body is there."""
    while (await receive()).get("more_body"):
        pass
    time.sleep(0.5)
    await send({"type": "http.response.start", "status": 200, "headers": []})
    await send({"type": "http.response.body", "body": b"here"})


@pytest.fixture
def address(monkeypatch: pytest.MonkeyPatch) -> Iterator[tuple[str, int]]:
    monkeypatch.setattr(security, "HEADER_TIMEOUT_S", 0.3)
    config = uvicorn.Config(
        _app, http=security.HeaderTimeoutProtocol, log_level="error", lifespan="off", ws="none"
    )
    server = uvicorn.Server(config)
    opened = socket.create_server(("127.0.0.1", 0))
    thread = threading.Thread(target=server.run, args=[[opened]])
    thread.start()
    yield opened.getsockname()
    server.should_exit = True
    thread.join()
    opened.close()


@pytest.mark.parametrize("begun", [b"", HEAD + b"X: " + b"a" * 200])
@pytest.mark.parametrize("second", [False, True])
def test_a_half_sent_request_is_given_up(address, begun: bytes, second: bool) -> None:
    if second and not begun:
        return  # which is a connection kept alive
    with socket.create_connection(address, timeout=10) as client:
        if second:
            client.sendall(HEAD + b"\r\n")
            assert b"here" in _all_of(client)
        client.sendall(begun)
        assert client.recv(1000) == b""


def test_a_slow_body_and_a_slow_answer_are_waited_for(address) -> None:
    with socket.create_connection(address, timeout=10) as client:
        client.sendall(b"POST / HTTP/1.1\r\nHost: x\r\nContent-Length: 2\r\n\r\na")
        time.sleep(0.6)
        client.sendall(b"b")
        assert b"here" in _all_of(client)


def _all_of(client: socket.socket) -> bytes:
    """An answer to its end."""
    told = b""
    while b"here" not in told and (more := client.recv(1000)):
        told += more
    time.sleep(0.05)
    client.setblocking(False)
    with suppress(BlockingIOError):
        told += client.recv(1000)
    client.settimeout(10)
    return told


def test_a_request_that_does_not_go_on_is_given_up(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(bodies, "CHUNK_TIMEOUT_S", 0.05)
    pieces: list[dict[str, Any]] = [{"type": "http.request", "body": b"{", "more_body": True}]

    async def receive() -> dict[str, Any]:
        if not pieces:
            await asyncio.sleep(60)
        return pieces.pop()

    with pytest.raises(bodies.TooSlowError, match="no data arrived for 0.05 s"):
        asyncio.run(bodies.read_body(Request({"type": "http"}, receive)))
