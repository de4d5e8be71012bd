"""Corrections by hand: each edit returns a new segmentation, whose levels tile the recording.

A border is a frame at which one segment of a level stops and the next starts. Borders
of activities are also borders of primitives, so edits of an activity also change the
primitives at its ends. A primitive that moves to another activity takes the cluster
and label of this activity if it had those of its old one, and otherwise keeps its own.

Edited segments have no confidence: it is dropped if span, kind or cluster change.
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
