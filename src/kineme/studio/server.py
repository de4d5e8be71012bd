"""The server: a socket of this machine, a token, one line with the address, and a clean end."""

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
from kineme.studio.events import Hub
from kineme.studio.security import new_token

if TYPE_CHECKING:
    from kineme.studio.documents import Documents
    from kineme.studio.takes import Reading

HOST = "127.0.0.1"
PORT = 8750
TRIES = 20
"""Ports after the first that are tried if it is in use."""
PATIENCE = 2
"""Seconds that requests have to end in after Ctrl+C."""
HEAD_START = 10.0
"""Seconds before the code of the presets that are rarely used is made ready."""


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
    reading: Reading,
    port: int | None,
    browser: bool,
    announce: Callable[[str], None],
) -> None:
    """Serve until Ctrl+C.

    Parameters
    ----------
    root : the folder
    files : the recordings of it to list; None for all
    reading : what they do not say themselves
    port : to listen on; None for the first free one from 8750, 0 for any
    browser : open the address there
    announce : called with the address

    Raises
    ------
    ParameterError : the port is in use, or not one
    """
    with listening(port) as opened, suppress(KeyboardInterrupt):
        number = opened.getsockname()[1]
        token = new_token()
        address = f"http://{HOST}:{number}/?token={token}"
        announce(address)
        if browser:
            threading.Thread(target=webbrowser.open, args=[address], daemon=True).start()
        # The browser starts meanwhile; its first request waits in the socket.
        from kineme.studio.app import create_app
        from kineme.studio.documents import Documents
        from kineme.studio.folder import Folder
        from kineme.studio.uploads import forget_drafts

        hub = Hub()
        documents = Documents(Folder(root, files), hub.tell, reading)
        forget_drafts(root)
        config = uvicorn.Config(
            create_app(documents, token=token, port=number, hub=hub),
            log_level=logging.ERROR,
            access_log=False,  # addresses hold the token
            server_header=False,
            ws="none",
            proxy_headers=False,
            timeout_graceful_shutdown=PATIENCE,
        )
        ended = threading.Event()
        threading.Thread(
            target=make_ready, args=[documents, ended], name="make ready", daemon=True
        ).start()
        try:
            Server(config, hub).run(sockets=[opened])
        finally:
            ended.set()


def listening(port: int | None) -> socket.socket:
    """A socket of this machine alone that listens on the port, or on the next free one."""
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
    which = f"{PORT} to {PORT + TRIES - 1} are" if port is None else f"{port} is"
    raise ParameterError(f"port {which} not free ({reason}): name another with --port")


def make_ready(documents: Documents, ended: threading.Event) -> None:
    """Open the only recording, which every page shows, and load or build the compiled code.

    What fails once the server has ended is not said: an interpreter that ends lets nobody start
    threads.
    """
    try:
        names = list(documents.folder.recordings())
        if len(names) == 1:
            documents.prepare(names)
        load_code(ended)
    except KinemeError:  # it will be said where it matters
        return
    except Exception:
        if not ended.is_set():
            raise


def load_code(ended: threading.Event) -> None:
    """Show and segment the bundled recording; by the default preset first."""
    from kineme.datasets import bundled_recording
    from kineme.formats import read_motion
    from kineme.methods.presets import DEFAULT, PRESETS
    from kineme.segmentation.segmenter import segment
    from kineme.web.recording import footage

    motion = read_motion(bundled_recording())
    footage(motion)
    segment(motion, preset=DEFAULT)
    if not ended.wait(HEAD_START):
        for name in (name for name in PRESETS if name != DEFAULT):
            segment(motion, preset=name)
