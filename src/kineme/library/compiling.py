"""Compile the analyses of a library into tables with shared clusters."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from functools import lru_cache, partial
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from kineme._util.arrays import Ints
from kineme.library.executors import Progress
from kineme.library.planning import Entry
from kineme.library.storage.analyses import (
    Analysis,
    read_analysis,
    read_channel_samples,
    read_spans,
)
from kineme.library.storage.layout import (
    ANALYSES,
    BODIES,
    EMBEDDED,
    as_array,
    as_column,
    import_arrow,
)
from kineme.library.storage.tables import make_table, read_table
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

Columns = dict[str, Any]

CACHED = 500
"""Number of local clusters whose features are cached: those of one round of comparisons."""


def compile_tables(
    folder: Path,
    entries: Sequence[Entry],
    before: Mapping[str, Spans],
    following: int,
    progress: Progress,
) -> tuple[dict[str, Any], int]:
    """Return the tables of a library by name, and the first unused cluster number.

    ``entries`` are sorted by name. ``before`` holds the former activities of recordings, see
    `list_activities`: clusters that are found again keep their numbers.
    """
    analyses = [read_analysis(folder / ANALYSES, key) for _, _, key in entries]
    keys = [key for _, _, key in entries]
    local, assignment = _join_clusters(analyses, keys, folder / ANALYSES, progress)
    shared = _assign_clusters(analyses, local, assignment.cluster)
    new = {
        name: list_spans(analysis.table.columns(), clusters)
        for (name, _, _), analysis, clusters in zip(entries, analyses, shared, strict=True)
    }
    numbers = keep_numbers(before, new, following=following)
    renumbered = np.array([*numbers.values(), -1], np.int64)  # index -1 (no cluster) gives -1
    tables = {
        "recordings": _tabulate_recordings(entries, analyses),
        "segments": _tabulate_segments(entries, analyses, [renumbered[each] for each in shared]),
        "local_clusters": _tabulate_local_clusters(entries, local, assignment, renumbered),
        "embeddings": _tabulate_embeddings(entries, analyses),
    }
    return {name: make_table(name, columns) for name, columns in tables.items()}, max(
        [following, *(number + 1 for number in numbers.values())]
    )


def list_activities(folder: Path, tables: str | None) -> dict[str, Spans]:
    """Return the activities of each recording with their clusters from the library's tables."""
    if tables is None:
        return {}
    table = read_table(folder, tables, "segments")
    names = ("recording", "level", "kind", "start_s", "stop_s", "cluster")
    columns = {name: as_array(table.column(name)) for name in names}
    # Rows are grouped by recording, so first occurrences are the borders.
    first = np.unique(columns["recording"], return_index=True)[1]
    edges = [*np.sort(first).tolist(), len(table)]
    found = {}
    for start, stop in pairwise(edges):
        rows = {name: column[start:stop] for name, column in columns.items()}
        found[str(rows["recording"][0])] = list_spans(rows, rows["cluster"])
    return found


def _join_clusters(
    analyses: Sequence[Analysis],
    keys: Sequence[str],
    folder: Path,
    progress: Progress,
) -> tuple[list[LocalCluster], Assignment]:
    """Return the local clusters of all recordings, and the shared cluster of each.

    ``keys`` name the analyses in ``folder``.
    """
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
    @lru_cache(CACHED)
    def load(each: LocalCluster) -> Features:
        facts = analyses[each.recording].facts
        size = facts["features_fps"], facts["samples"]
        spans = to_samples(each.example, *size), to_samples(each.context, *size)
        return read_spans(folder, keys[each.recording], spans)

    embeddings = np.array([analyses[each.recording].embeddings[each.row] for each in local])
    return ClusterSet(local, embeddings, load)


def _assign_clusters(
    analyses: Sequence[Analysis], local: Sequence[LocalCluster], clusters: Ints
) -> list[Ints]:
    """Return the shared cluster of each segment of each analysis, -1 for none."""
    label = {
        (each.recording, each.cluster): cluster
        for each, cluster in zip(local, clusters.tolist(), strict=True)
    }
    return [
        np.array(
            [label.get((i, number), -1) for number in analysis.table.cluster.tolist()], np.int64
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
