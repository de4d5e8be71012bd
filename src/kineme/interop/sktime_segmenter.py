"""kineme as an sktime detector: ``predict`` returns the segments of a series.

Source: sktime.detection.base, sktime 1.2.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from kineme._util.checks import require_extra
from kineme.interop.adapters import to_sktime
from kineme.methods.estimator import Segmenter
from kineme.methods.presets import DEFAULT
from kineme.segments.table import Level

with require_extra("sktime", "segmenters"):
    from sktime.detection.base import BaseDetector

if TYPE_CHECKING:
    import pandas as pd


class KinemeSegmenter(BaseDetector):  # type: ignore[misc]
    """Finds segments of a series (time points, channels), like sktime's segmenters.

    Parameters
    ----------
    preset : str, optional
        As in `kineme.Segmenter`.
    fps : float, optional
        See `preset`.
    level : {"activity", "primitive"}, optional
        Level of the segments.
    constants : mapping of str to anything, optional
        Constants of the preset to override.

    Examples
    --------
    >>> import numpy as np
    >>> from kineme.interop.sktime_segmenter import KinemeSegmenter
    >>> segments = KinemeSegmenter(fps=30).fit_predict(np.sin(np.arange(300) / 5))
    """

    _tags = {  # noqa: RUF012
        "task": "segmentation",
        "learning_type": "unsupervised",
        "capability:multivariate": True,
        "fit_is_empty": True,
    }

    def __init__(
        self,
        preset: str = DEFAULT,
        fps: float | None = None,
        level: Level = "activity",
        constants: Mapping[str, Any] | None = None,
    ):
        self.preset = preset
        self.fps = fps
        self.level = level
        self.constants = constants
        super().__init__()

    def _predict(self, X: pd.DataFrame | pd.Series) -> pd.DataFrame:  # noqa: N803
        segmenter = Segmenter(self.preset, fps=self.fps, level=self.level, **(self.constants or {}))
        found = to_sktime(segmenter.fit(X).segmentation_, level=self.level)
        if rows := segmenter.segmentation_.rows():  # convert from frames to rows of X
            import pandas as pd

            at = segmenter.segmentation_.table.level == self.level
            ends = rows["start_row"][at], rows["stop_row"][at]
            found["ilocs"] = pd.IntervalIndex.from_arrays(*ends, closed="left")
        return found

    @classmethod
    def get_test_params(cls, parameter_set: str = "default") -> list[dict[str, Any]]:  # noqa: ARG003
        """Return parameters for sktime's checks."""
        return [{"fps": 30.0}, {"fps": 10.0, "level": "primitive"}]
