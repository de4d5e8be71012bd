"""Methods on a folder of recordings with labels: every score of each, and over all of them.

ACA, HACA and GMM take the true number of classes, as in all published comparisons; others find it.
Several recordings and methods are worked out here or in several processes.

Clusters stand for classes by one mapping a recording, or by one for the whole folder; for the
latter the clusters of all recordings are joined first: bodies, and signals of the same channels,
have a vocabulary each, and nothing is one cluster across these. What one method finds is joined by
itself. A recording that cannot be read, segmented or compared costs itself only, and says why.
"""

from __future__ import annotations

import json
import time
import warnings
from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import Future, as_completed
from dataclasses import dataclass, field, replace
from fnmatch import fnmatchcase
from pathlib import Path
from typing import Any, Literal

from kineme._util.parallel import defer_interrupt, make_process_pool
from kineme._version import __version__
from kineme.errors import KinemeError, KinemeWarning, MotionError, ParameterError, ReadError
from kineme.evaluation.comparison import Comparison, compare, map_clusters
from kineme.evaluation.score import Ratio, compute_results, get_value, pool_scores, scores, to_plain
from kineme.formats import ReadOptions, read
from kineme.labels.collections import LabelSource
from kineme.methods.presets import PRESETS
from kineme.recordings.motion import Motion
from kineme.recordings.signals import Signals
from kineme.segments.editing.rows import renumber_clusters
from kineme.segments.segmentation import Segmentation
from kineme.transfer.channel_samples import ChannelSamples, compute_channel_samples
from kineme.transfer.sharing import share_by_samples, share_clusters

Mapped = Literal["recording", "folder"]
Progress = Callable[[str], None]

UNMET = "has no column like"
"""How a note on a pattern begins that no column of a recording fits, such as a mistyped one."""
NUMBER_OF_CLASSES = "n_classes"
"""Constant of presets that take the true number of classes."""


@dataclass(frozen=True)
class RecordingScores:
    """One method on one recording of ``length_s``: results by score, or the error why not.

    ``seconds`` are what segmenting took; ``notes`` what is unusual about the labels.
    """

    recording: str
    seconds: float = 0.0
    length_s: float = 0.0
    results: Mapping[str, float | Ratio] = field(default_factory=dict)
    notes: tuple[str, ...] = ()
    error: str = ""

    @property
    def scores(self) -> dict[str, float]:
        """Return the scores of this recording by name."""
        return {name: get_value(result) for name, result in self.results.items()}


@dataclass(frozen=True)
class FolderScores:
    """What each method scored on the recordings of a folder, in the order of the files.

    Clusters were mapped to classes for each recording, or at once for the folder.
    """

    methods: Mapping[str, Sequence[RecordingScores]]
    mapping: Mapped

    def pool_scores(self, method: str) -> dict[str, float]:
        """Return the scores of a method over its recordings by name, and ``seconds_per_hour``."""
        good = [one for one in self.methods[method] if not one.error]
        found = {n: pool_scores(one.results.get(n) for one in good) for n in scores() if good}
        # Weighed by length: seconds over all recordings.
        length = sum(one.length_s for one in good)
        if length:
            found["seconds_per_hour"] = 3600 * sum(one.seconds for one in good) / length
        return found

    def records(self) -> list[dict[str, Any]]:
        """One record per method and recording, then one per method over all (``*``)."""
        records: list[dict[str, Any]] = []
        for method, ones in self.methods.items():
            for one in ones:
                head = {"recording": one.recording, "method": method}
                seconds = {} if one.error else {"seconds": one.seconds}
                records.append({**head, **one.scores, **seconds, "error": one.error})
        overall = [{"recording": "*", "method": m, **self.pool_scores(m)} for m in self.methods]
        return records + overall

    def to_json(self) -> str:
        """Everything as one JSON object; scores that are not defined are null."""
        methods = {
            method: {
                "scores": to_plain(self.pool_scores(method)),
                "recordings": [
                    {"recording": one.recording, "error": one.error}
                    if one.error
                    else {
                        "recording": one.recording,
                        "scores": to_plain(one.scores),
                        "seconds": one.seconds,
                        "notes": list(one.notes),
                    }
                    for one in ones
                ],
            }
            for method, ones in self.methods.items()
        }
        return json.dumps({"kineme": __version__, "mapping": self.mapping, "methods": methods})


