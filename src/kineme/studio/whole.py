"""What concerns the folder as a whole, and files that go along with a recording.

Shared labels, exports of everything that is checked, knowledge bases, clips of chosen segments,
reference videos.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import cast, get_args

from starlette.concurrency import run_in_threadpool
from starlette.requests import Request
from starlette.responses import FileResponse, Response
from starlette.routing import Route

from kineme.errors import ParameterError
from kineme.segments.table import Level
from kineme.studio.http.answers import MessageResponse, file_response
from kineme.studio.http.bodies import body
from kineme.studio.http.uploads import safe_name
from kineme.studio.open_recordings import OpenRecordings, UnknownError
from kineme.studio.progress import progress
from kineme.studio.storage.sidecars import set_offset, share_labels, video_of
from kineme.web.encoding import from_json
from kineme.web.folder_messages import FileChoice
from kineme.web.requests import (
    ClipsRequest,
    KnowledgeRequest,
    LabelsRequest,
    ReadingRequest,
    VideoRequest,
)


class Whole:
    """The addresses of the folder as a whole.

    Parameters
    ----------
    recordings : OpenRecordings
    """

    def __init__(self, recordings: OpenRecordings):
        self._recordings = recordings

    async def labels(self, request: Request) -> Response:
        sent = from_json(await body(request), LabelsRequest)
        root = self._recordings.folder.root
        return MessageResponse(await run_in_threadpool(share_labels, root, sent.labels))

    async def export(self, request: Request) -> Response:
        wanted = request.query_params.get("level") or None
        if wanted not in (None, *get_args(Level)):
            raise ParameterError(f"level must be {' or '.join(get_args(Level))}")
        kind, level = request.path_params["format"], cast(Level | None, wanted)

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
        said = {field: getattr(sent, field) for field in sent.__struct_fields__}
        await run_in_threadpool(self._recordings.read_as, name, said)
        return MessageResponse({field: value for field, value in said.items() if value})

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
        names = [name for name, said in done.items() if said and said.checked >= said.segments]
        if not names:
            raise ParameterError("no recording is checked yet: check all segments of one first")
        return names

    def _knowledge(self, sent: KnowledgeRequest) -> FileChoice:
        """A knowledge base of the named primitives of some recordings, in the folder."""
        from kineme.studio.folder import file_id
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
