"""Small figures of spans of recordings, read from their files when they are looked at."""

from __future__ import annotations

import threading
from base64 import b64encode
from collections import OrderedDict
from pathlib import Path

import numpy as np

from kineme.errors import KinemeError, ParameterError
from kineme.library import Library
from kineme.recordings import Motion, Signals
from kineme.studio.reading import Stamp, stamp_of
from kineme.web.display import display_motion
from kineme.web.library_messages import LibraryFigure

MOST_IN_MEMORY = 4
"""Recordings."""
LONGEST = 30.0
"""Seconds that a figure shows at most."""
CHANNELS, POINTS = 6, 120
"""Curves of a recording without a body, and points of each."""


class Figures:
    """Figures of a library; the recordings used last stay in memory."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._known: OrderedDict[tuple[Path, Stamp], Motion | Signals] = OrderedDict()

    def figure(self, library: Library, name: str, start_s: float, stop_s: float) -> LibraryFigure:
        """What is drawn of a span.

        Parameters
        ----------
        library : Library
        name : str
            Of a recording of it.
        start_s, stop_s : float

        Raises
        ------
        ParameterError
            There is no such recording, or nothing in the span.
        ReadError
            Its file is gone.
        """
        if not 0 <= start_s < stop_s:
            raise ParameterError("a figure is of a span from one second to a later one")
        stop_s = min(stop_s, start_s + LONGEST)
        seen = self._read(library, name).seconds(start_s, stop_s)
        if isinstance(seen, Signals):
            return LibraryFigure(motion=None, numbers="", curves=_curves(seen))
        names = library.settings.effectors
        try:
            head, numbers = display_motion(seen, effectors=names)
        except KinemeError:  # names of effectors that this skeleton does not have
            head, numbers = display_motion(seen)
        return LibraryFigure(motion=head, numbers=b64encode(numbers).decode(), curves=[])

    def _read(self, library: Library, name: str) -> Motion | Signals:
        path = library.path_of(name)
        with self._lock:  # many figures of a recording are asked for at once
            key = path, stamp_of(path)
            if key not in self._known:
                self._known[key] = library.read(name)
            self._known.move_to_end(key)
            while len(self._known) > MOST_IN_MEMORY:
                self._known.popitem(last=False)
            return self._known[key]


def _curves(signals: Signals) -> list[list[float]]:
    """The first channels, thinned, each between 0 and 1; not seen is in the middle."""
    every = max(1, signals.n_frames // POINTS)
    shown = signals.values[::every, :CHANNELS].astype(float)
    low, high = np.nanmin(shown, axis=0), np.nanmax(shown, axis=0)
    scaled = (shown - low) / np.where(high > low, high - low, 1)
    curves: list[list[float]] = np.nan_to_num(scaled, nan=0.5).T.round(3).tolist()
    return curves
