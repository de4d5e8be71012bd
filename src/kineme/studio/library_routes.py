"""Routes of a library: state, edits, searches, and small figures of spans."""

from __future__ import annotations

import threading
from base64 import b64encode
from collections import OrderedDict
from pathlib import Path

import numpy as np
from starlette.requests import Request
from starlette.routing import Route

from kineme.errors import KinemeError, ParameterError
from kineme.library import Library
from kineme.recordings import Motion, Signals
from kineme.studio.http.bodies import make_route
from kineme.studio.library import StudioLibrary
from kineme.studio.open_recordings import OpenRecordings
from kineme.studio.recording_cache import Stamp, read_stamp
from kineme.web.display import display_motion
from kineme.web.library_messages import (
    CallEverywhere,
    CallHits,
    LibraryEdit,
    LibraryFigure,
    LibraryHits,
    LibraryState,
    NamedHits,
    SearchRequest,
    TablesChanged,
    TablesRequest,
)

MAX_RECORDINGS = 4
"""Recordings cached in memory."""
MAX_FIGURE_S = 30.0
"""Longest span that a figure shows."""
MAX_CHANNELS, MAX_POINTS = 6, 120
"""Points of each curve; ``MAX_CHANNELS`` is the number of curves."""


class LibraryApi:
    """Routes under ``/api/library``."""

    def __init__(self, library: StudioLibrary, recordings: OpenRecordings):
        self._shown, self._recordings, self._figures = library, recordings, Figures()

    def routes(self) -> list[Route]:
        return [
            make_route("/api/library", self.state),
            make_route("/api/library/edits", self.edit, LibraryEdit),
            make_route("/api/library/tables", self.tables, TablesRequest),
            make_route("/api/library/everywhere", self.everywhere, CallEverywhere),
            make_route("/api/library/search", self.search, SearchRequest),
            make_route("/api/library/names", self.names, CallHits),
            make_route("/api/library/figure", self.figure),
        ]

    def state(self, _: Request) -> LibraryState:
        return self._shown.state()

    def edit(self, _: Request, sent: LibraryEdit) -> LibraryState:
        state = self._shown.edit(sent)
        self._recordings.refresh_tables()
        return state

    def tables(self, _: Request, sent: TablesRequest) -> TablesChanged:
        return self._shown.update_tables(self._recordings, names=sent.names)

    def everywhere(self, _: Request, sent: CallEverywhere) -> TablesChanged:
        return self._shown.rename_everywhere(sent, self._recordings)

    def search(self, _: Request, sent: SearchRequest) -> LibraryHits:
        return self._shown.search(sent)

    def names(self, _: Request, sent: CallHits) -> NamedHits:
        return self._shown.name_hits(sent, self._recordings)

    def figure(self, request: Request) -> LibraryFigure:
        query = request.query_params
        try:
            start_s, stop_s = float(query["start"]), float(query["stop"])
        except (KeyError, ValueError):
            raise ParameterError("a figure needs start and stop in seconds") from None
        name = query.get("recording", "")
        return self._figures.figure(self._shown.library(), name, start_s, stop_s)


class Figures:
    """Figures of a library; the most recently used recordings stay in memory."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._recent: OrderedDict[tuple[Path, Stamp], Motion | Signals] = OrderedDict()

    def figure(self, library: Library, name: str, start_s: float, stop_s: float) -> LibraryFigure:
        """Return the poses or curves of a span.

        ParameterError for an unknown recording or an empty span, ReadError if the file is missing.
        """
        if not 0 <= start_s < stop_s:
            raise ParameterError("the stop of a figure must be after its start")
        stop_s = min(stop_s, start_s + MAX_FIGURE_S)
        span = self._read(library, name).seconds(start_s, stop_s)
        if isinstance(span, Signals):
            return LibraryFigure(motion=None, numbers="", curves=_sample_curves(span))
        effectors = library.segment_options.effectors
        try:
            head, numbers = display_motion(span, effectors=effectors)
        except KinemeError:  # this skeleton lacks the named effectors
            head, numbers = display_motion(span)
        return LibraryFigure(motion=head, numbers=b64encode(numbers).decode(), curves=[])

    def _read(self, library: Library, name: str) -> Motion | Signals:
        path = library.path_of(name)
        with self._lock:  # a page requests many figures of a recording at once
            key = path, read_stamp(path)
            if key not in self._recent:
                self._recent[key] = library.read(name)
            self._recent.move_to_end(key)
            while len(self._recent) > MAX_RECORDINGS:
                self._recent.popitem(last=False)
            return self._recent[key]


def _sample_curves(signals: Signals) -> list[list[float]]:
    """Return the first channels, thinned and scaled to 0 to 1; missing values become 0.5."""
    step = max(1, signals.n_frames // MAX_POINTS)
    samples = signals.values[::step, :MAX_CHANNELS].astype(float)
    low, high = np.nanmin(samples, axis=0), np.nanmax(samples, axis=0)
    scaled = (samples - low) / np.where(high > low, high - low, 1)
    curves: list[list[float]] = np.nan_to_num(scaled, nan=0.5).T.round(3).tolist()
    return curves
