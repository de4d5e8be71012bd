"""Collect the analyses of a build's recordings, and compile them into tables.

Existing analyses are reused, the others are made, on any executor. An error affects one recording
only.

Recordings with equal content share one analysis.

`compile_tables` then merges the clusters of all analyses and makes the tables of the library.
"""

from __future__ import annotations

import warnings
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import lru_cache, partial
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from threadpoolctl import threadpool_limits

from kineme._util.arrays import Ints
from kineme._util.checks import is_text
from kineme.errors import KinemeError, KinemeWarning, ReadError, WriteError
from kineme.formats import read_quietly
from kineme.library.executors import Executor, Progress, track_progress
from kineme.library.planning import (
    Entry,
    Plan,
    compute_digest,
    fetch,
    measure_size,
    read_states,
)
from kineme.library.storage.layout import (
    ANALYSES,
    BODIES,
    EMBEDDED,
    STATES,
    as_array,
    as_column,
    import_arrow,
    read_json,
    write_json,
)
from kineme.library.storage.tables import (
    Analysis,
    find_rows,
    has_analysis,
    make_table,
    read_analysis,
    read_channel_samples,
    read_spans,
    read_table,
    write_analysis,
)
from kineme.recordings.arrays import to_samples
from kineme.segments.table import COLUMNS
from kineme.transfer.clusters import (
    CONSTANTS,
    Assignment,
    ClusterSet,
    Features,
    LocalCluster,
    Spans,
    assign_to_centres,
    find_local_clusters,
    keep_numbers,
    link_clusters,
    list_spans,
)

States = dict[str, tuple[str, str]]
UNNAMED = "its name is not UTF-8 and cannot be stored: rename it"
"""Error for a file whose name is not UTF-8."""
PER_WORKER = 1 << 20
"""Bytes of recordings per process: starting one takes seconds."""
DIED = "the process that read it died: it may need more memory than is available"
Columns = dict[str, Any]
CACHED = 500
"""Number of local clusters whose features are cached: those of one round of comparisons."""


@dataclass
class Gathered:
    """Analyses of the recordings of a build.

    ``digests`` holds the digest of each analysed recording's files, ``failed`` the errors of the
    others, ``new`` the number of new analyses.
    """

    digests: dict[Path, str] = field(default_factory=dict)
    failed: dict[Path, str] = field(default_factory=dict)
    new: int = 0


def gather(plan: Plan, found: Sequence[Path], executor: Executor, progress: Progress) -> Gathered:
    """Return the analyses of recordings; make those that are missing.

    Files with unchanged size and time are not read again.
    """
    former = _read_former_states(plan.folder / STATES, progress)
    readable = [path for path in found if is_text(str(path))]
    states = read_states(readable, plan.read_options.skeleton)
    unreadable = [path for path in found if path not in states]
    complete = {path.stem for path in plan.analyses.glob("*.parquet")}
    gathered = Gathered(failed=dict.fromkeys(unreadable, UNNAMED))
    for path, state in states.items():
        former_state, digest = former.get(str(path), ("", ""))
        if state and state == former_state and plan.key(digest) in complete:
            gathered.digests[path] = digest
    waiting = [path for path in readable if path not in gathered.digests]
    if waiting:
        _make_analyses(plan, waiting, executor, progress, gathered)
    present = {str(path): (states[path], digest) for path, digest in gathered.digests.items()}
    if present != former:
        write_json(plan.folder / STATES, present)
    return gathered


@dataclass(frozen=True)
class Task:
    """A recording of ``size`` bytes to analyse."""

    path: Path
    plan: Plan
    size: int

    def __hash__(self) -> int:
        return hash(self.path)


@dataclass(frozen=True)
class Outcome:
    """Outcome of a task: the digest of its analysed files, or an error."""

    digest: str = ""
    new: bool = False
    """Whether the analysis was made now."""
    error: str = ""
    fatal: bool = False
    """Whether all other tasks will fail, too, as on a full disk."""


def _read_former_states(path: Path, progress: Progress) -> States:
    """Return the last state and digest of each recording; empty if the file is damaged."""
    try:
        return read_json(path, tuple[str, str])
    except ReadError as error:
        progress(f"{path.name} was ignored and all recordings are read again: it {error.reason}")
        return {}


def _make_analyses(
    plan: Plan, waiting: Sequence[Path], executor: Executor, progress: Progress, into: Gathered
) -> None:
    """Make the analyses of recordings and record the outcomes in ``into``."""
    tasks = make_tasks(waiting, plan)
    done = track_progress(progress, len(tasks), sum(task.size for task in tasks))
    for task, outcome in run_tasks(tasks, executor):
        if outcome.fatal:
            raise WriteError(plan.folder, outcome.error)
        if outcome.error:
            into.failed[task.path] = outcome.error
        else:
            into.digests[task.path] = outcome.digest
        into.new += outcome.new
        done(1, task.size)