def evaluate_folder(
    labels: Mapping[Path, LabelSource],
    methods: Sequence[str],
    *,
    mapping: Mapped = "recording",
    n_clusters: int | None = None,
    read_options: ReadOptions | None = None,
    without: Sequence[str] = (),
    constants: Mapping[str, Any] | None = None,
    processes: int = 2,
    progress: Progress | None = None,
) -> FolderScores:
    """Return every score of every method on every recording that has labels.

    Parameters
    ----------
    labels : Mapping of Path to LabelSource
        The recordings and where their labels are, see `kineme.labels.collections.find_labels`.
    methods : sequence of str
        Names of methods, in the order of the tables.
    mapping : {"recording", "folder"}
        Whether clusters stand for classes of their recording alone, or for the same in all,
        over which they are joined before.
    n_clusters : int, optional
        How many clusters signals of the folder are joined to; found out by default.
    read_options : ReadOptions, optional
        How the recordings are read. Of its columns, which may be patterns, each takes those it has.
    without : sequence of str
        Patterns of columns to leave out of signals.
    constants : mapping, optional
        Of every method that are to be others, such as ``{"min_action": 2.0}``. Which there are
        depends on the recording; one that cannot be taken is an error of it.
    processes : int
        How many at once; 1 stays in this process.
    progress : callable, optional
        Called with a sentence on each recording that is done.

    Returns
    -------
    FolderScores

    Raises
    ------
    ParameterError
        There is no such method.

    Examples
    --------
    >>> import kineme
    >>> from kineme.datasets import bundled_truth
    >>> sources = {kineme.bundled_recording(): LabelSource(bundled_truth())}
    >>> found = evaluate_folder(sources, ["voegele2014"], processes=1)
    >>> 0 < found.pool_scores("voegele2014")["mof"] < 1
    True
    """
    options, others = read_options or ReadOptions(), dict(constants or {})
    for name in methods:
        check_method(name)
    jobs = [
        Job(path, source, name, options, without, mapping == "folder", others)
        for path, source in labels.items()
        for name in methods
    ]
    answers: dict[Job, Answer] = {}
    for done, (job, answer) in enumerate(run_jobs(jobs, processes), 1):
        answers[job] = answer
        if progress is not None:
            progress(f"{done} of {len(jobs)}, {job.path.stem} {job.method}")
    results: dict[str, list[RecordingScores]] = {}
    for name in methods:
        of_method = [(job, answers[job]) for job in jobs if job.method == name]
        if progress is not None and mapping == "folder":
            progress(f"joining the clusters of all recordings, {name}")
        if mapping == "folder":
            compared = join_comparisons(of_method, n_clusters)
        else:
            compared = [answer.compared for _, answer in of_method]
        results[name] = [
            RecordingScores(job.path.name, error=answer.error)
            if one is None
            else RecordingScores(
                job.path.name, answer.seconds, answer.length_s, compute_results(one), answer.notes
            )
            for (job, answer), one in zip(of_method, compared, strict=True)
        ]
    return FolderScores(results, mapping)


def join_comparisons(
    answers: Sequence[tuple[Job, Answer]], n_clusters: int | None = None
) -> list[Comparison | None]:
    """Return the comparisons of one method by one mapping of joined clusters; None of failures."""
    classes: dict[str, int] = {}
    compared = {
        i: compare(sides.truth, found, classes=classes)
        for i, (sides, found) in _join_clusters(answers, n_clusters).items()
    }
    mapping = map_clusters(list(compared.values())) if compared else {}
    mapped = {i: replace(one, mapping=mapping) for i, one in compared.items()}
    return [mapped.get(i) for i in range(len(answers))]


