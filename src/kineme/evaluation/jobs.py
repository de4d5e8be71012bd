"""A method on a recording with labels, here or in several processes: what there is to score."""

from __future__ import annotations

import time
import warnings
from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import Future, as_completed
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

from kineme._processes import interrupted_later, pool_of
from kineme.errors import KinemeError, KinemeWarning
from kineme.evaluation.comparison import Comparison, compare
from kineme.evaluation.methods import segment_by
from kineme.evaluation.recordings import UNMET, Reading
from kineme.labels.collections import LabelSource
from kineme.recordings.motion import Motion
from kineme.recordings.signals import Signals
from kineme.segments.segmentation import Segmentation
from kineme.transfer.moments import Moments, moments_of


@dataclass(frozen=True)
class Job:
    """A method on a recording."""

    path: Path
    source: LabelSource
    method: str
    reading: Reading
    joins: bool = False
    """Whether clusters will be joined with those of other recordings."""
    constants: Mapping[str, Any] = field(default_factory=dict)
    """Of the method that are to be others."""

    def __hash__(self) -> int:
        return hash((self.path, self.method))


@dataclass(frozen=True, eq=False)
class Sides:
    """Both sides of a comparison, to join the clusters of several recordings first."""

    truth: Segmentation
    found: Segmentation
    moments: Moments | None
    """Of signals; motions are read again."""


@dataclass(frozen=True, eq=False)
class Answer:
    """What came out of a job: something to compare, or an error."""

    compared: Comparison | None = None
    sides: Sides | None = None
    classes: Mapping[str, int] = field(default_factory=dict)
    seconds: float = 0.0
    length_s: float = 0.0
    notes: tuple[str, ...] = ()
    error: str = ""


def answers_to(jobs: Sequence[Job], processes: int) -> Iterator[tuple[Job, Answer]]:
    """Each job and its answer, as they come.

    Parameters
    ----------
    jobs : sequence of Job
    processes : int
        How many at once; 1 stays in this process.

    Yields
    ------
    job : Job
    answer : Answer
    """
    if processes == 1:
        for job in jobs:
            yield job, _answer(job)
        return
    pool = pool_of(processes)
    try:
        with interrupted_later():
            waiting: dict[Future[Answer], Job] = {pool.submit(_answer, job): job for job in jobs}
        for future in as_completed(waiting):
            failure = future.exception()
            yield waiting[future], future.result() if failure is None else _failed(failure)
    finally:
        pool.shutdown(cancel_futures=True)  # none is left, or nobody asks any more


def _answer(job: Job) -> Answer:
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", KinemeWarning)
            return worked_out(job)
    except (KinemeError, ValueError, ArithmeticError, MemoryError) as error:
        return _failed(error)


def worked_out(job: Job, clock: Callable[[], float] = time.perf_counter) -> Answer:
    """What comes out of a job; raises what its method raises, and times it by this clock."""
    recording = job.reading.read(job.path)
    truth = job.source.of(
        n_frames=recording.n_frames, fps=recording.fps, clock=recording.provenance.clock
    )
    classes: dict[str, int] = {}
    compare(truth, truth, classes=classes)
    start = clock()
    found = segment_by(job.method, recording, n_classes=len(classes), **job.constants)
    seconds = clock() - start
    compared = compare(truth, found, classes=classes)
    sides = sides_of(recording, truth, found) if job.joins else None
    unmet = (str(note) for note in recording.provenance.notes if note.startswith(UNMET))
    notes = (*unmet, *truth.provenance.get("notes", ()))
    return Answer(compared, sides, classes, seconds, recording.duration, notes)


def sides_of(recording: Motion | Signals, truth: Segmentation, found: Segmentation) -> Sides:
    """Both sides as they can be joined with others.

    Parameters
    ----------
    recording : Motion or Signals
    truth, found : Segmentation

    Returns
    -------
    Sides
    """
    moments = moments_of(recording) if isinstance(recording, Signals) else None
    return Sides(truth, replace(found, hierarchy=None), moments)


def _failed(error: BaseException) -> Answer:
    text = " ".join(str(error).split())
    return Answer(
        error=text if isinstance(error, KinemeError) else f"{type(error).__name__}: {text}"
    )