def make_tasks(paths: Iterable[Path], plan: Plan) -> list[Task]:
    """Return tasks for recordings, the largest first, so that processes finish together."""
    # Each task is sent to another process: without all sources, and with the digest cached.
    sent = replace(plan, sources=(), missing=())
    _ = sent.options_digest
    tasks = [Task(path, sent, measure_size(path)) for path in paths]
    return sorted(tasks, key=lambda task: (-task.size, task.path))


def run_tasks(tasks: Sequence[Task], executor: Executor) -> Iterator[tuple[Task, Outcome]]:
    """Yield each task with its outcome as they complete."""
    workers = 1 + sum(task.size for task in tasks) // PER_WORKER
    for task, outcome in executor.completed(analyze_recording, tasks, workers=workers):
        yield task, outcome or Outcome(error=DIED)


def analyze_recording(task: Task) -> Outcome:
    """Read, segment and describe a recording, unless its analysis exists."""
    try:
        from kineme.library.descriptions import make_analysis

        with warnings.catch_warnings(), threadpool_limits(1):  # rounding depends on BLAS threads
            warnings.simplefilter("ignore", KinemeWarning)
            plan, options = task.plan, task.plan.read_options
            with fetch(task.path, options.skeleton) as path:
                digest = compute_digest(path, options.skeleton)
                key = plan.key(digest)
                if has_analysis(plan.analyses, key):
                    return Outcome(digest)
                recording = read_quietly(path, options)
            write_analysis(plan.analyses, key, *make_analysis(recording, plan.segment_options))
    except Exception as error:  # noqa: BLE001 (one recording must not end a build)
        reason = " ".join(str(error).split())
        if not isinstance(error, KinemeError):
            reason = f"{type(error).__name__}: {reason}"
        return Outcome(error=reason, fatal=isinstance(error, WriteError))
    return Outcome(digest, new=True)


def compile_tables(
    folder: Path,
    entries: Sequence[Entry],
    before: Mapping[str, Spans],
    next_cluster: int,
    progress: Progress,
) -> tuple[dict[str, Any], int]:
    """Return the tables of a library by name, and the first unused cluster number.

    ``entries`` are sorted by name. ``before`` holds the former activities of recordings, see
    `list_activities`: clusters that are found again keep their numbers. Others are numbered from
    ``next_cluster`` on.
    """
    analyses = [read_analysis(folder / ANALYSES, key) for _, _, key in entries]
    keys = [key for _, _, key in entries]
    local, assignment = _join_clusters(analyses, keys, folder / ANALYSES, progress)
    shared = _assign_clusters(analyses, local, assignment.cluster)
    new = {
        name: list_spans(analysis.table.columns(), clusters)
        for (name, _, _), analysis, clusters in zip(entries, analyses, shared, strict=True)
    }
    numbers = keep_numbers(before, new, next_number=next_cluster)
    renumbered = np.array([*numbers.values(), -1], np.int64)  # index -1 (no cluster) gives -1
    tables = {
        "recordings": _tabulate_recordings(entries, analyses),
        "segments": _tabulate_segments(entries, analyses, [renumbered[each] for each in shared]),
        "local_clusters": _tabulate_local_clusters(entries, local, assignment, renumbered),
        "embeddings": _tabulate_embeddings(entries, analyses),
    }
    return {name: make_table(name, columns) for name, columns in tables.items()}, max(
        [next_cluster, *(number + 1 for number in numbers.values())]
    )


def list_activities(folder: Path, tables: str | None) -> dict[str, Spans]:
    """Return the activities of each recording with their clusters from the library's tables."""
    if tables is None:
        return {}
    table = read_table(folder, tables, "segments")
    names = ("level", "kind", "start_s", "stop_s", "cluster")
    columns = {name: as_array(table.column(name)) for name in names}
    found = {}
    for recording, rows in find_rows(table).items():
        own = {name: column[rows] for name, column in columns.items()}
        found[recording] = list_spans(own, own["cluster"])
    return found


def _join_clusters(
    analyses: Sequence[Analysis], keys: Sequence[str], folder: Path, progress: Progress
) -> tuple[list[LocalCluster], Assignment]:
    """Return the local clusters of all recordings, and the shared cluster of each."""
    none = np.empty(0, np.int64)
    all_clusters, parts, count = [], [Assignment(none, none, np.empty(0), np.empty(0))], 0
    for kind in sorted({analysis.facts["vocabulary"] for analysis in analyses} - {""}):
        # Sorted by content key, so that rounding errors of sums do not depend on file names.
        numbers = [i for i, cluster in enumerate(analyses) if cluster.facts["vocabulary"] == kind]
        numbers.sort(key=keys.__getitem__)
        groups = [find_local_clusters(analyses[number].table, number) for number in numbers]
        local = [cluster for group in groups for cluster in group]
        if not local:
            continue
        if kind == BODIES or len(numbers) == 1:
            clusters = _make_cluster_set(local, analyses, keys, folder)
            assignment = link_clusters(clusters, keys, CONSTANTS, progress=progress)
        else:
            assignment = assign_to_centres(
                [partial(read_channel_samples, folder, keys[number]) for number in numbers],
                [analyses[number].facts["moments"] for number in numbers],
                [[cluster.spans for cluster in group] for group in groups],
            )
        parts.append(assignment.shift(count))
        all_clusters += local
        count += int(assignment.cluster.max()) + 1
    return all_clusters, Assignment(*map(np.concatenate, zip(*parts, strict=True)))


