"""Joints among channels: where the places of a body's points are given as channels.

A place says where somebody stands and which way they face, and only then how; and all
coordinates share the first two. So they are seen by how far points are from each other, as
bodies are whose head, hands and feet nobody can tell (`kineme.features.distance_features`).
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from kineme._arrays import Floats
from kineme.features import distance_features
from kineme.features.bones import have_bones
from kineme.recordings import Signals
from kineme.recordings.coordinates import axes_by_point, is_body

Indices = NDArray[np.intp]

AXES = "xyz"
STEADY = 0.15
"""Seconds: places are smoothed by a normal curve that deviates by this. Joints that a camera
guesses shake as much as hands move."""


def joints_among(signals: Signals) -> Indices | None:
    """Return the channels that are x, y and z of a body's points, by their names and by its bones.

    Parameters
    ----------
    signals : Signals

    Returns
    -------
    (points, 3) array or None
        None where there is no body.
    """
    points = [
        [signals.names.index(axes[axis]) for axis in AXES]
        for name, axes in axes_by_point(signals.names).items()
        if is_body(name) and len(axes) == len(AXES)
    ]
    if not points:
        return None
    values = np.concatenate([signals.values[slice(*span)] for span in signals.spans()])
    return np.array(points) if have_bones(values[:, points]) else None


def by_distances(rows: Sequence[Floats], points: Indices, fps: float) -> list[Floats]:
    """What distances between the points tell in place of their coordinates, and other channels.

    Parameters
    ----------
    rows : sequence of (samples, channels) array
        One of each span of the recording.
    points : (points, 3) array
        The channels that are their coordinates.
    fps : float
        Samples per second.
    """
    from scipy.ndimage import gaussian_filter1d

    places = [
        gaussian_filter1d(row[:, points.ravel()], STEADY * fps, axis=0, mode="nearest")
        for row in rows
    ]
    posture, _ = distance_features(np.concatenate(places).reshape(-1, *points.shape))
    others = np.delete(np.concatenate(rows), points.ravel(), axis=1)
    ends = np.cumsum([len(row) for row in rows])[:-1]
    return np.split(np.hstack([posture, others]), ends)
