"""Send events to other programs: websocket, OSC, Lab Streaming Layer.

Each entry of `OUTPUTS` is an option of ``kineme live``.
"""

from __future__ import annotations

import json
import re
from collections.abc import Callable, Iterator, Sequence
from contextlib import AbstractContextManager, contextmanager, suppress
from dataclasses import dataclass
from threading import Thread
from typing import Any

from kineme._util.checks import require_extra
from kineme.errors import ParameterError
from kineme.live.events import Event

Send = Callable[[Sequence[Event]], None]

HOST = "127.0.0.1"
OWN_PAGES = re.compile(r"https?://(localhost|127\.0\.0\.1)(:\d+)?")
"""Origins of web pages that may read the events."""
CLOSING_S = 2.0
"""Seconds that websockets have to close in."""


@dataclass(frozen=True)
class Output:
    """An output and its option.

    ``open`` takes the value of the option and returns a context manager, whose value is a function
    that sends events. ``metavar`` is the placeholder of the value in the help.
    """

    open: Callable[[Any], AbstractContextManager[Send]]
    help: str
    metavar: str
    type: type = str


@contextmanager
def open_lsl(name: str) -> Iterator[Send]:
    """Send events as markers of a stream of the Lab Streaming Layer, as JSON."""
    with require_extra("pylsl", "lsl"):
        import pylsl
    outlet = pylsl.StreamOutlet(pylsl.StreamInfo(name, "Markers", 1, 0, "string", f"kineme-{name}"))

    def send(events: Sequence[Event]) -> None:
        for event in events:
            outlet.push_sample([json.dumps(event.to_json())])

    yield send


@contextmanager
def open_osc(target: str) -> Iterator[Send]:
    """Send events as OSC messages to HOST:PORT.

    The address is ``/kineme/`` and the name of the event; the arguments are the attributes of the
    event in the order of its JSON.
    """
    with require_extra("python-osc", "osc"):
        from pythonosc.udp_client import SimpleUDPClient
    host, _, port = target.rpartition(":")
    if not (host and port.isdecimal() and 0 < int(port) < 2**16):
        raise ParameterError(f"OSC needs HOST:PORT, such as 127.0.0.1:9000, not {target!r}")
    try:
        client = SimpleUDPClient(host.strip("[]"), int(port))
    except OSError as error:
        raise ParameterError(f"OSC cannot be sent to {target}: {error.strerror}") from error

    def send(events: Sequence[Event]) -> None:
        for event in events:
            name, *values = event.to_json().values()
            with suppress(OSError):  # a network that fails must not end the recording
                client.send_message(f"/kineme/{name}", values)

    with client:
        yield send


@contextmanager
def open_websocket(port: int) -> Iterator[Send]:
    """Send events as JSON to all clients that are connected to a port of this machine."""
    import asyncio

    with require_extra("websockets", "websocket"):
        from websockets.asyncio.server import Server, ServerConnection, broadcast, serve
    loop = asyncio.new_event_loop()

    async def start() -> Server:
        # None: programs other than browsers send no origin.
        return await serve(ServerConnection.wait_closed, HOST, port, origins=[None, OWN_PAGES])

    try:
        server = loop.run_until_complete(start())
    except OSError as error:
        loop.close()
        raise ParameterError(f"port {port} is in use: give --websocket another one") from error
    thread = Thread(target=loop.run_forever, daemon=True)
    thread.start()

    def spread(text: str) -> None:
        broadcast(server.connections, text)  # never waits for a client

    def send(events: Sequence[Event]) -> None:
        for event in events:
            loop.call_soon_threadsafe(spread, json.dumps(event.to_json()))

    async def stop() -> None:
        server.close()
        await server.wait_closed()

    try:
        yield send
    finally:
        with suppress(TimeoutError):
            asyncio.run_coroutine_threadsafe(stop(), loop).result(CLOSING_S)
        loop.call_soon_threadsafe(loop.stop)
        thread.join()
        loop.close()


OUTPUTS = {
    "websocket": Output(
        open_websocket,
        "Send events as JSON to websocket clients on this local port.",
        "PORT",
        int,
    ),
    "osc_out": Output(open_osc, "Send events as OSC messages to this address.", "HOST:PORT"),
    "lsl_out": Output(open_lsl, "Send events as JSON markers by LSL.", "NAME"),
}
