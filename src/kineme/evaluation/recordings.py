"""Recordings to evaluate: which files of a folder they are, and what a method finds in each.

ACA, HACA and GMM take the true number of classes, as in all published comparisons; others find
it. Several recordings and methods are worked out here or in several processes.
"""

from __future__ import annotations

import time
import warnings
from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import Future, as_completed
from dataclasses import dataclass, field, replace
from fnmatch import fnmatchcase
from pathlib import Path
from typing import Any

from kineme._util.parallel import defer_interrupt, make_process_pool
from kineme.errors import KinemeError, KinemeWarning, ParameterError, ReadError
from kineme.evaluation.comparison import Comparison, compare
from kineme.formats import ReadOptions, read
from kineme.labels.collections import LabelSource
from kineme.methods.presets import PRESETS
from kineme.recordings.motion import Motion
from kineme.recordings.signals import Signals
from kineme.segments.segmentation import Segmentation
from kineme.transfer.channel_samples import ChannelSamples, channel_samples

UNMET = "has no column like"
"""How a note on a pattern begins that no column of a recording fits, such as a mistyped one."""
NUMBER_OF_CLASSES = "n_classes"
"""Constant of presets that take the true number of classes."""


def read_selected(
    path: Path, options: ReadOptions, without: Sequence[str] = ()
) -> Motion | Signals:
    """Return the recording in a file; where columns are named or left out, its channels.

    Parameters
    ----------
    path : Path
    options : ReadOptions
        Its columns may be patterns (``acc*``), of which a recording takes those it has.
    without : sequence of str
        Patterns of columns to leave out. Capitals and small letters are the same.
    """
    if not (options.columns or without):
        return read(path, **vars(options))
    signals = read(path, **vars(replace(options, columns=())))
    if not isinstance(signals, Signals):
        raise ParameterError(f"{path}: has no columns to choose from")
    columns = options.columns or ("*",)
    kept = [name for name in signals.names if _fits(name, *columns) and not _fits(name, *without)]
    if not kept:
        names = ", ".join(signals.names)
        raise ParameterError(f"{path}: no column is left of {names:.200}")
    unmet = [p for p in (*columns, *without) if not any(_fits(name, p) for name in signals.names)]
    return signals.select(kept).noted(*(f"{UNMET} {pattern!r:.60}" for pattern in unmet))


def _fits(name: str, *patterns: str) -> bool:
    return any(fnmatchcase(name.lower(), pattern.lower()) for pattern in patterns)


def recordings_below(folder: Path) -> list[Path]:
    """Return the recordings in a folder and in the folders in it, one at least, by name."""
    from kineme.formats.listing import recordings_in

    found = recordings_in(folder, recursive=True).recordings
    if not found:
        raise ReadError(folder, "there is no recording in this folder")
    return found


def segment_by(
    name: str, recording: Motion | Signals, *, n_classes: int, **constants: Any
) -> Segmentation:
    """Return the segments that a method finds in a recording.

    Examples
    --------
    >>> import kineme
    >>> motion = kineme.read(kineme.bundled_recording())
    >>> len(segment_by("voegele2014", motion, n_classes=4).activities)
    13
    """
    from kineme.methods.segmenter import segment

    check_method(name)
    # None as the preset's value asks for the true number of classes.
    if getattr(PRESETS[name], NUMBER_OF_CLASSES, 0) is None:
        constants = {NUMBER_OF_CLASSES: n_classes, **constants}
    return segment(recording, preset=name, **constants)


def check_method(name: str) -> None:
    """ParameterError for what is no method."""
    if name not in PRESETS:
        raise ParameterError(f"no method {name!r}; there are {', '.join(PRESETS)}")


@dataclass(frozen=True)
class Job:
    """A method on a recording."""

    path: Path
    source: LabelSource
    method: str
    read_options: ReadOptions
    without: Sequence[str] = ()
    """Columns of signals to leave out."""
    joins: bool = False
    """Whether clusters will be joined with those of other recordings."""
    constants: Mapping[str, Any] = field(default_factory=dict)
    """Of the method that are to be others."""

    def __hash__(self) -> int:
        return hash((self.path, self.method))

    def read(self) -> Motion | Signals:
        """Return the recording."""
        return read_selected(self.path, self.read_options, self.without)


@dataclass(frozen=True, eq=False)
class Sides:
    """Both sides of a comparison, to join the clusters of several recordings first."""

    truth: Segmentation
    found: Segmentation
    samples: ChannelSamples | None
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
    """Yield each job and its answer, as they come."""
    if processes == 1:
        for job in jobs:
            yield job, _answer(job)
        return
    pool = make_process_pool(processes)
    try:
        with defer_interrupt():
            waiting: dict[Future[Answer], Job] = {pool.submit(_answer, job): job for job in jobs}
        for future in as_completed(waiting):
            failure = future.exception()
            yield (
                waiting[future],
                future.result() if failure is None else _describe_failure(failure),
            )
    finally:
        # Also reached when the caller stops early.
        pool.shutdown(cancel_futures=True)  # none is left, or nobody asks any more


def _answer(job: Job) -> Answer:
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", KinemeWarning)
            return worked_out(job)
    except (KinemeError, ValueError, ArithmeticError, MemoryError) as error:
        return _describe_failure(error)


def worked_out(job: Job, clock: Callable[[], float] = time.perf_counter) -> Answer:
    """Return what comes out of a job; raises what its method raises, and times it by this clock."""
    recording = job.read()
    truth = job.source.of(
        n_frames=recording.n_frames, fps=recording.fps, clock=recording.provenance.clock
    )
    classes: dict[str, int] = {}
    # Numbers the classes as the truth has them; the comparison itself is not needed.
    compare(truth, truth, classes=classes)
    start = clock()
    found = segment_by(job.method, recording, n_classes=len(classes), **job.constants)
    seconds = clock() - start
    compared = compare(truth, found, classes=classes)
    sides = None
    if job.joins:
        samples = channel_samples(recording) if isinstance(recording, Signals) else None
        # The hierarchy is large and is not needed for joining.
        sides = Sides(truth, replace(found, hierarchy=None), samples)
    unmet = (str(note) for note in recording.provenance.notes if note.startswith(UNMET))
    notes = (*unmet, *truth.provenance.get("notes", ()))
    return Answer(compared, sides, classes, seconds, recording.duration, notes)


def _describe_failure(error: BaseException) -> Answer:
    text = " ".join(str(error).split())
    return Answer(
        error=text if isinstance(error, KinemeError) else f"{type(error).__name__}: {text}"
    )
