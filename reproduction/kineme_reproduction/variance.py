"""How similar are the segments of one cluster? (Vögele, Krüger, Klein 2014, section 5.2)

Two segments are compared by dynamic time warping; the sum of frame distances
along the cheapest path is divided by the number of frames of the first
(equation 2). Every ordered pair of a cluster gives one distance; their mean
and variance (equation 1, with n - 1) describe it, as in figures 5 and 8.

The frame distance is either Euclidean on stacked features or that of point
clouds after Kovar and Gleicher 2004: joints in a window around the frame, as
one cloud, moved on the floor and turned about the vertical to fit best. Here
it is the root mean square over the points of the cloud, in metres. The paper
gives neither window nor scale; 1/3 s is Kovar and Gleicher's.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from itertools import combinations

import numpy as np
from numpy.typing import ArrayLike
from scipy.spatial.distance import cdist

from kineme._util.arrays import Floats, Ints
from kineme.errors import ParameterError
from kineme.evaluation.comparison import Comparison
from kineme.evaluation.score import Score, choose_number
from kineme.evaluation.truth import TRANSITION, Labelling
from kineme.features._kernels import find_cheapest_path
from kineme.features.point_clouds import compute_cloud_distances

Distances = Callable[[slice, slice], Floats]

WINDOW_S = 1 / 3


@dataclass(frozen=True)
class ClusterVariance:
    """One cluster: its segments, their distances from each other, and their lengths.

    Distances are nan for a single segment, variances where there are fewer
    than two values.

    Examples
    --------
    >>> found = Labelling.from_cuts([2], ["0", "0"], frames=4, fps=2)
    >>> (cluster,) = feature_variance([[0.0], [1.0], [0.0], [1.5]], found)
    >>> cluster.segments, cluster.distance_mean, cluster.length_mean_s
    (2, 0.25, 1.0)
    """

    label: str
    segments: int
    distance_mean: float
    distance_variance: float
    length_mean_s: float
    length_variance_s2: float


def point_cloud_variance(positions: ArrayLike, found: Labelling) -> list[ClusterVariance]:
    """Return the distances of each cluster's segments as moving point clouds, in metres.

    Parameters
    ----------
    positions : array_like of shape (frames, joints, 3)
        Metres, y up, at the rate of ``found``.
    found : Labelling
        The segments; transitions are left out.

    Raises
    ------
    ParameterError
        Positions of another shape or length.

    Examples
    --------
    >>> import kineme
    >>> motion = kineme.read(kineme.bundled_recording())[:60]
    >>> steps = Labelling.from_cuts([30], ["step", "step"], frames=60, fps=60)
    >>> point_cloud_variance(motion.positions, steps)[0].segments
    2
    """
    points = np.asarray(positions, np.float64)
    if points.ndim != 3 or points.shape[2] != 3:
        raise ParameterError(f"positions must be (frames, joints, 3), not {points.shape}")
    half = round(WINDOW_S * found.fps / 2)
    return _variances(
        lambda a, b: compute_cloud_distances(points, a, b, half=half), len(points), found
    )


def feature_variance(features: ArrayLike, found: Labelling) -> list[ClusterVariance]:
    """Return the distances of each cluster's segments in feature space.

    Parameters
    ----------
    features : array_like of shape (frames, dims)
        Stacked, at the rate of ``found``.
    found : Labelling
        The segments; transitions are left out.

    Raises
    ------
    ParameterError
        Features of another shape or length.

    Examples
    --------
    >>> found = Labelling.from_cuts([2], ["0", "0"], frames=4, fps=2)
    >>> feature_variance([[0.0], [1.0], [0.0], [1.5]], found)[0].distance_mean
    0.25
    """
    vectors = np.asarray(features, np.float64)
    if vectors.ndim != 2:
        raise ParameterError(f"features must be (frames, dims), not {vectors.shape}")
    return _variances(lambda a, b: cdist(vectors[a], vectors[b]), len(vectors), found)


def overall(clusters: list[ClusterVariance]) -> tuple[float, float]:
    """Return mean distance and mean variance over the clusters of at least two segments.

    Clusters weigh the same, as bars of a figure do; nan where there is none.

    Examples
    --------
    >>> found = Labelling.from_cuts([2], ["0", "0"], frames=4, fps=2)
    >>> overall(feature_variance([[0.0], [1.0], [0.0], [1.5]], found))
    (0.25, 0.0)
    """
    shared = [c for c in clusters if c.segments > 1]
    if not shared:
        return float("nan"), float("nan")
    return (
        float(np.mean([c.distance_mean for c in shared])),
        float(np.mean([c.distance_variance for c in shared])),
    )


def length_variance(found: Labelling) -> tuple[float, float]:
    """Mean length in seconds, and mean variance of lengths, over the clusters as in `overall`."""
    lengths: dict[str, list[float]] = {}
    for label, frames in zip(found.labels, np.diff(found.borders), strict=True):
        if label != TRANSITION:
            lengths.setdefault(label, []).append(frames / found.fps)
    # A single segment has no variance.
    shared = [seconds for seconds in lengths.values() if len(seconds) > 1]
    if not shared:
        return float("nan"), float("nan")
    return (
        float(np.mean([np.mean(seconds) for seconds in shared])),
        float(np.mean([np.var(seconds, ddof=1) for seconds in shared])),
    )


def _variances(distances: Distances, frames: int, found: Labelling) -> list[ClusterVariance]:
    if frames != found.frames:
        raise ParameterError(f"the segments cover {found.frames} frames, the data {frames}")
    spans: dict[str, list[slice]] = {}
    for label, start, stop in zip(found.labels, found.starts, found.stops, strict=True):
        if label != TRANSITION:
            spans.setdefault(label, []).append(slice(int(start), int(stop)))
    return [_variance(label, rows, distances, found.fps) for label, rows in spans.items()]


def _variance(label: str, spans: list[slice], distances: Distances, fps: float) -> ClusterVariance:
    lengths: Ints = np.array([span.stop - span.start for span in spans])
    normalised = []
    for i, j in combinations(range(len(spans)), 2):
        cost, _, _ = find_cheapest_path(np.ascontiguousarray(distances(spans[i], spans[j])), 0.0)
        # The path costs the same in both directions, so one warp gives both ordered pairs.
        normalised += [cost / lengths[i], cost / lengths[j]]
    seconds = lengths / fps
    return ClusterVariance(
        label,
        len(spans),
        float(np.mean(normalised)) if normalised else float("nan"),
        float(np.var(normalised, ddof=1)) if normalised else float("nan"),
        float(seconds.mean()),
        float(seconds.var(ddof=1)) if len(spans) > 1 else float("nan"),
    )


def _clouds(compared: Comparison) -> tuple[float, float] | None:
    spans = compared.spans
    if spans.positions is None:
        return None
    return overall(point_cloud_variance(spans.positions, spans.primitives))


def _vectors(compared: Comparison) -> tuple[float, float] | None:
    spans = compared.spans
    if spans.features is None:
        return None
    return overall(feature_variance(spans.features, spans.primitives))


def _lengths(compared: Comparison) -> tuple[float, float]:
    return length_variance(compared.spans.primitives)


SCORES = (
    Score("cloud_distance", "cloud distance, m", "between segments of a cluster, as point clouds",
          "clusters", choose_number(_clouds, 0)),
    Score("cloud_variance", "cloud variance, m²", "of these distances", "clusters",
          choose_number(_clouds, 1)),
    Score("feature_distance", "feature distance, m", "the same by their features", "clusters",
          choose_number(_vectors, 0)),
    Score("feature_variance", "feature variance, m²", "of these distances", "clusters",
          choose_number(_vectors, 1)),
    Score("length_mean", "length, s", "of the segments of a cluster", "clusters",
          choose_number(_lengths, 0)),
    Score("length_variance", "length variance, s²", "of these lengths", "clusters",
          choose_number(_lengths, 1)),
)  # fmt: skip
