"""What is drawn of a recording, in pieces: poses, tiles of the matrix, curves."""

from __future__ import annotations

from starlette.concurrency import run_in_threadpool
from starlette.requests import Request
from starlette.responses import Response
from starlette.routing import Route

from kineme.studio.http.answers import MessageResponse, number_in
from kineme.studio.loading import LoadedRecording
from kineme.studio.open_recordings import OpenRecordings, UnknownError
from kineme.web.messages import CurveList

BINARY = "application/octet-stream"


class Pictures:
    """The addresses of what is drawn.

    Parameters
    ----------
    recordings : OpenRecordings
    """

    def __init__(self, recordings: OpenRecordings):
        self._recordings = recordings

    async def motion(self, request: Request) -> Response:
        wanted = number_in(request.query_params.get("poses", ""))
        name, poses = request.path_params["id"], self._recordings.poses
        return Response(await run_in_threadpool(poses, name, wanted), media_type=BINARY)

    async def tile(self, request: Request) -> Response:
        place = [number_in(request.path_params[name]) for name in ("level", "row", "column")]

        def work() -> bytes | None:
            shown = self._loaded(request).page_data()
            return shown.matrix.tile(*place)

        found = await run_in_threadpool(work)
        if found is None:
            raise UnknownError("the matrix has no such tile")
        return Response(found, media_type="image/png")

    async def curves(self, request: Request) -> Response:
        def work() -> CurveList:
            return self._loaded(request).curves().head()

        return MessageResponse(await run_in_threadpool(work))

    async def piece(self, request: Request) -> Response:
        place = [number_in(request.path_params[name]) for name in ("curve", "level", "number")]

        def work() -> bytes | None:
            loaded = self._loaded(request)
            return loaded.curves().piece(loaded.source, *place)

        found = await run_in_threadpool(work)
        if found is None:
            raise UnknownError("there is no such piece of a curve")
        return Response(found, media_type=BINARY)

    def routes(self, one: str) -> list[Route]:
        """Those of a recording, whose address begins with ``one``."""
        return [
            Route(f"{one}/motion", self.motion),
            Route(f"{one}/matrix/{{level}}/{{row}}/{{column}}", self.tile),
            Route(f"{one}/curves", self.curves),
            Route(f"{one}/curves/{{curve}}/{{level}}/{{number}}", self.piece),
        ]

    def _loaded(self, request: Request) -> LoadedRecording:
        return self._recordings.get(request.path_params["id"]).loaded
