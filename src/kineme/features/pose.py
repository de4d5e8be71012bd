"""Compute pose features, and stack them with neighbouring frames.

A pose is 15 numbers: x, y, z of the left ankle, right ankle, head, left wrist
and right wrist in the body's own frame (see ``compute_body_frame``), in metres. Stacked
with the poses some frames before and after it, it also shows the direction of
movement.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike

from kineme._util.arrays import Floats
from kineme._util.checks import as_floats, as_indices
from kineme.errors import ParameterError
from kineme.features.body_frame import compute_body_frame
from kineme.features.effectors import EndEffectors, Names, end_effectors
from kineme.recordings import Motion
from kineme.recordings.motion import check_motion


def pose_features(motion: Motion, *, effectors: EndEffectors | Names | None = None) -> Floats:
    """Return the positions (frames, 15) of the end effectors in the body's own frame, in metres.

    Parameters
    ----------
    motion : Motion
    effectors : EndEffectors or mapping of str to str or sequence of str, optional
        The end effectors or their names (see ``end_effectors``); by default they are searched.

    Raises
    ------
    EndEffectorError
        Head, hands or feet were not found.

    References
    ----------
    Voegele et al. 2014, section 3.1 (feature set of 15 values).

    Examples
    --------
    >>> import kineme
    >>> motion = kineme.read(kineme.bundled_recording())
    >>> kineme.pose_features(motion).shape
    (2898, 15)
    """
    check_motion(motion, "pose_features")
    if not isinstance(effectors, EndEffectors):
        effectors = end_effectors(motion, names=effectors)
    local = compute_body_frame(motion, effectors.indices, effectors=effectors)
    return local.reshape(len(local), -1)


def stack(features: ArrayLike, offsets: Sequence[int]) -> Floats:
    """Stack frames with their neighbours: row t holds ``features[t + o]`` for ascending offsets o.

    Beyond both ends, features are extrapolated linearly from the two outermost frames; a
    single frame is repeated.

    Parameters
    ----------
    features : array_like of shape (frames, dims)
    offsets : sequence of int
        Frames relative to t; 0 is not added automatically.

    Returns
    -------
    (frames, dims * number of offsets) array

    Raises
    ------
    ParameterError
        The features are not two-dimensional or have no rows; or offsets are empty or not distinct.

    Examples
    --------
    >>> import kineme
    >>> kineme.stack([[0.0], [1.0], [2.0]], [-1, 0]).tolist()
    [[-1.0, 0.0], [0.0, 1.0], [1.0, 2.0]]
    """
    features = as_floats(features, "features")
    offsets = as_indices(offsets, "offsets")
    if features.ndim != 2 or len(features) == 0:
        raise ParameterError(f"features must be frames x dims, not of shape {features.shape}")
    if len(offsets) == 0 or len(set(offsets)) < len(offsets):
        raise ParameterError(f"offsets must be different frames, at least one, not {offsets!r}")
    # Number of frames that are needed beyond each end.
    before, after = max(0, -min(offsets)), max(0, *offsets)
    longer = _extrapolate(features, before, after)
    frames, dims = features.shape
    stacked = np.empty((frames, len(offsets), dims))
    for block, offset in enumerate(sorted(offsets)):
        # Frame t + offset of the features is row before + t + offset of the longer array.
        stacked[:, block] = longer[before + offset : before + offset + frames]
    return stacked.reshape(frames, -1)


def round_offsets(offsets_s: Sequence[float], fps: float) -> tuple[int, ...]:
    """Convert offsets from seconds to whole frames, ascending.

    Raises
    ------
    ParameterError
        An offset is not finite, or two fall on the same frame.

    Examples
    --------
    >>> from kineme.features import round_offsets
    >>> round_offsets([-0.1, 0.0, 0.1], 30.0)
    (-3, 0, 3)
    """
    if not (fps > 0 and np.isfinite(fps)):
        raise ParameterError(f"fps must be a positive number, not {fps!r}")
    if not np.all(np.isfinite(offsets_s)):
        raise ParameterError(f"offsets must be finite seconds, not {offsets_s!r}")
    frames = tuple(sorted(round(offset * fps) for offset in offsets_s))
    if len(set(frames)) < len(frames):
        raise ParameterError(
            f"offsets {tuple(offsets_s)} s fall on the same frame at {fps:g} Hz: choose "
            "wider offsets"
        )
    return frames


def _extrapolate(features: Floats, before: int, after: int) -> Floats:
    """Extend features at both ends, linearly from the two outermost frames."""
    # A single frame is repeated.
    first = features[1] - features[0] if len(features) > 1 else np.zeros(features.shape[1])
    last = features[-1] - features[-2] if len(features) > 1 else first
    # The farthest frame is the first in time, so multiples descend.
    head = features[0] - np.arange(before, 0, -1)[:, None] * first
    tail = features[-1] + np.arange(1, after + 1)[:, None] * last
    return np.concatenate([head, features, tail])
