"""Events at the other end of real sockets."""

from __future__ import annotations

import json
import socket
from contextlib import ExitStack
from queue import Queue
from threading import Thread

import pytest

from kineme.errors import ParameterError
from kineme.live import Notice, Repetition
from kineme.live.outputs import open_lsl, open_osc, open_websocket

EVENTS = [
    Repetition(at_s=16.0, number=1, start_s=9.0, stop_s=11.5, cluster=2),
    Notice(at_s=17.0, text="the clock goes back"),
]


def free_port(kind: socket.SocketKind = socket.SOCK_STREAM) -> int:
    with socket.socket(socket.AF_INET, kind) as free:
        free.bind(("127.0.0.1", 0))
        return free.getsockname()[1]


def test_a_websocket_sends_json_to_all_and_ends():
    client = pytest.importorskip("websockets.sync.client")
    from websockets.exceptions import ConnectionClosed, InvalidStatus

    port = free_port()
    with ExitStack() as clients:
        with open_websocket(port) as send:
            with pytest.raises(ParameterError, match=f"{port} is in use"), open_websocket(port):
                pass

            def connect(origin: str | None):
                connection = client.connect(f"ws://127.0.0.1:{port}", origin=origin)
                return clients.enter_context(connection)

            with pytest.raises(InvalidStatus):
                connect("https://elsewhere.example")
            both = [connect(origin) for origin in (None, "http://localhost:3000")]
            send(EVENTS)
        for each in both:
            got = [json.loads(each.recv(timeout=5)) for _ in EVENTS]
            assert got == [event.to_json() for event in EVENTS]
            with pytest.raises(ConnectionClosed):
                each.recv(timeout=5)


def test_osc_has_the_attributes_in_order():
    dispatcher = pytest.importorskip("pythonosc.dispatcher").Dispatcher()
    from pythonosc.osc_server import BlockingOSCUDPServer

    got: Queue = Queue()
    dispatcher.set_default_handler(lambda address, *values: got.put((address, *values)))
    with BlockingOSCUDPServer(("127.0.0.1", 0), dispatcher) as server:
        thread = Thread(target=server.serve_forever)
        thread.start()
        with open_osc(f"127.0.0.1:{server.server_address[1]}") as send:
            send(EVENTS)
        assert got.get(timeout=5) == ("/kineme/Repetition", 16.0, "final", 1, 9.0, 11.5, 2)
        assert got.get(timeout=5) == ("/kineme/Notice", 17.0, "final", "the clock goes back")
        server.shutdown()
        thread.join()


@pytest.mark.parametrize(
    "target", ["9000", "127.0.0.1:", "127.0.0.1:99999", "nowhere.invalid:9000"]
)
def test_osc_needs_a_host_and_a_port(target):
    pytest.importorskip("pythonosc")
    with pytest.raises(ParameterError, match="OSC"), open_osc(target):
        pass


def test_lsl_has_markers():
    pylsl = pytest.importorskip("pylsl")
    with open_lsl("kineme-events") as send:
        inlet = pylsl.StreamInlet(pylsl.resolve_byprop("name", "kineme-events", timeout=5)[0])
        inlet.open_stream(5)
        send(EVENTS)
        assert json.loads(inlet.pull_sample(timeout=5)[0][0]) == EVENTS[0].to_json()
