"""What segments are: their clusters and kinds."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from typing import get_args

from kineme.errors import ParameterError
from kineme.segments.editing.naming import (
    change_columns,
    members_of,
    names_by_cluster,
    set_cluster_names,
)
from kineme.segments.editing.rows import (
    as_movement,
    as_transition,
    join_rows,
    renumber_clusters,
    replace_rows,
    starting,
)
from kineme.segments.segmentation import Segmentation
from kineme.segments.table import Kind, Level, Segment


def set_cluster(segmentation: Segmentation, level: Level, frame: int, cluster: int) -> Segmentation:
    """Put the segment that starts at ``frame`` into a cluster, as no transition; -1: into none.

    The primitives of an activity that were in its cluster go with it. Who was called by
    the old cluster's name is called by the new one's.

    Parameters
    ----------
    segmentation : Segmentation
    level : {"activity", "primitive"}
    frame : int
        Where the segment starts.
    cluster : int

    Returns
    -------
    Segmentation

    Raises
    ------
    ParameterError
        No segment starts there, or the cluster is neither there nor the next new one.

    Examples
    --------
    >>> import kineme
    >>> from kineme.datasets import bundled_truth
    >>> found = kineme.read_segments(bundled_truth())
    >>> again = set_cluster(found, "activity", 2494, 3)
    >>> again.activities[-1].label, again.repetitions()[3]
    ('jump', 8)
    """
    # Numbers have no holes: only the next new one may be named.
    following = int(segmentation.table.cluster.max(initial=-1)) + 1
    if not -1 <= cluster <= following:
        raise ParameterError(f"there is no cluster {cluster}; the next new one is {following}")
    chosen = starting(segmentation, level, frame)
    members = [(level, chosen)]
    if level == "activity":
        inside = segmentation.primitives.select(segmentation.primitives.activity == chosen.activity)
        members += [("primitive", row) for row in inside if row.cluster == chosen.cluster]
    # Members that have their own name keep it, those called by their cluster's do not.
    moved = _moved_to(segmentation, members, cluster)
    become = as_transition if cluster < 0 and chosen.kind == "transition" else as_movement
    places = {(row.level, row.start_frame) for _, row in members}
    rows = [become(row) if (row.level, row.start_frame) in places else row for row in moved]
    return replace_rows(moved, rows, [])


def merge_clusters(segmentation: Segmentation, cluster: int, into: int) -> Segmentation:
    """Move the segments of a cluster into another, with its name where it has one.

    Parameters
    ----------
    segmentation : Segmentation
    cluster : int
        Which is gone then.
    into : int

    Returns
    -------
    Segmentation

    Raises
    ------
    ParameterError
        One of them has no segments, or they are the same.

    Examples
    --------
    >>> import kineme
    >>> from kineme.datasets import bundled_truth
    >>> found = kineme.read_segments(bundled_truth())
    >>> merge_clusters(found, 4, 0).repetitions()
    {0: 15, 1: 4, 2: 5, 3: 4, 5: 4}
    """
    for each in (cluster, into):
        if not members_of(segmentation, each):
            raise ParameterError(f"no segment is in cluster {each}")
    if cluster == into:
        raise ParameterError(f"cluster {cluster} cannot be merged with itself: name another")
    members = [(row.level, row) for row in members_of(segmentation, cluster)]
    return _moved_to(segmentation, members, into)


def split_cluster(segmentation: Segmentation, cluster: int, frames: Iterable[int]) -> Segmentation:
    """Move the primitives of a cluster that start at ``frames`` into a new cluster.

    So is an activity all of whose primitives of that cluster go.

    Parameters
    ----------
    segmentation : Segmentation
    cluster : int
    frames : iterable of int
        Where the primitives start; activities in a table without primitives.

    Returns
    -------
    Segmentation

    Raises
    ------
    ParameterError
        None of these is in the cluster, or all are.

    Examples
    --------
    >>> import kineme
    >>> from kineme.datasets import bundled_truth
    >>> found = kineme.read_segments(bundled_truth())
    >>> split_cluster(found, 0, [962, 1027]).repetitions()
    {0: 7, 1: 4, 2: 5, 3: 4, 4: 6, 5: 4, 6: 2}
    """
    chosen, rows = set(frames), members_of(segmentation, cluster)
    level: Level = "primitive" if any(row.level == "primitive" for row in rows) else "activity"
    members = [row for row in rows if row.level == level]
    leavers = [row for row in members if row.start_frame in chosen]
    if not leavers or len(leavers) == len(members):
        raise ParameterError(
            f"{len(leavers)} of {len(members)} segments of cluster {cluster} are chosen: "
            "choose some of them, not all"
        )
    # An activity moves only if none of its primitives of the cluster stays.
    staying = {row.activity for row in members if row.start_frame not in chosen}
    leaving = {row.activity for row in leavers} - staying
    moved: list[tuple[Level, Segment]] = [(row.level, row) for row in leavers]
    if level == "primitive":
        numbered = enumerate(segmentation.activities)
        moved += [
            ("activity", row) for i, row in numbered if i in leaving and row.cluster == cluster
        ]
    following = int(segmentation.table.cluster.max(initial=-1)) + 1
    return _moved_to(segmentation, moved, following)


def order_clusters(segmentation: Segmentation, order: Sequence[int]) -> Segmentation:
    """Return the same clusters numbered anew, in this order from 0; names go along.

    Parameters
    ----------
    segmentation : Segmentation
    order : sequence of int
        The clusters, each once.

    Returns
    -------
    Segmentation

    Raises
    ------
    ParameterError
        They are not the clusters of the table.

    Examples
    --------
    >>> import kineme
    >>> from kineme.datasets import bundled_truth
    >>> found = kineme.read_segments(bundled_truth())
    >>> order_clusters(found, [5, 4, 3, 2, 1, 0]).activities.cluster[-1].item()
    0
    """
    present = sorted(set(segmentation.table.cluster.tolist()) - {-1})
    if sorted(order) != present:
        raise ParameterError(f"name each cluster once: {', '.join(map(str, present))}")
    new = {cluster: number for number, cluster in enumerate(order)}
    names = names_by_cluster(segmentation)
    renamed = {new[cluster]: name for cluster, name in names.items()}
    return set_cluster_names(renumber_clusters(segmentation, new), renamed)


def set_kind(segmentation: Segmentation, level: Level, frame: int, kind: Kind) -> Segmentation:
    """Return the segment that starts at ``frame`` is a transition and in no cluster, or none.

    An activity's primitives become what it becomes; a transition is one primitive.

    Parameters
    ----------
    segmentation : Segmentation
    level : {"activity", "primitive"}
    frame : int
        Where the segment starts.
    kind : {"activity", "primitive", "transition"}
        One of the first two: what its level says.

    Returns
    -------
    Segmentation

    Raises
    ------
    ParameterError
        No segment starts there, or no such kind.

    Examples
    --------
    >>> import kineme
    >>> from kineme.datasets import bundled_truth
    >>> found = kineme.read_segments(bundled_truth())
    >>> set_kind(found, "activity", 2494, "transition").activities[-1].kind
    'transition'
    """
    if kind not in get_args(Kind):
        raise ParameterError(f"kind must be {' or '.join(get_args(Kind))}, not {kind!r}")
    chosen = starting(segmentation, level, frame)
    if (kind == "transition") == (chosen.kind == "transition"):
        return segmentation
    become = as_transition if kind == "transition" else as_movement
    activities, primitives = list(segmentation.activities), list(segmentation.primitives)
    if level == "primitive":
        primitives = [become(row) if row.start_frame == frame else row for row in primitives]
        return replace_rows(segmentation, activities, primitives)
    inside = [i for i, row in enumerate(primitives) if row.activity == chosen.activity]
    if inside and kind == "transition":
        # Its primitives become one, which is a transition.
        primitives = join_rows(primitives, inside[0], inside[-1], inside[0])
        inside = inside[:1]
    for i in inside:
        primitives[i] = become(primitives[i])
    activities = [become(row) if row.start_frame == frame else row for row in activities]
    return replace_rows(segmentation, activities, primitives)


def _moved_to(
    segmentation: Segmentation,
    members: Sequence[tuple[Level, Segment]],
    cluster: int,
) -> Segmentation:
    """Return the members in another cluster, called by its name unless they have their own."""
    names = names_by_cluster(segmentation)
    moved = segmentation
    # First those called by the cluster's name, then those with a name of their own.
    for inherits in (True, False):
        some = [
            (level, row)
            for level, row in members
            if (row.label in ("", names.get(row.cluster, ""))) == inherits
        ]
        label = {"label": names.get(cluster, "")} if inherits else {}
        if some:
            moved = change_columns(moved, some, cluster=cluster, confidence=math.nan, **label)
    # A cluster that was nameless is said to be, so that labels of members do not name it.
    return set_cluster_names(moved, ({cluster: ""} if cluster >= 0 else {}) | names)
