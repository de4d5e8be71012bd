"""Making pieces, here or in several processes; whatever happens to one recording costs it only."""

from __future__ import annotations

import os
import threading
import warnings
from collections.abc import Generator, Iterator, Sequence
from concurrent.futures import FIRST_COMPLETED, Future, ProcessPoolExecutor, wait
from concurrent.futures.process import BrokenProcessPool
from dataclasses import dataclass
from multiprocessing import get_context, parent_process
from multiprocessing.connection import wait as wait_for
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from threadpoolctl import threadpool_limits

from kineme._threads import n_threads
from kineme.errors import KinemeError, KinemeWarning, MissingDependencyError, WriteError
from kineme.formats import read_quietly
from kineme.library.descriptions import describe
from kineme.library.layout import EMBEDDED
from kineme.library.pieces import Piece, has_piece, write_piece
from kineme.library.settings import Settings
from kineme.library.sources import content_digest, size_of
from kineme.recordings import Motion, Signals
from kineme.segmentation.segmenter import segment

PER_WORKER = 1 << 20
"""Bytes of recordings for which one process more is started: a start costs seconds."""
DIED = "the process that worked on it died: it may need more memory than there is"


@dataclass(frozen=True)
class Task:
    """A recording to describe."""

    path: Path
    pieces: Path
    settings: Settings

    def __hash__(self) -> int:
        return hash(self.path)


@dataclass(frozen=True)
class Outcome:
    """What came of a task: the digest of its files, whose piece is there, or why it is not.

    Attributes
    ----------
    digest : str
    new : bool
        Whether it was not there before.
    error : str
    fatal : bool
        Whether others will fail alike, as on a full disk.
    """

    digest: str = ""
    new: bool = False
    error: str = ""
    fatal: bool = False


def outcomes_of(tasks: Sequence[Task], jobs: int) -> Iterator[tuple[Task, Outcome]]:
    """Each task and what came of it, as they come.

    Parameters
    ----------
    tasks : sequence of Task
    jobs : int
        Processes at most; 1 stays in this one.

    Yields
    ------
    task : Task
    outcome : Outcome
    """
    if jobs == 1 or len(tasks) < 2:
        for task in tasks:
            yield task, work_on(task)
        return
    waiting = list(reversed(tasks))
    workers = min(jobs, 1 + sum(size_of(task.path) for task in tasks) // PER_WORKER)
    while waiting:
        suspects = yield from _in_a_pool(waiting, workers)
        for task in suspects:  # alone, so that it is known who ends its process
            dying = yield from _in_a_pool([task], 1)
            if dying:
                yield task, Outcome(error=DIED)


def work_on(task: Task) -> Outcome:
    """Read, segment and describe a recording, unless its piece is there."""
    try:
        with warnings.catch_warnings(), threadpool_limits(1):  # sums do not depend on threads
            warnings.simplefilter("ignore", KinemeWarning)
            options = task.settings.options()
            digest = content_digest(task.path, options.skeleton)
            key = task.settings.key(digest)
            if has_piece(task.pieces, key):
                return Outcome(digest)
            recording = read_quietly(task.path, options)
            write_piece(task.pieces, key, *make_piece(recording, task.settings))
    except (WriteError, MissingDependencyError) as error:
        return Outcome(error=_said(error), fatal=isinstance(error, WriteError))
    except Exception as error:  # noqa: BLE001 (one recording never ends a build)
        return Outcome(error=_said(error))
    return Outcome(digest, new=True)


def make_piece(
    recording: Motion | Signals, settings: Settings
) -> tuple[Piece, NDArray[np.float32]]:
    """What is kept of a recording, and its features.

    Parameters
    ----------
    recording : Motion or Signals
    settings : Settings

    Returns
    -------
    piece : Piece
    features : (samples, dims) array
    """
    emg = settings.options().emg
    found = segment(
        recording,
        preset=settings.preset,
        effectors=settings.effectors,
        emg=emg,
        **settings.constants,
    )
    described = describe(recording, effectors=settings.effectors, emg=emg)
    embeddings = np.zeros((len(found.table), EMBEDDED), np.float32)
    for row, each in enumerate(found.table):
        if each.kind == "activity":
            embeddings[row] = described.embedding(each.start_s, each.stop_s)
    reason = f"not searched: {described.reason}" if described.reason else ""
    facts = {
        "format": recording.provenance.format or "",
        "n_frames": recording.n_frames,
        "fps": recording.fps,
        "vocabulary": described.vocabulary,
        "features_fps": described.fps,
        "notes": [*found.provenance["notes"], *filter(None, [reason])],
    }
    return Piece(facts, found.table, embeddings), described.features


def _in_a_pool(waiting: list[Task], jobs: int) -> Generator[tuple[Task, Outcome], None, list[Task]]:
    """Work on tasks from the end of the list; those in work when a process died are returned."""
    share = max(1, n_threads() // jobs)
    # Started anew, for a copy of this process could wait forever for threads that it lacks.
    pool = ProcessPoolExecutor(
        min(jobs, len(waiting)),
        mp_context=get_context("spawn"),
        initializer=_prepare,
        initargs=(share,),
    )
    running: dict[Future[Outcome], Task] = {}
    try:
        while waiting or running:
            while waiting and len(running) < jobs:
                task = waiting.pop()
                running[pool.submit(work_on, task)] = task
            for future in wait(running, return_when=FIRST_COMPLETED).done:
                outcome = future.result()
                yield running.pop(future), outcome
    except BrokenProcessPool:
        return list(running.values())
    finally:
        pool.shutdown(wait=False, cancel_futures=True)
    return []


def _prepare(threads: int) -> None:
    """Make a worker one of several, which ends when the process that started it is gone."""
    os.environ["KINEME_THREADS"] = str(threads)
    parent = parent_process()
    if parent is not None:
        sentinel = parent.sentinel

        def watch() -> None:
            wait_for([sentinel])
            os._exit(1)

        threading.Thread(target=watch, daemon=True).start()


def _said(error: BaseException) -> str:
    text = " ".join(str(error).split())
    return text if isinstance(error, KinemeError) else f"{type(error).__name__}: {text}"
