"""The addresses of a library: what it is, edits, searches, small figures."""

from __future__ import annotations

from starlette.concurrency import run_in_threadpool
from starlette.requests import Request
from starlette.responses import Response
from starlette.routing import Route

from kineme.errors import ParameterError
from kineme.studio.http.answers import MessageResponse
from kineme.studio.http.bodies import body
from kineme.studio.library.figures import Figures
from kineme.studio.library.shown import ShownLibrary
from kineme.studio.open_recordings import OpenRecordings
from kineme.web.encoding import from_json
from kineme.web.library_messages import CallHits, LibraryEdit, LibraryFigure, SearchRequest


class LibraryApi:
    """The addresses under ``/api/library``.

    Parameters
    ----------
    shown : ShownLibrary
    recordings : OpenRecordings
        Those of the library.
    """

    def __init__(self, shown: ShownLibrary, recordings: OpenRecordings):
        self._shown, self._recordings, self._figures = shown, recordings, Figures()

    async def state(self, _: Request) -> Response:
        return MessageResponse(await run_in_threadpool(self._shown.state))

    async def edit(self, request: Request) -> Response:
        sent: LibraryEdit = from_json(await body(request), LibraryEdit)  # type: ignore[arg-type]
        return MessageResponse(await run_in_threadpool(self._shown.edit, sent))

    async def search(self, request: Request) -> Response:
        sent = from_json(await body(request), SearchRequest)
        return MessageResponse(await run_in_threadpool(self._shown.search, sent))

    async def names(self, request: Request) -> Response:
        sent = from_json(await body(request), CallHits)
        return MessageResponse(await run_in_threadpool(self._shown.call, sent, self._recordings))

    async def figure(self, request: Request) -> Response:
        asked = request.query_params
        try:
            start_s, stop_s = float(asked["start"]), float(asked["stop"])
        except (KeyError, ValueError):
            raise ParameterError("a figure is of a span: start and stop in seconds") from None

        def work() -> LibraryFigure:
            name = asked.get("recording", "")
            return self._figures.figure(self._shown.library(), name, start_s, stop_s)

        return MessageResponse(await run_in_threadpool(work))

    def routes(self) -> list[Route]:
        return [
            Route("/api/library", self.state),
            Route("/api/library/edits", self.edit, methods=["POST"]),
            Route("/api/library/search", self.search, methods=["POST"]),
            Route("/api/library/names", self.names, methods=["POST"]),
            Route("/api/library/figure", self.figure),
        ]
