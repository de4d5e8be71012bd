"""The segments of a recording that has no table yet, found while the recording is shown."""

from __future__ import annotations

import threading
from collections.abc import Callable
from concurrent.futures import Future, wait

from kineme.segments.segmentation import Segmentation

Found = tuple[Segmentation, list[str]]
SOON = 3.0
"""Seconds that a page waits for segments; the first ones of all take longer, to compile."""


class FirstSegments:
    """Segments that a thread is finding.

    Parameters
    ----------
    find : callable
        Gives a table and notes for people.
    """

    def __init__(self, find: Callable[[], Found]):
        self._found: Future[Found] = Future()
        # Not one of a pool: those are waited for when the server ends.
        threading.Thread(target=self._run, args=[find], name="segments", daemon=True).start()

    def _run(self, find: Callable[[], Found]) -> None:
        try:
            self._found.set_result(find())
        except Exception as error:  # noqa: BLE001 (raised where it is asked for)
            self._found.set_exception(error)

    def are_soon(self) -> bool:
        """Whether they are there within the time that people wait for."""
        return bool(wait([self._found], SOON).done)

    def result(self) -> Found:
        """Table and notes, as soon as they are there; whatever finding them raised."""
        return self._found.result()
