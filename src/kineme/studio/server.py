"""Server: a local socket, an access token, the printed address, and a clean shutdown."""

from __future__ import annotations

import logging
import os
import socket
import threading
import webbrowser
from collections.abc import Callable, Iterable
from contextlib import suppress
from pathlib import Path
from types import FrameType
from typing import TYPE_CHECKING

import uvicorn

from kineme._util.files import remove_abandoned_drafts
from kineme.errors import KinemeError, ParameterError
from kineme.studio.http.security import DEVELOPMENT, HeaderTimeoutProtocol, make_token

if TYPE_CHECKING:
    from kineme.formats import ReadOptions
    from kineme.methods.segmenter import SegmentOptions
    from kineme.studio.http.events import Hub
    from kineme.studio.http.security import Guard
    from kineme.studio.library import StudioLibrary
    from kineme.studio.open_recordings import OpenRecordings

HOST = "127.0.0.1"
PORT = 8750
PORT_ATTEMPTS = 20
"""Number of ports that are tried, from `PORT` on."""
SHUTDOWN_S = 2
"""Time that running requests get after Ctrl+C."""
PAGE_WAIT_S = 5.0
"""Time that a page gets to list a folder before compiled code is loaded."""
PUBLISHED_DELAY_S = 10.0
"""Delay before the code of the published methods is loaded, since they are rarely used."""


def serve(
    root: Path,
    files: Iterable[Path] | None,
    *,
    read_options: ReadOptions,
    segment_options: SegmentOptions,
    port: int | None,
    browser: bool,
    announce: Callable[[str], None],
    library: StudioLibrary | None = None,
    development: bool = False,
) -> None:
    """Serve a folder, or some files of it, or a library, until Ctrl+C.

    ``port`` is passed to `open_socket`; ``announce`` is called with the address. In ``development``
    the address is that of the Vite server, and the port defaults to 8750, which Vite expects.
    """
    if development and port is None:
        port = PORT
    with open_socket(port) as server_socket, suppress(KeyboardInterrupt):
        actual_port = server_socket.getsockname()[1]
        token = make_token()
        origin = DEVELOPMENT if development else f"http://{HOST}:{actual_port}"
        address = f"{origin}/?token={token}"
        announce(address)
        if browser:
            threading.Thread(target=webbrowser.open, args=[address], daemon=True).start()
        # Import after the browser was started; its first request waits in the socket.
        from kineme.studio.folder import Folder
        from kineme.studio.http.events import Hub
        from kineme.studio.open_recordings import OpenRecordings
        from kineme.studio.routes import create_app

        hub = Hub()
        folder = Folder(root, files) if library is None else library.as_folder()
        recordings = OpenRecordings(folder, hub.tell, read_options, segment_options)
        remove_abandoned_drafts(folder.root)
        config = make_server_config(
            create_app(
                recordings,
                token=token,
                port=actual_port,
                hub=hub,
                library=library,
                development=development,
            )
        )
        ended = threading.Event()
        threading.Thread(
            target=warm_up, args=[recordings, hub, ended], name="warm up", daemon=True
        ).start()
        try:
            Server(config, hub).run(sockets=[server_socket])
        finally:
            ended.set()


def open_socket(port: int | None) -> socket.socket:
    """Return a listening socket on this machine; ParameterError if the port is in use or invalid.

    ``port`` None takes the first free port from 8750 on, 0 any free port.
    """
    if port is not None and not 0 <= port < 2**16:
        raise ParameterError(f"the port is a number from 0 to 65535, not {port}")
    for number in range(PORT, PORT + PORT_ATTEMPTS) if port is None else [port]:
        server_socket = socket.socket(socket.AF_INET, socket.SOCK_STREAM)
        if os.name == "posix":  # on Windows it would let two servers share a port
            server_socket.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        try:
            server_socket.bind((HOST, number))
            server_socket.listen(128)
        except OSError as error:
            server_socket.close()
            reason = error.strerror
            continue
        return server_socket
    ports = f"{PORT} to {PORT + PORT_ATTEMPTS - 1} are" if port is None else f"{port} is"
    raise ParameterError(f"port {ports} not available ({reason}): choose another with --port")


def make_server_config(app: Guard) -> uvicorn.Config:
    """Return the server settings: plain HTTP on this machine, without logs."""
    return uvicorn.Config(
        app,
        log_level=logging.ERROR,
        access_log=False,  # addresses hold the token
        server_header=False,
        ws="none",
        proxy_headers=False,
        timeout_graceful_shutdown=SHUTDOWN_S,
        http=HeaderTimeoutProtocol,
    )


class Server(uvicorn.Server):
    """Server that ends the event streams first when it shuts down."""

    def __init__(self, config: uvicorn.Config, hub: Hub):
        super().__init__(config)
        self._hub = hub

    def handle_exit(self, sig: int, frame: FrameType | None) -> None:
        self._hub.close()
        super().handle_exit(sig, frame)


def warm_up(recordings: OpenRecordings, hub: Hub, ended: threading.Event) -> None:
    """Open the recording of a folder with only one, and load or build the compiled code.

    Exceptions during shutdown are ignored: the interpreter cannot start threads then.
    """
    try:
        names = list(recordings.folder.recordings())
        if len(names) == 1:
            recordings.prepare(names)
        else:
            hub.has_listener.wait(PAGE_WAIT_S)
        load_compiled_code(ended)
    except KinemeError:  # the request for it will report it
        return
    except Exception:
        if not ended.is_set():
            raise


def load_compiled_code(ended: threading.Event) -> None:
    """Load the compiled code by displaying and segmenting the bundled recording.

    The code of the published methods is last, unless ``ended`` is set before.
    """
    from kineme.datasets import bundled_recording
    from kineme.formats import read_motion
    from kineme.methods.presets import DEFAULT, PUBLISHED
    from kineme.methods.segmenter import segment
    from kineme.web.page_data import make_page_data

    motion = read_motion(bundled_recording())
    make_page_data(motion)
    segment(motion, preset=DEFAULT)
    if not ended.wait(PUBLISHED_DELAY_S):
        for name in PUBLISHED:
            segment(motion, preset=name)
