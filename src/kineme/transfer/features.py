"""Features in which primitives are compared: those in which movements of different people match."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from kineme.features.canonical import MATCHING_FPS, matching_features
from kineme.features.canonical.matching import OFFSETS_S
from kineme.features.effectors import Names
from kineme.recordings import Motion
from kineme.segments.table import SegmentTable

FPS = MATCHING_FPS
SETTINGS = {"fps": FPS, "offsets_s": list(OFFSETS_S), "unit": "directions"}


def transfer_features(motion: Motion, *, effectors: Names | None = None) -> NDArray[np.float32]:
    """Features in which primitives are compared: unit vectors, whoever moves.

    Parameters
    ----------
    motion : Motion
    effectors : joints, optional
        To take for head, hands and feet where names do not tell.

    Returns
    -------
    (samples, 40) array
        Fifteen samples a second.

    Raises
    ------
    EndEffectorError
        Head, hands or feet were not found.

    Examples
    --------
    >>> import kineme
    >>> from kineme.transfer import transfer_features
    >>> motion = kineme.read(kineme.bundled_recording())
    >>> transfer_features(motion).shape
    (725, 40)
    """
    return matching_features(motion, effectors=effectors)


def working_frames(
    rows: SegmentTable, fps: float, n_features: int
) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """First frame and end of each row in the features; at least one frame each."""
    starts = np.minimum(np.rint(rows.start_frame * (FPS / fps)).astype(np.int64), n_features - 1)
    stops = np.minimum(np.rint(rows.stop_frame * (FPS / fps)).astype(np.int64), n_features)
    return starts, np.maximum(stops, starts + 1)
