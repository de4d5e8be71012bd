"""What each address answers; the list is at the end.

Everything that reads, computes or writes runs in a thread of its own, so that
the server answers others meanwhile. What is rarely asked for is imported when
it is.
"""

from __future__ import annotations

from typing import Any, cast, get_args
from urllib.parse import quote

from starlette.concurrency import run_in_threadpool
from starlette.requests import ClientDisconnect, Request
from starlette.responses import JSONResponse, Response, StreamingResponse
from starlette.routing import Route

from kineme._version import __version__
from kineme.errors import ParameterError
from kineme.methods.presets import DEFAULT
from kineme.segments.table import Level
from kineme.studio import choices
from kineme.studio.documents import Documents, UnknownError, segments_message
from kineme.studio.events import Hub
from kineme.studio.folder import file_id
from kineme.studio.storage import has_table
from kineme.studio.uploads import LIMIT, TooLargeError, Upload
from kineme.studio.validation import checked, parsed
from kineme.web.messages import (
    CompareRequest,
    Comparison,
    EditRequest,
    FileChoice,
    Listing,
    State,
)

MOST_JSON = 1_000_000
"""Bytes of a request; the largest that a page makes has a few hundred."""


class Api:
    """The addresses under ``/api``.

    Parameters
    ----------
    limit : bytes of an upload
    """

    def __init__(self, documents: Documents, hub: Hub, *, limit: int = LIMIT):
        self._documents, self._hub, self._limit = documents, hub, limit

    async def state(self, _: Request) -> Response:
        return JSONResponse(await run_in_threadpool(self._state))

    async def upload(self, request: Request) -> Response:
        length = request.headers.get("content-length", "")
        upload = Upload(
            self._documents.folder.root,
            request.query_params.get("name", ""),
            length=int(length) if length.isdigit() else None,
            limit=self._limit,
        )
        with upload:
            try:
                async for chunk in request.stream():
                    upload.write(chunk)
            except ClientDisconnect:
                return Response(status_code=400)  # nobody is there to read it
            path = await run_in_threadpool(upload.keep)
        self._documents.folder.add(path)
        self._hub.tell(file_id(path), 0)
        listing = Listing(
            id=file_id(path), name=path.name, bytes=path.stat().st_size, corrected=has_table(path)
        )
        return JSONResponse(listing)

    async def recording(self, request: Request) -> Response:
        name = request.path_params["id"]
        return JSONResponse(await run_in_threadpool(self._documents.recording, name))

    async def motion(self, request: Request) -> Response:
        def work() -> bytes:
            return self._documents.get(request.path_params["id"]).take.footage().binary

        return Response(await run_in_threadpool(work), media_type="application/octet-stream")

    async def tile(self, request: Request) -> Response:
        place = [_number(request.path_params[name]) for name in ("level", "row", "column")]

        def work() -> bytes | None:
            return self._documents.get(request.path_params["id"]).take.footage().matrix.tile(*place)

        found = await run_in_threadpool(work)
        if found is None:
            raise UnknownError("the matrix has no such tile")
        return Response(found, media_type="image/png")

    async def edit(self, request: Request) -> Response:
        sent = cast(EditRequest, checked(EditRequest, await _json(request)))
        name = request.path_params["id"]
        work = self._documents.edit
        return JSONResponse(await run_in_threadpool(work, name, sent["revision"], sent["edit"]))

    async def compare(self, request: Request) -> Response:
        sent = cast(CompareRequest, checked(CompareRequest, await _json(request)))
        if len(sent) != 1:
            raise ParameterError("compare with a preset or with an annotation: name one of them")
        name = request.path_params["id"]
        return JSONResponse(await run_in_threadpool(self._compare, name, sent))

    async def export(self, request: Request) -> Response:
        wanted = request.query_params.get("level") or None
        if wanted not in (None, *get_args(Level)):
            raise ParameterError(f"level must be {' or '.join(get_args(Level))}")
        name, kind = request.path_params["id"], request.path_params["format"]
        level = cast(Level | None, wanted)
        file, content = await run_in_threadpool(self._export, name, kind, level)
        headers = {"content-disposition": f"attachment; filename*=UTF-8''{quote(file, safe='')}"}
        return Response(content, headers=headers, media_type="application/octet-stream")

    async def events(self, _: Request) -> Response:
        return StreamingResponse(self._hub.stream(), media_type="text/event-stream")

    async def unknown(self, _: Request) -> Response:
        raise UnknownError("there is nothing at this address")

    def routes(self) -> list[Route]:
        one = "/api/recordings/{id}"
        return [
            Route("/api/state", self.state),
            Route("/api/recordings", self.upload, methods=["POST"]),
            Route(one, self.recording),
            Route(f"{one}/motion", self.motion),
            Route(f"{one}/matrix/{{level}}/{{row}}/{{column}}", self.tile),
            Route(f"{one}/edits", self.edit, methods=["POST"]),
            Route(f"{one}/compare", self.compare, methods=["POST"]),
            Route(f"{one}/export/{{format}}", self.export),
            Route("/api/events", self.events),
            Route("/api{rest:path}", self.unknown),
        ]

    def _state(self) -> State:
        folder = self._documents.folder
        recordings: list[Listing] = [
            {
                "id": name,
                "name": path.name,
                "bytes": path.stat().st_size,
                "corrected": has_table(path),
            }
            for name, path in folder.recordings().items()
        ]
        bases, annotations = (
            [FileChoice(id=name, name=path.name) for name, path in files.items()]
            for files in (folder.knowledge_bases(), folder.annotations())
        )
        return {
            "version": __version__,
            "folder": str(folder.root.absolute()),
            "recordings": recordings,
            "presets": choices.presets(),
            "default_preset": DEFAULT,
            "knowledge_bases": bases,
            "annotations": annotations,
            "export_formats": choices.export_formats(),
        }

    def _compare(self, name: str, sent: CompareRequest) -> Comparison:
        from kineme.studio import comparison

        document = self._documents.get(name)
        shown = document.table
        if "preset" in sent:
            title = sent["preset"]
            other = document.take.segment(title)
            scores = comparison.agreement(shown, other)
        else:
            path = self._documents.annotation(sent["annotation"])
            title = path.name
            other, scores = comparison.annotation(path, shown)
        return {"name": title, "segmentation": segments_message(other), "scores": scores}

    def _export(self, name: str, kind: str, level: Level | None) -> tuple[str, bytes]:
        from kineme.studio import downloads

        document = self._documents.get(name)
        take, stem = document.take, document.path.stem
        if kind == choices.CLIPS:
            return downloads.motion_files(take.motion, document.table, stem, level)
        if kind == choices.REPORT:
            return downloads.report_file(take.source, document.table, take.path, take.effectors)
        return downloads.table_file(document.table, stem, kind, level)


def _number(text: str) -> int:
    """The number of a tile; -1, which no tile has, for anything else."""
    return int(text) if text.isascii() and text.isdigit() and len(text) < 9 else -1


async def _json(request: Request) -> Any:
    """The value in the body, which is read no farther than a request may be long."""
    body = bytearray()
    async for chunk in request.stream():
        body += chunk
        if len(body) > MOST_JSON:
            raise TooLargeError(f"a request has at most {MOST_JSON} bytes")
    return parsed(bytes(body))
