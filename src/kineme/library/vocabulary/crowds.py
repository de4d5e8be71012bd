"""One vocabulary of more words than can be compared each with each.

Words are clustered in turns. In each, a sample of those that are left is compared each with each
(`kineme.library.vocabulary.joining`). Every other word is compared with the most typical words of
the few clusters whose embeddings are nearest to its own, and joins the nearest of these clusters if
average linkage would have let it. Words that join none are left for the next turn: what is rare is
not in the first sample, and not lost. Time grows with the number of words, not with its square.

The sample are the words whose names have the lowest digests, so that a few recordings more change
little of it.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from threadpoolctl import threadpool_limits

from kineme._threads import map_threads
from kineme.library.constants import VocabularyConstants
from kineme.library.executors import Executor
from kineme.library.progress import Progress, Watch
from kineme.library.vocabulary.comparing import Contexts, Crowd, results, two_way_distances
from kineme.library.vocabulary.joining import Ints, Joined, joined

Float32s = NDArray[np.float32]

AT_ONCE = 200
"""Words of a task that looks for their clusters."""
PER_WORKER = 2000
"""Words for which one process more is started: some seconds of work."""


@dataclass(frozen=True, eq=False)
class _Typical:
    """The most typical words of the clusters of a turn, one cluster after the other."""

    words: Crowd
    labels: Ints


@dataclass(frozen=True, eq=False)
class _Search:
    """Words, by their numbers, whose clusters are looked for among those of a turn."""

    numbers: Ints
    words: Crowd
    typical: _Typical
    constants: VocabularyConstants


def clusters_in(
    crowd: Crowd, constants: VocabularyConstants, executor: Executor, progress: Progress
) -> Joined:
    """The clusters of words, however many.

    Parameters
    ----------
    crowd : Crowd
    constants : VocabularyConstants
    executor : Executor
        Where words are compared.
    progress : callable
        Called with a sentence on how far it is.

    Returns
    -------
    Joined
        As if each had been compared with each where there are no more than ``most``. Of more,
        spread and confidence are those in the turn in which a word found its cluster.
    """
    n = len(crowd)
    workers = n // PER_WORKER
    if n <= constants.most:
        return _each_with_each(crowd, constants, executor, workers)
    labels, following = np.full(n, -1), np.full(n, -1)
    confidence, spread = np.full(n, np.nan), np.zeros(n)
    waiting, count = np.argsort(crowd.drawn, kind="stable"), 0
    watch = Watch(progress, n, 0, "clusters in common: ")
    while len(waiting):
        sample, others = np.sort(waiting[: constants.most]), waiting[constants.most :]
        watch.more(len(sample) ** 2 + len(others) * _searches(constants))
        found = _each_with_each(crowd.part(sample), constants, executor, workers)
        watch.done(len(sample), len(sample) ** 2)
        typical = _typical(crowd, sample, found, constants.typical)
        met = _met(crowd, others, typical, constants, executor, watch)
        for numbers, each in ((sample, found), *met):
            at = np.flatnonzero(each.labels >= 0)
            rows = numbers[at]
            labels[rows] = each.labels[at] + count
            following[rows] = np.where(each.following[at] < 0, -1, each.following[at] + count)
            confidence[rows], spread[rows] = each.confidence[at], each.spread[at]
        count += int(found.labels.max()) + 1
        waiting = others[labels[others] < 0]
    rank = np.argsort(np.argsort(-np.bincount(labels, crowd.seconds), kind="stable"))
    return Joined(rank[labels], np.where(following < 0, -1, rank[following]), confidence, spread)


def _each_with_each(
    crowd: Crowd, constants: VocabularyConstants, executor: Executor, workers: int
) -> Joined:
    distances = two_way_distances(crowd, executor, workers)
    return joined(distances, crowd.recording, crowd.seconds, constants)


def _searches(constants: VocabularyConstants) -> int:
    """How often a word that is not in the sample is searched, or others in it, at most."""
    return 2 * constants.nearest * constants.typical


def _typical(crowd: Crowd, sample: Ints, found: Joined, most: int) -> _Typical:
    """The most typical words of each cluster."""
    order = np.lexsort((found.spread, found.labels))
    first = np.searchsorted(found.labels[order], found.labels[order])
    chosen = order[np.arange(len(order)) - first < most]
    return _Typical(crowd.part(sample[chosen]), found.labels[chosen])


def _met(
    crowd: Crowd,
    numbers: Ints,
    typical: _Typical,
    constants: VocabularyConstants,
    executor: Executor,
    watch: Watch,
) -> Iterator[tuple[Ints, Joined]]:
    """Words by their numbers, and the cluster of each; -1 where none is near enough."""
    blocks = [numbers[first : first + AT_ONCE] for first in range(0, len(numbers), AT_ONCE)]
    tasks = [_Search(own, crowd.part(own), typical, constants) for own in blocks]
    for task, found in results(executor, _clusters_of, tasks, len(crowd) // PER_WORKER):
        watch.done(int((found.labels >= 0).sum()), len(task.numbers) * _searches(constants))
        yield task.numbers, found


def _clusters_of(task: _Search) -> Joined:
    """The nearest cluster of each word of a task."""
    constants, crowd, labels = task.constants, task.words, task.typical.labels
    near = [_near(embedding, task.typical, constants.nearest) for embedding in crowd.embeddings]
    needed = sorted({i for each in near for i in each.tolist()})
    typical = {i: task.typical.words.load(task.typical.words.places[i]) for i in needed}

    def nearest(number: int) -> tuple[int, int, float, float]:
        at = near[number]
        word, others = crowd.load(crowd.places[number]), [typical[i] for i in at.tolist()]
        there = Contexts(others).costs_of(word).astype(np.float64)
        back = Contexts([word])
        costs = (there + [back.costs_of(other)[0] for other in others]) / 2
        same = task.typical.words.recording[at] == crowd.recording[number]
        costs[same] = np.maximum(costs[same], constants.told_apart)
        clusters, of = np.unique(labels[at], return_inverse=True)
        costs = np.minimum(costs, constants.farthest)
        means = np.bincount(of, costs) / np.bincount(of)
        order = np.argsort(means, kind="stable")
        own, least = int(clusters[order[0]]), float(means[order[0]])
        if least > constants.join:
            return -1, -1, np.nan, least
        if len(order) == 1:
            return own, -1, np.nan, least
        sure = np.clip(1 - least / max(float(means[order[1]]), 1e-9), 0, 1)
        return own, int(clusters[order[1]]), float(sure), least

    with threadpool_limits(1):  # sums do not depend on threads
        rows = map_threads(nearest, range(len(crowd)))
    columns = zip(*rows, strict=True)
    return Joined(*map(np.array, columns))


def _near(embedding: Float32s, typical: _Typical, most: int) -> Ints:
    """The typical words of the clusters of which one word's embedding is nearest."""
    apart = ((typical.words.embeddings - embedding) ** 2).sum(axis=1)
    order = np.argsort(apart, kind="stable")
    clusters = list(dict.fromkeys(typical.labels[order].tolist()))[:most]
    return np.flatnonzero(np.isin(typical.labels, clusters))
