"""A running segmentation: its stage, its progress, and its cancellation.

Methods announce their stages (`kineme.methods.stages`). Progress is estimated from the share of
time that each stage took on recordings of an hour, and from the speed so far. It is unknown for
other methods. A cancelled segmentation stops at its next stage, or when its code calls
`kineme._util.parallel.check_cancelled`, several times a second.
"""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from time import monotonic

from kineme.errors import KinemeError
from kineme.web.messages import Progress

STAGE_SHARES: Mapping[str, Mapping[str, float]] = {
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
"""Share of the total time by preset and stage, in order: medians over an hour of motion."""
IDLE = Progress(stage="", share=None)
READING = Progress(stage="reading the file", share=None)
CANCELLING = Progress(stage="cancelled: stopping", share=None)


class CancelledError(KinemeError):
    """Raised if a result is no longer wanted."""

    def __init__(self) -> None:
        super().__init__("it was cancelled")


class Run:
    """One segmentation by a preset; thread-safe."""

    def __init__(self, preset: str, clock: Callable[[], float] = monotonic):
        self._shares, self._clock = STAGE_SHARES.get(preset, {}), clock
        self._cancelled = threading.Event()
        self._stage, self._starts = "", (clock(), clock())

    def cancel(self) -> None:
        """Cancel the run."""
        self._cancelled.set()

    def check_cancelled(self) -> None:
        """Raise CancelledError if the run was cancelled."""
        if self._cancelled.is_set():
            raise CancelledError

    def start_stage(self, name: str) -> None:
        """Start a stage; CancelledError if the run was cancelled."""
        self.check_cancelled()
        self._stage, self._starts = name, (self._starts[0], self._clock())

    def progress(self) -> Progress:
        """Return the progress message for pages."""
        if self._cancelled.is_set():
            return CANCELLING
        stage, (first, last) = self._stage, self._starts
        if stage not in self._shares:
            return Progress(stage=stage, share=None)
        names = list(self._shares)
        done = sum(self._shares[name] for name in names[: names.index(stage)])
        pace = done / (last - first) if last > first else 0.0
        in_stage = pace * (self._clock() - last)
        return Progress(stage=stage, share=done + min(in_stage, self._shares[stage]))


class Runs:
    """Running segmentations of a recording."""

    def __init__(self) -> None:
        self._present: list[Run] = []

    @contextmanager
    def track(self, run: Run) -> Iterator[Run]:
        """List a run while the block lasts."""
        self._present.append(run)
        try:
            yield run
        finally:
            self._present.remove(run)

    def progress(self) -> Progress:
        """Return the progress of the latest run."""
        present = self._present[-1:]
        return present[0].progress() if present else IDLE

    def cancel(self) -> None:
        """Cancel all runs."""
        for run in [*self._present]:
            run.cancel()