def _join_clusters(
    answers: Sequence[tuple[Job, Answer]], n_clusters: int | None
) -> dict[int, tuple[Sides, Segmentation]]:
    """By the place of an answer: what was found there, with the joined clusters."""
    # Recordings whose clusters can be joined: bodies under (), signals by their channels.
    kinds: dict[tuple[str, ...], list[int]] = {}
    for i, (_, answer) in enumerate(answers):
        if answer.sides is not None:
            samples = answer.sides.samples
            kinds.setdefault(samples.names if samples else (), []).append(i)
    found: dict[int, tuple[Sides, Segmentation]] = {}
    following = 0
    for rows in kinds.values():
        jobs = [answers[i][0] for i in rows]
        sides = [s for i in rows if (s := answers[i][1].sides) is not None]
        shared = _share_clusters(jobs, sides, n_clusters)
        for i, side, one in zip(rows, sides, shared, strict=True):
            # Numbers of different kinds must not meet.
            found[i] = side, _renumber(one, following)
        following += 1 + max(int(one.table.cluster.max()) for one in shared)
    return dict(sorted(found.items()))


def _share_clusters(
    jobs: Sequence[Job], sides: Sequence[Sides], n_clusters: int | None
) -> list[Segmentation]:
    segmentations = [one.found for one in sides]
    samples = [one.samples for one in sides if one.samples is not None]
    if samples:
        return share_by_samples(samples, segmentations, n_clusters=n_clusters)
    # Motions are read again: to keep them all would take much memory.
    motions = [motion for job in jobs if isinstance(motion := job.read(), Motion)]
    try:
        return share_clusters(motions, segmentations)
    except MotionError:  # no body whose movements could be compared: nothing is one cluster
        apart, following = [], 0
        for found in segmentations:
            apart.append(_renumber(found, following))
            following += 1 + int(found.table.cluster.max())
        return apart


def _renumber(found: Segmentation, first: int) -> Segmentation:
    """Return the same with clusters numbered from a number on."""
    return renumber_clusters(found, {c: c + first for c in found.table.cluster.tolist() if c >= 0})


def read_selected(
    path: Path, options: ReadOptions, without: Sequence[str] = ()
) -> Motion | Signals:
    """Return the recording in a file; where columns are named or left out, its channels.

    Both are patterns (``acc*``), of which a recording takes or leaves those that it has. Capitals
    and small letters are the same.
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


def find_recordings(folder: Path) -> list[Path]:
    """Return the recordings in a folder and in the folders in it, one at least, by name."""
    from kineme.formats.listing import scan_folder

    found = scan_folder(folder, recursive=True).recordings
    if not found:
        raise ReadError(folder, "there is no recording in this folder")
    return found


def segment_by(
    name: str, recording: Motion | Signals, *, n_classes: int, **constants: Any
) -> Segmentation:
    """Return the segments that a method finds in a recording."""
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


def run_jobs(jobs: Sequence[Job], processes: int) -> Iterator[tuple[Job, Answer]]:
    """Yield each job and its answer, as they come."""
    if processes == 1:
        for job in jobs:
            yield job, _try_job(job)
        return
    pool = make_process_pool(processes)
    try:
        with defer_interrupt():
            waiting: dict[Future[Answer], Job] = {pool.submit(_try_job, job): job for job in jobs}
        for future in as_completed(waiting):
            failure = future.exception()
            answer = future.result() if failure is None else _describe_failure(failure)
            yield waiting[future], answer
    finally:
        # Also reached when the caller stops early.
        pool.shutdown(cancel_futures=True)  # none is left, or nobody asks any more


def _try_job(job: Job) -> Answer:
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", KinemeWarning)
            return run_job(job)
    except (KinemeError, ValueError, ArithmeticError, MemoryError) as error:
        return _describe_failure(error)


def run_job(job: Job, clock: Callable[[], float] = time.perf_counter) -> Answer:
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
        samples = compute_channel_samples(recording) if isinstance(recording, Signals) else None
        # The hierarchy is large and is not needed for joining.
        sides = Sides(truth, replace(found, hierarchy=None), samples)
    unmet = (str(note) for note in recording.provenance.notes if note.startswith(UNMET))
    notes = (*unmet, *truth.provenance.get("notes", ()))
    return Answer(compared, sides, classes, seconds, recording.duration, notes)


def _describe_failure(error: BaseException) -> Answer:
    text = " ".join(str(error).split())
    name = "" if isinstance(error, KinemeError) else f"{type(error).__name__}: "
    return Answer(error=f"{name}{text}")
