"""Evaluate methods on a folder of labelled recordings: scores of each recording and of all.

ACA, HACA and GMM get the true number of classes, as in all published comparisons; other methods
estimate it. Jobs run in this process or in several.

Clusters are mapped to classes for each recording, or once for the whole folder. In the second case,
clusters of all recordings are shared first, separately for each method. They are shared among
bodies, and among signals with the same channels. A recording that cannot be read, segmented or
compared gets an error and does not affect the others.
"""

from __future__ import annotations

import json
import time
import warnings
from collections import defaultdict
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from concurrent.futures import Future, as_completed
from dataclasses import dataclass, field, replace
from fnmatch import fnmatchcase
from itertools import chain
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
from kineme.segments.editing.borders import renumber_clusters
from kineme.segments.segmentation import Segmentation
from kineme.transfer.embeddings import ChannelSamples, compute_channel_samples
from kineme.transfer.sharing import share_by_samples, share_clusters

Mapped = Literal["recording", "folder"]
Progress = Callable[[str], None]

UNMET = "has no column like"
"""Start of a note about a pattern that matches no column of a recording."""
NUMBER_OF_CLASSES = "n_classes"
"""Name of the constant of presets that need the true number of classes."""


@dataclass(frozen=True)
class RecordingScores:
    """Results by score of one method on one recording of ``length_s``, or an error.

    ``seconds`` is the run time of the segmentation; ``notes`` describe problems of the labels.
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
    """Scores of each method on the recordings of a folder, in the order of files.

    ``mapping`` tells whether clusters were mapped to classes for each recording or for the folder.
    """

    methods: Mapping[str, Sequence[RecordingScores]]
    mapping: Mapped

    def pool_scores(self, method: str) -> dict[str, float]:
        """Return the scores of a method over all recordings by name, and ``seconds_per_hour``."""
        good = [one for one in self.methods[method] if not one.error]
        pooled = {n: pool_scores(one.results.get(n) for one in good) for n in scores() if good}
        length = sum(one.length_s for one in good)
        if length:
            pooled["seconds_per_hour"] = 3600 * sum(one.seconds for one in good) / length
        return pooled

    def records(self) -> list[dict[str, Any]]:
        """Return one record per method and recording, then one per method over all (``*``)."""
        records: list[dict[str, Any]] = []
        for method, ones in self.methods.items():
            for one in ones:
                head = {"recording": one.recording, "method": method}
                seconds = {} if one.error else {"seconds": one.seconds}
                records.append({**head, **one.scores, **seconds, "error": one.error})
        overall = [{"recording": "*", "method": m, **self.pool_scores(m)} for m in self.methods]
        return records + overall

    def to_json(self) -> str:
        """Return everything as one JSON object; undefined scores are null."""
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
    """Compute all scores of all methods on all labelled recordings.

    Parameters
    ----------
    labels : Mapping of Path to LabelSource
        Recordings and the sources of their labels, see `kineme.labels.collections.find_labels`.
    methods : sequence of str
        Names of methods, in the order of the tables.
    mapping : {"recording", "folder"}
        Whether clusters are mapped to classes for each recording, or shared first and mapped
        once for the folder.
    n_clusters : int, optional
        Number of shared clusters of signals; estimated by default.
    read_options : ReadOptions, optional
        Options for reading recordings. Columns may be patterns; each recording uses those that it
        has.
    without : sequence of str
        Patterns of columns to leave out of signals.
    constants : mapping, optional
        Constants of the methods to change, such as ``{"min_action": 2.0}``. If a recording's
        preset does not have one of them, this is an error of the recording.
    processes : int
        Number of processes; with 1, everything runs in this process.
    progress : callable, optional
        Called with a sentence for each finished recording.

    Raises
    ------
    ParameterError
        A method does not exist.

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
    tell = progress or (lambda _: None)
    for name in methods:
        check_method(name)
    # One job for each recording and method; results arrive in any order.
    jobs = [
        Job(
            path,
            source,
            method=name,
            read_options=options,
            without=without,
            joins=mapping == "folder",
            constants=others,
        )
        for path, source in labels.items()
        for name in methods
    ]
    job_results: dict[Job, JobResult] = {}
    for done, (job, result) in enumerate(run_jobs(jobs, processes), 1):
        job_results[job] = result
        tell(f"{done} of {len(jobs)}, {job.path.stem} {job.method}")
    results: dict[str, list[RecordingScores]] = {}
    for name in methods:
        own_results = [(job, job_results[job]) for job in jobs if job.method == name]
        if mapping == "folder":
            tell(f"joining the clusters of all recordings, {name}")
            compared = join_comparisons(own_results, n_clusters)
        else:
            compared = [result.compared for _, result in own_results]
        results[name] = [
            RecordingScores(job.path.name, error=result.error)
            if one is None
            else RecordingScores(
                job.path.name, result.seconds, result.length_s, compute_results(one), result.notes
            )
            for (job, result), one in zip(own_results, compared, strict=True)
        ]
    return FolderScores(results, mapping)


