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
from fnmatch import filter as filter_names
from fnmatch import fnmatchcase
from pathlib import Path
from typing import Any

from kineme._util.parallel import defer_interrupt, make_process_pool
from kineme.errors import KinemeError, KinemeWarning, ParameterError, ReadError
from kineme.evaluation.comparison import Comparison, compare
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


@dataclass(frozen=True)
class Reading:
    """How recordings are read, the same for all.

    Parameters
    ----------
    columns : tuple of str
        Patterns (``acc*``) of the columns to take as signals; none: what the file says.
    without : tuple of str
        Patterns of columns to leave out of signals.
    options : dict
        For `kineme.read`, such as ``fps``, ``unit`` and ``up``.
    """

    columns: tuple[str, ...] = ()
    without: tuple[str, ...] = ()
    options: dict[str, Any] = field(default_factory=dict)

    def read(self, path: Path) -> Motion | Signals:
        """Return the recording in a file."""
        from kineme.formats import read

        if not (self.columns or self.without):
            return read(path, **self.options)
        signals = read(path, columns=(), **self.options)
        if not isinstance(signals, Signals):
            raise ParameterError(f"{path}: has no columns to choose from")
        kept = [name for name in signals.names if self.takes(name)]
        if not kept:
            names = ", ".join(signals.names)
            raise ParameterError(f"{path}: no column is left of {names:.200}")
        return signals.select(kept).noted(*self._unmet(signals.names))

    def _unmet(self, names: Sequence[str]) -> list[str]:
        """Return what is said of patterns that no column fits."""
        lower = [name.lower() for name in names]
        unmet = [p for p in (*self.columns, *self.without) if not filter_names(lower, p.lower())]
        return [f"{UNMET} {pattern!r:.60}" for pattern in unmet]

    def takes(self, name: str) -> bool:
        """Whether a column is one of those to take; capitals and small letters are the same."""
        small = name.lower()
        fits = not self.columns or any(fnmatchcase(small, p.lower()) for p in self.columns)
        return fits and not any(fnmatchcase(small, p.lower()) for p in self.without)


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
    recording = job.reading.read(job.path)
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
