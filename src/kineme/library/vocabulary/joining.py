"""One vocabulary: the clusters of single recordings, joined over all of them.

The clusters that were found in each recording alone are the *words* to be joined. A word is looked
at by an example, its typical segment, and by a context, the activity around it: in a cyclic
movement, the example of one recording may be cut at another phase than that of the next.

The distance of two words is the mean of what it costs to find the example of each in the context
of the other. Words of one recording were found to differ there: they are as far apart at least as
two that have nothing in common, so that they are one only where those of others lie between them.
Words are joined by average linkage, as long as a search would find them by each other.

That compares each with each. Of more words than that is worth, see
`kineme.library.vocabulary.crowds`.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.cluster.hierarchy import fcluster, linkage
from scipy.spatial.distance import squareform
from threadpoolctl import threadpool_limits

from kineme._threads import map_threads
from kineme.library.constants import VocabularyConstants
from kineme.matching.subsequences import warped

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
Float32s = NDArray[np.float32]

APART = 1e3
"""In each feature of a sample between two contexts: no match reaches over it."""


@dataclass(frozen=True, eq=False)
class Word:
    """A cluster of one recording, as it is compared.

    Attributes
    ----------
    example, context : (samples, dims) array
        Features of its typical segment, and of the activity that this lies in.
    recording : int
        Number of the recording that it is of.
    seconds : float
        Of all its segments.
    """

    example: Float32s
    context: Float32s
    recording: int
    seconds: float


@dataclass(frozen=True, eq=False)
class Joined:
    """The cluster of each word, and how well it fits there.

    Attributes
    ----------
    labels : (words,) array
        From 0, those of most seconds first.
    following : (words,) array
        The next cluster, -1 where there is none.
    confidence : (words,) array
        How much nearer it is to the others of its cluster than to the next one, 0 to 1; nan
        where there is no other cluster.
    spread : (words,) array
        Mean distance to the others of its cluster; the least is that of the most typical word.
    """

    labels: Ints
    following: Ints
    confidence: Floats
    spread: Floats


def joined(words: Sequence[Word], constants: VocabularyConstants) -> Joined:
    """The clusters of words.

    Parameters
    ----------
    words : sequence of Word
        With features of one vocabulary.
    constants : VocabularyConstants

    Returns
    -------
    Joined
    """
    if len(words) < 2:
        alone = np.zeros(len(words), np.int64)
        return Joined(alone, alone - 1, np.full(len(words), np.nan), np.zeros(len(words)))
    distances = np.minimum(two_way_distances(words), constants.farthest)
    recording = np.array([word.recording for word in words])
    same = recording[:, None] == recording
    distances[same] = np.maximum(distances[same], constants.told_apart)
    np.fill_diagonal(distances, 0.0)
    seconds = np.array([word.seconds for word in words])
    tree = linkage(squareform(distances, checks=False), "average")
    labels = fcluster(tree, constants.join, "distance").astype(np.int64) - 1
    order = np.argsort(-np.bincount(labels, seconds), kind="stable")
    labels = np.argsort(order)[labels]
    return _fitted(distances, labels)


def two_way_distances(words: Sequence[Word]) -> Floats:
    """``distances[a, b]``: the mean of a's example found in b's context, and b's in a's."""
    contexts = Contexts(words)
    with threadpool_limits(1):  # sums do not depend on threads
        one_way = np.array(map_threads(contexts.costs_of, words), np.float64)
    both: Floats = (one_way + one_way.T) / 2
    np.fill_diagonal(both, 0.0)
    return both


class Contexts:
    """The contexts of several words, to look for examples in.

    Parameters
    ----------
    words : sequence of Word
    """

    def __init__(self, words: Sequence[Word]):
        gap = np.full((1, words[0].example.shape[1]), APART, np.float32)
        self._laid = np.concatenate([part for word in words for part in (word.context, gap)])
        self._ends = np.cumsum([len(word.context) + 1 for word in words])

    def costs_of(self, word: Word) -> Float32s:
        """What it costs to find the example of a word in each of the contexts."""
        costs = warped(word.example, self._laid)[0]
        costs[self._ends - 1] = np.inf
        starts = np.concatenate([[0], self._ends[:-1]])
        least: Float32s = np.minimum.reduceat(costs, starts)
        return least


def _fitted(distances: Floats, labels: Ints) -> Joined:
    """Labels, and how well each word fits its own."""
    members = np.eye(int(labels.max()) + 1)[labels]
    words = np.arange(len(labels))
    sums, sizes = distances @ members, members.sum(axis=0)
    spread = sums[words, labels] / np.maximum(sizes[labels] - 1, 1)
    if len(sizes) == 1:
        return Joined(labels, labels - 1, np.full(len(labels), np.nan), spread)
    means = sums / sizes
    means[words, labels] = np.inf
    nearest = means.min(axis=1)
    confidence = np.clip(1 - spread / np.maximum(nearest, 1e-9), 0, 1)
    return Joined(labels, means.argmin(axis=1), confidence, spread)