def _make_cluster_set(
    local: Sequence[LocalCluster], analyses: Sequence[Analysis], keys: Sequence[str], folder: Path
) -> ClusterSet:
    """Return local clusters to link, whose features are read from disk when needed."""

    @lru_cache(CACHED)
    def load(each: LocalCluster) -> Features:
        facts = analyses[each.recording].facts
        size = facts["features_fps"], facts["samples"]
        spans = to_samples(each.example, *size), to_samples(each.context, *size)
        return [*read_spans(folder, keys[each.recording], spans)]

    embeddings = np.array([analyses[each.recording].embeddings[each.row] for each in local])
    return ClusterSet(local, embeddings, load)


def _assign_clusters(
    analyses: Sequence[Analysis], local: Sequence[LocalCluster], clusters: Ints
) -> list[Ints]:
    """Return the shared cluster of each segment of each analysis, -1 for none."""
    shared = {
        (each.recording, each.cluster): cluster
        for each, cluster in zip(local, clusters.tolist(), strict=True)
    }
    return [
        np.array(
            [shared.get((i, number), -1) for number in analysis.table.cluster.tolist()], np.int64
        )
        for i, analysis in enumerate(analyses)
    ]


def _tabulate_recordings(entries: Sequence[Entry], analyses: Sequence[Analysis]) -> Columns:
    facts = [analysis.facts for analysis in analyses]
    names = ("vocabulary", "format", "n_frames", "fps", "features_fps", "samples")
    return {
        "recording": [name for name, _, _ in entries],
        "path": [str(path) for _, path, _ in entries],
        **{name: [each[name] for each in facts] for name in names},
        "duration_s": [each["n_frames"] / each["fps"] for each in facts],
        "piece": [key for _, _, key in entries],
        "notes": ["\n".join(each["notes"]) for each in facts],
    }


def _tabulate_segments(
    entries: Sequence[Entry], analyses: Sequence[Analysis], clusters: Sequence[Ints]
) -> Columns:
    """Return the columns of the table of all segments; see `DESCRIBED`."""
    tables = [analysis.table for analysis in analyses]
    columns: Columns = {
        name: _concatenate(getattr(table, name) for table in tables) for name in COLUMNS
    }
    actions = [
        # Cluster of the activity that contains each row.
        numbers[np.flatnonzero(table.level == "activity")][table.activity]
        for numbers, table in zip(clusters, tables, strict=True)
    ]
    return {
        **_count_rows(entries, analyses),
        **columns,
        "cluster": _concatenate(clusters),
        "action": _concatenate(actions),
        "own_cluster": columns["cluster"],
    }


def _tabulate_local_clusters(
    entries: Sequence[Entry], local: Sequence[LocalCluster], assignment: Assignment, numbers: Ints
) -> Columns:
    names = ("start_s", "stop_s", "seconds")
    return {
        "recording": [entries[each.recording][0] for each in local],
        "own_cluster": [each.cluster for each in local],
        "cluster": numbers[assignment.cluster],
        "next_cluster": numbers[assignment.next_cluster],
        "confidence": assignment.confidence,
        "spread": assignment.spread,
        **{name: [getattr(each, name) for each in local] for name in names},
    }


def _tabulate_embeddings(entries: Sequence[Entry], analyses: Sequence[Analysis]) -> Columns:
    pa, _ = import_arrow()
    values = _concatenate(analysis.embeddings for analysis in analyses).reshape(-1, EMBEDDED)
    # Rows of zeros are segments without an embedding.
    embedded = np.flatnonzero(values.any(axis=1))
    rows = {
        name: np.asarray(column)[embedded] if len(column) else column
        for name, column in _count_rows(entries, analyses).items()
    }
    flat = as_column(values[embedded].ravel(), np.float32)
    return {**rows, "embedding": pa.FixedSizeListArray.from_arrays(flat, EMBEDDED)}


def _count_rows(entries: Sequence[Entry], analyses: Sequence[Analysis]) -> Columns:
    counts = [len(analysis.table) for analysis in analyses]
    return {
        "recording": [n for (n, _, _), k in zip(entries, counts, strict=True) for _ in range(k)],
        "segment": _concatenate(np.arange(count) for count in counts),
    }


def _concatenate(parts: Iterable[NDArray[Any]]) -> NDArray[Any]:
    """Concatenate arrays; return an empty one if there are none."""
    arrays = list(parts)
    return np.concatenate(arrays) if arrays else np.empty(0)
