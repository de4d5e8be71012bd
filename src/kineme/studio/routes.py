"""Handlers of all routes, and the application with its error responses and access control.

Handlers that read, compute or write run in threads, so that the server stays responsive. Rarely
used modules are imported when needed.
"""

from __future__ import annotations

from collections.abc import Callable
from math import isfinite
from pathlib import Path
from typing import TYPE_CHECKING, Any, cast, get_args

from msgspec import UNSET
from starlette.applications import Starlette
from starlette.background import BackgroundTask
from starlette.concurrency import run_in_threadpool
from starlette.exceptions import HTTPException
from starlette.requests import ClientDisconnect, Request
from starlette.responses import FileResponse, Response, StreamingResponse
from starlette.routing import BaseRoute, Mount, Route
from starlette.staticfiles import StaticFiles

from kineme._util.files import find_video
from kineme._util.json import options_from_json
from kineme._version import __version__
from kineme.errors import (
    KinemeError,
    LinkError,
    ParameterError,
    ReadError,
    SeveralPeopleError,
    WriteError,
)
from kineme.formats import ReadOptions
from kineme.methods.presets import DEFAULT
from kineme.segments.table import Level
from kineme.studio import choices
from kineme.studio.annotators import list_annotators, make_label_lanes, measure_agreement
from kineme.studio.edits import read_table
from kineme.studio.folder import Progress, count_progress
from kineme.studio.http.bodies import (
    MAX_UPLOAD,
    MessageResponse,
    TooLargeError,
    TooSlowError,
    Upload,
    list_recording_suffixes,
    make_file_response,
    make_route,
    make_safe_name,
    parse_number,
    read_chunks,
)
from kineme.studio.http.events import Hub
from kineme.studio.http.security import Guard, is_trusted
from kineme.studio.jobs import PoseQueue, PosesNeededError, lacks_estimator, needs_poses
from kineme.studio.loading import SKETCH_REVISION
from kineme.studio.open_recording import ConflictError, OpenRecording
from kineme.studio.open_recordings import (
    OpenRecordings,
    SupersededError,
    UnknownError,
    rename_everywhere,
)
from kineme.studio.storage.sidecars import (
    ListedRecording,
    make_file_id,
    read_shared_labels,
    write_shared_labels,
    write_video_offset,
)
from kineme.web import STATIC, messages, requests
from kineme.web.annotator_messages import Agreement, AgreementRequest, LabelLane
from kineme.web.library_messages import CallEverywhere, TablesChanged
from kineme.web.matrix import make_tile
from kineme.web.tables import make_segments_message

if TYPE_CHECKING:
    from kineme.studio.library import StudioLibrary

BINARY = "application/octet-stream"
VIDEO_TYPES = {".mov": "video/mp4", ".m4v": "video/mp4", ".mkv": "video/webm"}
"""Media types that browsers accept for similar containers."""

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

    routes: list[BaseRoute] = []
    if library is not None:
        from kineme.studio.library import LibraryApi  # reads Parquet

        routes += LibraryApi(library, recordings).routes()
    assets = StaticFiles(directory=static / "assets", check_dir=False)
    routes += Api(recordings, hub, limit=limit).routes()
    routes += [Route("/", page), Mount("/assets", assets)]
    handlers: dict[Any, Handler] = {
        **dict.fromkeys(STATUS, _answer_known_error),
        ClientDisconnect: lambda *_: Response(status_code=400),  # never read: the client is gone
        HTTPException: _answer_http_error,
        Exception: lambda *_: _make_failure("the server failed: see its terminal for details", 500),
    }
    app = Starlette(routes=routes, exception_handlers=handlers)
    return Guard(app, token=token, port=port, development=development)


def _answer_known_error(_: Request, error: Exception) -> Response:
    status = next(STATUS[kind] for kind in type(error).__mro__ if kind in STATUS)
    people = error.people if isinstance(error, SeveralPeopleError) else ()
    needs_poses = isinstance(error, PosesNeededError)
    can_retry = isinstance(error, ReadError) and not needs_poses
    failure = messages.Failure(
        error=str(error), people=[*people], reading=can_retry, poses=needs_poses
    )
    return MessageResponse(failure, status)


def _answer_http_error(_: Request, error: Exception) -> Response:
    status = error.status_code if isinstance(error, HTTPException) else 500
    wrong_method = "this address does not accept this method"
    return _make_failure(wrong_method if status == 405 else "there is nothing here", status)


def _make_failure(reason: str, status: int) -> Response:
    return MessageResponse(messages.Failure(error=reason), status)


