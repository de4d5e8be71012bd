"""Clusters of single recordings made the same in a whole set, to score one mapping for all.

Each cluster is the mean posture and energy of its moments, in the units of the file, so that
recordings can be compared; each channel is divided by its deviation over the set, and means and
each band weigh the same. Ward's linkage joins the clusters of all recordings into as many as the
set has classes: published methods that are scored with one mapping are told that number, too.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy.cluster.hierarchy import fcluster, linkage

from kineme import Segmentation, Signals
from kineme.evaluation.comparison import Comparison
from kineme.methods.hierarchy.preset import SENSORS
from kineme.methods.hierarchy.statistics import channel_statistics
from kineme.segmentation.channels import at_rate

Floats = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Described:
    """The clusters of a recording: their numbers, mean statistics, and moments of each."""

    clusters: list[int]
    means: Floats
    moments: Floats
    squares: Floats
    channels: int


def described(recording: Signals, found: Segmentation) -> Described:
    """Mean statistics of the clusters of a recording."""
    preset = SENSORS.at_most(recording.fps)
    values = at_rate(recording.values, recording.fps, preset.working_fps, smoothing=0.0)
    seen = channel_statistics(
        values, preset.working_fps, rate=preset.rate, window=preset.averaging, bands=preset.bands
    )
    at = np.minimum(np.arange(len(seen)) / preset.rate * recording.fps, recording.n_frames - 1)
    rows = found.activities
    labels = rows.cluster[np.searchsorted(rows.stop_frame, at.astype(np.int64), "right")]
    clusters = np.unique(labels).tolist()
    groups = [seen[labels == cluster] for cluster in clusters]
    return Described(
        clusters,
        np.array([group.mean(axis=0) for group in groups]),
        np.array([len(group) for group in groups], np.float64),
        np.array([(group**2).mean(axis=0) for group in groups]),
        recording.n_channels,
    )


def one_vocabulary(
    compared: Sequence[Comparison], recordings: Sequence[Described], n_classes: int
) -> list[Comparison]:
    """The comparisons with clusters that mean the same in all of them."""
    weights = np.concatenate([one.moments for one in recordings])
    means = np.concatenate([one.means for one in recordings])
    squares = np.concatenate([one.squares for one in recordings])
    middle = np.average(means, axis=0, weights=weights)
    variances = np.average(squares, axis=0, weights=weights) - middle**2
    channels = recordings[0].channels
    parts = variances.reshape(-1, channels)
    whole = np.maximum(parts[0], 1e-12)  # of each channel's means
    shares = parts / whole
    scaled = (means - middle).reshape(len(means), -1, channels) / np.sqrt(whole)
    scaled = scaled / np.sqrt(np.maximum(shares.mean(axis=1), 1e-12))[:, None]
    labels = fcluster(linkage(scaled.reshape(len(means), -1), "ward"), n_classes, "maxclust")
    shared, first = [], 0
    for comparison, one in zip(compared, recordings, strict=True):
        numbers = dict(
            zip(one.clusters, labels[first : first + len(one.clusters)].tolist(), strict=True)
        )
        first += len(one.clusters)
        found = np.array([numbers.get(each, -1) for each in comparison.found.tolist()])
        shared.append(replace(comparison, found=found, mapping=None))
    return shared
