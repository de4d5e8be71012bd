"""kineme as an aeon segmenter: ``predict`` returns the change points of a series.

Source: aeon.segmentation.base, aeon 1.6.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from kineme._util.checks import require_extra
from kineme.methods.estimator import Segmenter
from kineme.methods.presets import DEFAULT
from kineme.segments.table import Level

with require_extra("aeon", "segmenters"):
    from aeon.segmentation.base import BaseSegmenter


class KinemeSegmenter(BaseSegmenter):  # type: ignore[misc]
    """Finds change points of a series (time points, channels), like aeon's segmenters.

    Parameters
    ----------
    preset : str, optional
        As in `kineme.Segmenter`.
    fps : float, optional
        See `preset`.
    level : {"activity", "primitive"}, optional
        Level whose borders are change points.
    constants : mapping of str to anything, optional
        Constants of the preset to override.
    n_segments : int, optional
        Number of segments, see `kineme.Segmenter`.
    """

    _tags = {"capability:multivariate": True, "fit_is_empty": True, "returns_dense": True}  # noqa: RUF012

    def __init__(
        self,
        preset: str = DEFAULT,
        fps: float | None = None,
        level: Level = "activity",
        constants: Mapping[str, Any] | None = None,
        n_segments: int | None = None,
    ):
        self.preset = preset
        self.fps = fps
        self.level = level
        self.constants = constants
        super().__init__(axis=0, n_segments=n_segments)

    def _predict(self, X: NDArray[Any]) -> NDArray[np.int64]:  # noqa: N803
        options = {"level": self.level, "n_segments": self.n_segments, **(self.constants or {})}
        segmenter = Segmenter(self.preset, fps=self.fps, **options)
        return segmenter.fit(X.reshape(len(X), -1)).change_points_

    @classmethod
    def _get_test_params(cls, parameter_set: str = "default") -> dict[str, Any]:  # noqa: ARG003
        """Return parameters for aeon's checks."""
        return {"fps": 10.0}
