"""Work of the studio in threads: segmentations, and the estimation of poses of videos.

Methods announce their stages (`kineme.methods.base`). Progress is estimated from the share of
time that each stage took on recordings of an hour, and from the speed so far. It is unknown for
other methods. A cancelled segmentation stops at its next stage, or when its code calls
`kineme._util.parallel.check_cancelled`, several times a second.

Poses are estimated for one video after another. An estimation that was cancelled, or cut short by
the end of the server, resumes where it stopped.
"""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from time import monotonic

from msgspec import structs

from kineme._util.parallel import cancellable
from kineme.errors import KinemeError, MissingDependencyError, ReadError
from kineme.formats.files import load_head
from kineme.formats.registry import is_video
from kineme.pose.estimating import has_poses, keep_poses
from kineme.pose.estimators import choose_estimator
from kineme.studio.storage.sidecars import ListedRecording
from kineme.web.messages import PosesProgress, Progress

STAGE_SHARES: Mapping[str, Mapping[str, float]] = {
    "kineme": {
        "features": 0.08,
        "views": 0.05,
        "segments": 0.49,
        "borders": 0.01,
        "repetitions": 0.09,
        "events": 0.01,
        "confidence": 0.27,
    }
}
"""Share of the total time by preset and stage, in order: medians over an hour of motion."""
IDLE = Progress(stage="", share=None)
READING = Progress(stage="reading the file", share=None)
CANCELLING = Progress(stage="cancelled: stopping", share=None)
NO_POSES = PosesProgress(recording="", name="", share=None, pace=0.0, done=0, all=0, failed=[])
"""Progress when no video is in the queue."""


class CancelledError(KinemeError):
    """Raised if a result is no longer wanted."""

    def __init__(self) -> None:
        super().__init__("it was cancelled")


class Run:
    """One segmentation by a preset; thread-safe."""

    def __init__(self, preset: str):
        self._shares = STAGE_SHARES.get(preset, {})
        self._cancelled = threading.Event()
        self._stage, self._starts = "", (monotonic(), monotonic())

    def cancel(self) -> None:
        self._cancelled.set()

    def check_cancelled(self) -> None:
        """Raise CancelledError if the run was cancelled."""
        if self._cancelled.is_set():
            raise CancelledError

    def start_stage(self, name: str) -> None:
        """Start a stage; CancelledError if the run was cancelled."""
        self.check_cancelled()
        self._stage, self._starts = name, (self._starts[0], monotonic())

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
        in_stage = pace * (monotonic() - last)
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
        for run in [*self._present]:
            run.cancel()


class PosesNeededError(ReadError):
    """Raised on reading a video whose poses have not been estimated."""


def needs_poses(path: Path) -> bool:
    """Return whether a file is a video whose poses have not been estimated."""
    return is_video(path) and not has_poses(path)


def require_poses(path: Path) -> None:
    """Raise PosesNeededError for a video without poses: estimating them here would take minutes."""
    if needs_poses(path):
        raise PosesNeededError(path, f"has no poses yet: estimate them, or run kineme pose {path}")


def lacks_estimator() -> str:
    """Return what to install before poses can be estimated; empty if there is an estimator."""
    try:
        choose_estimator(None)
    except MissingDependencyError as error:
        extra = f"pip install 'kineme[{error.extra}]'"
        return f"Estimating poses needs {error.package}: {extra}, then start the studio again"
    return ""


class PoseQueue:
    """Videos whose poses are to be estimated; ``done`` is called with the id of each one done."""

    def __init__(self, done: Callable[[str], None]) -> None:
        self._done = done
        self._lock = threading.Lock()
        self._waiting: list[ListedRecording] = []
        self._run: Run | None = None
        self.progress = NO_POSES

    def start(self, videos: Iterable[ListedRecording]) -> PosesProgress:
        """Add videos that are not in the queue yet, and start the thread if it is idle."""
        with self._lock:
            progress = self.progress
            known = {progress.recording, *(video.id for video in self._waiting)}
            new = [video for video in videos if video.id not in known]
            self._waiting += new
            if self._run is None and new:
                self._run = Run("")
                self.progress = structs.replace(NO_POSES, recording=new[0].id, name=new[0].name)
                threading.Thread(
                    target=self._run_queue, args=[self._run], name="poses", daemon=True
                ).start()
            self._update(all=self.progress.all + len(new))
            return self.progress

    def cancel(self) -> None:
        """Stop; the poses estimated so far are kept."""
        with self._lock:
            if self._run is not None:
                self._run.cancel()
            self._waiting.clear()

    def _run_queue(self, run: Run) -> None:
        """Estimate poses of queued videos until none is left or the run is cancelled."""
        while (listed := self._take_next()) is not None:
            try:
                with cancellable(run.check_cancelled):
                    keep_poses(
                        load_head(listed.path),
                        report=lambda share, pace: self._update(share=share, pace=pace),
                    )
            except CancelledError:
                break
            except KinemeError as error:
                self._update(failed=[*self.progress.failed, str(error)])
            except Exception as error:  # noqa: BLE001 (estimators raise anything; the next video may work)
                reason = f"{listed.name}: the estimator failed: {error}"
                self._update(failed=[*self.progress.failed, reason])
            self._update(done=self.progress.done + 1)
            self._done(listed.id)
        with self._lock:
            self._run, self.progress = None, structs.replace(self.progress, recording="")

    def _take_next(self) -> ListedRecording | None:
        with self._lock:
            if not self._waiting:
                return None
            listed = self._waiting.pop(0)
            self._update(recording=listed.id, name=listed.name, share=None, pace=0.0)
            return listed

    def _update(self, **fields: object) -> None:
        self.progress = structs.replace(self.progress, **fields)
