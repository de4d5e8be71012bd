"""Convert segments to the representations of other packages.

kineme's spans are half-open frames ``[start, stop)``. Others treat the ends differently:

========== =====================================================================
ruptures   ends of all segments, including the number of frames but not 0
aeon       change points, including neither 0 nor the number of frames
sktime     a frame with intervals ``[start, stop)`` as ``ilocs``, and ``labels``
mir_eval   ``(n, 2)`` seconds from 0 to the end, and a list of labels
========== =====================================================================

Texts are those of `kineme.labels.spans`.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from kineme._util.checks import require_extra
from kineme.labels.spans import format_text
from kineme.segments.segmentation import Segmentation
from kineme.segments.table import Level

if TYPE_CHECKING:
    import pandas as pd


def to_ruptures(segmentation: Segmentation, *, level: Level = "activity") -> list[int]:
    """Return the ends of all segments including ``n_frames``, like ``predict`` of ruptures.

    Examples
    --------
    >>> from kineme import read_segments
    >>> from kineme.datasets import bundled_truth
    >>> from kineme.interop.adapters import to_ruptures
    >>> truth = read_segments(bundled_truth(), fps=60)
    >>> to_ruptures(truth)[:3]
    [326, 380, 928]
    """
    stops: list[int] = segmentation.level(level).stop_frame.tolist()
    return stops


def to_aeon(segmentation: Segmentation, *, level: Level = "activity") -> NDArray[np.int64]:
    """Return the frames at which a segment starts, without 0: aeon's change points.

    aeon's other convention, a label for each frame, is
    `kineme.Segmentation.per_frame`.

    Examples
    --------
    >>> from kineme import read_segments
    >>> from kineme.datasets import bundled_truth
    >>> from kineme.interop.adapters import to_aeon
    >>> truth = read_segments(bundled_truth(), fps=60)
    >>> to_aeon(truth)[:3].tolist()
    [326, 380, 928]
    """
    return segmentation.cuts(level)


def to_sktime(segmentation: Segmentation, *, level: Level = "activity") -> pd.DataFrame:
    """Return a data frame with left-closed intervals ``ilocs`` and texts ``labels``.

    Raises
    ------
    MissingDependencyError
        pandas is not installed.

    Examples
    --------
    >>> from kineme import read_segments
    >>> from kineme.datasets import bundled_truth
    >>> from kineme.interop.adapters import to_sktime
    >>> truth = read_segments(bundled_truth(), fps=60)
    >>> to_sktime(truth)["labels"][0]
    'walk'
    """
    with require_extra("pandas", "tables"):
        import pandas as pd
    rows = segmentation.level(level)
    spans = pd.IntervalIndex.from_arrays(rows.start_frame, rows.stop_frame, closed="left")
    return pd.DataFrame({"ilocs": spans, "labels": list(map(format_text, rows))})


def to_mir_eval(
    segmentation: Segmentation, *, level: Level = "activity"
) -> tuple[NDArray[np.float64], list[str]]:
    """Return intervals ``(n, 2)`` in seconds and their texts for ``mir_eval.segment``.

    Examples
    --------
    >>> from kineme import read_segments
    >>> from kineme.datasets import bundled_truth
    >>> from kineme.interop.adapters import to_mir_eval
    >>> truth = read_segments(bundled_truth(), fps=60)
    >>> intervals, labels = to_mir_eval(truth)
    >>> intervals.shape[0] == len(labels)
    True
    """
    rows = segmentation.level(level)
    return np.column_stack([rows.start_s, rows.stop_s]), list(map(format_text, rows))
