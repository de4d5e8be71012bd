"""Results of all stages of the published methods, and the segment table made from them."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from kineme.methods.base import Columns
from kineme.methods.region_growing.activities import ActivityCuts
from kineme.methods.region_growing.clustering import Clustering
from kineme.methods.region_growing.neighbors import NeighborGraph
from kineme.methods.segments import make_columns, number_by_appearance

Frames = NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class RegionsFound:
    """Results of the stages.

    Attributes
    ----------
    features : (frames, dims) array
        As given, or bundled.
    graph : NeighborGraph
        Neighbours of every frame, with the main diagonal.
    activity_cuts : ActivityCuts
        Ends and starts of activities.
    borders : (segments + 1,) array
        Borders of activities and transitions, from 0 to n.
    repeats : (segments,) array of bool
        True for activities, False for transitions.
    repetition : (segments,) array
        Share of the frames that are similar to other frames of the segment.
    primitives : (primitives + 1,) array
        Borders of primitives, from 0 to n, including those of activities.
    clustering : Clustering
        Cluster and score of each primitive.
    symmetry : (segments,) array of str, optional
        Symmetry of each activity: ``symmetric``, ``alternating`` or ``one-sided`` (see
        `kineme.methods.region_growing.mirroring`); empty for transitions; None if the preset
        does not mirror.
    timings : dict of str to float
        Seconds per stage.
    """

    features: NDArray[np.float64]
    graph: NeighborGraph
    activity_cuts: ActivityCuts
    borders: Frames
    repeats: NDArray[np.bool_]
    repetition: NDArray[np.float64]
    primitives: Frames
    clustering: Clustering
    symmetry: NDArray[np.str_] | None = None
    timings: dict[str, float] = field(default_factory=dict)

    def columns(self) -> Columns:
        """Return the segment table; an activity is in the cluster of most of its frames."""
        # Activity of each primitive: the last one that begins at or before it.
        parents = np.searchsorted(self.borders, self.primitives[:-1], side="right") - 1
        clusters = _number_clusters(self, parents)
        activity_clusters = _find_main_clusters(clusters, parents, np.diff(self.primitives))
        return make_columns(
            self.borders,
            self.primitives,
            is_activity=self.repeats,
            clusters=(activity_clusters, clusters),
            confidence=(self.repetition, self.clustering.scores),
        )

    def doubts(self, columns: Columns, fps: float) -> list[str]:  # noqa: ARG002
        """Return an empty list: the published methods estimate no confidence."""
        return []


def _number_clusters(found: RegionsFound, parents: NDArray[np.intp]) -> Frames:
    """Number clusters from 0 by appearance; -1 for transitions that are similar to no other."""
    labels = found.clustering.labels
    is_single = np.bincount(labels)[labels] == 1
    has_cluster = ~(is_single & ~found.repeats[parents])
    return number_by_appearance(np.where(has_cluster, labels, -1))


def _find_main_clusters(clusters: Frames, parents: NDArray[np.intp], lengths: Frames) -> Frames:
    """Return the cluster of most of the frames of each activity; -1 if most are in none."""
    frames = np.zeros((int(parents.max()) + 1, int(clusters.max()) + 2), np.int64)
    np.add.at(frames, (parents, clusters), lengths)  # cluster -1 counts in the last column
    main = frames.argmax(axis=1)
    return np.where(main == frames.shape[1] - 1, -1, main)
