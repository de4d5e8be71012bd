"""The application: the addresses of the studio, what becomes of errors, and the guard in front."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from starlette.applications import Starlette
from starlette.background import BackgroundTask
from starlette.exceptions import HTTPException
from starlette.requests import Request
from starlette.responses import JSONResponse, Response
from starlette.routing import Route

from kineme.errors import KinemeError, WriteError
from kineme.studio.documents import ConflictError, Documents, UnknownError
from kineme.studio.events import Hub
from kineme.studio.pages import STATIC, Pages
from kineme.studio.routes import Api
from kineme.studio.security import Guard, is_trusted
from kineme.studio.uploads import LIMIT, TooLargeError

Handler = Callable[[Request, Exception], Response]
STATUS: dict[type[Exception], int] = {
    KinemeError: 400,
    UnknownError: 404,
    TooLargeError: 413,
    WriteError: 500,
}


def create_app(
    documents: Documents,
    *,
    token: str,
    port: int,
    hub: Hub,
    static: Path = STATIC,
    limit: int = LIMIT,
) -> Guard:
    """The studio of some recordings, as an ASGI application.

    Parameters
    ----------
    token : what requests must carry
    port : the server's own
    hub : where the documents' news go through
    static : the built page
    limit : bytes of an upload
    """
    api = Api(documents, hub, limit=limit)
    pages = Pages(static)

    def page(request: Request) -> Response:
        answer = pages.answer(request)
        if is_trusted(request):  # the recordings are read while the browser sets up the page
            names = request.query_params.getlist("open")
            answer.background = BackgroundTask(documents.prepare, names)
        return answer

    handlers: dict[type[Exception], Handler] = dict.fromkeys(STATUS, _refused)
    app = Starlette(
        routes=[*api.routes(), Route("/", page), Route("/{path:path}", pages.answer)],
        exception_handlers={
            **handlers,
            ConflictError: _conflict,
            HTTPException: _http_error,
            Exception: _failed,
        },
    )
    return Guard(app, token=token, port=port)


def _refused(_: Request, error: Exception) -> Response:
    status = next(STATUS[kind] for kind in type(error).__mro__ if kind in STATUS)
    return JSONResponse({"error": str(error)}, status)


def _conflict(_: Request, error: Exception) -> Response:
    present = dict(error.present) if isinstance(error, ConflictError) else {}
    return JSONResponse({**present, "error": str(error)}, 409)


def _http_error(_: Request, error: Exception) -> Response:
    status = error.status_code if isinstance(error, HTTPException) else 500
    what = "this address takes other methods" if status == 405 else "there is nothing here"
    return JSONResponse({"error": what}, status)


def _failed(_: Request, __: Exception) -> Response:
    return JSONResponse({"error": "the server failed; its terminal says how"}, 500)
