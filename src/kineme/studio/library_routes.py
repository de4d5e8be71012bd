"""The addresses of a library: what it is, edits, searches, small figures of spans."""

from __future__ import annotations

import threading
from base64 import b64encode
from collections import OrderedDict
from pathlib import Path

import numpy as np
from starlette.concurrency import run_in_threadpool
from starlette.requests import Request
from starlette.responses import Response
from starlette.routing import Route

from kineme.errors import KinemeError, ParameterError
from kineme.library import Library
from kineme.recordings import Motion, Signals
from kineme.studio.http.bodies import MessageResponse, body
from kineme.studio.library import ShownLibrary
from kineme.studio.open_recordings import OpenRecordings
from kineme.studio.reading import Stamp, stamp_of
from kineme.web.display import display_motion
from kineme.web.encoding import from_json
from kineme.web.library_messages import CallHits, LibraryEdit, LibraryFigure, SearchRequest

MOST_IN_MEMORY = 4
"""Recordings."""
LONGEST = 30.0
"""Seconds that a figure shows at most."""
CHANNELS, POINTS = 6, 120
"""Curves of a recording without a body, and points of each."""


class LibraryApi:
    """The addresses under ``/api/library``."""

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
        query = request.query_params
        try:
            start_s, stop_s = float(query["start"]), float(query["stop"])
        except (KeyError, ValueError):
            raise ParameterError("a figure is of a span: start and stop in seconds") from None

        def work() -> LibraryFigure:
            name = query.get("recording", "")
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


class Figures:
    """Figures of a library; the recordings used last stay in memory."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._recent: OrderedDict[tuple[Path, Stamp], Motion | Signals] = OrderedDict()

    def figure(self, library: Library, name: str, start_s: float, stop_s: float) -> LibraryFigure:
        """What is drawn of a span.

        ParameterError where there is no such recording or nothing in the span, ReadError where the
        file is gone.
        """
        if not 0 <= start_s < stop_s:
            raise ParameterError("a figure is of a span from one second to a later one")
        stop_s = min(stop_s, start_s + LONGEST)
        span = self._read(library, name).seconds(start_s, stop_s)
        if isinstance(span, Signals):
            return LibraryFigure(motion=None, numbers="", curves=_curves(span))
        names = library.settings.effectors
        try:
            head, numbers = display_motion(span, effectors=names)
        except KinemeError:  # names of effectors that this skeleton does not have
            head, numbers = display_motion(span)
        return LibraryFigure(motion=head, numbers=b64encode(numbers).decode(), curves=[])

    def _read(self, library: Library, name: str) -> Motion | Signals:
        path = library.path_of(name)
        with self._lock:  # many figures of a recording are asked for at once
            key = path, stamp_of(path)
            if key not in self._recent:
                self._recent[key] = library.read(name)
            self._recent.move_to_end(key)
            while len(self._recent) > MOST_IN_MEMORY:
                self._recent.popitem(last=False)
            return self._recent[key]


def _curves(signals: Signals) -> list[list[float]]:
    """The first channels, thinned, each between 0 and 1; not seen is in the middle."""
    every = max(1, signals.n_frames // POINTS)
    shown = signals.values[::every, :CHANNELS].astype(float)
    low, high = np.nanmin(shown, axis=0), np.nanmax(shown, axis=0)
    scaled = (shown - low) / np.where(high > low, high - low, 1)
    curves: list[list[float]] = np.nan_to_num(scaled, nan=0.5).T.round(3).tolist()
    return curves