def join_comparisons(
    job_results: Sequence[tuple[Job, JobResult]], n_clusters: int | None = None
) -> list[Comparison | None]:
    """Compare the results of one method with shared clusters and one mapping; None for failures."""
    classes: dict[str, int] = {}
    compared = {
        i: compare(sides.truth, found, classes=classes)
        for i, (sides, found) in _join_clusters(job_results, n_clusters).items()
    }
    mapping = map_clusters(list(compared.values())) if compared else {}
    mapped = {i: replace(one, mapping=mapping) for i, one in compared.items()}
    return [mapped.get(i) for i in range(len(job_results))]


def _join_clusters(
    job_results: Sequence[tuple[Job, JobResult]], n_clusters: int | None
) -> dict[int, tuple[ComparedSides, Segmentation]]:
    """Return the results with shared clusters, by index of the job."""
    results = enumerate(result for _, result in job_results)
    sides = {i: result.sides for i, result in results if result.sides is not None}
    # Group recordings whose clusters can be shared: bodies under (), signals by channels.
    kinds: defaultdict[tuple[str, ...], list[int]] = defaultdict(list)
    for i, one in sides.items():
        kinds[one.samples.names if one.samples else ()].append(i)
    groups = [
        _share_clusters([job_results[i][0] for i in rows], [sides[i] for i in rows], n_clusters)
        for rows in kinds.values()
    ]
    found = dict(zip(chain(*kinds.values()), _number_apart(groups), strict=True))
    return {i: (one, found[i]) for i, one in sides.items()}


def _share_clusters(
    jobs: Sequence[Job], sides: Sequence[ComparedSides], n_clusters: int | None
) -> list[Segmentation]:
    """Return the results of all recordings with common cluster numbers."""
    segmentations = [one.found for one in sides]
    samples = [one.samples for one in sides if one.samples is not None]
    if samples:
        return share_by_samples(samples, segmentations, n_clusters=n_clusters)
    # Read motions again, as keeping them all would need much memory.
    motions = [motion for job in jobs if isinstance(motion := job.read(), Motion)]
    try:
        return share_clusters(motions, segmentations)
    except MotionError:  # without bodies, movements cannot be compared: share no cluster
        return _number_apart([[found] for found in segmentations])


def _number_apart(groups: Iterable[Sequence[Segmentation]]) -> list[Segmentation]:
    """Renumber clusters so that segmentations of different groups have none in common."""
    separate, first = [], 0
    for group in groups:
        for found in group:
            clusters = found.table.cluster.tolist()
            separate.append(renumber_clusters(found, {c: c + first for c in clusters if c >= 0}))
        first += 1 + max(int(found.table.cluster.max()) for found in group)
    return separate


def read_selected(
    path: Path, options: ReadOptions, without: Sequence[str] = ()
) -> Motion | Signals:
    """Read a recording, restricted to some channels if columns are selected or left out.

    Columns are patterns (``acc*``), which ignore case. Patterns that match no column are noted.
    """
    if not (options.columns or without):
        return read(path, **vars(options))
    signals = read(path, **vars(replace(options, columns=())))
    if not isinstance(signals, Signals):
        raise ParameterError(f"{path}: has no columns to select")
    columns = options.columns or ("*",)
    kept = [
        name
        for name in signals.names
        if _matches_any(name, *columns) and not _matches_any(name, *without)
    ]
    if not kept:
        names = ", ".join(signals.names)
        raise ParameterError(
            f"{path}: the selected and left-out columns leave none of its "
            f"{len(signals.names)} columns ({names:.200})"
        )
    unmet = [
        p for p in (*columns, *without) if not any(_matches_any(name, p) for name in signals.names)
    ]
    return signals.select(kept).noted(*(f"{UNMET} {pattern!r:.60}" for pattern in unmet))


def _matches_any(name: str, *patterns: str) -> bool:
    return any(fnmatchcase(name.lower(), pattern.lower()) for pattern in patterns)


