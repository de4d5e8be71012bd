"""Addresses of a library: what it is, edits, searches, small figures of spans."""

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
from kineme.studio.library import ShownLibrary
from kineme.studio.open_recordings import OpenRecordings
from kineme.studio.reading import Stamp, read_stamp
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

MOST_IN_MEMORY = 4
"""Recordings."""
LONGEST = 30.0
"""Seconds that a figure shows at most."""
CHANNELS, POINTS = 6, 120
"""Curves of a recording without a body, and points of each."""


class LibraryApi:
    """Addresses under ``/api/library``."""

    def __init__(self, shown: ShownLibrary, recordings: OpenRecordings):
        self._shown, self._recordings, self._figures = shown, recordings, Figures()

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
        self._recordings.renew()
        return state

    def tables(self, _: Request, sent: TablesRequest) -> TablesChanged:
        return self._shown.update_tables(self._recordings, names=sent.names)

    def everywhere(self, _: Request, sent: CallEverywhere) -> TablesChanged:
        return self._shown.call_everywhere(sent, self._recordings)

    def search(self, _: Request, sent: SearchRequest) -> LibraryHits:
        return self._shown.search(sent)

    def names(self, _: Request, sent: CallHits) -> NamedHits:
        return self._shown.call(sent, self._recordings)

    def figure(self, request: Request) -> LibraryFigure:
        query = request.query_params
        try:
            start_s, stop_s = float(query["start"]), float(query["stop"])
        except (KeyError, ValueError):
            raise ParameterError("a figure is of a span: start and stop in seconds") from None
        name = query.get("recording", "")
        return self._figures.figure(self._shown.library(), name, start_s, stop_s)


class Figures:
    """Figures of a library; the recordings used last stay in memory."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._recent: OrderedDict[tuple[Path, Stamp], Motion | Signals] = OrderedDict()

    def figure(self, library: Library, name: str, start_s: float, stop_s: float) -> LibraryFigure:
        """Return what is drawn of a span.

        ParameterError where there is no such recording or nothing in the span, ReadError where the
        file is gone.
        """
        if not 0 <= start_s < stop_s:
            raise ParameterError("a figure is of a span from one second to a later one")
        stop_s = min(stop_s, start_s + LONGEST)
        span = self._read(library, name).seconds(start_s, stop_s)
        if isinstance(span, Signals):
            return LibraryFigure(motion=None, numbers="", curves=_sample_curves(span))
        names = library.segment_options.effectors
        try:
            head, numbers = display_motion(span, effectors=names)
        except KinemeError:  # names of effectors that this skeleton does not have
            head, numbers = display_motion(span)
        return LibraryFigure(motion=head, numbers=b64encode(numbers).decode(), curves=[])

    def _read(self, library: Library, name: str) -> Motion | Signals:
        path = library.path_of(name)
        with self._lock:  # many figures of a recording are asked for at once
            key = path, read_stamp(path)
            if key not in self._recent:
                self._recent[key] = library.read(name)
            self._recent.move_to_end(key)
            while len(self._recent) > MOST_IN_MEMORY:
                self._recent.popitem(last=False)
            return self._recent[key]


def _sample_curves(signals: Signals) -> list[list[float]]:
    """Return the first channels, thinned, each between 0 and 1; not seen is in the middle."""
    every = max(1, signals.n_frames // POINTS)
    shown = signals.values[::every, :CHANNELS].astype(float)
    low, high = np.nanmin(shown, axis=0), np.nanmax(shown, axis=0)
    scaled = (shown - low) / np.where(high > low, high - low, 1)
    curves: list[list[float]] = np.nan_to_num(scaled, nan=0.5).T.round(3).tolist()
    return curves
