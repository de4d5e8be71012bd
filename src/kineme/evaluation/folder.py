"""Methods on a folder of recordings with labels: every score of each, and over all of them.

Clusters stand for classes by one mapping a recording, or by one for the whole folder; for the
latter the clusters of all recordings are joined first: bodies, and signals of the same channels,
have a vocabulary each, and nothing is one cluster across these. What one method finds is joined
by itself. A recording that cannot be read, segmented or compared costs itself only, and says why.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any, Literal

from kineme._version import __version__
from kineme.errors import MotionError
from kineme.evaluation.comparison import Comparison, best_mapping, compare
from kineme.evaluation.recordings import Answer, Job, Sides, answers_to, check_method
from kineme.evaluation.score import Ratio, pool_scores, results_of, scores, value_of
from kineme.evaluation.tables import plain
from kineme.formats import ReadOptions
from kineme.labels.collections import LabelSource
from kineme.recordings.motion import Motion
from kineme.segments.editing.rows import renumber_clusters
from kineme.segments.segmentation import Segmentation
from kineme.transfer.sharing import share_by_samples, share_clusters

Mapped = Literal["recording", "folder"]
Progress = Callable[[str], None]


@dataclass(frozen=True)
class Evaluated:
    """One method on one recording: its scores, or why there are none.

    Parameters
    ----------
    recording : str
        Name of the file.
    seconds : float
        What segmenting took.
    length_s : float
        Of the recording.
    results : Mapping of str to float or Ratio
        By the names of the scores.
    notes : tuple of str
        What is unusual about the labels, such as spans that overlap.
    error : str
        Why there are none; else empty.
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
        return {name: value_of(result) for name, result in self.results.items()}


@dataclass(frozen=True)
class FolderScores:
    """What each method scored on the recordings of a folder, in the order of the files.

    Clusters were mapped to classes for each recording, or at once for the folder.
    """

    methods: Mapping[str, Sequence[Evaluated]]
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
                "scores": plain(self.pool_scores(method)),
                "recordings": [
                    {"recording": one.recording, "error": one.error}
                    if one.error
                    else {
                        "recording": one.recording,
                        "scores": plain(one.scores),
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
        The recordings and where their labels are, see `kineme.labels.collections.labels_of`.
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
    for done, (job, answer) in enumerate(answers_to(jobs, processes), 1):
        answers[job] = answer
        if progress is not None:
            progress(f"{done} of {len(jobs)}, {job.path.stem} {job.method}")
    results: dict[str, list[Evaluated]] = {}
    for name in methods:
        of_method = [(job, answers[job]) for job in jobs if job.method == name]
        if progress is not None and mapping == "folder":
            progress(f"joining the clusters of all recordings, {name}")
        compared = joined_comparisons(of_method, n_clusters) if mapping == "folder" else None
        results[name] = _score_method(
            of_method, compared or [answer.compared for _, answer in of_method]
        )
    return FolderScores(results, mapping)


def joined_comparisons(
    answers: Sequence[tuple[Job, Answer]], n_clusters: int | None = None
) -> list[Comparison | None]:
    """Return the comparisons of one method by one mapping of joined clusters.

    None where a job failed.
    """
    classes: dict[str, int] = {}
    compared = {
        i: compare(sides.truth, found, classes=classes)
        for i, (sides, found) in _join_clusters(answers, n_clusters).items()
    }
    if not compared:
        # None of the jobs succeeded.
        return [None] * len(answers)
    mapping = best_mapping(list(compared.values()))
    mapped = {i: replace(one, mapping=mapping) for i, one in compared.items()}
    return [mapped.get(i) for i in range(len(answers))]


def _score_method(
    answers: Sequence[tuple[Job, Answer]], compared: Sequence[Comparison | None]
) -> list[Evaluated]:
    """Return the scores of one method."""
    found = []
    for (job, answer), one in zip(answers, compared, strict=True):
        if one is None:
            found.append(Evaluated(job.path.name, error=answer.error))
            continue
        found.append(
            Evaluated(job.path.name, answer.seconds, answer.length_s, results_of(one), answer.notes)
        )
    return found


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
            found[i] = side, _numbered_on(one, following)
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
    except MotionError:  # no body whose movements could be compared
        return _all_apart(segmentations)


def _all_apart(segmentations: Sequence[Segmentation]) -> list[Segmentation]:
    """Clusters of different recordings by different numbers."""
    apart, following = [], 0
    for found in segmentations:
        apart.append(_numbered_on(found, following))
        following += 1 + int(found.table.cluster.max())
    return apart


def _numbered_on(found: Segmentation, first: int) -> Segmentation:
    """Return the same with clusters numbered from a number on."""
    return renumber_clusters(found, {c: c + first for c in found.table.cluster.tolist() if c >= 0})
