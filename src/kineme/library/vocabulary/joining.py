"""One vocabulary: the clusters of single recordings, joined over all of them.

The clusters that were found in each recording alone are the *words* to be joined. How far two of
them are apart, `kineme.library.vocabulary.comparing` says. Words of one recording were found to
differ there: they are as far apart at least as two that have nothing in common, so that they are
one only where those of others lie between them. Words are joined by average linkage, as long as a
search would find them by each other.

That compares each with each. Of more words than that is worth, see
`kineme.library.vocabulary.crowds`.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.cluster.hierarchy import fcluster, linkage
from scipy.spatial.distance import squareform

from kineme.library.constants import VocabularyConstants

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]


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


def joined(
    distances: Floats, recording: Ints, seconds: Floats, constants: VocabularyConstants
) -> Joined:
    """The clusters of words.

    Parameters
    ----------
    distances : (words, words) array
        Of each two, by `kineme.library.vocabulary.comparing.two_way_distances`.
    recording : (words,) array
        Number of the recording that each is of.
    seconds : (words,) array
        Of all segments of each.
    constants : VocabularyConstants

    Returns
    -------
    Joined
    """
    n = len(distances)
    if n < 2:
        alone = np.zeros(n, np.int64)
        return Joined(alone, alone - 1, np.full(n, np.nan), np.zeros(n))
    distances = np.minimum(distances, constants.farthest)
    same = recording[:, None] == recording
    distances[same] = np.maximum(distances[same], constants.told_apart)
    np.fill_diagonal(distances, 0.0)
    tree = linkage(squareform(distances, checks=False), "average")
    labels = fcluster(tree, constants.join, "distance").astype(np.int64) - 1
    order = np.argsort(-np.bincount(labels, seconds), kind="stable")
    labels = np.argsort(order)[labels]
    return _fitted(distances, labels)


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
