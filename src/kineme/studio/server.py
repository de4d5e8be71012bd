"""Server: a socket of this machine, a token, one line with the address, and a clean end."""

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

from kineme.errors import KinemeError, ParameterError
from kineme.studio.http.events import Hub
from kineme.studio.http.security import DEVELOPMENT, Guard, HeadersInTime, make_token

if TYPE_CHECKING:
    from kineme.formats import ReadOptions
    from kineme.methods.segmenter import SegmentOptions
    from kineme.studio.library import ShownLibrary
    from kineme.studio.open_recordings import OpenRecordings

HOST = "127.0.0.1"
PORT = 8750
TRIES = 20
"""Ports after the first that are tried if it is in use."""
PATIENCE = 2
"""Seconds that requests have to end in after Ctrl+C."""
PAGE_FIRST = 5.0
"""Seconds that a page has to list a folder in before code is made ready beside it."""
HEAD_START = 10.0
"""Seconds before the code of the published methods, which are rarely used, is made ready."""


class Server(uvicorn.Server):
    """A server that ends the streams of news first when it is told to stop."""

    def __init__(self, config: uvicorn.Config, hub: Hub):
        super().__init__(config)
        self._hub = hub

    def handle_exit(self, sig: int, frame: FrameType | None) -> None:
        self._hub.close()
        super().handle_exit(sig, frame)


def serve(
    root: Path,
    files: Iterable[Path] | None,
    *,
    read_options: ReadOptions,
    segment_options: SegmentOptions,
    port: int | None,
    browser: bool,
    announce: Callable[[str], None],
    library: ShownLibrary | None = None,
    development: bool = False,
) -> None:
    """Serve a folder, or some files of it, or a library, until Ctrl+C.

    ``port`` is passed to `open_socket`; ``announce`` is called with the address. In ``development``
    the address is that of the Vite server, and the port defaults to 8750, which Vite expects.
    """
    if development and port is None:
        port = PORT
    with open_socket(port) as opened, suppress(KeyboardInterrupt):
        number = opened.getsockname()[1]
        token = make_token()
        origin = DEVELOPMENT if development else f"http://{HOST}:{number}"
        address = f"{origin}/?token={token}"
        announce(address)
        if browser:
            threading.Thread(target=webbrowser.open, args=[address], daemon=True).start()
        # The browser starts meanwhile; its first request waits in the socket.
        from kineme.studio.app import create_app
        from kineme.studio.folder import Folder
        from kineme.studio.http.bodies import remove_abandoned_drafts
        from kineme.studio.open_recordings import OpenRecordings

        hub = Hub()
        folder = Folder(root, files) if library is None else library.as_folder()
        recordings = OpenRecordings(folder, hub.tell, read_options, segment_options)
        remove_abandoned_drafts(folder.root)
        config = make_server_config(
            create_app(
                recordings,
                token=token,
                port=number,
                hub=hub,
                library=library,
                development=development,
            )
        )
        ended = threading.Event()
        threading.Thread(
            target=warm_up, args=[recordings, hub, ended], name="make ready", daemon=True
        ).start()
        try:
            Server(config, hub).run(sockets=[opened])
        finally:
            ended.set()


def make_server_config(app: Guard) -> uvicorn.Config:
    """Return how an application is served: plain HTTP, and nothing said of it."""
    return uvicorn.Config(
        app,
        log_level=logging.ERROR,
        access_log=False,  # addresses hold the token
        server_header=False,
        ws="none",
        proxy_headers=False,
        timeout_graceful_shutdown=PATIENCE,
        http=HeadersInTime,
    )


def open_socket(port: int | None) -> socket.socket:
    """Return a socket of this machine alone; ParameterError where the port is in use, or not one.

    None is the first free port from 8750, 0 any.
    """
    if port is not None and not 0 <= port < 2**16:
        raise ParameterError(f"the port is a number from 0 to 65535, not {port}")
    for number in range(PORT, PORT + TRIES) if port is None else [port]:
        opened = socket.socket(socket.AF_INET, socket.SOCK_STREAM)
        if os.name == "posix":  # elsewhere it would let two servers share a port
            opened.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        try:
            opened.bind((HOST, number))
            opened.listen(128)
        except OSError as error:
            opened.close()
            reason = error.strerror
            continue
        return opened
    ports = f"{PORT} to {PORT + TRIES - 1} are" if port is None else f"{port} is"
    raise ParameterError(f"port {ports} not free ({reason}): name another with --port")


def warm_up(recordings: OpenRecordings, hub: Hub, ended: threading.Event) -> None:
    """Open the only recording, which every page shows, and load or build the compiled code.

    What fails once the server has ended is not said: an interpreter that ends lets nobody start
    threads.
    """
    try:
        names = list(recordings.folder.recordings())
        if len(names) == 1:
            recordings.prepare(names)
        else:
            hub.listened.wait(PAGE_FIRST)
        load_compiled_code(ended)
    except KinemeError:  # it will be said where it matters
        return
    except Exception:
        if not ended.is_set():
            raise


def load_compiled_code(ended: threading.Event) -> None:
    """Show and segment the bundled recording; by the default preset first."""
    from kineme.datasets import bundled_recording
    from kineme.formats import read_motion
    from kineme.methods.presets import DEFAULT, PUBLISHED
    from kineme.methods.segmenter import segment
    from kineme.web.page_data import make_page_data

    motion = read_motion(bundled_recording())
    make_page_data(motion)
    segment(motion, preset=DEFAULT)
    if not ended.wait(HEAD_START):
        for name in PUBLISHED:
            segment(motion, preset=name)
