"""Poses of videos, estimated for pages that watch: one video after the other, in a thread.

What is cancelled, or ends with the server, goes on where it was when it is asked for again.
"""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterable
from pathlib import Path

from msgspec import structs

from kineme._util.parallel import cancellable
from kineme.errors import KinemeError, MissingDependencyError, ReadError
from kineme.formats.files import load_head
from kineme.formats.registry import is_video
from kineme.pose.estimating import has_poses, keep_poses
from kineme.pose.estimators import choose_estimator
from kineme.studio.running import CancelledError, Run
from kineme.studio.storage.listed import ListedRecording
from kineme.web.messages import PosesProgress

NOTHING = PosesProgress(recording="", name="", share=None, pace=0.0, done=0, all=0, failed=[])


class PosesNeededError(ReadError):
    """A video is to be read whose poses have not been estimated."""


def needs_poses(path: Path) -> bool:
    """Return whether a file is a video whose poses have not been estimated."""
    return is_video(path) and not has_poses(path)


def require_poses(path: Path) -> None:
    """Raise PosesNeededError for such a video: to read it would take minutes that nobody sees."""
    if needs_poses(path):
        raise PosesNeededError(path, f"has no poses yet: estimate them, or run kineme pose {path}")


def lacks_estimator() -> str:
    """Return what to install before poses can be estimated; empty where there is an estimator."""
    try:
        choose_estimator(None)
    except MissingDependencyError as error:
        extra = f"pip install 'kineme[{error.extra}]'"
        return f"Estimating poses needs {error.package}: {extra}, then start the studio again"
    return ""


class PoseQueue:
    """Videos whose poses are to be estimated; ``done`` is called with the id of each that is."""

    def __init__(self, done: Callable[[str], None]) -> None:
        self._done = done
        self._lock = threading.Lock()
        self._waiting: list[ListedRecording] = []
        self._run: Run | None = None
        self._progress = NOTHING

    def start(self, videos: Iterable[ListedRecording]) -> PosesProgress:
        """Add videos to the queue, unless they are in it, and see that it is worked on."""
        with self._lock:
            former = self._progress
            known = {former.recording, *(each.id for each in self._waiting)}
            new = [each for each in videos if each.id not in known]
            self._waiting += new
            if self._run is None and new:
                self._run = Run("")
                self._progress = structs.replace(NOTHING, recording=new[0].id, name=new[0].name)
                threading.Thread(
                    target=self._work, args=[self._run], name="poses", daemon=True
                ).start()
            self._tell(all=self._progress.all + len(new))
            return self._progress

    def progress(self) -> PosesProgress:
        """Return how far it is."""
        return self._progress

    def cancel(self) -> PosesProgress:
        """Have it end; the poses of each video so far are kept."""
        with self._lock:
            if self._run is not None:
                self._run.cancel()
            self._waiting.clear()
        return self._progress

    def _work(self, run: Run) -> None:
        while (listed := self._next()) is not None:
            try:
                self._estimate(listed, run)
            except CancelledError:
                break
            except KinemeError as error:
                self._tell(failed=[*self._progress.failed, str(error)])
            except Exception as error:  # noqa: BLE001 (of an estimator: the next video may do)
                said = f"{listed.name}: the estimator failed: {error}"
                self._tell(failed=[*self._progress.failed, said])
            self._tell(done=self._progress.done + 1)
            self._done(listed.id)
        with self._lock:
            self._run, self._progress = None, structs.replace(self._progress, recording="")

    def _next(self) -> ListedRecording | None:
        with self._lock:
            if not self._waiting:
                return None
            listed = self._waiting.pop(0)
            self._tell(recording=listed.id, name=listed.name, share=None, pace=0.0)
            return listed

    def _estimate(self, listed: ListedRecording, run: Run) -> None:
        with cancellable(run.go_on):
            keep_poses(
                load_head(listed.path),
                report=lambda share, pace: self._tell(share=share, pace=pace),
            )

    def _tell(self, **news: object) -> None:
        self._progress = structs.replace(self._progress, **news)
