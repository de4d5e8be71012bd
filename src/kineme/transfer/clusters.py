"""Find common clusters: clusters of several recordings that are the same movement.

Segmentation finds clusters in each recording separately, here called local clusters. An
`Assignment` gives the common cluster of each.

**Bodies** (`link_clusters`). The example of a local cluster is its typical segment. Its context is
the activity around it, because another recording may cut the same cyclic movement at another phase.
A search (see `kineme.transfer.matching`) finds the example of each local cluster in the context
of the other. Their distance is the mean of both search distances, at most 1. Average linkage merges
clusters up to the threshold of the search, unless the two groups are clearly separate, such as
walking and running. Local clusters of one recording differ, so their distance is set to 2.

More local clusters than ``most`` are linked in rounds, so that run time is linear in their number.
A round links a sample. All others are compared with representatives of the clusters with the
nearest embeddings, and take the nearest cluster within the threshold. The rest is left for the next
round, so that rare movements are not lost.

**Signals** (`assign_to_centres`). Clusters of a single recording depend on its content: a recording
of walking separates fast from slow, one of walking and sitting does not. So the samples of all
recordings are clustered together (k-means, the best of several runs) in common units. Each local
cluster is assigned to the centre nearest to the mean of its samples.

**Numbers** (`keep_numbers`). A cluster that is found again keeps its number.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from hashlib import sha256
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray
from threadpoolctl import threadpool_limits

from kineme._util.arrays import Float32s, Floats, Ints
from kineme._util.parallel import map_threads
from kineme.segments.table import SegmentTable
from kineme.transfer.embeddings import fit_units
from kineme.transfer.matching import THRESHOLD, Searched

FARTHEST = 1.0
"""Distance of two movements with nothing in common."""
SAME_RECORDING = 2.0
"""Distance of local clusters of one recording: above any other, as its segmentation found them to
be different movements."""
SEPARATOR = 1e3
"""Value of each feature between two contexts, so that no match crosses from one to the other."""
BLOCK = 100
"""Number of local clusters that are compared at a time."""
MAX_SAMPLES = 20_000
"""Largest number of samples for k-means; of more, every n-th of each recording is used."""
N_STARTS = 5
"""Number of runs of k-means; the best is used."""
MIN_EXPLAINED = 0.02
"""Share of the variance of all samples that an additional cluster must explain."""
COUNTING_SAMPLES = 10_000
"""Largest number of samples from which the number of clusters is estimated."""
PATIENCE = 3
"""Number of larger numbers of clusters that are tried after the best."""
Features = Sequence[Float32s]
"""Features (samples, dims) of an example, and of its context."""
Spans = tuple[Floats, Floats, Ints]
"""Starts and stops in seconds, and clusters, of the activities of a recording."""


@dataclass(frozen=True, kw_only=True)
class ClusterConstants:
    """Constants for comparing and linking local clusters."""

    join: float = THRESHOLD
    """Largest mean distance at which clusters are merged."""
    apart: float = 0.2
    """Mean silhouette above which two groups are not merged."""
    fewest: int = 3
    """Smallest size of groups for which the silhouette is tested."""
    longest_example: float = 4.0
    longest_context: float = 12.0
    """Longest example and context, s; longer ones are cut."""
    most: int = 400
    """Largest number of local clusters in the sample of a round."""
    typical: int = 5
    """Number of representatives of each cluster of a round: those with the least spread."""
    nearest: int = 4
    """Number of clusters of a round with which each other local cluster is compared."""
    unsure: float = 0.1
    """Confidence below which an assignment is shown as uncertain."""


CONSTANTS = ClusterConstants()


class Assignment(NamedTuple):
    """Common clusters: ``cluster[i]`` is that of local cluster i, numbered by descending duration.

    ``next_cluster`` is the nearest other cluster, or -1. ``spread`` is the mean distance to the
    other members of the cluster (for signals, to its centre). ``confidence`` is 1 - spread /
    distance to the next cluster, 0 to 1, or nan without a next cluster. With several rounds, the
    values are from the round in which a local cluster was assigned.
    """

    cluster: Ints
    next_cluster: Ints
    confidence: Floats
    spread: Floats

    def shift(self, count: int) -> Assignment:
        """Return the assignment with clusters numbered from ``count`` on."""
        cluster, next_cluster = (np.where(n < 0, -1, n + count) for n in self[:2])
        return self._replace(cluster=cluster, next_cluster=next_cluster)


@dataclass(frozen=True, eq=False)
class LocalCluster:
    """A cluster of one recording; ``row`` is its typical segment in the segment table."""

    recording: int
    cluster: int
    row: int
    start_s: float
    stop_s: float
    spans: Floats
    """Starts and stops of all its segments, (segments, 2) seconds."""
    example: tuple[float, float]
    context: tuple[float, float]
    """Start and stop of the example, and of its context, in seconds."""

    @property
    def seconds(self) -> float:
        """Return the total duration of its segments."""
        return round(float((self.spans[:, 1] - self.spans[:, 0]).sum()), 6)


def find_local_clusters(table: SegmentTable, recording: int) -> list[LocalCluster]:
    """Return the clusters of a segment table, in ascending order.

    The typical segment is the repetition of median length, or else the activity.
    """
    is_active, is_primitive = table.kind != "transition", table.level == "primitive"
    local_clusters = []
    for cluster in sorted(set(table.cluster[is_active].tolist()) - {-1}):
        members = np.flatnonzero((table.cluster == cluster) & is_active)
        repetitions = members[is_primitive[members]]
        chosen = repetitions if len(repetitions) else members
        row = int(chosen[np.argsort(table.duration_s[chosen], kind="stable")[len(chosen) // 2]])
        # One level only, so that no time counts twice. Rows of activities precede primitives, so
        # this is the level of activities, if there are any.
        counted = members[is_primitive[members] == is_primitive[members[0]]]
        example, context = _find_example(table, row)
        local_clusters.append(
            LocalCluster(
                recording=recording,
                cluster=cluster,
                row=row,
                start_s=float(table.start_s[row]),
                stop_s=float(table.stop_s[row]),
                spans=np.column_stack([table.start_s[counted], table.stop_s[counted]]),
                example=example,
                context=context,
            )
        )
    return local_clusters


def _find_example(table: SegmentTable, row: int) -> tuple[tuple[float, float], tuple[float, float]]:
    """Return the middle part of a segment, and the middle part of the activity around it."""
    start_s, stop_s = float(table.start_s[row]), float(table.stop_s[row])
    middle = (start_s + stop_s) / 2
    length = min(stop_s - start_s, CONSTANTS.longest_example)
    example = middle - length / 2, middle + length / 2
    around = (table.level == "activity") & (table.start_s <= middle) & (middle < table.stop_s)
    reach = max(CONSTANTS.longest_context, length) / 2
    # Without an activity around the segment, the context is the example.
    first = min([example[0], *table.start_s[around].tolist()])
    last = max([example[1], *table.stop_s[around].tolist()])
    return example, (max(first, middle - reach), min(last, middle + reach))


@dataclass(frozen=True, eq=False)
class ClusterSet:
    """Local clusters to link.

    ``load(cluster)`` returns the features of a local cluster. Features are not stored, as a set may
    be large.
    ``embeddings`` (n, 32) are those of the typical segments.
    """

    local: Sequence[LocalCluster]
    embeddings: Float32s
    load: Callable[[LocalCluster], Features]

    @property
    def recording(self) -> Ints:
        return np.array([each.recording for each in self.local], np.int64)

    def select(self, numbers: Ints) -> ClusterSet:
        """Return some of the local clusters."""
        local = [self.local[number] for number in numbers.tolist()]
        return ClusterSet(local, self.embeddings[numbers], self.load)


def link_clusters(
    clusters: ClusterSet,
    keys: Sequence[str],
    constants: ClusterConstants = CONSTANTS,
    *,
    progress: Callable[[str], None] = lambda _: None,
) -> Assignment:
    """Find the common cluster of each local cluster, by average linkage.

    ``keys`` identify recordings. Samples are drawn in the order of their digests, so that a few
    more recordings change little. ``progress`` is called after each of several rounds.
    """
    n, count = len(clusters.local), 0
    result = Assignment(np.full(n, -1), np.full(n, -1), np.full(n, np.nan), np.zeros(n))

    def store(numbers: Ints, found: Assignment) -> None:
        """Write those local clusters to ``result`` for which a cluster is found."""
        fits = found.cluster >= 0
        for column, values in zip(result, found.shift(count), strict=True):
            column[numbers[fits]] = values[fits]
        if n > constants.most:
            progress(f"clusters in common: {(result.cluster >= 0).sum()} of {n}")

    names = [f"{keys[each.recording]} {each.cluster}" for each in clusters.local]
    waiting = np.array(sorted(range(n), key=lambda i: sha256(names[i].encode()).digest()), np.int64)
    while len(waiting):
        sample, others = np.sort(waiting[: constants.most]), waiting[constants.most :]
        linked = _link(clusters.select(sample), constants)
        store(sample, linked)
        # Sort each cluster by spread; the first few members represent it.
        order = np.lexsort((linked.spread, linked.cluster))
        ordered = linked.cluster[order]
        rank = np.arange(len(order)) - np.searchsorted(ordered, ordered)
        chosen = order[rank < constants.typical]
        typical = clusters.select(sample[chosen]), linked.cluster[chosen]
        for first in range(0, len(others), BLOCK):
            block = others[first : first + BLOCK]
            store(block, _assign_to_nearest(clusters.select(block), *typical, constants))
        count += int(linked.cluster.max()) + 1
        waiting = others[result.cluster[others] < 0]
    return _number_by_seconds(result, [each.seconds for each in clusters.local])


def _link(clusters: ClusterSet, constants: ClusterConstants) -> Assignment:
    """Compare local clusters pairwise and merge them by average linkage."""
    rows, recording = np.arange(len(clusters.local)), clusters.recording
    # Distances are symmetric: compute only blocks on and above the diagonal.
    is_needed = rows >= rows[:, None] // BLOCK * BLOCK
    distances = measure_distances(clusters, clusters, is_needed)
    distances = np.where(is_needed, distances, distances.T)
    distances[recording[:, None] == recording] = SAME_RECORDING
    np.fill_diagonal(distances, 0.0)
    cluster = group_by_distance(distances, constants)
    # One-hot rows: products with them sum over clusters.
    members = np.eye(int(cluster.max()) + 1)[cluster]
    sums, sizes = distances @ members, members.sum(axis=0)
    spread = sums[rows, cluster] / np.maximum(sizes[cluster] - 1, 1)
    return _compare_with_next(cluster, spread, sums / sizes)


def group_by_distance(distances: Floats, constants: ClusterConstants = CONSTANTS) -> Ints:
    """Return the group of each row of a distance matrix, by average linkage.

    Two groups at a mean distance up to ``join`` are merged, unless both have at least ``fewest``
    members and their mean silhouette [1]_ is above ``apart``.

    References
    ----------
    .. [1] Rousseeuw, "Silhouettes: a graphical aid to the interpretation and validation of cluster
       analysis", Journal of Computational and Applied Mathematics 20 (1987).
    """
    from scipy.cluster.hierarchy import linkage, to_tree
    from scipy.spatial.distance import squareform

    groups: list[list[int]] = [[*range(len(distances))]]
    if len(distances) > 1:
        groups, waiting = [], [to_tree(linkage(squareform(distances, checks=False), "average"))]
        while waiting:
            node = waiting.pop()
            if not node.is_leaf() and (
                node.dist > constants.join
                or _are_apart(distances, node.left.pre_order(), node.right.pre_order(), constants)
            ):
                waiting += [node.left, node.right]
            else:
                groups.append(node.pre_order())
    result = np.empty(len(distances), np.int64)
    for number, members in enumerate(sorted(groups, key=min)):
        result[members] = number
    return result


def _are_apart(
    distances: Floats, ones: list[int], others: list[int], constants: ClusterConstants
) -> bool:
    """Return whether members of two groups are much nearer to their own group than to the other."""
    if min(len(ones), len(others)) < constants.fewest:
        return False
    silhouettes = []
    for group, other in ((ones, others), (others, ones)):
        # Divide by size - 1: the distance of a member to itself is 0.
        within = distances[np.ix_(group, group)].sum(axis=1) / (len(group) - 1)
        between = distances[np.ix_(group, other)].mean(axis=1)
        silhouettes += ((between - within) / np.maximum(np.maximum(between, within), 1e-9)).tolist()
    return float(np.mean(silhouettes)) > constants.apart


def _assign_to_nearest(
    clusters: ClusterSet, typical: ClusterSet, numbers: Ints, constants: ClusterConstants
) -> Assignment:
    """Return the nearest cluster of each local cluster, -1 if none is within the threshold.

    ``numbers`` are the clusters of the representatives in ``typical``.
    """
    # (local clusters, representatives): compare only clusters with the nearest embeddings.
    is_near = np.zeros((len(clusters.local), len(numbers)), np.bool_)
    for row, embedding in enumerate(clusters.embeddings):
        distances_to = ((typical.embeddings - embedding) ** 2).sum(axis=1)
        order = numbers[np.argsort(distances_to, kind="stable")].tolist()
        is_near[row] = np.isin(numbers, list(dict.fromkeys(order))[: constants.nearest])
    distances = measure_distances(clusters, typical, is_near)
    same = clusters.recording[:, None] == typical.recording
    # Pairs that were not compared are 0, so that they do not add to the sums.
    distances = np.where(is_near, np.where(same, SAME_RECORDING, distances), 0.0)
    # One-hot rows (representatives, clusters): products with them sum over clusters.
    members = np.eye(int(numbers.max()) + 1)[numbers]
    counts = is_near @ members
    means = np.where(counts > 0, distances @ members / np.maximum(counts, 1), np.inf)
    least = means.min(axis=1)
    assignment = _compare_with_next(means.argmin(axis=1), least, means)
    return assignment._replace(cluster=np.where(least <= constants.join, assignment.cluster, -1))


def _compare_with_next(cluster: Ints, spread: Floats, distances: Floats) -> Assignment:
    """Add next cluster and confidence, from distances (n, clusters), inf if not compared."""
    others = distances.copy()
    others[np.arange(len(cluster)), cluster] = np.inf
    nearest = others.min(axis=1)
    next_cluster = np.where(np.isinf(nearest), -1, others.argmin(axis=1))
    confidence = np.clip(1 - spread / np.maximum(nearest, 1e-9), 0, 1)
    return Assignment(cluster, next_cluster, np.where(next_cluster < 0, np.nan, confidence), spread)


def _number_by_seconds(found: Assignment, seconds: Sequence[float]) -> Assignment:
    """Number the clusters from 0 by descending total duration."""
    totals = np.round(np.bincount(found.cluster, seconds), 6)
    # `argsort` twice gives ranks; the appended -1 is found by index -1.
    rank = np.append(np.argsort(np.argsort(-totals, kind="stable")), -1)
    return found._replace(cluster=rank[found.cluster], next_cluster=rank[found.next_cluster])


def measure_distances(ones: ClusterSet, others: ClusterSet, wanted: NDArray[np.bool_]) -> Floats:
    """Return the mean distance of i's example in j's context and of j's example in i's context.

    Only pairs that are ``wanted`` (ones, others) are measured; the others get `FARTHEST`.
    """
    distances = np.full(wanted.shape, FARTHEST)
    for first in range(0, len(wanted), BLOCK):
        rows = slice(first, first + BLOCK)
        columns = np.flatnonzero(wanted[rows].any(axis=0))
        part = wanted[rows][:, columns]
        row_features = [ones.load(each) for each in ones.local[rows]]
        column_features = [others.load(each) for each in others.select(columns).local]
        with threadpool_limits(1):  # so that sums do not depend on the number of threads
            both = _search(row_features, column_features, part)
            both = both + _search(column_features, row_features, part.T).T
        distances[rows, columns] = both / 2
    return distances


def _search(
    ones: Sequence[Features], others: Sequence[Features], wanted: NDArray[np.bool_]
) -> Floats:
    """Return the distance of each example to its best match in each context, (ones, others).

    It is `FARTHEST` at most, and for pairs that are not ``wanted``.
    """
    all_contexts = _join_contexts(others) if wanted.all() else None

    def search_one(number: int) -> Floats:
        """Return the distances of one example to its best match in each context."""
        distances = np.full(len(others), FARTHEST)
        columns = np.flatnonzero(wanted[number])
        if len(columns):
            searched, starts = all_contexts or _join_contexts([others[i] for i in columns.tolist()])
            found, _ = searched.distances(ones[number][0], most=FARTHEST)
            distances[columns] = np.minimum(np.minimum.reduceat(found, starts), FARTHEST)
        return distances

    return np.array(map_threads(search_one, range(len(ones))))


def _join_contexts(others: Sequence[Features]) -> tuple[Searched, Ints]:
    """Concatenate contexts to one recording to search; return it and the start of each."""
    gap = np.full((1, others[0][1].shape[1]), SEPARATOR, np.float32)
    searched = Searched(np.concatenate([part for _, context in others for part in (context, gap)]))
    return searched, np.cumsum([0, *(len(context) + 1 for _, context in others[:-1])])


def assign_to_centres(
    loads: Sequence[Callable[[int], NDArray[Any]]],
    counts: Sequence[int],
    spans: Sequence[Sequence[Floats]],
    *,
    n_clusters: int | None = None,
) -> Assignment:
    """Assign each group of spans, such as a local cluster, to the centre nearest to its mean.

    Each argument has an item per recording: ``loads`` a function that returns every n-th of its
    `ChannelSamples.rows`, ``counts`` the number of these rows, ``spans`` its groups of spans
    (segments, 2) in seconds. Sort the recordings by content, not by name: sums depend on the order.
    """
    # Rounded up, so that at most about `MAX_SAMPLES` rows are used for the centres.
    step = -(-sum(counts) // MAX_SAMPLES)
    rows = np.concatenate([load(step) for load in loads])
    to_features = fit_units(rows)
    points = to_features(rows)
    centres, _ = fit_centres(points, n_clusters or estimate_n_clusters(points))
    means = []
    for load, groups in zip(loads, spans, strict=True):
        # All rows; their first column is the time.
        rows = load(1)
        features = to_features(rows).astype(np.float64)
        means += [features[find_samples_in(rows[:, 0], group)].mean(axis=0) for group in groups]
    distances = np.sqrt(((np.array(means)[:, None] - centres) ** 2).sum(axis=2))
    # Number only centres that are the nearest of some group.
    used, cluster = np.unique(distances.argmin(axis=1), return_inverse=True)
    found = _compare_with_next(cluster, distances.min(axis=1), distances[:, used])
    durations = [float((each[:, 1] - each[:, 0]).sum()) for groups in spans for each in groups]
    return _number_by_seconds(found, durations)


def find_samples_in(seconds: NDArray[Any], spans: Floats) -> Ints:
    """Return the samples inside spans; for a span without samples, the next one."""
    firsts = np.minimum(np.searchsorted(seconds, spans[:, 0]), len(seconds) - 1)
    stops = np.maximum(np.searchsorted(seconds, spans[:, 1]), firsts + 1)
    return np.concatenate([np.arange(*span) for span in zip(firsts, stops, strict=True)])


def fit_centres(points: Float32s, n_clusters: int) -> tuple[Float32s, float]:
    """Return the centres of k-means (at most the number of distinct points), and the inertia."""
    from sklearn.cluster import KMeans  # imported here, as it takes a second

    count = min(n_clusters, len(np.unique(points, axis=0)))
    with threadpool_limits(1):  # so that sums do not depend on the number of cores
        model = KMeans(count, n_init=N_STARTS, random_state=0).fit(points)
    return model.cluster_centers_, float(model.inertia_)


def estimate_n_clusters(points: Float32s) -> int:
    """Estimate the number of clusters: each must explain `MIN_EXPLAINED` of the variance.

    Examples
    --------
    >>> points = np.repeat([[0.0, 0], [9, 0], [0, 9]], 20, axis=0).astype(np.float32)
    >>> estimate_n_clusters(points)
    3
    """
    points = points[:: -(-len(points) // COUNTING_SAMPLES)]
    total = max(float(points.var(axis=0, dtype=np.float64).sum()) * len(points), 1e-12)
    costs = [1.0 + MIN_EXPLAINED]
    # Stop after PATIENCE failures, or if even a perfect fit would cost more than the best.
    while len(costs) <= np.argmin(costs) + 1 + PATIENCE and len(costs) * MIN_EXPLAINED < min(costs):
        left = fit_centres(points, len(costs) + 1)[1]
        costs.append(left / total + (len(costs) + 1) * MIN_EXPLAINED)
    return int(np.argmin(costs)) + 1


def list_spans(columns: Mapping[str, NDArray[Any]], clusters: Ints) -> Spans:
    """Return the activities of a segment table, and primitives of clusters without activities."""
    active, coarse = columns["kind"] != "transition", columns["level"] == "activity"
    rows = active & (coarse | ~np.isin(clusters, clusters[active & coarse]))
    return columns["start_s"][rows], columns["stop_s"][rows], clusters[rows]


def keep_numbers(
    old: Mapping[Any, Spans], new: Mapping[Any, Spans], *, next_number: int
) -> dict[int, int]:
    """Give each new cluster the number of the old cluster with which it overlaps longest.

    Each number is given to one cluster. The others are numbered from ``next_number`` on. Keys of
    ``old`` and ``new`` are recordings.

    Examples
    --------
    >>> starts, stops = np.array([0.0, 5.0]), np.array([5.0, 9.0])
    >>> old = {"a": (starts, stops, np.array([4, 2]))}
    >>> new = {"a": (starts, stops, np.array([0, 1])), "b": (starts, stops, np.array([1, 2]))}
    >>> keep_numbers(old, new, next_number=7)
    {0: 4, 1: 2, 2: 7}
    """
    shared: defaultdict[tuple[int, int], float] = defaultdict(float)
    for recording in old.keys() & new.keys():
        (starts, stops, before), (begins, ends, now) = old[recording], new[recording]
        overlap = np.minimum(stops[:, None], ends) - np.maximum(starts[:, None], begins)
        for i, j in np.argwhere((overlap > 0) & (before[:, None] >= 0) & (now >= 0)):
            shared[int(before[i]), int(now[j])] += round(float(overlap[i, j]), 6)
    numbers: dict[int, int] = {}
    for (number, cluster), _ in sorted(shared.items(), key=lambda pair: (-pair[1], pair[0])):
        if cluster not in numbers and number not in numbers.values():
            numbers[cluster] = number
    for cluster in sorted({int(c) for _, _, clusters in new.values() for c in clusters} - {-1}):
        if cluster not in numbers:
            numbers[cluster], next_number = next_number, next_number + 1
    return dict(sorted(numbers.items()))
