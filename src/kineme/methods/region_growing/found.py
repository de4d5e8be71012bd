"""What the published methods find, stage by stage, and the segments that come of it."""

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
    """What the stages found, stage by stage.

    Attributes
    ----------
    features : (frames, dims) array
        As given, or bundled.
    graph : NeighborGraph
        Neighbours of every frame, main diagonal included.
    activity_cuts : ActivityCuts
        Where activities end and start.
    borders : (segments + 1,) array
        Of activities and transitions, from 0 to n.
    repeats : (segments,) array of bool
        Whether it is an activity, or else a transition.
    repetition : (segments,) array
        Share of its frames that are similar to others of it.
    primitives : (primitives + 1,) array
        Borders of the primitives, from 0 to n, those of activities included.
    clustering : Clustering
        Cluster and score of each primitive.
    symmetry : (segments,) array of str, optional
        How left and right go together in each activity: ``symmetric``, ``alternating`` or
        ``one-sided`` (see `kineme.methods.region_growing.mirroring`); empty in transitions;
        None where the preset does not mirror.
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
        """Activities in the cluster that most of their frames are in, primitives in their own."""
        # The activity of each primitive: the last that begins at or before it.
        parents = np.searchsorted(self.borders, self.primitives[:-1], side="right") - 1
        clusters = _cluster_numbers(self, parents)
        of_activities = _main_clusters(clusters, parents, np.diff(self.primitives))
        return make_columns(
            self.borders,
            self.primitives,
            is_activity=self.repeats,
            clusters=(of_activities, clusters),
            confidence=(self.repetition, self.clustering.scores),
        )

    def doubts(self, columns: Columns, fps: float) -> list[str]:  # noqa: ARG002
        """None: the published methods give no confidence."""
        return []


def _cluster_numbers(found: RegionsFound, parents: NDArray[np.intp]) -> Frames:
    """Numbers from 0 by first appearance; -1 for transitions that nothing else is similar to."""
    labels = found.clustering.labels
    # Clusters of a single primitive.
    lonely = np.bincount(labels)[labels] == 1
    named = ~(lonely & ~found.repeats[parents])
    return number_by_appearance(np.where(named, labels, -1))


def _main_clusters(clusters: Frames, parents: NDArray[np.intp], lengths: Frames) -> Frames:
    """For each activity the cluster that most of its frames are in; -1 where that is none."""
    frames = np.zeros((int(parents.max()) + 1, int(clusters.max()) + 2), np.int64)
    np.add.at(frames, (parents, clusters), lengths)  # those in no cluster: the last column
    main = frames.argmax(axis=1)
    return np.where(main == frames.shape[1] - 1, -1, main)
