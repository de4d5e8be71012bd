"""Do poses come back within ten seconds? (Vögele, Krüger, Klein 2014, section 1)

The method needs poses that reoccur. The paper counts "all poses of sequences
of length more than 8 seconds which reoccur - after some intermission - within
a time slot not wider than 10 seconds" and reaches 81.89 % on CMU and HDM05. It
does not say what an intermission is. Here a pose reoccurs if, within 10 s on
either side, a frame lies within the search radius, with at least 1/3 s between
them of frames that do not.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from kineme.errors import KinemeError
from kineme.graph import NeighborGraph, neighbor_graph
from kineme.methods.region_growing.preset import VOEGELE2014
from kineme.recordings import Motion
from kineme.segmentation.bodies import motion_features

MIN_LENGTH_S = 8.0
SLOT_S = 10.0
INTERMISSION_S = 1 / 3
PUBLISHED = 0.8189


@dataclass(frozen=True)
class Recording:
    """A recording of more than 8 s and the share of its poses that reoccur."""

    path: Path
    frames: int
    share: float


def survey(paths: Iterable[Path]) -> list[Recording]:
    """The recordings longer than 8 s; what does not read is left out."""
    found = []
    for path in paths:
        motion = _read(path)
        if motion is not None and motion.duration > MIN_LENGTH_S:
            poses = reoccurring(motion)
            found.append(Recording(path, poses.size, float(poses.mean())))
    return found


def share_of_poses(recordings: Iterable[Recording]) -> float:
    """The share of all poses of these recordings that reoccur."""
    rows = list(recordings)
    return float(np.average([r.share for r in rows], weights=[r.frames for r in rows]))


def reoccurring(motion: Motion) -> NDArray[np.bool_]:
    """Which poses come back within 10 s, (frames,) at 30 Hz."""
    fps = VOEGELE2014.working_fps
    graph = neighbor_graph(
        motion_features(motion, VOEGELE2014),
        radius=VOEGELE2014.radius,
        max_lag=round(SLOT_S * fps),
    )
    gap = round(INTERMISSION_S * fps)
    return np.array([_returns(graph, frame, gap) for frame in range(len(graph))])


def _returns(graph: NeighborGraph, frame: int, gap: int) -> bool:
    """Whether more than ``gap`` frames in a row are missing from the neighbours of a frame."""
    indices = graph.indices[graph.indptr[frame] : graph.indptr[frame + 1]]
    return bool((np.diff(indices) > gap).any())


def _read(path: Path) -> Motion | None:
    from kineme.formats import read_motion

    try:
        return read_motion(path)
    except KinemeError:
        return None