class Api:
    """Handlers under ``/api``; ``limit`` is the largest upload in bytes."""

    def __init__(self, recordings: OpenRecordings, hub: Hub, *, limit: int = MAX_UPLOAD):
        self._recordings, self._hub, self._limit = recordings, hub, limit
        self._poses = PoseQueue(lambda name: hub.tell(name, SKETCH_REVISION + 1))

    def routes(self) -> list[Route]:
        one, get = "/api/recordings/{id}", self._get_opened
        return [
            make_route("/api/state", self.state),
            make_route("/api/tables", lambda _: self._recordings.tables()),
            make_route("/api/names", self.names, CallEverywhere),
            make_route("/api/labels", self.labels, requests.LabelsRequest),
            make_route("/api/knowledge", self.knowledge, requests.KnowledgeRequest),
            make_route("/api/annotators", lambda _: list_annotators(self._recordings)),
            make_route("/api/agreement", self.agreement, AgreementRequest),
            make_route("/api/export/{format}", self.export_checked),
            Route("/api/recordings", self.upload, methods=["POST"]),
            make_route(one, self.recording),
            make_route(f"{one}/motion", self.motion),
            make_route(f"{one}/matrix/{{level}}/{{row}}/{{column}}", self.tile),
            make_route(f"{one}/curves", lambda request: get(request).loaded.curves().head()),
            make_route(f"{one}/curves/{{curve}}/{{level}}/{{number}}", self.curve_tile),
            make_route(f"{one}/cycles", self.cycle_channels),
            make_route(f"{one}/cycles/{{cluster}}", self.cycle_curves),
            make_route(f"{one}/edits", self.edit, requests.EditRequest),
            make_route(f"{one}/preview", self.preview, requests.PreviewRequest),
            make_route(f"{one}/progress", self.progress),
            Route(f"{one}/cancel", self.cancel, methods=["POST"]),
            make_route(f"{one}/versions", self.versions),
            make_route(f"{one}/versions/{{number}}", self.version),
            make_route(f"{one}/compare", self.compare, requests.CompareRequest),
            make_route(f"{one}/lanes", self.lanes, AgreementRequest),
            make_route(f"{one}/export/{{format}}", self.export),
            make_route(f"{one}/clips", self.clips, requests.ClipsRequest),
            make_route(f"{one}/loops", self.loops),
            make_route(f"{one}/loops/{{number}}", self.loop),
            make_route(f"{one}/video", self.video),
            make_route(f"{one}/video", self.offset, requests.VideoRequest),
            make_route(f"{one}/keypoints", self.keypoints),
            make_route(f"{one}/reading", self.reading, requests.ReadRequest),
            make_route("/api/poses", lambda _: self._poses.progress),
            make_route("/api/poses", self.estimate, requests.PosesRequest),
            Route("/api/poses/cancel", self.stop_estimating, methods=["POST"]),
            Route("/api/events", self.events),
            Route("/api{rest:path}", self.unknown),
        ]

    def state(self, _: Request) -> messages.State:
        folder = self._recordings.folder
        recordings = folder.recordings()
        bases, annotations = (
            [messages.FileChoice(id=name, name=path.name) for name, path in files.items()]
            for files in (folder.knowledge_bases(), folder.annotations(recordings.values()))
        )
        listings = [_make_listing(listed) for listed in recordings.values()]
        return messages.State(
            version=__version__,
            folder=str(folder.root.absolute()),
            of_library=folder.is_library,
            suffixes=list_recording_suffixes(),
            recordings=listings,
            presets=choices.list_presets(),
            default_preset=DEFAULT,
            details=choices.list_details(),
            labels=read_shared_labels(folder.root),
            knowledge_bases=bases,
            annotations=annotations,
            export_formats=choices.list_export_formats(),
            install=lacks_estimator() if any(each.needs_poses for each in listings) else "",
        )

    def names(self, _: Request, sent: CallEverywhere) -> TablesChanged:
        return rename_everywhere(self._recordings, sent)

    def labels(self, _: Request, sent: requests.LabelsRequest) -> list[str]:
        return write_shared_labels(self._recordings.folder.root, sent.labels)

    def knowledge(self, _: Request, sent: requests.KnowledgeRequest) -> messages.FileChoice:
        """Save a knowledge base with the named primitives of some recordings; return its file."""
        from kineme.transfer import KnowledgeBase

        if not sent.recordings:
            raise ParameterError("choose the recordings whose names go into the knowledge base")
        bases = []
        for name in sent.recordings:
            opened = self._recordings.get(name)
            motion, effectors = opened.loaded.motion, opened.loaded.effectors
            bases.append(KnowledgeBase.from_recording(motion, opened.table, effectors=effectors))
        stem = make_safe_name(f"{sent.name.removesuffix('.npz')}.npz")
        path = self._recordings.folder.root / stem
        if path.exists():
            raise ParameterError(f"{path.name} exists already: choose another name")
        KnowledgeBase.merged(*bases).save(path)
        return messages.FileChoice(id=make_file_id(path), name=path.name)

    def export_checked(self, request: Request) -> Response:
        """Return a ZIP with all recordings whose segments are all checked."""
        from kineme.studio import downloads

        kind, level = request.path_params["format"], _parse_level(request)
        folder = self._recordings.folder
        counts = {name: count_progress(listed) for name, listed in folder.recordings().items()}
        names = [name for name, n in counts.items() if n and n.checked == n.segments]
        if not names:
            raise ParameterError("no recording is checked yet: check all segments of one first")
        opened = [self._recordings.get(name) for name in names]
        file = downloads.export_several(opened, folder.root.name or "folder", kind, level)
        return make_file_response(*file)

    async def upload(self, request: Request) -> Response:
        length = request.headers.get("content-length", "")
        upload = Upload(
            self._recordings.folder.root,
            request.query_params.get("name", ""),
            length=int(length) if length.isdigit() else None,
            limit=self._limit,
        )
        with upload:
            async for chunk in read_chunks(request):
                upload.write(chunk)
            path = await run_in_threadpool(upload.finish)
        self._recordings.folder.add(path)
        self._hub.tell(make_file_id(path), 0)
        return MessageResponse(_make_listing(ListedRecording(path)))

    def recording(self, request: Request) -> messages.Recording:
        return self._recordings.message(request.path_params["id"])

    def motion(self, request: Request) -> Response:
        n_samples = parse_number(request.query_params.get("poses", ""))
        poses = self._recordings.poses(request.path_params["id"], n_samples)
        return Response(poses, media_type=BINARY)

    def tile(self, request: Request) -> Response:
        indices = _parse_numbers(request, "level", "row", "column")
        png = make_tile(self._get_opened(request).loaded.page_data().matrix, *indices)
        if png is None:
            raise UnknownError("the matrix has no such tile")
        return Response(png, media_type="image/png")

    def curve_tile(self, request: Request) -> Response:
        indices = _parse_numbers(request, "curve", "level", "number")
        loaded = self._get_opened(request).loaded
        pairs = loaded.curves().tile(loaded.get_source, *indices)
        if pairs is None:
            raise UnknownError("the curve has no such tile")
        return Response(pairs, media_type=BINARY)

    def cycle_channels(self, request: Request) -> messages.CycleChannels:
        curves = self._get_opened(request).loaded.cycle_curves()
        return messages.CycleChannels(channels=curves.channels())

    def cycle_curves(self, request: Request) -> messages.ClusterCurves:
        opened, channel = self._get_opened(request), request.query_params.get("channel", "")
        (cluster,) = _parse_numbers(request, "cluster")
        curves, other_id = opened.loaded.cycle_curves(), request.query_params.get("beside")
        if other_id:
            other = self._recordings.get(other_id)
            others = other.loaded.cycle_curves(), other.table
            message = curves.compare_with(opened.table, cluster, channel, *others)
        else:
            message = curves.make_curves(opened.table, cluster, channel)
        if message is None:
            raise UnknownError("there are no such repetitions, or no such channel")
        return message

    def edit(self, request: Request, sent: requests.EditRequest) -> messages.Edited:
        return self._recordings.edit(request.path_params["id"], sent)

    def preview(self, request: Request, sent: requests.PreviewRequest) -> messages.Preview:
        return self._get_opened(request).preview(sent)

    def progress(self, request: Request) -> messages.Progress:
        return self._recordings.progress(request.path_params["id"])

    async def cancel(self, request: Request) -> Response:
        self._recordings.cancel(request.path_params["id"])
        return Response(status_code=204)

    def versions(self, request: Request) -> messages.Versions:
        return messages.Versions(versions=self._get_opened(request).versions())

    def version(self, request: Request) -> messages.Comparison:
        return self._get_opened(request).version(*_parse_numbers(request, "number"))

    def compare(self, request: Request, sent: requests.CompareRequest) -> messages.Comparison:
        from kineme.evaluation import evaluate, scores
        from kineme.evaluation.inputs import find_differences

        opened = self._get_opened(request)
        table = opened.table
        if sent.preset is not UNSET and sent.annotation is UNSET:
            title = sent.preset
            other = opened.loaded.segment(title)
        elif sent.annotation is not UNSET and sent.preset is UNSET:
            path = self._recordings.annotation(sent.annotation)
            title = path.name
            other = read_table(opened.listed, path, table)
        else:
            raise ParameterError("name a preset or an annotation to compare with")
        # The other table counts as the truth; without an activity there is nothing to score.
        known = bool((other.activities.kind == "activity").any())
        found = evaluate(other, table) if known else {}
        values = {name: value for name, value in found.items() if isfinite(value)}
        return messages.Comparison(
            name=title,
            segmentation=make_segments_message(other),
            scores=values,
            meanings={
                name: messages.ScoreMeaning(title=scores()[name].title, help=scores()[name].help)
                for name in values
            },
            differences=find_differences(other, table) if known else [],
        )

    def agreement(self, _: Request, sent: AgreementRequest) -> Agreement:
        return measure_agreement(self._recordings, sent.annotators)

    def lanes(self, request: Request, sent: AgreementRequest) -> list[LabelLane]:
        return make_label_lanes(self._recordings, request.path_params["id"], sent.annotators)

    def export(self, request: Request) -> Response:
        from kineme.studio import downloads

        opened, kind = self._get_opened(request), request.path_params["format"]
        return make_file_response(*downloads.export_download(opened, kind, _parse_level(request)))

    def clips(self, request: Request, sent: requests.ClipsRequest) -> Response:
        from kineme.studio import downloads

        files = downloads.make_clip_archive(self._get_opened(request), sent.rows, loops=sent.loops)
        return make_file_response(*files)

    def loops(self, request: Request) -> messages.Loops:
        from kineme.studio import downloads

        return downloads.rank_loops(self._get_opened(request))

    def loop(self, request: Request) -> messages.PlayedLoop:
        from kineme.studio import downloads

        return downloads.make_played_loop(
            self._get_opened(request), *_parse_numbers(request, "number")
        )

    def video(self, request: Request) -> Response:
        path = find_video(self._recordings.find_listed(request.path_params["id"]).path)
        if path is None:
            raise UnknownError("there is no video of that name next to the recording")
        return FileResponse(path, media_type=VIDEO_TYPES.get(path.suffix.lower()))

    def keypoints(self, request: Request) -> Response:
        picture = self._get_opened(request).loaded.picture()
        if picture is None:
            raise UnknownError("these poses do not come from a video")
        return Response(picture.binary, media_type=BINARY)

    def offset(self, request: Request, sent: requests.VideoRequest) -> requests.VideoRequest:
        write_video_offset(self._get_opened(request).path, sent.offset_s)
        return sent

    def reading(self, request: Request, sent: requests.ReadRequest) -> list[str]:
        options = options_from_json(ReadOptions, sent.options)
        name = request.path_params["id"]
        return self._recordings.change_reading(name, options, everybody=sent.everybody)

    def estimate(self, _: Request, sent: requests.PosesRequest) -> messages.PosesProgress:
        if missing := lacks_estimator():
            raise ParameterError(missing)
        listed = [self._recordings.find_listed(name) for name in sent.recordings]
        return self._poses.start(each for each in listed if needs_poses(each.path))

    async def stop_estimating(self, _: Request) -> Response:
        self._poses.cancel()
        return Response(status_code=204)

    async def events(self, _: Request) -> Response:
        return StreamingResponse(self._hub.stream(), media_type="text/event-stream")

    async def unknown(self, _: Request) -> Response:
        raise UnknownError("there is nothing at this address")

    def _get_opened(self, request: Request) -> OpenRecording:
        return self._recordings.get(request.path_params["id"])


def _parse_numbers(request: Request, *names: str) -> list[int]:
    """Return the numbers in the path of a request."""
    return [parse_number(request.path_params[name]) for name in names]


def _parse_level(request: Request) -> Level | None:
    """Return the level in the query of a request; None without one."""
    level = request.query_params.get("level") or None
    if level not in (None, *get_args(Level)):
        raise ParameterError(f"level must be {' or '.join(get_args(Level))}")
    return cast(Level | None, level)


def _get_file_size(path: Path) -> int:
    """Return the bytes of a file; 0 if it was deleted after it was listed."""
    try:
        return path.stat().st_size
    except OSError:
        return 0


def _make_listing(listed: ListedRecording) -> messages.Listing:
    """Return the entry of a recording in the list of the page."""
    counts = count_progress(listed)
    return messages.Listing(
        id=listed.id,
        file=make_file_id(listed.path),
        name=listed.name,
        bytes=_get_file_size(listed.path),
        needs_poses=needs_poses(listed.path),
        corrected=counts is not None,
        **vars(counts or Progress(0, 0, 0, 0)),
    )
