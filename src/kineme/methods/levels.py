"""Levels of detail: clusters joined one by one, so that each level is nested in the next.

What a method finds by default is detail 1. Segments finer than these are
clusters within its clusters. The two clusters whose union costs least, for what
it saves, are joined, again and again: first within the clusters of detail 1,
then these (weakest-link pruning, after Breiman, Friedman, Olshen and Stone
1984). The cost is by how much more the samples of the union differ from each
other; saved are the prices of the borders between the two and of a cluster.

- Above 1 clusters are joined that save more than they cost at prices divided by the detail.
- Below 1 so many are joined that a share of those at detail 1 is left, the detail.

So every border at one detail is a border at any finer one, and every cluster a
union of finer ones.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from kineme._util.arrays import Floats, Ints
from kineme.methods.base import Columns
from kineme.methods.segments import number_by_appearance

COARSER = (0.125, 0.25, 0.5, 0.75)
FINER = (2.0, 4.0, 8.0)
DETAILS = (*COARSER, *FINER)
"""Details that are offered beside 1."""


@dataclass(frozen=True, eq=False)
class FineSegments:
    """Segments of the finest level, and which cluster of detail 1 they lie in.

    Attributes
    ----------
    borders : (segments + 1,) array
        Samples; those of detail 1 are among them.
    labels : (segments,) array
        Cluster at the finest level, from 0; -1 for transitions.
    parents : (clusters,) array
        The cluster at detail 1 of each cluster.
    differences : (clusters, clusters) array
        Summed over their samples: how much the clusters differ, 0 for equal ones.
    """

    borders: Ints
    labels: Ints
    parents: Ints
    differences: Floats


def assign_clusters(
    fine: FineSegments, details: tuple[float, ...], *, border_price: float, cluster_price: float
) -> dict[float, Ints]:
    """Return the cluster of each fine segment at each detail, -1 for transitions.

    Parameters
    ----------
    fine : FineSegments
    details : tuple of float
    border_price, cluster_price : float
        What a border and a cluster cost at detail 1.
    """
    finer, coarser = _list_joins(fine, border_price, cluster_price)
    found = {}
    # At first each cluster is its own; a join gives all of its clusters the kept number.
    of, done = np.arange(len(fine.parents)), 0
    for detail in sorted(details, reverse=True):  # each has the joins of the one before, and more
        joins = [(kept, joined) for kept, joined, least in finer if detail < least]
        if detail < 1:
            # A share of the clusters of detail 1, at least one; their number is one more than the
            # joins.
            left = max(1, round(detail * (len(coarser) + 1)))
            joins += [(kept, joined) for kept, joined, _ in coarser[: len(coarser) + 1 - left]]
        # Joins of the former detail were done already.
        for kept, joined in joins[done:]:
            of[of == of[joined]] = of[kept]
        done = len(joins)
        # One entry more, so that index -1 stays -1.
        found[detail] = np.where(fine.labels < 0, -1, np.append(of, -1)[fine.labels])
    return {detail: found[detail] for detail in details}


def make_tables(
    columns: Columns, borders: Ints, clusters: Mapping[float, Ints], longest: float
) -> dict[float, Columns]:
    """Return the table at each detail; of neighbours that are one and the same, the coarsest.

    Those that are the same as at detail 1 are left out.

    Parameters
    ----------
    columns : dict of str to array
        Of detail 1.
    borders, clusters
        As in `FineSegments`, and of `assign_clusters`.
    longest : float
        Samples: below 1, neighbours of one cluster are one activity even with a transition
        between them that is no longer than this over the detail.
    """
    level = columns["level"] == "activity"
    before, inner = (
        {name: column[of] for name, column in columns.items()} for of in (level, ~level)
    )
    found: dict[float, Columns] = {}
    # Details that give the same labels give one table. Sorted, so the coarsest comes first.
    same: dict[tuple[bool, bytes], float] = {}
    for detail in sorted(clusters):
        labels = clusters[detail]
        if detail < 1:
            labels = _bridge_transitions(borders, labels, longest / detail)
        if same.setdefault((detail < 1, labels.tobytes()), detail) == detail:
            # Finer than 1: borders of detail 1 stay. Coarser: only frame 0 is fixed.
            begins = np.isin(borders[:-1], before["start_frame"] if detail > 1 else 0)
            # Segments begin where the label changes; -2 differs from every label.
            first = np.flatnonzero((np.diff(labels, prepend=-2) != 0) | begins)
            # Numbers by appearance can be compared between details.
            starts, of = borders[:-1][first], number_by_appearance(labels[first])
            if not (
                np.array_equal(starts, before["start_frame"])
                and np.array_equal(of, number_by_appearance(before["cluster"]))
            ):
                found[detail] = change_detail(before, inner, starts, of, int(borders[-1]))
    return found


def change_detail(
    before: Columns, inner: Columns, starts: Ints, clusters: Ints, end: int
) -> Columns:
    """Return the columns of a table with other activities: segments joined, repetitions kept.

    Every primitive border stays.

    Parameters
    ----------
    before, inner : dict of str to array
        Activities and primitives of detail 1.
    starts, clusters : array of int
        Of the activities, -1 for transitions.
    end : int
        Where the last one ends.

    Returns
    -------
    dict of str to array
    """
    # Borders of activities cut repetitions, too.
    cuts = np.unique(np.concatenate([starts, inner["start_frame"]]))
    kinds = np.where(clusters < 0, "transition", "activity")
    activities = _make_rows(before, starts, end) | {"kind": kinds, "cluster": clusters}
    primitives = _make_rows(inner, cuts, end)
    # The activity of each primitive: the last that begins at or before it.
    parents = np.searchsorted(starts, cuts, side="right") - 1
    in_cluster = primitives["kind"] == "activity"
    if _is_inherited(before, inner):
        primitives["cluster"] = np.where(in_cluster, clusters[parents], -1)
    else:
        # Repetitions that were cut are not like the whole ones: they get new clusters.
        parts = in_cluster & ~_find_same_spans(primitives, inner)
        pairs = np.column_stack([primitives["cluster"], clusters[parents]])[parts]
        # One new number for each pair of old cluster and activity's cluster.
        numbers = np.unique(pairs, axis=0, return_inverse=True)[1].ravel()
        primitives["cluster"][parts] = inner["cluster"].max(initial=-1) + 1 + numbers
    return {name: np.concatenate([activities[name], primitives[name]]) for name in before}


Join = tuple[int, int, float]
"""A cluster that stays, one that becomes part of it, and the detail below which it does."""


def _list_joins(
    fine: FineSegments, border_price: float, cluster_price: float
) -> tuple[list[Join], list[Join]]:
    """Joins within the clusters of detail 1, and of these, each in order."""
    labels = fine.labels[fine.labels >= 0]
    k = len(fine.parents)
    # How often each cluster follows another one: each is a border that a join saves.
    adjacent = np.zeros((k, k))
    np.add.at(adjacent, (labels[:-1], labels[1:]), 1.0)
    # Between segments of one cluster a join saves nothing.
    np.fill_diagonal(adjacent, 0)
    prices = border_price * (adjacent + adjacent.T)
    lengths = np.diff(fine.borders)[fine.labels >= 0]
    # A cluster without samples counts as one, to avoid a division by 0.
    sizes = np.maximum(np.bincount(labels, lengths, k), 1.0)
    state = (fine.differences.copy(), prices, sizes)
    finer: list[Join] = []
    for parent in np.unique(fine.parents):
        finer += _order_joins(*state, np.flatnonzero(fine.parents == parent), cluster_price)
    # Joins within a cluster of detail 1 must be done at detail 1, whatever they cost.
    finer = [(kept, joined, max(detail, np.nextafter(1, 2))) for kept, joined, detail in finer]
    # Clusters that are left when each cluster of detail 1 is one.
    roots = np.setdiff1d(np.arange(k), [joined for _, joined, _ in finer])
    # Sorted by detail; stable, so joins of one cluster stay in order.
    return sorted(finer, key=lambda join: -join[2]), _order_joins(*state, roots, cluster_price)


def _order_joins(
    differences: Floats, prices: Floats, sizes: Floats, among: Ints, cluster_price: float
) -> list[Join]:
    """Return the joins of some clusters into one, those that cost least first; details never rise.

    The arrays are changed: rows and columns of joined clusters are summed.
    """

    def details(of: Ints) -> Floats:
        """Return the detail below which each of these clusters and each of all are one."""
        within = np.diagonal(differences)
        rows, others = within[of][:, None], within[among]
        sums = rows + others + 2 * differences[of[:, None], among]
        size = sizes[of][:, None]
        # Ward's criterion: what the union costs, less what both cost apart.
        losses = sums / (size + sizes[among]) - rows / size - others / sizes[among]
        found: Floats = (prices[of[:, None], among] + cluster_price) / np.maximum(losses, 1e-9)
        # A cluster is not joined with itself, nor with one that is gone.
        return np.where(alive & (among != of[:, None]), found, -1.0)

    alive = np.full(len(among), True)
    matrix = details(among)
    found: list[Join] = []
    detail = np.inf
    for _ in range(len(among) - 1):
        # The largest detail of the matrix: the pair that costs least for what it saves.
        first, second = sorted(divmod(int(np.argmax(matrix)), len(among)))
        # A later join may have a larger detail, but it cannot happen before this one.
        detail = min(detail, float(matrix[first, second]))
        kept, joined = int(among[first]), int(among[second])
        for sums in (differences, prices):
            sums[kept] += sums[joined]
            sums[:, kept] += sums[:, joined]
        prices[kept, kept] = 0
        sizes[kept] += sizes[joined]
        alive[second] = False
        matrix[second] = matrix[:, second] = -1
        # Only the row and column of the union are new.
        matrix[first] = matrix[:, first] = details(among[[first]])[0]
        found.append((kept, joined, detail))
    return found


def _bridge_transitions(borders: Ints, labels: Ints, longest: float) -> Ints:
    """Return the labels with short transitions between neighbours of one cluster as part of it."""
    joined = labels.copy()
    # Three segments in a row: the middle one is the transition.
    before, after, short = labels[:-2], labels[2:], np.diff(borders)[1:-1] <= longest
    between = (labels[1:-1] < 0) & (before == after) & (after >= 0) & short
    joined[1:-1][between] = before[between]
    return joined


def _make_rows(source: Columns, starts: Ints, end: int) -> Columns:
    """Rows that begin there, like those of the source they lie in; confidence of others is nan."""
    order = np.argsort(source["start_frame"], kind="stable")
    # The source row in which each start lies.
    at = order[np.searchsorted(source["start_frame"][order], starts, side="right") - 1]
    rows = {name: column[at] for name, column in source.items()}
    same_start = rows["start_frame"] == starts
    rows["start_frame"] = starts
    stops = np.append(starts[1:], end)
    same_span = same_start & (rows["stop_frame"] == stops)
    rows["stop_frame"] = stops
    # A confidence holds only for what it was computed from: the whole span, or its start.
    for name, same in (("confidence", same_span), ("border_confidence", same_start)):
        if name in rows:
            rows[name] = np.where(same, rows[name], np.nan)
    return rows


def _find_same_spans(rows: Columns, source: Columns) -> NDArray[np.bool_]:
    """Return which rows have the span of one of the source."""
    spans = {*zip(source["start_frame"].tolist(), source["stop_frame"].tolist(), strict=True)}
    found = zip(rows["start_frame"].tolist(), rows["stop_frame"].tolist(), strict=True)
    return np.array([span in spans for span in found], bool)


def _is_inherited(activities: Columns, primitives: Columns) -> bool:
    """Return whether each primitive is in the cluster of its activity."""
    parents = np.searchsorted(activities["start_frame"], primitives["start_frame"], "right") - 1
    in_cluster = primitives["kind"] == "activity"
    return bool((activities["cluster"][parents] == primitives["cluster"])[in_cluster].all())
