"""Build segment tables from the borders and clusters of a method, at several levels of detail.

Detail 1 is the default result of a method. Finer segments form clusters within
its clusters. The pair of clusters whose union has the least ratio of cost to
saving is merged repeatedly: first within the clusters of detail 1, then these
(weakest-link pruning, after Breiman, Friedman, Olshen and Stone 1984). The cost
is the increase of the differences between samples of a cluster. The saving is the
price of one cluster and of the borders between the two.

- Above 1, clusters are merged if this saves more than it costs at prices divided by the detail.
- Below 1, clusters are merged until ``detail`` times those of detail 1 are left.

So every border at one detail is a border at any finer one, and every cluster is a
union of finer ones.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from kineme._util.arrays import Floats, Ints
from kineme.methods.base import Columns

ClusterMerge = tuple[int, int, float]
"""Cluster that is kept, cluster that is merged into it, and the detail below which this happens."""
Doubt = tuple[float, str]
"""Confidence of a result, and the sentence about it."""
MAX_SENTENCES = 5
"""Largest number of sentences: nobody reads a longer list."""
MIN_CONFIDENCE = 0.5
"""Confidence below which a result is listed."""
COARSER = (0.125, 0.25, 0.5, 0.75)
FINER = (2.0, 4.0, 8.0)
DETAILS = (*COARSER, *FINER)
"""Details offered besides 1."""


def make_columns(
    activities: Ints,
    primitives: Ints,
    *,
    is_activity: NDArray[np.bool_],
    is_primitive: NDArray[np.bool_] | None = None,
    clusters: tuple[Ints, Ints],
    confidence: tuple[Floats, Floats],
    border_confidence: tuple[Floats, Floats] | None = None,
) -> Columns:
    """Return the columns of a segment table with activities and primitives.

    Parameters
    ----------
    activities, primitives : (segments + 1,) array
        Borders of each level, from 0 to the end. Borders of activities are also borders of
        primitives.
    is_activity : (activities,) array of bool
        False for transitions.
    is_primitive : (primitives,) array of bool, optional
        False for transitions; by default all in activities are primitives.
    clusters, confidence : pair of arrays
        For activities, and for primitives.
    border_confidence : pair of arrays, optional
        Probability that the start of each is right, for activities and for primitives.
    """
    parents = find_segments(activities, primitives[:-1])
    primitive = is_activity[parents] if is_primitive is None else is_primitive
    columns = {
        "level": np.repeat(["activity", "primitive"], [len(activities) - 1, len(parents)]),
        "kind": np.where(np.append(is_activity, primitive), "activity", "transition"),
        "start_frame": np.concatenate([activities[:-1], primitives[:-1]]),
        "stop_frame": np.concatenate([activities[1:], primitives[1:]]),
        "cluster": np.concatenate(clusters),
        "confidence": np.concatenate(confidence),
    }
    if border_confidence is not None:
        columns["border_confidence"] = np.concatenate(border_confidence)
    return columns


def find_segments(borders: Ints, frames: Ints) -> Ints:
    """Return the segment that contains each frame, by ascending starts; -1 before the first."""
    segments: Ints = np.searchsorted(borders, frames, side="right") - 1
    return segments


def number_by_appearance(labels: NDArray[np.integer]) -> Ints:
    """Renumber labels from 0 in order of appearance; -1 stays.

    Examples
    --------
    >>> import numpy as np
    >>> number_by_appearance(np.array([7, 7, -1, 2, 7]))
    array([ 0,  0, -1,  1,  0])
    """
    in_cluster = labels >= 0
    _, first, inverse = np.unique(labels[in_cluster], return_index=True, return_inverse=True)
    numbered = np.full(len(labels), -1, np.int64)
    # `argsort` twice gives ranks: the rank of a label's first position is its new number.
    numbered[in_cluster] = np.argsort(np.argsort(first))[inverse]
    return numbered


def list_doubts(columns: Columns, fps: float) -> list[str]:
    """Return one sentence for each doubtful cluster or border: the five least certain.

    The columns are those of a segment table in frames, at ``fps`` frames per second, with
    ``confidence`` and ``border_confidence``.
    """
    doubts: list[Doubt] = []
    for row in np.flatnonzero(columns["level"] == "activity"):
        border = float(columns["border_confidence"][row])
        cluster = float(columns["confidence"][row])
        if border < MIN_CONFIDENCE:
            start_s = columns["start_frame"][row] / fps
            doubts.append((border, f"check the border at {start_s:.2f} s"))
        if cluster < MIN_CONFIDENCE:
            start, stop = (columns[f"{name}_frame"][row] / fps for name in ("start", "stop"))
            where = f"at {start:.2f} to {stop:.2f} s"
            doubts.append((cluster, f"check the cluster of the activity {where}"))
    worst = sorted(doubts, key=lambda each: each[0])[:MAX_SENTENCES]
    return [f"{text} ({100 * probability:.0f} % sure)" for probability, text in worst]


@dataclass(frozen=True, eq=False)
class FineSegments:
    """Segments of the finest level, and the clusters of detail 1 that contain them."""

    borders: Ints
    """Samples, including the borders of detail 1."""
    parents: Ints
    """Cluster at detail 1 of each segment."""
    differences: Floats
    """Differences of two segments, summed over pairs of samples; 0 if they are equal."""


def assign_clusters(
    fine: FineSegments, details: tuple[float, ...], *, border_price: float, cluster_price: float
) -> dict[float, Ints]:
    """Return the cluster of each fine segment at each detail.

    The prices are the costs of a border and of a cluster at detail 1.
    """
    k = len(fine.parents)
    # A merge of neighbours saves the border between them.
    prices = border_price * (np.eye(k, k=1) + np.eye(k, k=-1))
    sizes = np.diff(fine.borders).astype(np.float64)
    state = (fine.differences.copy(), prices, sizes)
    # Merges within the clusters of detail 1, then those of these clusters.
    fine_merges: list[ClusterMerge] = []
    for parent in np.unique(fine.parents):
        fine_merges += _order_merges(*state, np.flatnonzero(fine.parents == parent), cluster_price)
    # `nextafter`: merges within a cluster of detail 1 happen at detail 1, whatever they cost.
    fine_merges = [
        (kept, absorbed, max(detail, np.nextafter(1, 2))) for kept, absorbed, detail in fine_merges
    ]
    # One representative for each cluster of detail 1.
    roots = np.setdiff1d(np.arange(k), [absorbed for _, absorbed, _ in fine_merges])
    # `sort` is stable, so merges within one cluster stay in order.
    fine_merges.sort(key=lambda merge: -merge[2])
    coarser = _order_merges(*state, roots, cluster_price)

    labels_by_detail = {}
    # Cluster of each fine segment; at first each is its own.
    merged, done = np.arange(k), 0
    for detail in sorted(details, reverse=True):  # a coarser detail has all merges of a finer one
        merges = [(kept, absorbed) for kept, absorbed, least in fine_merges if detail < least]
        if detail < 1:
            # n clusters need n - 1 merges to become one.
            left = max(1, round(detail * (len(coarser) + 1)))
            merges += [(kept, absorbed) for kept, absorbed, _ in coarser[: len(coarser) + 1 - left]]
        # Skip the merges that the previous detail has done.
        for kept, absorbed in merges[done:]:
            merged[merged == merged[absorbed]] = merged[kept]
        done = len(merges)
        labels_by_detail[detail] = merged.copy()
    return {detail: labels_by_detail[detail] for detail in details}


def make_tables(
    columns: Columns, borders: Ints, clusters: Mapping[float, Ints]
) -> dict[float, Columns]:
    """Return the table at each detail; of equal tables only the coarsest.

    Tables that equal the one at detail 1 are left out. ``columns`` are those of detail 1,
    ``borders`` as in `FineSegments`, ``clusters`` as returned by `assign_clusters`.
    """
    is_activity = columns["level"] == "activity"
    activities, primitives = (
        {name: column[rows] for name, column in columns.items()}
        for rows in (is_activity, ~is_activity)
    )
    tables: dict[float, Columns] = {}
    # Details with equal labels have equal tables. Sorted, so the coarsest comes first.
    coarsest: dict[tuple[bool, bytes], float] = {}
    for detail in sorted(clusters):
        labels = clusters[detail]
        if coarsest.setdefault((detail < 1, labels.tobytes()), detail) == detail:
            # Finer than 1: borders of detail 1 stay. Coarser: only frame 0 is fixed.
            is_fixed = np.isin(borders[:-1], activities["start_frame"] if detail > 1 else 0)
            # Segments begin where the label changes; -2 differs from every label.
            run_starts = np.flatnonzero((np.diff(labels, prepend=-2) != 0) | is_fixed)
            # Numbers by appearance can be compared between details.
            starts = borders[:-1][run_starts]
            numbers = number_by_appearance(labels[run_starts])
            if not (
                np.array_equal(starts, activities["start_frame"])
                and np.array_equal(numbers, number_by_appearance(activities["cluster"]))
            ):
                tables[detail] = change_detail(
                    activities, primitives, starts, numbers, int(borders[-1])
                )
    return tables


def change_detail(
    before: Columns, inner: Columns, starts: Ints, clusters: Ints, end: int
) -> Columns:
    """Return the columns of a table with other activities; every primitive border stays.

    ``before`` and ``inner`` are the activities and primitives at detail 1. The new activities begin
    at ``starts``, have these clusters, and end at ``end``.
    """
    # Borders of activities are also borders of primitives.
    cuts = np.unique(np.concatenate([starts, inner["start_frame"]]))
    kinds = np.full(len(starts), "activity")
    activities = _make_rows(before, starts, end) | {"kind": kinds, "cluster": clusters}
    primitives = _make_rows(inner, cuts, end)
    parents = find_segments(starts, cuts)
    in_cluster = primitives["kind"] == "activity"
    old_parents = find_segments(before["start_frame"], inner["start_frame"])
    has_own = before["cluster"][old_parents] != inner["cluster"]
    # Every primitive is in the cluster of its activity, or some have clusters of their own.
    if not has_own[inner["kind"] == "activity"].any():
        primitives["cluster"] = np.where(in_cluster, clusters[parents], -1)
    else:
        # A part of a repetition differs from a whole one: parts get new clusters.
        parts = in_cluster & ~_find_same_spans(primitives, inner)
        pairs = np.column_stack([primitives["cluster"], clusters[parents]])[parts]
        # One new number for each pair of old cluster and activity's cluster.
        numbers = np.unique(pairs, axis=0, return_inverse=True)[1].ravel()
        primitives["cluster"][parts] = inner["cluster"].max(initial=-1) + 1 + numbers
    return {name: np.concatenate([activities[name], primitives[name]]) for name in before}


def _order_merges(
    differences: Floats, prices: Floats, sizes: Floats, among: Ints, cluster_price: float
) -> list[ClusterMerge]:
    """Return the merges of the clusters `among` into one, cheapest first; details never rise.

    Change the arrays: rows and columns of merged clusters are summed.
    """

    def compute_details(clusters: Ints) -> Floats:
        """Return the detail below which each cluster is merged with each of `among`."""
        within = np.diagonal(differences)
        rows, others = within[clusters][:, None], within[among]
        sums = rows + others + 2 * differences[clusters[:, None], among]
        size = sizes[clusters][:, None]
        # Ward's criterion: cost of the union less the costs of both clusters apart.
        losses = sums / (size + sizes[among]) - rows / size - others / sizes[among]
        savings = prices[clusters[:, None], among] + cluster_price
        details: Floats = savings / np.maximum(losses, 1e-9)
        # A cluster is not merged with itself, nor with one that is already merged.
        return np.where(alive & (among != clusters[:, None]), details, -1.0)

    alive = np.full(len(among), True)
    matrix = compute_details(among)
    merges: list[ClusterMerge] = []
    detail = np.inf
    for _ in range(len(among) - 1):
        # Largest detail: the pair with the least ratio of cost to saving.
        first, second = sorted(divmod(int(np.argmax(matrix)), len(among)))
        # A later merge may have a larger detail, but it cannot happen before this one.
        detail = min(detail, float(matrix[first, second]))
        kept, absorbed = int(among[first]), int(among[second])
        for sums in (differences, prices):
            sums[kept] += sums[absorbed]
            sums[:, kept] += sums[:, absorbed]
        prices[kept, kept] = 0
        sizes[kept] += sizes[absorbed]
        alive[second] = False
        matrix[second] = matrix[:, second] = -1
        # Only the row and column of the union change.
        matrix[first] = matrix[:, first] = compute_details(among[[first]])[0]
        merges.append((kept, absorbed, detail))
    return merges


def _make_rows(source: Columns, starts: Ints, end: int) -> Columns:
    """Return rows with these starts, copied from the source rows that contain them.

    Their confidence is nan if their span differs from that of the source row.
    """
    order = np.argsort(source["start_frame"], kind="stable")
    # The source row in which each start lies.
    source_rows = order[find_segments(source["start_frame"][order], starts)]
    rows = {name: column[source_rows] for name, column in source.items()}
    same_start = rows["start_frame"] == starts
    rows["start_frame"] = starts
    stops = np.append(starts[1:], end)
    same_span = same_start & (rows["stop_frame"] == stops)
    rows["stop_frame"] = stops
    # A confidence is valid only for the span, or the start, it was computed from.
    for name, same in (("confidence", same_span), ("border_confidence", same_start)):
        if name in rows:
            rows[name] = np.where(same, rows[name], np.nan)
    return rows


def _find_same_spans(rows: Columns, source: Columns) -> NDArray[np.bool_]:
    """Mark the rows whose span is also a span of the source."""
    spans = {*zip(source["start_frame"].tolist(), source["stop_frame"].tolist(), strict=True)}
    row_spans = zip(rows["start_frame"].tolist(), rows["stop_frame"].tolist(), strict=True)
    return np.array([span in spans for span in row_spans], bool)
