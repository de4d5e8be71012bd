"""What each address answers; the list is at the end.

Everything that reads, computes or writes runs in a thread of its own, so that
the server answers others meanwhile. What is rarely asked for is imported when
it is.
"""

from __future__ import annotations

from pathlib import Path
from typing import cast, get_args

from msgspec import UNSET
from starlette.concurrency import run_in_threadpool
from starlette.requests import Request
from starlette.responses import Response, StreamingResponse
from starlette.routing import Route

from kineme._version import __version__
from kineme.errors import ParameterError
from kineme.methods.presets import DEFAULT
from kineme.segments.table import Level
from kineme.studio import choices
from kineme.studio.folder import file_id
from kineme.studio.http.answers import MessageResponse, file_response, number_in
from kineme.studio.http.bodies import body, chunks
from kineme.studio.http.events import Hub
from kineme.studio.http.uploads import (
    LIMIT,
    Upload,
    recording_suffixes,
)
from kineme.studio.open_recordings import OpenRecordings, UnknownError
from kineme.studio.pictures import Pictures
from kineme.studio.progress import progress
from kineme.studio.storage.sidecars import shared_labels
from kineme.studio.whole import Whole
from kineme.web.encoding import from_json
from kineme.web.folder_messages import FileChoice, Listing, State
from kineme.web.messages import Comparison, Preview, Versions
from kineme.web.requests import CompareRequest, EditRequest, PreviewRequest


class Api:
    """The addresses under ``/api``.

    Parameters
    ----------
    recordings : OpenRecordings
    hub : Hub
        Where news go to the pages.
    limit : int
        Bytes of an upload.
    """

    def __init__(self, recordings: OpenRecordings, hub: Hub, *, limit: int = LIMIT):
        self._recordings, self._hub, self._limit = recordings, hub, limit

    async def state(self, _: Request) -> Response:
        return MessageResponse(await run_in_threadpool(self._state))

    async def upload(self, request: Request) -> Response:
        length = request.headers.get("content-length", "")
        upload = Upload(
            self._recordings.folder.root,
            request.query_params.get("name", ""),
            length=int(length) if length.isdigit() else None,
            limit=self._limit,
        )
        with upload:
            async for chunk in chunks(request):
                upload.write(chunk)
            path = await run_in_threadpool(upload.finish)
        self._recordings.folder.add(path)
        self._hub.tell(file_id(path), 0)
        return MessageResponse(_listing(file_id(path), path))

    async def recording(self, request: Request) -> Response:
        name = request.path_params["id"]
        return MessageResponse(await run_in_threadpool(self._recordings.message, name))

    async def edit(self, request: Request) -> Response:
        sent = from_json(await body(request), EditRequest)
        name, work = request.path_params["id"], self._recordings.edit
        return MessageResponse(await run_in_threadpool(work, name, sent))

    async def preview(self, request: Request) -> Response:
        sent = from_json(await body(request), PreviewRequest)

        def work() -> Preview:
            return self._recordings.get(request.path_params["id"]).preview(sent)

        return MessageResponse(await run_in_threadpool(work))

    async def versions(self, request: Request) -> Response:
        def work() -> Versions:
            opened = self._recordings.get(request.path_params["id"])
            return Versions(versions=opened.versions())

        return MessageResponse(await run_in_threadpool(work))

    async def version(self, request: Request) -> Response:
        number = number_in(request.path_params["number"])

        def work() -> Comparison:
            return self._recordings.get(request.path_params["id"]).version(number)

        return MessageResponse(await run_in_threadpool(work))

    async def compare(self, request: Request) -> Response:
        sent = from_json(await body(request), CompareRequest)
        name = request.path_params["id"]
        return MessageResponse(await run_in_threadpool(self._compare, name, sent))

    async def export(self, request: Request) -> Response:
        wanted = request.query_params.get("level") or None
        if wanted not in (None, *get_args(Level)):
            raise ParameterError(f"level must be {' or '.join(get_args(Level))}")
        name, kind = request.path_params["id"], request.path_params["format"]
        level = cast(Level | None, wanted)

        def work() -> tuple[str, bytes]:
            from kineme.studio import downloads

            return downloads.exported(self._recordings.get(name), kind, level)

        return file_response(*await run_in_threadpool(work))

    async def events(self, _: Request) -> Response:
        # sse-starlette would be one more dependency for the few lines of Hub.stream, no shorter.
        return StreamingResponse(self._hub.stream(), media_type="text/event-stream")

    async def unknown(self, _: Request) -> Response:
        raise UnknownError("there is nothing at this address")

    def routes(self) -> list[Route]:
        one = "/api/recordings/{id}"
        return [
            Route("/api/state", self.state),
            Route("/api/recordings", self.upload, methods=["POST"]),
            Route(one, self.recording),
            *Pictures(self._recordings).routes(one),
            *Whole(self._recordings).routes(one),
            Route(f"{one}/edits", self.edit, methods=["POST"]),
            Route(f"{one}/preview", self.preview, methods=["POST"]),
            Route(f"{one}/versions", self.versions),
            Route(f"{one}/versions/{{number}}", self.version),
            Route(f"{one}/compare", self.compare, methods=["POST"]),
            Route(f"{one}/export/{{format}}", self.export),
            Route("/api/events", self.events),
            Route("/api{rest:path}", self.unknown),
        ]

    def _state(self) -> State:
        folder = self._recordings.folder
        bases, annotations = (
            [FileChoice(id=name, name=path.name) for name, path in files.items()]
            for files in (folder.knowledge_bases(), folder.annotations())
        )
        return State(
            version=__version__,
            folder=str(folder.root.absolute()),
            of_library=folder.of_library,
            suffixes=recording_suffixes(),
            recordings=[_listing(name, path) for name, path in folder.recordings().items()],
            presets=choices.presets(),
            default_preset=DEFAULT,
            details=choices.details(),
            labels=shared_labels(folder.root),
            knowledge_bases=bases,
            annotations=annotations,
            export_formats=choices.export_formats(),
        )

    def _compare(self, name: str, sent: CompareRequest) -> Comparison:
        from kineme.studio import comparison
        from kineme.web.page_data import segments_message

        opened = self._recordings.get(name)
        shown = opened.table
        if sent.preset is not UNSET and sent.annotation is UNSET:
            title = sent.preset
            other = opened.loaded.segment(title)
            scores = comparison.agreement(shown, other)
        elif sent.annotation is not UNSET and sent.preset is UNSET:
            path = self._recordings.annotation(sent.annotation)
            title = path.name
            other, scores = comparison.annotation(path, opened.path, shown)
        else:
            raise ParameterError("compare with a preset or with an annotation: name one of them")
        return Comparison(name=title, segmentation=segments_message(other), scores=scores)


def _size(path: Path) -> int:
    """Bytes of a file, which may have gone since it was listed."""
    try:
        return path.stat().st_size
    except OSError:
        return 0


def _listing(name: str, path: Path) -> Listing:
    said = progress(path)
    return Listing(
        id=name,
        name=path.name,
        bytes=_size(path),
        corrected=said is not None,
        segments=said.segments if said else 0,
        checked=said.checked if said else 0,
        named=said.named if said else 0,
        to_name=said.to_name if said else 0,
    )
