"""Server: a local socket, an access token, the printed address, and a clean shutdown.

@@app: Application: the routes of the studio, error responses, and the guard in front of them.
"""

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
from starlette.applications import Starlette
from starlette.background import BackgroundTask
from starlette.exceptions import HTTPException
from starlette.requests import ClientDisconnect, Request
from starlette.responses import FileResponse, Response
from starlette.routing import Mount, Route
from starlette.staticfiles import StaticFiles

from kineme.errors import (
    KinemeError,
    LinkError,
    ParameterError,
    ReadError,
    SeveralPeopleError,
    WriteError,
)
from kineme.studio.http.bodies import MAX_UPLOAD, MessageResponse, TooLargeError, TooSlowError
from kineme.studio.http.events import Hub
from kineme.studio.http.security import (
    DEVELOPMENT,
    Guard,
    HeaderTimeoutProtocol,
    is_trusted,
    make_token,
)
from kineme.studio.jobs import PosesNeededError
from kineme.studio.open_recording import ConflictError
from kineme.studio.open_recordings import OpenRecordings, SupersededError, UnknownError
from kineme.studio.routes import Api
from kineme.web import STATIC
from kineme.web.messages import Failure

if TYPE_CHECKING:
    from kineme.formats import ReadOptions
    from kineme.methods.segmenter import SegmentOptions
    from kineme.studio.library import StudioLibrary
    from kineme.studio.open_recordings import OpenRecordings

PAGE, LIBRARY_PAGE = "studio.html", "library.html"
Handler = Callable[[Request, Exception], Response]
STATUS: dict[type[Exception], int] = {
    KinemeError: 400,
    UnknownError: 404,
    TooLargeError: 413,
    TooSlowError: 408,
    WriteError: 500,
    LinkError: 400,
    SupersededError: 409,
    ConflictError: 409,
}
"""HTTP status by exception; a class without an entry takes that of its base class."""


def create_app(
    recordings: OpenRecordings,
    *,
    token: str,
    port: int,
    hub: Hub,
    library: StudioLibrary | None = None,
    static: Path = STATIC,
    limit: int = MAX_UPLOAD,
    development: bool = False,
) -> Guard:
    """Return the studio for a folder of recordings, as an ASGI application.

    If there is a ``library``, its page is shown unless the URL names a recording or the folder.
    ``static`` holds the built pages, and ``limit`` is the largest upload in bytes. In
    ``development``, requests from pages of the Vite server are accepted.
    """

    def page(request: Request) -> Response:
        names = request.query_params.getlist("open")
        folder = "folder" in request.query_params
        path = static / (PAGE if library is None or names or folder else LIBRARY_PAGE)
        if not path.is_file():
            return _make_failure("this page has not been built: npm run build", 404)
        response = FileResponse(path)
        if is_trusted(request):  # read the recordings while the browser loads the page
            response.background = BackgroundTask(recordings.prepare, names)
        return response

    handlers: dict[type[Exception], Handler] = dict.fromkeys(STATUS, _answer_known_error)
    app = Starlette(
        routes=[
            *make_library_routes(library, recordings),
            *Api(recordings, hub, limit=limit).routes(),
            Route("/", page),
            Mount("/assets", StaticFiles(directory=static / "assets", check_dir=False)),
        ],
        exception_handlers={
            **handlers,
            ClientDisconnect: _answer_disconnect,
            HTTPException: _answer_http_error,
            Exception: _answer_unexpected_error,
        },
    )
    return Guard(app, token=token, port=port, development=development)


def make_library_routes(library: StudioLibrary | None, recordings: OpenRecordings) -> list[Route]:
    """Return the routes of a library; none without one."""
    if library is None:
        return []
    from kineme.studio.library_routes import LibraryApi  # reads Parquet

    return LibraryApi(library, recordings).routes()


def _answer_known_error(_: Request, error: Exception) -> Response:
    status = next(STATUS[kind] for kind in type(error).__mro__ if kind in STATUS)
    people = error.people if isinstance(error, SeveralPeopleError) else ()
    needs_poses = isinstance(error, PosesNeededError)
    can_retry = isinstance(error, ReadError) and not needs_poses
    failure = Failure(error=str(error), people=[*people], reading=can_retry, poses=needs_poses)
    return MessageResponse(failure, status)


def _answer_disconnect(_: Request, __: Exception) -> Response:
    return Response(status_code=400)  # never read: the client is gone


def _answer_http_error(_: Request, error: Exception) -> Response:
    status = error.status_code if isinstance(error, HTTPException) else 500
    reason = (
        "this address does not accept this method" if status == 405 else "there is nothing here"
    )
    return _make_failure(reason, status)


def _answer_unexpected_error(_: Request, __: Exception) -> Response:
    return _make_failure("the server failed: see its terminal for details", 500)


def _make_failure(reason: str, status: int) -> Response:
    return MessageResponse(Failure(error=reason), status)


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


class Server(uvicorn.Server):
    """Server that ends the event streams first when it shuts down."""

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
    """Display and segment the bundled recording, by the default preset first."""
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
