"""Searches of a library, one at a time; a newer one ends the one before."""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterator, Sequence
from itertools import count
from typing import TypeVar

from msgspec import UNSET
from threadpoolctl import threadpool_limits

from kineme._threads import map_threads
from kineme.errors import ParameterError
from kineme.library import Example, Library
from kineme.library.searching import Named
from kineme.studio.open_recordings import SupersededError
from kineme.web.library_messages import LibraryHit, LibraryHits, SearchRequest, Span

AT_ONCE = 8
"""Tasks of a search between two looks for a newer one."""
Task = TypeVar("Task")
Outcome = TypeVar("Outcome")


class Searches:
    """Searches, each of which ends those before it."""

    def __init__(self) -> None:
        self._numbers = count(1)
        self._newest = 0
        self._searching = threading.Lock()

    def search(self, library: Library, sent: SearchRequest) -> LibraryHits:
        """What a library has that is like the examples.

        Raises
        ------
        SupersededError
            A newer search was asked for meanwhile.
        ParameterError
            Nothing to search for, or no recording of that name.
        """
        mine = self._newest = next(self._numbers)

        def check() -> None:
            if mine != self._newest:
                raise SupersededError("a newer search took the place of this one")

        known = {*library.recordings["recording"]}
        with self._searching:
            check()
            hits = library.search(
                _examples(sent.like, known),
                cluster=None if sent.cluster is UNSET else sent.cluster,
                unlike=_examples(sent.unlike, known),
                threshold=sent.threshold,
                top=sent.top,
                mirror=sent.mirror,
                client=Interruptible(check),
            )
        return LibraryHits(hits=[LibraryHit(**hit._asdict()) for hit in hits])


class Interruptible:
    """Threads of this process, with a look now and then whether anybody still waits.

    Parameters
    ----------
    check : callable
        Raises what ends the work.
    """

    def __init__(self, check: Callable[[], None]):
        self._check = check

    def completed(
        self, work: Callable[[Task], Outcome], tasks: Sequence[Task]
    ) -> Iterator[tuple[Task, Outcome | None]]:
        """Each task and what came of it; see `kineme.library.executors.Executor`."""
        for first in range(0, len(tasks), AT_ONCE):
            self._check()
            some = tasks[first : first + AT_ONCE]
            with threadpool_limits(1):
                yield from zip(some, map_threads(work, some), strict=True)


def _examples(spans: Sequence[Span], known: set[str]) -> list[Example]:
    """Spans as examples, each of a recording of the library and of no other file."""
    for span in spans:
        if span.recording not in known:
            raise ParameterError(f"the library has no recording {span.recording!r:.80}")
    return [Example(Named(span.recording), span.start_s, span.stop_s) for span in spans]
