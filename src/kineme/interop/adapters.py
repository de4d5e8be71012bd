"""Convert segments to and from the representations of other packages.

kineme's spans are half-open frames ``[start, stop)``. Others treat the ends differently:

========== =====================================================================
ruptures   ends of all segments, including the number of frames but not 0
aeon       change points, including neither 0 nor the number of frames
sktime     a frame with intervals ``[start, stop)`` as ``ilocs``, and ``labels``
mir_eval   ``(n, 2)`` seconds from 0 to the end, and a list of labels
========== =====================================================================

Texts are those of `kineme.labels.spans`. Conversion back creates segments of the activity
level.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from kineme._util.checks import require_extra
from kineme.errors import ParameterError
from kineme.labels.spans import format_text, join_lines, parse_text
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


def from_ruptures(breakpoints: Sequence[int], *, fps: float) -> Segmentation:
    """Return activities that end at the breakpoints; the last one is the number of frames.

    Examples
    --------
    >>> from kineme.interop.adapters import from_ruptures
    >>> from_ruptures([40, 100], fps=10).activities.stop_s.tolist()
    [4.0, 10.0]
    """
    stops = _check_frames(breakpoints, "breakpoints")
    if not len(stops):
        raise ParameterError("breakpoints must contain at least the number of frames")
    return _make_activities([0, *stops], [""] * len(stops), fps)


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


def from_aeon(change_points: ArrayLike, *, n_frames: int, fps: float) -> Segmentation:
    """Return activities that meet at change points without both ends, as aeon and claspy use.

    Examples
    --------
    >>> from kineme.interop.adapters import from_aeon
    >>> from_aeon([40], n_frames=100, fps=10).activities.stop_s.tolist()
    [4.0, 10.0]
    """
    cuts = _check_frames(change_points, "change_points")
    return _make_activities([0, *cuts, n_frames], [""] * (len(cuts) + 1), fps)


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


def from_sktime(segments: pd.DataFrame, *, fps: float) -> Segmentation:
    """Return activities from contiguous intervals, with texts from ``labels`` if present.

    Examples
    --------
    >>> from kineme import read_segments
    >>> from kineme.datasets import bundled_truth
    >>> from kineme.interop.adapters import from_sktime, to_sktime
    >>> truth = read_segments(bundled_truth(), fps=60)
    >>> from_sktime(to_sktime(truth), fps=60).activities[0].label
    'walk'
    """
    spans = segments["ilocs"].array
    if getattr(spans, "closed", None) != "left":
        raise ParameterError("ilocs must be left-closed intervals")
    starts, stops = _check_frames(spans.left, "ilocs"), _check_frames(spans.right, "ilocs")
    texts = segments["labels"] if "labels" in segments else [""] * len(spans)
    return _join_intervals(starts, stops, list(map(str, texts)), fps)


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


def from_mir_eval(intervals: ArrayLike, labels: Sequence[str], *, fps: float) -> Segmentation:
    """Return activities from contiguous intervals in seconds from 0, at the nearest frames.

    Examples
    --------
    >>> from kineme.interop.adapters import from_mir_eval
    >>> from_mir_eval([[0, 4], [4, 10]], ["walk", "jump"], fps=10).activities.label.tolist()
    ['walk', 'jump']
    """
    times = np.asarray(intervals, float)
    if times.ndim != 2 or times.shape[1] != 2 or not np.isfinite(times).all():
        raise ParameterError(f"intervals must be finite, (n, 2), not of shape {times.shape}")
    # Round halves up, as when reading label files.
    frames = np.floor(times * fps + 0.5).astype(np.int64)
    return _join_intervals(frames[:, 0], frames[:, 1], list(labels), fps)


def _join_intervals(
    starts: NDArray[np.int64], stops: NDArray[np.int64], texts: Sequence[str], fps: float
) -> Segmentation:
    if len(starts) != len(texts) or not len(starts):
        raise ParameterError(f"{len(starts)} intervals and {len(texts)} labels: give one for each")
    if starts[0] != 0 or (starts[1:] != stops[:-1]).any():
        raise ParameterError(
            "intervals must start at 0, and each must start where the previous one stops"
        )
    return _make_activities([0, *stops], texts, fps)


def _make_activities(borders: Sequence[Any], texts: Sequence[str], fps: float) -> Segmentation:
    """Return activities from borders in frames and a text for each."""
    kinds, clusters, labels = zip(*(parse_text(join_lines(text)) for text in texts), strict=True)
    columns: dict[str, Any] = {
        "level": ["activity"] * len(texts),
        "kind": kinds,
        "start_frame": np.array(borders[:-1], np.int64),
        "stop_frame": np.array(borders[1:], np.int64),
        "cluster": clusters,
        "label": labels,
    }
    return Segmentation.from_columns(columns, n_frames=int(borders[-1]), fps=fps)


def _check_frames(values: ArrayLike, name: str) -> NDArray[np.int64]:
    frames = np.asarray(values)
    if frames.ndim != 1 or (frames.size and frames.dtype.kind not in "iu"):
        raise ParameterError(f"{name} must be consecutive whole numbers, not {frames.dtype}")
    return frames.astype(np.int64)
