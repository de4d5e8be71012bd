"""One vocabulary: the clusters of single recordings, compared and joined over all of them.

The clusters that were found in each recording alone are the *words* to be joined. A word is looked
at by an example, its typical segment, and by a context, the activity around it: in a cyclic
movement, the example of one recording may be cut at another phase than that of the next. The
distance of two words is the mean of those at which a search finds the example of each in the
context of the other; what it would not find within 1 has nothing in common and is at 1.

Words of one recording were found to differ there: they are at 1, too, so that they are one only
where those of others lie between them. Words are joined by average linkage, as long as a search
would find them by each other, on average.

More words than can be compared each with each are clustered in turns. In each, a sample of those
that are left is compared each with each. Every other word is compared with the most typical words
of the few clusters whose embeddings are nearest to its own, and joins the nearest of these clusters
if average linkage would have let it. Words that join none are left for the next turn: what is rare
is not in the first sample, and not lost. Time grows with the number of words, not with its square.
The sample are the words whose names have the lowest digests, so that a few recordings more change
little of it.

Words are compared by tasks of an executor. A task tells where its words lie, and whoever works on
it reads their features there: what goes to another machine and back is small. Tasks are the same
wherever they are worked on, and so are sums.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from itertools import combinations_with_replacement
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.cluster.hierarchy import fcluster, linkage
from scipy.spatial.distance import squareform
from threadpoolctl import threadpool_limits

from kineme._util.arrays import Float32s, Floats, Ints
from kineme._util.parallel import map_threads
from kineme.errors import KinemeError
from kineme.library.executors import Executor, Outcome, Progress, Task, Watch
from kineme.library.settings import VocabularyConstants

FARTHEST = 1.0
"""Of two movements that have nothing in common: see `kineme.transfer.subsequences`."""
APART = 1e3
"""Value of each feature between two contexts: no match crosses it."""
BLOCK = 100
"""Words that a task compares with as many others."""
AT_ONCE = 200
"""Words of a task that looks for their clusters."""
PER_WORKER = 2000
"""Words for which one process more is started: some seconds of work."""


@dataclass(frozen=True, eq=False)
class Word:
    """A cluster of one recording, as it is compared.

    Attributes
    ----------
    example, context : (samples, dims) array
        Features of its typical segment, and of the activity that this lies in.
    """

    example: Float32s
    context: Float32s


@dataclass(frozen=True, eq=False)
class Crowd:
    """Words of one vocabulary, which are loaded where they are compared.

    Attributes
    ----------
    load : callable
        The word at a place; it can be pickled, and so can places.
    places : sequence
        Of each word.
    recording : (words,) array
        Number of the recording that each is of.
    seconds : (words,) array
        Of all its segments.
    embeddings : (words, 32) array
        Of its typical segment.
    drawn : (words,) array
        Those of the least numbers are drawn for a sample first.
    """

    load: Callable[[Any], Word]
    places: Sequence[Any]
    recording: Ints
    seconds: Floats
    embeddings: Float32s
    drawn: NDArray[np.unsignedinteger[Any]]

    def __len__(self) -> int:
        return len(self.places)

    def part(self, numbers: Ints) -> Crowd:
        """These of its words."""
        return Crowd(
            self.load,
            [self.places[number] for number in numbers.tolist()],
            self.recording[numbers],
            self.seconds[numbers],
            self.embeddings[numbers],
            self.drawn[numbers],
        )


@dataclass(frozen=True, eq=False)
class _Pairs:
    """Words of a crowd, rows and columns of a table, to be compared."""

    load: Callable[[Any], Word]
    rows: slice
    columns: slice
    ones: Sequence[Any]
    others: Sequence[Any]


def mutual_distances(crowd: Crowd, executor: Executor, workers: int) -> Floats:
    """``distances[a, b]``: the mean of a's example found in b's context, and b's in a's."""
    n = len(crowd)
    blocks = [slice(first, min(first + BLOCK, n)) for first in range(0, n, BLOCK)]
    tasks = [
        _Pairs(crowd.load, rows, columns, crowd.places[rows], crowd.places[columns])
        for rows, columns in combinations_with_replacement(blocks, 2)
    ]
    distances = np.zeros((n, n))
    for task, found in results(executor, _compared, tasks, workers):
        distances[task.rows, task.columns] = found
        distances[task.columns, task.rows] = found.T
    np.fill_diagonal(distances, 0.0)
    return distances


def results(
    executor: Executor, work: Callable[[Task], Outcome], tasks: Sequence[Task], workers: int
) -> Iterator[tuple[Task, Outcome]]:
    """What comes of tasks that compare words, as they come; KinemeError where processes died."""
    for task, outcome in executor.completed(work, tasks, workers=workers):
        if outcome is None:
            raise KinemeError(
                "the processes that compared clusters died: they may need more memory than there "
                "is; what was read is kept, build again"
            )
        yield task, outcome


def _compared(task: _Pairs) -> Floats:
    """Return the distance of each word of the rows from each of the columns."""
    ones = [task.load(place) for place in task.ones]
    others = ones if task.columns == task.rows else [task.load(place) for place in task.others]
    forward = _all_distances(ones, Contexts(others))
    backward = forward if others is ones else _all_distances(others, Contexts(ones))
    both: Floats = (forward + backward.T) / 2
    return both


def _all_distances(words: Sequence[Word], contexts: Contexts) -> Floats:
    with threadpool_limits(1):  # sums do not depend on threads
        return np.array(map_threads(contexts.distances_of, words), np.float64)


class Contexts:
    """The contexts of several words, to look for examples in."""

    def __init__(self, words: Sequence[Word]):
        from kineme.transfer.subsequences import Searched  # half a second, for who compares only

        gap = np.full((1, words[0].example.shape[1]), APART, np.float32)
        parts = [part for word in words for part in (word.context, gap)]
        self._searched = Searched(np.concatenate(parts))
        lengths = [len(word.context) + 1 for word in words]
        self._starts = np.cumsum([0, *lengths[:-1]])

    def distances_of(self, word: Word) -> Float32s:
        """How far the example of a word is from the nearest movement in each of the contexts."""
        distances, _ = self._searched.distances(word.example, most=FARTHEST)
        least: Float32s = np.minimum.reduceat(distances, self._starts)
        return np.minimum(least, np.float32(FARTHEST))


class Joined(NamedTuple):
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


def joined(distances: Floats, recording: Ints, seconds: Floats, threshold: float) -> Joined:
    """The clusters of words of these recordings, by `mutual_distances` and seconds of each."""
    n = len(distances)
    if n < 2:
        alone = np.zeros(n, np.int64)
        return Joined(alone, alone - 1, np.full(n, np.nan), np.zeros(n))
    distances = np.where(recording[:, None] == recording, FARTHEST, distances)
    np.fill_diagonal(distances, 0.0)
    tree = linkage(squareform(distances, checks=False), "average")
    labels = fcluster(tree, threshold, "distance").astype(np.int64) - 1
    order = np.argsort(-np.bincount(labels, seconds), kind="stable")
    labels = np.argsort(order)[labels]
    return _fitted(distances, labels)


def _fitted(distances: Floats, labels: Ints) -> Joined:
    """Labels, and how well each word fits its own."""
    members = np.eye(int(labels.max()) + 1)[labels]
    sums, sizes = distances @ members, members.sum(axis=0)
    spread = sums[np.arange(len(labels)), labels] / np.maximum(sizes[labels] - 1, 1)
    return beside_others(labels, spread, sums / sizes)


def beside_others(labels: Ints, spread: Floats, distances: Floats) -> Joined:
    """Words with the next cluster of each, by their distances (words, clusters) from all."""
    if distances.shape[1] == 1:
        return Joined(labels, labels - 1, np.full(len(labels), np.nan), spread)
    others = distances.copy()
    others[np.arange(len(labels)), labels] = np.inf
    confidence = np.clip(1 - spread / np.maximum(others.min(axis=1), 1e-9), 0, 1)
    return Joined(labels, others.argmin(axis=1), confidence, spread)


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
    """Return the clusters of words, however many.

    Up to ``most`` are compared each with each. Of more, spread and confidence are those in the turn
    in which a word found its cluster.
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
        nearest = _nearest_clusters(crowd, others, typical, constants, executor, watch)
        for numbers, each in ((sample, found), *nearest):
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
    distances = mutual_distances(crowd, executor, workers)
    return joined(distances, crowd.recording, crowd.seconds, constants.join)


