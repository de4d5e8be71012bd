"""Corrections by hand: each edit gives a new segmentation, in which every level still tiles.

A border is a frame where one segment of a level stops and the next starts. The
borders of activities are borders of primitives, too, where there are any, and
stay so: what is done to an activity is done to the primitives at its ends. A
primitive that comes to lie in another activity keeps its own cluster and label
where they differ from those of the activity it was in; what it had in common
with that one it has in common with the new one.

What a person says has no confidence: segments whose span, kind or cluster was
changed lose theirs.
"""

from kineme.segments.editing.annotating import check, comment, comments, exclude
from kineme.segments.editing.borders import delete_border, merge, move_border, split
from kineme.segments.editing.carrying import carry_corrections
from kineme.segments.editing.clusters import (
    cluster_names,
    merge_clusters,
    name_cluster,
    name_segment,
    order_clusters,
    set_cluster,
    set_kind,
    split_cluster,
)

__all__ = [
    "carry_corrections",
    "check",
    "cluster_names",
    "comment",
    "comments",
    "delete_border",
    "exclude",
    "merge",
    "merge_clusters",
    "move_border",
    "name_cluster",
    "name_segment",
    "order_clusters",
    "set_cluster",
    "set_kind",
    "split",
    "split_cluster",
]
