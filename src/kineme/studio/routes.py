"""What each address answers; the list is at the end of `Api`.

Everything that reads, computes or writes runs in a thread of its own, so that
the server answers others meanwhile. What is rarely asked for is imported when
it is.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import cast, get_args

from msgspec import UNSET
from starlette.concurrency import run_in_threadpool
from starlette.requests import Request
from starlette.responses import FileResponse, Response, StreamingResponse
from starlette.routing import Route

from kineme._version import __version__
from kineme.errors import ParameterError
from kineme.methods.presets import DEFAULT
from kineme.segments.table import Level
from kineme.studio import choices
from kineme.studio.folder import file_id, progress
from kineme.studio.http.bodies import (
    LIMIT,
    MessageResponse,
    Upload,
    body,
    chunks,
    file_response,
    number_in,
    recording_suffixes,
    safe_name,
)
from kineme.studio.http.events import Hub
from kineme.studio.loading import LoadedRecording
from kineme.studio.open_recordings import OpenRecordings, UnknownError
from kineme.studio.storage.sidecars import set_offset, share_labels, shared_labels, video_of
from kineme.web.encoding import from_json
from kineme.web.folder_messages import FileChoice, Listing, State
from kineme.web.messages import Comparison, CurveList, Preview, Versions
from kineme.web.requests import (
    ClipsRequest,
    CompareRequest,
    EditRequest,
    KnowledgeRequest,
    LabelsRequest,
    PreviewRequest,
    ReadingRequest,
    VideoRequest,
)

BINARY = "application/octet-stream"


class Api:
    """The addresses under ``/api``; uploads have at most ``limit`` bytes."""

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
        name, kind = request.path_params["id"], request.path_params["format"]
        level = _level(request)

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
            *PictureApi(self._recordings).routes(one),
            *FolderApi(self._recordings).routes(one),
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
        from kineme.evaluation.inputs import agreement
        from kineme.labels.collections import labels_for
        from kineme.web.page_data import segments_message

        opened = self._recordings.get(name)
        table = opened.table
        if sent.preset is not UNSET and sent.annotation is UNSET:
            title = sent.preset
            other = opened.loaded.segment(title)
        elif sent.annotation is not UNSET and sent.preset is UNSET:
            path = self._recordings.annotation(sent.annotation)
            title = path.name
            other = labels_for(
                opened.path, path, n_frames=table.n_frames, fps=table.fps, clock=table.clock
            )
        else:
            raise ParameterError("compare with a preset or with an annotation: name one of them")
        scores = agreement(other, table)  # the other is taken for the truth
        return Comparison(name=title, segmentation=segments_message(other), scores=scores)


class PictureApi:
    """The addresses of what is drawn."""

    def __init__(self, recordings: OpenRecordings):
        self._recordings = recordings

    async def motion(self, request: Request) -> Response:
        n_samples = number_in(request.query_params.get("poses", ""))
        name, poses = request.path_params["id"], self._recordings.poses
        return Response(await run_in_threadpool(poses, name, n_samples), media_type=BINARY)

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

    async def curve_tile(self, request: Request) -> Response:
        place = [number_in(request.path_params[name]) for name in ("curve", "level", "number")]

        def work() -> bytes | None:
            loaded = self._loaded(request)
            return loaded.curves().tile(loaded.source, *place)

        found = await run_in_threadpool(work)
        if found is None:
            raise UnknownError("the curve has no such tile")
        return Response(found, media_type=BINARY)

    def routes(self, one: str) -> list[Route]:
        """Those of a recording, whose address begins with ``one``."""
        return [
            Route(f"{one}/motion", self.motion),
            Route(f"{one}/matrix/{{level}}/{{row}}/{{column}}", self.tile),
            Route(f"{one}/curves", self.curves),
            Route(f"{one}/curves/{{curve}}/{{level}}/{{number}}", self.curve_tile),
        ]

    def _loaded(self, request: Request) -> LoadedRecording:
        return self._recordings.get(request.path_params["id"]).loaded


class FolderApi:
    """The addresses of the folder as a whole."""

    def __init__(self, recordings: OpenRecordings):
        self._recordings = recordings

    async def labels(self, request: Request) -> Response:
        sent = from_json(await body(request), LabelsRequest)
        root = self._recordings.folder.root
        return MessageResponse(await run_in_threadpool(share_labels, root, sent.labels))

    async def export(self, request: Request) -> Response:
        kind, level = request.path_params["format"], _level(request)

        def work() -> tuple[str, bytes]:
            from kineme.studio import downloads

            files = [
                downloads.exported(self._recordings.get(name), kind, level)
                for name in self._checked()
            ]
            return downloads.together(files, self._recordings.folder.root.name or "checked")

        return file_response(*await run_in_threadpool(work))

    async def knowledge(self, request: Request) -> Response:
        sent = from_json(await body(request), KnowledgeRequest)
        return MessageResponse(await run_in_threadpool(self._knowledge, sent))

    async def clips(self, request: Request) -> Response:
        sent = from_json(await body(request), ClipsRequest)
        opened = request.path_params["id"]

        def work() -> tuple[str, bytes]:
            from kineme.studio import downloads

            recording = self._recordings.get(opened)
            return downloads.clip_files(recording, sent.rows, loops=sent.loops)

        return file_response(*await run_in_threadpool(work))

    async def video(self, request: Request) -> Response:
        found = video_of(self._path(request))
        if found is None:
            raise UnknownError("there is no video of that name beside the recording")
        return FileResponse(found)

    async def offset(self, request: Request) -> Response:
        sent = from_json(await body(request), VideoRequest)
        path = self._path(request)
        await run_in_threadpool(set_offset, path, sent.offset_s)
        return MessageResponse({"offset_s": sent.offset_s})

    async def reading(self, request: Request) -> Response:
        sent = from_json(await body(request), ReadingRequest)
        name = request.path_params["id"]
        options = {field: getattr(sent, field) for field in sent.__struct_fields__}
        await run_in_threadpool(self._recordings.read_as, name, options)
        return MessageResponse({field: value for field, value in options.items() if value})

    async def people(self, request: Request) -> Response:
        work = self._recordings.people
        return MessageResponse(await run_in_threadpool(work, request.path_params["id"]))

    def routes(self, one: str) -> list[Route]:
        """These, and those of a recording, whose address begins with ``one``."""
        sent: list[tuple[str, Callable[..., object]]] = [
            ("/api/labels", self.labels),
            ("/api/knowledge", self.knowledge),
            (f"{one}/clips", self.clips),
            (f"{one}/video", self.offset),
            (f"{one}/reading", self.reading),
        ]
        return [
            Route("/api/export/{format}", self.export),
            Route(f"{one}/video", self.video, methods=["GET"]),
            Route(f"{one}/people", self.people),
            *(Route(address, work, methods=["POST"]) for address, work in sent),
        ]

    def _path(self, request: Request) -> Path:
        return self._recordings.get(request.path_params["id"]).path

    def _checked(self) -> list[str]:
        """The recordings all of whose segments are checked."""
        found = self._recordings.folder.recordings()
        done = {name: progress(path) for name, path in found.items()}
        names = [
            name for name, counts in done.items() if counts and counts.checked >= counts.segments
        ]
        if not names:
            raise ParameterError("no recording is checked yet: check all segments of one first")
        return names

    def _knowledge(self, sent: KnowledgeRequest) -> FileChoice:
        """A knowledge base of the named primitives of some recordings, in the folder."""
        from kineme.transfer import KnowledgeBase

        if not sent.recordings:
            raise ParameterError("choose the recordings whose names it is to know")
        bases = []
        for name in sent.recordings:
            opened = self._recordings.get(name)
            loaded = opened.loaded
            bases.append(
                KnowledgeBase.from_recording(
                    loaded.motion, opened.table, effectors=loaded.effectors
                )
            )
        stem = safe_name(f"{sent.name.removesuffix('.npz')}.npz")
        path = self._recordings.folder.root / stem
        if path.exists():
            raise ParameterError(f"{path.name} is there already: take another name")
        KnowledgeBase.merged(*bases).save(path)
        return FileChoice(id=file_id(path), name=path.name)


def _level(request: Request) -> Level | None:
    """The level that an address names, if it names one."""
    level = request.query_params.get("level") or None
    if level not in (None, *get_args(Level)):
        raise ParameterError(f"level must be {' or '.join(get_args(Level))}")
    return cast(Level | None, level)


def _size(path: Path) -> int:
    """Bytes of a file, which may have gone since it was listed."""
    try:
        return path.stat().st_size
    except OSError:
        return 0


def _listing(name: str, path: Path) -> Listing:
    counts = progress(path)
    return Listing(
        id=name,
        name=path.name,
        bytes=_size(path),
        corrected=counts is not None,
        segments=counts.segments if counts else 0,
        checked=counts.checked if counts else 0,
        named=counts.named if counts else 0,
        to_name=counts.to_name if counts else 0,
    )
