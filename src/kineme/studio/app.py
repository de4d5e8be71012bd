"""Application: the addresses of the studio, what becomes of errors, and the guard in front."""

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
from kineme.studio.http.bodies import LIMIT, MessageResponse, TooLargeError, TooSlowError
from kineme.studio.http.events import Hub
from kineme.studio.http.security import Guard, is_trusted
from kineme.studio.open_recording import ConflictError
from kineme.studio.open_recordings import OpenRecordings, SupersededError, UnknownError
from kineme.studio.poses import PosesNeededError
from kineme.studio.routes import Api
from kineme.web import STATIC
from kineme.web.messages import Failure

if TYPE_CHECKING:
    from kineme.studio.library import ShownLibrary

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


def create_app(
    recordings: OpenRecordings,
    *,
    token: str,
    port: int,
    hub: Hub,
    library: ShownLibrary | None = None,
    static: Path = STATIC,
    limit: int = LIMIT,
    development: bool = False,
) -> Guard:
    """Return the studio of some recordings, as an ASGI application.

    Where there is a ``library``, its page is shown when neither a recording nor the folder is
    named. ``static`` has the built pages, ``limit`` is in bytes of an upload; pages of the
    development server may ask in ``development``.
    """

    def page(request: Request) -> Response:
        names = request.query_params.getlist("open")
        folder = "folder" in request.query_params
        path = static / (PAGE if library is None or names or folder else LIBRARY_PAGE)
        if not path.is_file():
            return _make_failure("this page has not been built: npm run build", 404)
        answer = FileResponse(path)
        if is_trusted(request):  # the recordings are read while the browser sets up the page
            answer.background = BackgroundTask(recordings.prepare, names)
        return answer

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


def make_library_routes(library: ShownLibrary | None, recordings: OpenRecordings) -> list[Route]:
    """Return the addresses of a library, if there is one."""
    if library is None:
        return []
    from kineme.studio.library_routes import LibraryApi  # reads Parquet

    return LibraryApi(library, recordings).routes()


def _answer_known_error(_: Request, error: Exception) -> Response:
    status = next(STATUS[kind] for kind in type(error).__mro__ if kind in STATUS)
    people = error.people if isinstance(error, SeveralPeopleError) else ()
    poses = isinstance(error, PosesNeededError)
    reading = isinstance(error, ReadError) and not poses
    failure = Failure(error=str(error), people=[*people], reading=reading, poses=poses)
    return MessageResponse(failure, status)


def _answer_disconnect(_: Request, __: Exception) -> Response:
    return Response(status_code=400)  # nobody is there to read it


def _answer_http_error(_: Request, error: Exception) -> Response:
    status = error.status_code if isinstance(error, HTTPException) else 500
    what = "this address takes other methods" if status == 405 else "there is nothing here"
    return _make_failure(what, status)


def _answer_unexpected_error(_: Request, __: Exception) -> Response:
    return _make_failure("the server failed; its terminal says how", 500)


def _make_failure(reason: str, status: int) -> Response:
    return MessageResponse(Failure(error=reason), status)
