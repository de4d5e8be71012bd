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

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from threadpoolctl import threadpool_limits

from kineme._threads import map_threads
from kineme.library.constants import VocabularyConstants
from kineme.library.vocabulary.joining import Contexts, Floats, Ints, Joined, Word, joined

Float32s = NDArray[np.float32]


@dataclass(frozen=True, eq=False)
class Crowd:
    """Words of one vocabulary, which are loaded when they are compared.

    Attributes
    ----------
    word : callable
        The word of a number from 0.
    recording : (words,) array
        Number of the recording that each is of.
    seconds : (words,) array
        Of all its segments.
    embeddings : (words, 32) array
        Of its typical segment.
    order : (words,) array
        The words, in the order in which they are drawn for a sample.
    """

    word: Callable[[int], Word]
    recording: Ints
    seconds: Floats
    embeddings: Float32s
    order: Ints


@dataclass(frozen=True, eq=False)
class _Typical:
    """The most typical words of the clusters of a turn, one cluster after the other."""

    words: list[Word]
    embeddings: Float32s
    labels: Ints


def clusters_in(crowd: Crowd, constants: VocabularyConstants) -> Joined:
    """The clusters of words, however many.

    Parameters
    ----------
    crowd : Crowd
    constants : VocabularyConstants

    Returns
    -------
    Joined
        As if each had been compared with each where there are no more than ``most``. Of more,
        spread and confidence are those in the turn in which a word found its cluster.
    """
    n = len(crowd.seconds)
    if n <= constants.most:
        return joined([crowd.word(number) for number in range(n)], constants)
    labels, following = np.full(n, -1), np.full(n, -1)
    confidence, spread = np.full(n, np.nan), np.zeros(n)
    waiting, count = crowd.order, 0
    while len(waiting):
        sample, others = np.sort(waiting[: constants.most]), waiting[constants.most :]
        words = [crowd.word(number) for number in sample.tolist()]
        found = joined(words, constants)
        typical = _typical(words, crowd.embeddings[sample], found, constants.typical)
        met = _assigned(crowd, others, typical, constants)
        for numbers, each in ((sample, found), (others, met)):
            at = np.flatnonzero(each.labels >= 0)
            rows = numbers[at]
            labels[rows] = each.labels[at] + count
            following[rows] = np.where(each.following[at] < 0, -1, each.following[at] + count)
            confidence[rows], spread[rows] = each.confidence[at], each.spread[at]
        count += int(found.labels.max()) + 1
        waiting = others[met.labels < 0]
    rank = np.argsort(np.argsort(-np.bincount(labels, crowd.seconds), kind="stable"))
    return Joined(rank[labels], np.where(following < 0, -1, rank[following]), confidence, spread)


def _typical(words: Sequence[Word], embeddings: Float32s, found: Joined, most: int) -> _Typical:
    """The most typical words of each cluster."""
    order = np.lexsort((found.spread, found.labels))
    first = np.searchsorted(found.labels[order], found.labels[order])
    chosen = order[np.arange(len(order)) - first < most]
    return _Typical([words[i] for i in chosen], embeddings[chosen], found.labels[chosen])


def _assigned(
    crowd: Crowd, numbers: Ints, typical: _Typical, constants: VocabularyConstants
) -> Joined:
    """The nearest cluster of each word, -1 where none is near enough, and the next one."""

    def nearest(number: int) -> tuple[int, int, float, float]:
        near = _near(crowd.embeddings[number], typical, constants.nearest)
        word, others = crowd.word(number), [typical.words[i] for i in near]
        there = Contexts(others).costs_of(word).astype(np.float64)
        back = Contexts([word])
        costs = (there + [back.costs_of(other)[0] for other in others]) / 2
        same = [other.recording == word.recording for other in others]
        costs[same] = np.maximum(costs[same], constants.told_apart)
        clusters, at = np.unique(typical.labels[near], return_inverse=True)
        costs = np.minimum(costs, constants.farthest)
        means = np.bincount(at, costs) / np.bincount(at)
        order = np.argsort(means, kind="stable")
        own, least = int(clusters[order[0]]), float(means[order[0]])
        if least > constants.join:
            return -1, -1, np.nan, least
        if len(order) == 1:
            return own, -1, np.nan, least
        sure = np.clip(1 - least / max(float(means[order[1]]), 1e-9), 0, 1)
        return own, int(clusters[order[1]]), float(sure), least

    with threadpool_limits(1):  # sums do not depend on threads
        rows = map_threads(nearest, numbers.tolist())
    columns = zip(*rows, strict=True) if rows else ((), (), (), ())
    labels, following, confidence, spread = columns
    return Joined(
        np.array(labels, np.int64),
        np.array(following, np.int64),
        np.array(confidence, np.float64),
        np.array(spread, np.float64),
    )


def _near(embedding: Float32s, typical: _Typical, most: int) -> Ints:
    """The typical words of the clusters of which one word's embedding is nearest."""
    apart = ((typical.embeddings - embedding) ** 2).sum(axis=1)
    order = np.argsort(apart, kind="stable")
    clusters = list(dict.fromkeys(typical.labels[order].tolist()))[:most]
    return np.flatnonzero(np.isin(typical.labels, clusters))
