"""A segmentation while it runs: its stage, how far it is, and a way to end it.

Methods say when a stage begins (`kineme.methods.stages`). How far one is follows from the shares of
time that the stages took on recordings of an hour, and from the pace so far; of methods that are
not listed nobody knows. A segmentation that is cancelled ends when its next stage would begin, or
its work asks whether to go on (`kineme._util.parallel.check_cancelled`), several times a second.
"""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from time import monotonic

from kineme.errors import KinemeError
from kineme.web.messages import Progress

SHARES: Mapping[str, Mapping[str, float]] = {
    "kineme": {
        "features": 0.08,
        "views": 0.05,
        "segments": 0.49,
        "borders": 0.01,
        "repetitions": 0.09,
        "events": 0.01,
        "confidence": 0.27,
    },
}
"""Of the time that a preset takes, by stage in their order: medians of an hour of motion."""
NOTHING = Progress(stage="", share=None)
READING = Progress(stage="reading the file", share=None)
ENDING = Progress(stage="cancelled: it comes to its end", share=None)


class CancelledError(KinemeError):
    """Somebody has said that a result is not wanted any more."""

    def __init__(self) -> None:
        super().__init__("it was cancelled")


class Run:
    """One segmentation by a preset, from any thread."""

    def __init__(self, preset: str, clock: Callable[[], float] = monotonic):
        self._shares, self._clock = SHARES.get(preset, {}), clock
        self._cancelled = threading.Event()
        self._stage, self._starts = "", (clock(), clock())

    def cancel(self) -> None:
        """Have it end."""
        self._cancelled.set()

    def go_on(self) -> None:
        """CancelledError where it should not."""
        if self._cancelled.is_set():
            raise CancelledError

    def stage(self, name: str) -> None:
        """A stage begins; CancelledError where it should not."""
        self.go_on()
        self._stage, self._starts = name, (self._starts[0], self._clock())

    def progress(self) -> Progress:
        """Return what a page is told."""
        if self._cancelled.is_set():
            return ENDING
        stage, (first, last) = self._stage, self._starts
        if stage not in self._shares:
            return Progress(stage=stage, share=None)
        names = list(self._shares)
        before = sum(self._shares[name] for name in names[: names.index(stage)])
        pace = before / (last - first) if last > first else 0.0
        within = pace * (self._clock() - last)
        return Progress(stage=stage, share=before + min(within, self._shares[stage]))


class Runs:
    """Segmentations of a recording that run at present."""

    def __init__(self) -> None:
        self._present: list[Run] = []

    @contextmanager
    def one(self, run: Run) -> Iterator[Run]:
        """One more, while the block lasts."""
        self._present.append(run)
        try:
            yield run
        finally:
            self._present.remove(run)

    def progress(self) -> Progress:
        """Of the latest, if one is running."""
        present = self._present[-1:]
        return present[0].progress() if present else NOTHING

    def cancel(self) -> None:
        """Have all of them end."""
        for run in [*self._present]:
            run.cancel()
