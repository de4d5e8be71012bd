"""Uniform cuts: the control that every score has to tell from a result."""

from __future__ import annotations

import numpy as np

from kineme.errors import ParameterError
from kineme_reproduction.baselines.segments import Segments, unclustered


def uniform(n_frames: int, *, fps: float, seconds: float) -> Segments:
    """Cut at regular intervals, each at the nearest frame; find no clusters.

    Raises
    ------
    ParameterError
        The cuts would be less than a frame apart.
    """
    step = seconds * fps
    if not step >= 1:
        raise ParameterError(
            f"cuts every {seconds:g} s are less than a frame apart at {fps:g} fps: use at least "
            f"{1 / fps:.4g} s"
        )
    cuts = np.rint(np.arange(1, int(n_frames / step) + 2) * step).astype(np.int64)
    return unclustered(cuts[cuts < n_frames], n_frames)