def _searches(constants: VocabularyConstants) -> int:
    """How often a word that is not in the sample is searched, or others in it, at most."""
    return 2 * constants.nearest * constants.typical


def _typical(crowd: Crowd, sample: Ints, found: Joined, most: int) -> _Typical:
    """Return the most typical words of each cluster."""
    order = np.lexsort((found.spread, found.labels))
    first = np.searchsorted(found.labels[order], found.labels[order])
    chosen = order[np.arange(len(order)) - first < most]
    return _Typical(crowd.part(sample[chosen]), found.labels[chosen])


def _nearest_clusters(
    crowd: Crowd,
    numbers: Ints,
    typical: _Typical,
    constants: VocabularyConstants,
    executor: Executor,
    watch: Watch,
) -> Iterator[tuple[Ints, Joined]]:
    """Words by their numbers, and the cluster of each; -1 where none is near enough."""
    blocks = [numbers[first : first + AT_ONCE] for first in range(0, len(numbers), AT_ONCE)]
    tasks = [_Search(block, crowd.part(block), typical, constants) for block in blocks]
    for task, found in results(executor, _clusters_of, tasks, len(crowd) // PER_WORKER):
        watch.done(int((found.labels >= 0).sum()), len(task.numbers) * _searches(constants))
        yield task.numbers, found


def _clusters_of(task: _Search) -> Joined:
    """Return the nearest cluster of each word of a task."""
    constants, crowd, labels = task.constants, task.words, task.typical.labels
    near = [_near(embedding, task.typical, constants.nearest) for embedding in crowd.embeddings]
    needed = sorted({i for each in near for i in each.tolist()})
    typical = {i: task.typical.words.load(task.typical.words.places[i]) for i in needed}

    def nearest(number: int) -> tuple[int, int, float, float]:
        at = near[number]
        word, others = crowd.load(crowd.places[number]), [typical[i] for i in at.tolist()]
        forward = Contexts(others).distances_of(word).astype(np.float64)
        context = Contexts([word])
        distances = (forward + [context.distances_of(other)[0] for other in others]) / 2
        distances[task.typical.words.recording[at] == crowd.recording[number]] = FARTHEST
        clusters, of = np.unique(labels[at], return_inverse=True)
        means = np.bincount(of, distances) / np.bincount(of)
        order = np.argsort(means, kind="stable")
        cluster, least = int(clusters[order[0]]), float(means[order[0]])
        if least > constants.join:
            return -1, -1, np.nan, least
        if len(order) == 1:
            return cluster, -1, np.nan, least
        confidence = np.clip(1 - least / max(float(means[order[1]]), 1e-9), 0, 1)
        return cluster, int(clusters[order[1]]), float(confidence), least

    with threadpool_limits(1):  # sums do not depend on threads
        rows = map_threads(nearest, range(len(crowd)))
    columns = zip(*rows, strict=True)
    return Joined(*map(np.array, columns))


def _near(embedding: Float32s, typical: _Typical, most: int) -> Ints:
    """Return the typical words of the clusters of which one word's embedding is nearest."""
    apart = ((typical.words.embeddings - embedding) ** 2).sum(axis=1)
    order = np.argsort(apart, kind="stable")
    clusters = list(dict.fromkeys(typical.labels[order].tolist()))[:most]
    return np.flatnonzero(np.isin(typical.labels, clusters))
