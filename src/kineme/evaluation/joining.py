"""The clusters of a folder's recordings joined, so that one mapping can hold for all of them.

Bodies, and signals of the same channels, have a vocabulary each; nothing is one cluster across
these. What one method finds is joined by itself.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from kineme.errors import EndEffectorError
from kineme.evaluation.comparison import Comparison, best_mapping, compare
from kineme.evaluation.jobs import Answer, Job, Sides
from kineme.recordings.motion import Motion
from kineme.segments.segmentation import Segmentation
from kineme.transfer.sharing import share_clusters
from kineme.transfer.vocabulary import share_by_moments


def joined_comparisons(
    answers: Sequence[tuple[Job, Answer]], n_clusters: int | None = None
) -> list[Comparison | None]:
    """The comparisons of what one method found, by one mapping of joined clusters.

    Parameters
    ----------
    answers : sequence of Job and Answer
        Of jobs that join.
    n_clusters : int, optional
        Of signals, how many there are of each kind; found out by default.

    Returns
    -------
    list of Comparison or None
        None where a job failed.
    """
    classes: dict[str, int] = {}
    compared = {
        i: compare(sides.truth, found, classes=classes)
        for i, (sides, found) in _joined(answers, n_clusters).items()
    }
    if not compared:
        return [None] * len(answers)
    mapping = best_mapping(list(compared.values()))
    mapped = {i: replace(one, mapping=mapping) for i, one in compared.items()}
    return [mapped.get(i) for i in range(len(answers))]


def _joined(
    answers: Sequence[tuple[Job, Answer]], n_clusters: int | None
) -> dict[int, tuple[Sides, Segmentation]]:
    """By the place of an answer: what was found there, with the joined clusters."""
    kinds: dict[tuple[str, ...], list[int]] = {}
    for i, (_, answer) in enumerate(answers):
        if answer.sides is not None:
            moments = answer.sides.moments
            kinds.setdefault(moments.names if moments else (), []).append(i)
    found: dict[int, tuple[Sides, Segmentation]] = {}
    following = 0
    for rows in kinds.values():
        jobs = [answers[i][0] for i in rows]
        sides = [s for i in rows if (s := answers[i][1].sides) is not None]
        shared = _of_one_kind(jobs, sides, n_clusters)
        for i, side, one in zip(rows, sides, shared, strict=True):
            found[i] = side, _from(one, following)
        following += 1 + max(int(one.table.cluster.max()) for one in shared)
    return dict(sorted(found.items()))


def _of_one_kind(
    jobs: Sequence[Job], sides: Sequence[Sides], n_clusters: int | None
) -> list[Segmentation]:
    segmentations = [one.found for one in sides]
    moments = [one.moments for one in sides if one.moments is not None]
    if moments:
        return share_by_moments(moments, segmentations, n_clusters=n_clusters)
    motions = [motion for job in jobs if isinstance(motion := job.reading.read(job.path), Motion)]
    try:
        return share_clusters(motions, segmentations)
    except EndEffectorError:  # no body whose movements could be compared
        return _all_apart(segmentations)


def _all_apart(segmentations: Sequence[Segmentation]) -> list[Segmentation]:
    """Clusters of different recordings by different numbers."""
    apart, following = [], 0
    for found in segmentations:
        apart.append(_from(found, following))
        following += 1 + int(found.table.cluster.max())
    return apart


def _from(found: Segmentation, first: int) -> Segmentation:
    """The same with clusters numbered from a number on."""
    table = found.table
    cluster, action = (np.where(c >= 0, c + first, c) for c in (table.cluster, table.action))
    changed = table.with_columns(cluster=cluster, action=action)
    return replace(found, table=changed, hierarchy=None)
