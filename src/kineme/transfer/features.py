"""Features in which primitives are compared: those of the ``kineme`` method, in any recording."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from kineme.features import end_effectors
from kineme.features.effectors import Names
from kineme.methods.recurrence.preset import KINEME
from kineme.recordings import Motion
from kineme.segmentation.bodies import motion_features
from kineme.segments.table import SegmentTable

FPS = KINEME.working_fps / KINEME.step
SETTINGS = {"fps": FPS, "offsets_s": list(KINEME.offsets), "unit": "body sizes"}
DIMS = 15 * len(KINEME.offsets)


def transfer_features(motion: Motion, *, effectors: Names | None = None) -> NDArray[np.float64]:
    """Features in which primitives are compared, in body sizes.

    Parameters
    ----------
    motion : Motion
    effectors : joints, optional
        To take for head, hands and feet where names do not tell.

    Returns
    -------
    (samples, 75) array
        Ten samples a second.

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
    (483, 75)
    """
    found = end_effectors(motion, names=effectors)
    return motion_features(motion, KINEME, effectors=found)[:: KINEME.step]


def working_frames(
    rows: SegmentTable, fps: float, n_features: int
) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """First frame and end of each row in the features; at least one frame each."""
    starts = np.minimum(np.rint(rows.start_frame * (FPS / fps)).astype(np.int64), n_features - 1)
    stops = np.minimum(np.rint(rows.stop_frame * (FPS / fps)).astype(np.int64), n_features)
    return starts, np.maximum(stops, starts + 1)
