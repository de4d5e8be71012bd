"""Application: the routes of the studio, error responses, and the guard in front of them."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

from starlette.applications import Starlette
from starlette.background import BackgroundTask
from starlette.exceptions import HTTPException
from starlette.requests import ClientDisconnect, Request
from starlette.responses import FileResponse, Response
from starlette.routing import Mount, Route
from starlette.staticfiles import StaticFiles

from kineme.errors import KinemeError, LinkError, ReadError, SeveralPeopleError, WriteError
from kineme.studio.http.bodies import MAX_UPLOAD, MessageResponse, TooLargeError, TooSlowError
from kineme.studio.http.events import Hub
from kineme.studio.http.security import Guard, is_trusted
from kineme.studio.open_recording import ConflictError
from kineme.studio.open_recordings import OpenRecordings, SupersededError, UnknownError
from kineme.studio.poses import PosesNeededError
from kineme.studio.routes import Api
from kineme.web import STATIC
from kineme.web.messages import Failure

if TYPE_CHECKING:
    from kineme.studio.library import StudioLibrary

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
