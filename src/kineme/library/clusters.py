"""Clusters that the recordings of a library have in common, from what is kept of each recording.

`kineme.transfer.clusters` compares bodies with bodies, and channels with the same channels.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache, partial
from pathlib import Path

import numpy as np

from kineme.library.executors import Progress
from kineme.library.storage.analyses import Analysis, read_channel_samples, read_spans
from kineme.library.storage.layout import BODIES
from kineme.transfer.clusters import (
    CONSTANTS,
    Assignment,
    ClusterSet,
    Features,
    LocalCluster,
    assign_to_centres,
    find_local_clusters,
    link_clusters,
    to_samples,
)

CACHED = 500
"""Local clusters whose features are kept for the next comparison: those of a round."""


def join_clusters(
    analyses: Sequence[Analysis],
    keys: Sequence[str],
    folder: Path,
    progress: Progress,
) -> tuple[list[LocalCluster], Assignment]:
    """Return the local clusters of all recordings, and the cluster in common of each.

    ``keys`` name the analyses in ``folder``.
    """
    none = np.empty(0, np.int64)
    every, parts, count = [], [Assignment(none, none, np.empty(0), np.empty(0))], 0
    for kind in sorted({analysis.facts["vocabulary"] for analysis in analyses} - {""}):
        # By key, which tells the content: sums must not depend on what files are called.
        numbers = [i for i, each in enumerate(analyses) if each.facts["vocabulary"] == kind]
        numbers.sort(key=keys.__getitem__)
        groups = [find_local_clusters(analyses[number].table, number) for number in numbers]
        local = [each for group in groups for each in group]
        if not local:
            continue
        if kind == BODIES or len(numbers) == 1:
            clusters = _cluster_set(local, analyses, keys, folder)
            tell = partial(_tell, progress, len(local))
            found = link_clusters(clusters, keys, CONSTANTS, progress=tell)
        else:
            found = assign_to_centres(
                [partial(read_channel_samples, folder, keys[number]) for number in numbers],
                [analyses[number].facts["moments"] for number in numbers],
                [[each.spans for each in group] for group in groups],
            )
        following = np.where(found.next_cluster < 0, -1, found.next_cluster + count)
        parts.append(found._replace(cluster=found.cluster + count, next_cluster=following))
        every += local
        count += int(found.cluster.max()) + 1
    return every, Assignment(*map(np.concatenate, zip(*parts, strict=True)))


def _tell(progress: Progress, n: int, done: int) -> None:
    """Tell how many of n local clusters have their cluster; nothing of a single round."""
    if n > CONSTANTS.most:
        progress(f"clusters in common: {done} of {n}")


def _cluster_set(
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