def find_recordings(folder: Path) -> list[Path]:
    """Return the recordings in a folder and its subfolders by name; at least one is required."""
    from kineme.formats.listing import scan_folder

    found = scan_folder(folder, recursive=True).recordings
    if not found:
        raise ReadError(folder, "there is no recording in this folder")
    return found


def segment_with_method(
    name: str, recording: Motion | Signals, *, n_classes: int, **constants: Any
) -> Segmentation:
    """Segment a recording with a method."""
    from kineme.methods.segmenter import segment

    check_method(name)
    # Presets with the value None need the true number of classes.
    if getattr(PRESETS[name], NUMBER_OF_CLASSES, 0) is None:
        constants = {NUMBER_OF_CLASSES: n_classes, **constants}
    return segment(recording, preset=name, **constants)


def check_method(name: str) -> None:
    """Raise ParameterError if there is no such method."""
    if name not in PRESETS:
        raise ParameterError(f"no method {name!r}; there are {', '.join(PRESETS)}")


@dataclass(frozen=True)
class Job:
    """A method to run on a recording."""

    path: Path
    source: LabelSource
    method: str
    read_options: ReadOptions
    without: Sequence[str] = ()
    """Columns of signals to leave out."""
    joins: bool = False
    """Whether clusters will be shared with other recordings."""
    constants: Mapping[str, Any] = field(default_factory=dict)
    """Constants of the method to change."""

    def __hash__(self) -> int:
        return hash((self.path, self.method))

    def read(self) -> Motion | Signals:
        """Read the recording."""
        return read_selected(self.path, self.read_options, self.without)


@dataclass(frozen=True, eq=False)
class ComparedSides:
    """Both sides of a comparison, kept to share clusters with other recordings first."""

    truth: Segmentation
    found: Segmentation
    samples: ChannelSamples | None
    """Samples of signals; None for motions, which are read again."""


@dataclass(frozen=True, eq=False)
class JobResult:
    """Result of a job: a comparison, or an error."""

    compared: Comparison | None = None
    sides: ComparedSides | None = None
    classes: Mapping[str, int] = field(default_factory=dict)
    seconds: float = 0.0
    length_s: float = 0.0
    notes: tuple[str, ...] = ()
    error: str = ""


def run_jobs(jobs: Sequence[Job], processes: int) -> Iterator[tuple[Job, JobResult]]:
    """Yield each job with its result, in order of completion."""
    if processes == 1:
        for job in jobs:
            yield job, _try_job(job)
        return
    pool = make_process_pool(processes)
    try:
        with defer_interrupt():
            waiting: dict[Future[JobResult], Job] = {
                pool.submit(_try_job, job): job for job in jobs
            }
        for future in as_completed(waiting):
            failure = future.exception()
            result = future.result() if failure is None else _describe_failure(failure)
            yield waiting[future], result
    finally:
        # Also reached if the caller stops early; then jobs that have not started are cancelled.
        pool.shutdown(cancel_futures=True)


def _try_job(job: Job) -> JobResult:
    try:
        with warnings.catch_warnings(action="ignore", category=KinemeWarning):
            return run_job(job)
    except (KinemeError, ValueError, ArithmeticError, MemoryError) as error:
        return _describe_failure(error)


def run_job(job: Job, clock: Callable[[], float] = time.perf_counter) -> JobResult:
    """Run a job and measure its time with this clock; raise what the method raises."""
    recording = job.read()
    truth = job.source.of(
        n_frames=recording.n_frames, fps=recording.fps, clock=recording.provenance.clock
    )
    classes: dict[str, int] = {}
    # Comparing the truth with itself numbers its classes.
    compare(truth, truth, classes=classes)
    start = clock()
    found = segment_with_method(job.method, recording, n_classes=len(classes), **job.constants)
    seconds = clock() - start
    compared = compare(truth, found, classes=classes)
    sides = None
    if job.joins:
        samples = compute_channel_samples(recording) if isinstance(recording, Signals) else None
        # Drop the hierarchy, which is large and not needed.
        sides = ComparedSides(truth, replace(found, hierarchy=None), samples)
    unmet = (str(note) for note in recording.provenance.notes if note.startswith(UNMET))
    notes = (*unmet, *truth.provenance.get("notes", ()))
    return JobResult(
        compared, sides, classes=classes, seconds=seconds, length_s=recording.duration, notes=notes
    )


def _describe_failure(error: BaseException) -> JobResult:
    text = " ".join(str(error).split())
    name = "" if isinstance(error, KinemeError) else f"{type(error).__name__}: "
    return JobResult(error=f"{name}{text}")
